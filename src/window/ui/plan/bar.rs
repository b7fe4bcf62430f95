//! The controls above the plan.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{PADDING, PlanState};
use crate::{
    contract,
    export::EventFormat,
    model::{Model, UiCommand, export::Export, rehearsal::RehearsalState},
    station::{ChooseBy, Scheduling},
    ui::{
        format, replay, text, theme,
        widgets::{
            button::{self, Button, HEIGHT as BUTTON},
            drop_down::DropDown,
            paint,
            segmented::{self, Segment},
        },
        words,
    },
};

pub(super) const HEIGHT: f32 = 56.0;
const GAP: f32 = 8.0;
const SPANS_H: [(f64, &str); 4] = [(12.0, "12 h"), (24.0, "24 h"), (48.0, "48 h"), (168.0, "7 d")];
const SPANS: f32 = 200.0;
/// Min width of the title, points.
const TITLE: f32 = 176.0;

pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    model: &Model,
    has_drawer: bool,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    let inner = rect.shrink2(vec2(PADDING, 0.0));
    let (words, rehearse) = rehearsal(model);
    let lock = replay::lock(model);
    let is_planned = model.schedule.made_at.is_some();
    let of_rehearsal = Button::normal(&words).locked(!is_planned).locked_by(lock);
    let word = words::schedule::choose_by(model.station.scheduling.choose_by);
    let name = format!("Choose by, {word}");
    let button = Button::normal(word).locked_by(lock);
    let rules = DropDown { button, salt: "choose by", name: &name };
    let button = Button::normal("Export").locked_by(lock);
    let forms = DropDown { button, salt: "export plan", name: "Export the plan" };
    let word = if state.inspector_is_open { "Close details" } else { "Details" };
    let details = Button::normal(word);
    let mut right = inner.right_center();
    let details_at =
        has_drawer.then(|| button::row_before(&mut right, BUTTON, [details.width(ui)]));
    let widths = [of_rehearsal.width(ui), SPANS, rules.width(ui), forms.width(ui)];
    let [rehearsal_at, spans_at, rules_at, forms_at] =
        button::row_before(&mut right, BUTTON, widths);
    title(ui, inner.with_max_x(right.x.max(inner.left() + TITLE)), model, state, commands);
    if of_rehearsal.show(ui, "rehearse plan", rehearsal_at).clicked() {
        commands.push(rehearse);
    }
    spans(ui, spans_at, model, state, commands);
    choose_by(ui, rules, rules_at, model, state, commands);
    save(ui, forms, forms_at, model, commands);
    if let Some([place]) = details_at
        && details.show(ui, "plan details", place).clicked()
    {
        state.inspector_is_open = !state.inspector_is_open;
    }
}

fn title(ui: &Ui, rect: Rect, model: &Model, state: &mut PlanState, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let line = |y: f32| {
        Rect::from_x_y_ranges(rect.x_range(), rect.top() + y - 12.0..=rect.top() + y + 12.0)
    };
    let (left, small) = (Align2::LEFT_CENTER, text::small());
    paint::text_in(ui, line(19.0), left, "Plan", text::title(), t.t1);
    let second = line(40.0);
    if let Some(undo) = state.undo() {
        let words = undo.words.clone();
        let drawn = paint::text_in(ui, second, left, &words, small, t.t2);
        let button = Button::quiet("Undo");
        let min = pos2(drawn.right() + GAP, second.center().y - 12.0);
        let place = Rect::from_min_size(min, vec2(button.width(ui), 24.0));
        if button.show(ui, "undo plan", place).clicked() {
            commands.extend(state.take_undo());
        }
        return;
    }
    let words = if model.schedule.made_at.is_none() {
        "The passes are being planned.".to_owned()
    } else {
        let times = format::minutes(model.now, model.plan_until(), model.now);
        let changes = match model.schedule.changes.len() {
            0 => String::new(),
            1 => ", 1 pass changed".to_owned(),
            count => format!(", {count} passes changed"),
        };
        let rehearsed = words::rehearsal::in_short(&model.rehearsal, model.now);
        format!("{times}{changes}{}", rehearsed.map(|text| format!(". {text}")).unwrap_or_default())
    };
    paint::text_in(ui, second, left, &words, small, t.t2);
    let changed: Vec<String> = model
        .schedule
        .changes
        .iter()
        .map(|change| words::schedule::change(model, change))
        .collect();
    let response = paint::name_text(ui, "plan summary", second, &words);
    if !changed.is_empty() {
        response.on_hover_text(changed.join("\n"));
    }
}

fn spans(
    ui: &Ui,
    place: Rect,
    model: &Model,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let scheduling = model.station.scheduling;
    let is_chosen = |hours: f64| (scheduling.span_h - hours).abs() < 0.5;
    let lock = replay::lock(model);
    let segments = SPANS_H.map(|(hours, word)| {
        let state = match lock {
            _ if is_chosen(hours) => Segment::Chosen,
            Some(reason) => Segment::Locked(Some(reason)),
            None => Segment::Free,
        };
        (word, state)
    });
    let clicked = segmented::show(ui, "plan span", place, "Planned period", &segments);
    if let Some((hours, _)) = clicked.and_then(|index| SPANS_H.get(index)) {
        set(model, Scheduling { span_h: *hours, ..scheduling }, "Another period", state, commands);
    }
}

fn choose_by(
    ui: &Ui,
    list: DropDown<'_>,
    place: Rect,
    model: &Model,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    const ALL: [ChooseBy; 4] =
        [ChooseBy::Elevation, ChooseBy::Duration, ChooseBy::MostPasses, ChooseBy::MostMinutes];
    let scheduling = model.station.scheduling;
    let mut chosen = None;
    list.show(ui, place, |ui| {
        for rule in ALL {
            let is_chosen = rule == scheduling.choose_by;
            if ui.selectable_label(is_chosen, words::schedule::choose_by(rule)).clicked() {
                chosen = Some(rule);
            }
        }
    });
    if let Some(choose_by) = chosen {
        set(model, Scheduling { choose_by, ..scheduling }, "Another rule", state, commands);
    }
}

/// Returns label and command of the button that rehearses the whole plan or cancels the rehearsal.
fn rehearsal(model: &Model) -> (String, UiCommand) {
    match model.rehearsal {
        RehearsalState::UnderWay(share) => {
            let percent = format::number((100.0 * share).floor(), 0);
            (format!("Cancel, {percent} %"), UiCommand::EndRehearsal)
        }
        _ => ("Rehearse".to_owned(), UiCommand::Rehearse(None)),
    }
}

fn save(ui: &Ui, list: DropDown<'_>, place: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let plan = |format| Export::Schedule { format };
    let forms = [
        ("Hand-over sheet (HTML)…", Export::HandOverSheet),
        ("Plan as a table…", plan(EventFormat::Table)),
        ("Plan as CSV…", plan(EventFormat::Csv)),
        ("Plan as JSON…", plan(EventFormat::Json)),
        ("Plan as iCalendar…", plan(EventFormat::Ics)),
    ];
    list.show(ui, place, |ui| {
        for (word, export) in forms {
            let is_planned = model.schedule.made_at.is_some();
            if ui.add_enabled(is_planned, egui::Button::new(word).frame(false)).clicked() {
                commands.push(UiCommand::Save(export));
            }
        }
    });
}

fn set(
    model: &Model,
    scheduling: Scheduling,
    words: &str,
    state: &mut PlanState,
    commands: &mut Vec<UiCommand>,
) {
    let [command, back] =
        [scheduling, model.station.scheduling].map(contract::Command::SetScheduling);
    state.change(model, command, back, words, commands);
}
