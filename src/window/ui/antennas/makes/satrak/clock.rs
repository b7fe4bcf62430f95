//! Clock of the unit, and its effect on the track.

use egui::{Rect, Sense, Ui, pos2, vec2};

use crate::{
    astro::time::add_seconds,
    contract::passes::PredictedPass,
    controller::satrak::settings::{
        AHEAD_S, CATALOG_NUMBER, CLOCK, FILE, FROM_GPS, FROM_THIS_PC, SET_FROM,
    },
    device::settings::Values,
    model::{Model, UiCommand},
    ui::{
        antennas::{
            cards::{fields, is_reported},
            draft::Outcome,
            form::Form,
            row,
            unit::ShownUnit,
        },
        format,
        icons::Icon,
        text, theme,
        widgets::button::{Button, SMALL_HEIGHT},
        words,
    },
};

const DIFFERENCE: &str = "Against this computer";
const LABEL: &str = "Effect on the track";

pub(super) fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    commands: &mut Vec<UiCommand>,
) {
    fields(ui, unit, form, CLOCK.key, |field| is_reported(field) && field.key != AHEAD_S.name);
    difference(ui, unit);
    effect(ui, unit);
    ui.add_space(6.0);
    set(ui, unit, form, commands);
}

/// Shows the clock difference in words, because the operator would have to interpret a sign.
fn difference(ui: &mut Ui, unit: &ShownUnit<'_>) {
    let t = theme::tokens(ui);
    let clock = unit.antenna.snapshot.state.on_board.clock.filter(|clock| clock.is_set);
    let Some(clock) = clock else { return row::plain(ui, DIFFERENCE, "not known", None) };
    let disabled = (Some(Icon::Warning), "Off", t.warn);
    let words = words::compared_clock(clock.ahead_s);
    row::plain(ui, DIFFERENCE, &words, clock.is_surely_off().then_some(disabled));
}

/// Shows the pointing error that the unit's clock causes.
fn effect(ui: &mut Ui, unit: &ShownUnit<'_>) {
    let t = theme::tokens(ui);
    let ahead_s = unit.values(CLOCK.key).and_then(|values| AHEAD_S.get(values));
    let predicted = predicted_pass(unit);
    let rate_deg_s = predicted.and_then(|predicted| rate_at_tca(unit.model, predicted));
    let (Some(ahead_s), Some(predicted), Some(rate_deg_s)) = (ahead_s, predicted, rate_deg_s)
    else {
        return row::plain(ui, LABEL, "select a pass", None);
    };
    let off_deg = (ahead_s * rate_deg_s).abs();
    let deviation_text = format::degrees(off_deg, 1);
    let value = format!("{deviation_text} along the path of {}", predicted.satellite.short_name());
    let verdict = if off_deg <= unit.antenna.config.beam_width_deg / 2.0 {
        (Some(Icon::Check), "Inside beam", t.t3)
    } else {
        (Some(Icon::Warning), "Outside beam", t.warn)
    };
    row::plain(ui, LABEL, &value, Some(verdict));
}

/// Returns the pass of the tracked satellite, else of the satellite on the unit, else the selected
/// pass.
fn predicted_pass<'a>(unit: &ShownUnit<'a>) -> Option<&'a PredictedPass> {
    let model = unit.model;
    let current_number = || {
        let number = unit.values(FILE.key).and_then(|values| CATALOG_NUMBER.get(values))?;
        u32::try_from(number).ok()
    };
    let number = unit.antenna.tracked_number().or_else(current_number);
    number.and_then(|number| model.pass_of(number)).or_else(|| model.selected_pass())
}

/// Returns the angular rate of the satellite at TCA, degrees per second.
fn rate_at_tca(model: &Model, predicted: &PredictedPass) -> Option<f64> {
    let tca = predicted.pass.tca.time;
    let look = |seconds| {
        let time = add_seconds(tca, seconds);
        predicted.satellite.propagator.look_from(model.station.site, time).ok()
    };
    Some(look(-0.5)?.direction.separation(look(0.5)?.direction).degrees())
}

fn set(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let is_sending = form.draft(CLOCK.key).sent().is_some();
    let refusal = if !unit.is_open() {
        Some("There is no link.")
    } else if unit.tracks() {
        Some("Not while the unit is tracking.")
    } else if is_sending {
        Some("Sending.")
    } else {
        None
    };
    let size = vec2(ui.available_width(), SMALL_HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let mut left = rect.left();
    for (words, start) in [("Set from GPS", FROM_GPS), ("Set from this PC", FROM_THIS_PC)] {
        let button = Button::normal(words).locked(refusal.is_some());
        let size = vec2(button.width(ui), SMALL_HEIGHT);
        let place = Rect::from_min_size(pos2(left, rect.top()), size);
        left = place.right() + 8.0;
        if button.show(ui, words, place).clicked() {
            let values = Values::from([SET_FROM.entry(start)]);
            form.begin_report();
            form.send(unit, &CLOCK, values, commands);
        }
    }
    let outcome =
        CLOCK.field(SET_FROM.name).and_then(|field| form.draft(CLOCK.key).outcome(field, None));
    let spoken = match (refusal, outcome) {
        (Some(refusal), _) => refusal.to_owned(),
        (None, Some(Outcome::Taken(time) | Outcome::Verified(time))) => {
            format!("Set and read back {}", format::moment(time, unit.model.now))
        }
        (None, Some(Outcome::Rejected)) => "Not set. See below.".to_owned(),
        (None, None) => String::new(),
    };
    if !spoken.is_empty() {
        row::status_text(ui, rect.with_min_x(left), &spoken, text::small(), t.t2, &spoken);
    }
}
