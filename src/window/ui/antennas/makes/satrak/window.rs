//! Tracking window of the unit, and its automatic start.

use egui::{Align2, Rect, Ui, vec2};

use crate::{
    contract::{
        self,
        driver::{Command, Event, Refusal},
        passes::PredictedPass,
    },
    controller::satrak::settings::{START, STOP, WINDOW},
    device::{Motion, MotionRequest, settings::Value},
    model::UiCommand,
    ui::{
        antennas::{
            cards::fields,
            form::Form,
            row::{self, Columns},
            unit::ShownUnit,
        },
        format,
        icons::Icon,
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
        words,
    },
};

const AUTO: &str = "Automatic tracking";

pub(super) fn show(
    ui: &mut Ui,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    commands: &mut Vec<UiCommand>,
) {
    row::head(ui);
    automatic(ui, unit, form, commands);
    fields(ui, unit, form, WINDOW.key, |_| true);
    ui.add_space(8.0);
    take_from_pass(ui, unit, form);
}

/// Shows the switch for automatic tracking. The switch asks the operator before it switches on,
/// because the antenna may then start unattended.
fn automatic(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let columns = Columns::new(row::take(ui));
    let program = unit.antenna.snapshot.state.program.filter(|_| unit.is_open());
    let auto = program.map(|program| program.auto);
    paint::text_in(ui, columns.label, Align2::LEFT_CENTER, AUTO, text::small(), t.t1);
    let value = match auto {
        Some(Some(true)) => "On",
        Some(Some(false)) => "Off",
        Some(None) => "Not reported",
        None => "–",
    };
    let name = format!("{AUTO}, on the unit: {value}");
    row::status_text(ui, columns.on_unit, value, text::small(), t.t2, &name);
    let place = columns.new.with_max_x(columns.state.right());
    let send = |on| UiCommand::antenna(unit.antenna.id(), Command::AutoTrack(on));
    if auto == Some(Some(true)) {
        let button = Button::normal("Switch off");
        let place = place.with_max_x(place.left() + button.width(ui));
        if button.show(ui, "auto off", place).clicked() {
            commands.push(send(false));
        }
    } else if auto.is_some() {
        let button = Button::normal("Switch on…");
        let place = place.with_max_x(place.left() + button.width(ui));
        if button.show(ui, "auto on", place).clicked() {
            form.auto_asked = Some(unit.model.now);
            commands.push(send(true));
        }
    }
    let note = match auto {
        Some(Some(true)) => "On: the antenna starts by itself when the window begins.",
        Some(None) => "This unit does not report whether it starts by itself.",
        _ => "",
    };
    if !note.is_empty() {
        row::note(ui, Some(Icon::Info), note, t.t2);
    }
    if let Some(words) = refusal(unit, form) {
        row::note(ui, Some(Icon::Cross), &words, t.bad);
    }
}

/// Returns the reason why a request for automatic tracking failed, from the events.
fn refusal(unit: &ShownUnit<'_>, form: &Form) -> Option<String> {
    let requested = form.auto_asked?;
    let (event, _) = unit.antenna.news.as_ref().filter(|(_, time)| *time >= requested)?;
    match event {
        Event::NotSent(refusal) => Some(words::refusal(refusal, unit.model.now)),
        Event::Refused(MotionRequest::Motion(Motion::EnableAuto), answer) => {
            Some(format!("{AUTO}: the unit answered {answer}."))
        }
        Event::Unanswered(MotionRequest::Motion(Motion::EnableAuto)) => {
            Some(format!("{AUTO}: the unit did not answer."))
        }
        _ => None,
    }
}

/// Offers AOS and LOS of the selected pass as new values.
fn take_from_pass(ui: &mut Ui, unit: &ShownUnit<'_>, form: &mut Form) {
    let t = theme::tokens(ui);
    let pass = unit.model.selected_pass();
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), SMALL_HEIGHT), egui::Sense::hover());
    let model = unit.model;
    let window = |predicted: &PredictedPass| {
        contract::passes::window(predicted, &unit.antenna.config, model.station.site, model.now)
    };
    let window = pass.map_or(Err(Refusal::PassUnknown), window);
    let can = window.is_ok() && unit.is_open() && unit.values(WINDOW.key).is_some();
    let button = Button::normal("Take from pass").locked(!can);
    let place = rect.with_max_x(rect.left() + button.width(ui));
    let clicked = button.show(ui, "take from pass", place).clicked();
    let room = Rect::from_min_max(place.right_top() + vec2(8.0, 0.0), rect.max);
    let words = pass.map_or_else(
        || "No pass is selected.".to_owned(),
        |predicted| {
            let name = predicted.satellite.short_name();
            match &window {
                Ok((start, stop)) => {
                    format!("{name}, {}", format::stretch(*start, *stop, model.now))
                }
                Err(refusal) => words::refusal(refusal, model.now),
            }
        },
    );
    row::status_text(ui, room, &words, text::small(), t.t3, &words);
    let (true, Ok((start, stop))) = (clicked, window) else { return };
    // The unit accepts no time in the past.
    for (key, time) in [(START, start.max(unit.model.now)), (STOP, stop)] {
        if let Some(field) = WINDOW.field(key.name) {
            let text = key.kind.text(&Value::Time(time));
            form.draft(WINDOW.key).type_in(field, text, unit.values(WINDOW.key));
        }
    }
}
