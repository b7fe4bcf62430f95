//! The selected pass: path, times, the part that each antenna can track, and the operator's choice.

use egui::{Align2, Frame, Margin, Rect, Sense, Ui, pos2, vec2};

use super::{PADDING, PlanState};
use crate::{
    contract::{self, antenna::AntennaModel, automatic::Operation, driver::LinkState},
    model::{Model, UiCommand, View, plan::PlannedPass, rehearsal::RehearsalState},
    orbit::PassPoint,
    plan::schedule::{AntennaOff, Entry, LeftOutReason},
    station::{Priority, Take},
    ui::{
        format,
        icons::{self, Icon},
        pass_limits, replay, small_sky,
        text::{self, Weight},
        theme,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            inspector::{self, Head, Parts},
            paint,
            segmented::{self, Segment},
        },
        words,
    },
};

const PLOT: f32 = 188.0;
const LINE: f32 = 20.0;
const FOOT: f32 = 48.0;
const GAP: f32 = 8.0;
const LABEL: f32 = 80.0;

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    inspector::show_ground(ui, rect);
    let Some(planned) = model.selected_planned() else {
        return inspector::show_nothing(ui, rect, "No pass selected", "Click a bar or a row.");
    };
    let Parts { head, body, foot } = Parts::new(rect, FOOT);
    show_head(ui, head, model, &planned);
    inspector::show_body(ui, body, "plan", |ui| {
        parts(ui, body.width(), model, &planned, state, commands);
    });
    ui.painter().hline(foot.x_range(), foot.top() + 0.5, (1.0, t.line));
    let inner = foot.shrink2(vec2(PADDING, GAP));
    let button = Button::normal("Open on sky plot").icon(Icon::CrossHair);
    let place = Rect::from_min_size(inner.min, vec2(inner.width(), BUTTON));
    if button.show(ui, "plan sky plot", place).clicked() {
        commands.push(UiCommand::Show(View::Operate));
    }
}

fn show_head(ui: &Ui, rect: Rect, model: &Model, planned: &PlannedPass<'_>) {
    let predicted = planned.predicted;
    let is_up = predicted.in_progress(model.now);
    let (event, time) =
        if is_up { ("LOS", predicted.pass.los.time) } else { ("AOS", predicted.pass.aos.time) };
    let countdown = format::countdown(model.now, time);
    let age = format::age(predicted.satellite.elements.age_s(model.now));
    let detail = format!("{}, elements {age} old", predicted.number());
    let name = predicted.satellite.short_name();
    let head = Head { name, detail: &detail, event, countdown: &countdown, indent: 0.0 };
    inspector::show_head(ui, rect, "plan", head);
}

fn parts(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    planned: &PlannedPass<'_>,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let place =
        |ui: &mut Ui, height: f32| inspector::place(ui, width, height).shrink2(vec2(PADDING, 0.0));
    let plot = place(ui, PLOT);
    let look = model.sky.selected.filter(|_| planned.predicted.in_progress(model.now));
    small_sky::show(ui, plot, model, planned.predicted, look.map(|selected| selected.look));
    let pass = &planned.predicted.pass;
    let head = place(ui, LINE);
    sighting(ui, head, ["", "UTC", "Azimuth", "Elevation"], t.t3);
    for (word, point) in [("AOS", &pass.aos), ("TCA", &pass.tca), ("LOS", &pass.los)] {
        let row = place(ui, LINE);
        event(ui, row, model, word, point);
    }
    let line = place(ui, GAP);
    ui.painter().hline(line.expand2(vec2(PADDING, 0.0)).x_range(), line.center().y, (1.0, t.line));
    for entry in &planned.entries {
        for (label, value) in facts(model, entry) {
            let row = place(ui, LINE);
            paint::fact_in(ui, ("plan fact", label), row, label, &value, t.t1);
        }
    }
    rehearsal(ui, width, model, planned, commands);
    let title = place(ui, 28.0);
    let font = text::sized(13.0, Weight::SemiBold);
    paint::text_in(ui, title, Align2::LEFT_CENTER, "Antennas", font, t.t1);
    for antenna in &model.antennas {
        let (icon, colour, words) = verdict(model, planned, antenna, t);
        let room = width - 2.0 * PADDING - 20.0;
        let text = format!("{}: {words}", antenna.config.name);
        let galley = ui.painter().layout(text.clone(), text::small(), t.t1, room);
        let row = place(ui, galley.size().y + 6.0);
        let position = pos2(row.left() + 6.0, row.top() + 9.0);
        icons::paint(ui.painter(), paint::square(position, 12.0), icon, colour);
        ui.painter().galley(row.min + vec2(20.0, 2.0), galley, t.t1);
        paint::name_text(ui, ("verdict", antenna.id().0), row, &text);
    }
    price(ui, width, model, planned, commands);
    controls(ui, width, model, planned, state, commands);
    Frame::new().inner_margin(Margin::symmetric(PADDING as i8, 8)).show(ui, |ui| {
        let number = planned.predicted.number();
        let lock = replay::lock(model);
        pass_limits::show(ui, width - 2.0 * PADDING, model, number, lock, commands);
    });
}

/// Shows the outcome of the pass in the last rehearsal, which is not recorded, and the button for a
/// new rehearsal.
fn rehearsal(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    planned: &PlannedPass<'_>,
    commands: &mut Vec<UiCommand>,
) {
    if planned.entries.is_empty() {
        return;
    }
    let key = planned.predicted.key();
    let sentences: Vec<String> = model
        .rehearsed(key)
        .map(|rehearsed_pass| {
            let promise = words::rehearsal::beside_promise(rehearsed_pass);
            let outcome = words::rehearsal::outcome(rehearsed_pass, model.now);
            format!("Rehearsal, {}: {promise}. {outcome}", rehearsed_pass.antenna_name)
        })
        .collect();
    for (index, words) in sentences.iter().enumerate() {
        note(ui, width, ("rehearsed", index), words);
    }
    let (row, _) = ui.allocate_exact_size(vec2(width, BUTTON + GAP), Sense::hover());
    let is_free = !matches!(model.rehearsal, RehearsalState::UnderWay(_));
    let lock = replay::lock(model);
    let button = Button::quiet("Rehearse this pass").locked(!is_free).locked_by(lock);
    let position = row.min + vec2(PADDING, GAP / 2.0);
    let place = Rect::from_min_size(position, vec2(button.width(ui), BUTTON));
    if button.show(ui, "rehearse pass", place).clicked() {
        commands.push(UiCommand::Rehearse(Some(key)));
    }
}

fn sighting(ui: &Ui, row: Rect, words: [&str; 4], colour: egui::Color32) {
    let right = Align2::RIGHT_CENTER;
    let [word, time, azimuth, elevation] = words;
    paint::text_in(ui, row, Align2::LEFT_CENTER, word, text::small(), colour);
    let rect = |x: f32| row.with_max_x(row.right() - x);
    paint::text_in(ui, rect(130.0), right, time, text::small(), colour);
    paint::text_in(ui, rect(64.0), right, azimuth, text::small(), colour);
    paint::text_in(ui, rect(0.0), right, elevation, text::small(), colour);
}

fn event(ui: &Ui, row: Rect, model: &Model, word: &str, point: &PassPoint) {
    let t = theme::tokens(ui);
    let time = format::moment(point.time, model.now);
    let azimuth = format::azimuth(point.direction.azimuth_deg());
    let elevation = format::degrees(point.direction.elevation_deg(), 1);
    sighting(ui, row, [word, &time, &azimuth, &elevation], t.t1);
    let words = format!("{word} {time}, azimuth {azimuth}, elevation {elevation}");
    paint::name_text(ui, ("plan event", word), row, &words);
}

fn facts(model: &Model, entry: &Entry) -> Vec<(&'static str, String)> {
    let name = words::schedule::antenna_name(model, entry.antenna).to_owned();
    let mut facts = vec![
        ("Taken by", name),
        ("Inside the beam", format::duration(entry.counted_s)),
        ("Slew and set-up before", format::duration(entry.slew_s + entry.set_up_s)),
    ];
    if let Some(spare_s) = entry.spare_at(model.now) {
        facts.push(("Spare before", format::duration(spare_s)));
    }
    facts
}

/// Returns icon, colour and words for the part of the pass that an antenna can track.
fn verdict(
    model: &Model,
    planned: &PlannedPass<'_>,
    antenna: &AntennaModel,
    t: &crate::ui::tokens::Tokens,
) -> (Icon, egui::Color32, String) {
    let id = antenna.id();
    if let Some(entry) = planned.entries.iter().find(|entry| entry.antenna == id) {
        let lost = entry.lost.map(|lost| format!(" {}.", words::schedule::lost(lost)));
        let automatic = match antenna.operation {
            Operation::On(_) => "",
            Operation::Off(_) => " Automatic operation is off.",
            Operation::Suspended { .. } => " Automatic operation is suspended.",
        };
        let colour = if lost.is_some() { t.warn } else { t.ok };
        let icon = if lost.is_some() { Icon::Warning } else { Icon::Check };
        return (icon, colour, format!("takes it.{}{automatic}", lost.unwrap_or_default()));
    }
    let left_out = planned.left_out.and_then(|left_out| {
        left_out
            .by_antenna
            .iter()
            .find(|(antenna_id, _)| *antenna_id == id)
            .map(|(_, reason)| reason)
    });
    match left_out {
        Some(reason) => {
            (Icon::Dash, t.t2, format!("{}.", words::schedule::why_left_out(model, reason)))
        }
        None if antenna.snapshot.link == LinkState::Off => {
            let reason =
                words::schedule::why_left_out(model, &LeftOutReason::Off(AntennaOff::SwitchedOff));
            (Icon::Dash, t.t2, format!("{reason}."))
        }
        None if let Some(entry) = planned.entries.first() => {
            let other = words::schedule::antenna_name(model, entry.antenna);
            (Icon::Dash, t.t2, format!("{other} takes it."))
        }
        None => (Icon::Dash, t.t3, "not planned yet.".to_owned()),
    }
}

/// Shows the cost of taking a pass that is left out.
fn price(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    planned: &PlannedPass<'_>,
    commands: &mut Vec<UiCommand>,
) {
    if !planned.entries.is_empty() || planned.left_out.is_none() {
        return;
    }
    let key = planned.predicted.key();
    let words = if let Some(swap) = model.swap_of(key) {
        match swap.changes {
            Some(_) => format!("Always: {}", words::schedule::price(model, swap)),
            None => "Always is not available: no antenna can track enough of this pass.".to_owned(),
        }
    } else if model.replay.is_some() {
        // A replay shows only prices that the operator requested at the time.
        return;
    } else {
        let ask = UiCommand::Station(contract::Command::PriceSwap(key));
        // The view asks once per pass and schedule; the answer wakes the window.
        let id = ui.make_persistent_id("swap asked");
        let request = (key, model.schedule.revision);
        if ui.data(|data| data.get_temp(id)) != Some(request) {
            ui.data_mut(|data| data.insert_temp(id, request));
            commands.push(ask);
        }
        "Its cost is being worked out.".to_owned()
    };
    note(ui, width, "plan price", &words);
}

/// Shows a text in its own box.
fn note(ui: &mut Ui, width: f32, salt: impl egui::AsIdSalt, words: &str) {
    let t = theme::tokens(ui);
    let room = width - 2.0 * PADDING - 24.0;
    let galley = ui.painter().layout(words.to_owned(), text::small(), t.t1, room);
    let size = vec2(width, galley.size().y + 28.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let place = rect.shrink2(vec2(PADDING, 6.0));
    ui.painter().rect_filled(place, 5.0, t.bg2);
    ui.painter().galley(place.min + vec2(12.0, 8.0), galley, t.t1);
    paint::name_text(ui, salt, place, words);
}

/// Shows the operator's choice for this pass, and the priority of its satellite.
fn controls(
    ui: &mut Ui,
    width: f32,
    model: &Model,
    planned: &PlannedPass<'_>,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(width, 44.0), Sense::hover());
    let row = row.shrink2(vec2(PADDING, 6.0));
    paint::text_in(ui, row, Align2::LEFT_CENTER, "This pass", text::small(), t.t2);
    let lock = replay::lock(model);
    let choices = [(None, "By plan"), (Some(Take::Always), "Always"), (Some(Take::Never), "Never")];
    let present = planned.choice.map(|choice| choice.take);
    let cannot = model.swap_of(planned.predicted.key()).is_some_and(|swap| swap.changes.is_none());
    let segments = choices.map(|(take, word)| {
        let state = match take {
            take if take == present => Segment::Chosen,
            _ if lock.is_some() => Segment::Locked(lock),
            Some(Take::Always) if cannot => Segment::Locked(None),
            _ => Segment::Free,
        };
        (word, state)
    });
    let place = row.with_min_x(row.left() + LABEL);
    let clicked = segmented::show_commands(ui, "this pass", place, "This pass", &segments);
    if let Some((take, _)) = clicked.and_then(|index| choices.get(index)) {
        state.choose_for(model, planned, *take, commands);
    }
    let (row, _) = ui.allocate_exact_size(vec2(width, 40.0), Sense::hover());
    let row = row.shrink2(vec2(PADDING, 4.0));
    paint::text_in(ui, row, Align2::LEFT_CENTER, "Priority", text::small(), t.t2);
    let number = planned.predicted.number();
    let present = model.station.priority(number).unwrap_or_default();
    let words = Priority::ALL.map(|priority| priority.number().to_string());
    let segments: Vec<(&str, Segment)> = Priority::ALL
        .iter()
        .zip(&words)
        .map(|(priority, word)| {
            let state = match lock {
                _ if *priority == present => Segment::Chosen,
                Some(_) => Segment::Locked(lock),
                None => Segment::Free,
            };
            (word.as_str(), state)
        })
        .collect();
    let place = row.with_min_x(row.left() + LABEL);
    let name = "Priority of the satellite, 1 is the first";
    let clicked = segmented::show_commands(ui, "plan priority", place, name, &segments);
    if let Some(priority) = clicked.and_then(|index| Priority::ALL.get(index)) {
        let set = |priority| contract::Command::SetPriority { numbers: vec![number], priority };
        let (command, back) = (set(*priority), set(present));
        state.change(model, command, back, "Another priority", commands);
    }
}
