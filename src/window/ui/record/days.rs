//! The dialog that exports the passes of several days into one file.

use egui::{Grid, Key, RichText, Sense, TextEdit, Ui, vec2};
use jiff::{ToSpan as _, civil::Date, tz::TimeZone};

use super::RecordState;
use crate::{
    export::RowFormat,
    model::{Model, UiCommand, export::Export},
    ui::{
        text, theme,
        widgets::{
            button::{self, Button},
            modal::modal,
            status_line::{self, Tone},
        },
    },
};

const WIDTH: f32 = 360.0;
/// Width of the field of a day, points.
const DAY: f32 = 120.0;
/// Default number of exported days.
const DAYS: i64 = 7;

/// The entered days.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DaysDialog {
    first: String,
    last: String,
}

impl DaysDialog {
    /// Creates a dialog for the last week.
    pub(super) fn new(model: &Model) -> Self {
        let last = model.now.to_zoned(TimeZone::UTC).date();
        let first = last.checked_sub((DAYS - 1).days()).unwrap_or(last);
        Self { first: first.to_string(), last: last.to_string() }
    }

    fn days(&self) -> Result<(Date, Date), &'static str> {
        let day = |typed: &str| typed.trim().parse::<Date>().ok();
        match (day(&self.first), day(&self.last)) {
            (Some(first), Some(last)) if first <= last => Ok((first, last)),
            (Some(_), Some(_)) => Err("The last day is before the first one."),
            _ => Err("A day is written as 2026-11-30."),
        }
    }
}

/// Shows the dialog until the operator answers it.
pub(super) fn show(ui: &Ui, state: &mut RecordState, commands: &mut Vec<UiCommand>) {
    let (filters, query) = (state.filters(), state.query.clone());
    let Some(dialog) = &mut state.days else { return };
    let mut answer = None;
    let modal = modal(ui, "days of the record").show(ui.ctx(), |ui| {
        ui.set_width(WIDTH);
        answer = content(ui, dialog, filters);
    });
    let closes = modal.should_close().then_some(Answer::Cancel);
    if let Some(answer) = answer.or(closes) {
        if let (Answer::Save(format), Ok((first, last))) = (answer, dialog.days()) {
            let export = Export::Days { query, first, last, format };
            commands.push(UiCommand::Save(export));
        }
        state.days = None;
    }
}

#[derive(Clone, Copy)]
enum Answer {
    Save(RowFormat),
    Cancel,
}

fn content(ui: &mut Ui, dialog: &mut DaysDialog, filters: bool) -> Option<Answer> {
    let t = theme::tokens(ui);
    ui.label(RichText::new("Export the passes of several days").font(text::value()));
    let subset = if filters {
        "The passes that the list is filtered to, in one file. Days are those of UTC."
    } else {
        "All recorded passes of these days, in one file. Days are those of UTC."
    };
    ui.label(RichText::new(subset).font(text::small()).color(t.t2));
    ui.add_space(8.0);
    Grid::new("days").num_columns(2).show(ui, |ui| {
        for (name, typed) in [("First day", &mut dialog.first), ("Last day", &mut dialog.last)] {
            let label = ui.label(RichText::new(name).font(text::body()).color(t.t2));
            let edit = TextEdit::singleline(typed).id_salt(name).desired_width(DAY);
            ui.add(edit).labelled_by(label.id).accessible_name(name);
            ui.end_row();
        }
    });
    let problem = dialog.days().err();
    // The line always takes its room, so that the buttons keep their place.
    let tone = if problem.is_some() { Tone::Bad } else { Tone::Plain };
    status_line::line(ui, tone, problem.unwrap_or_default());
    ui.add_space(8.0);
    let is_locked = problem.is_some();
    let json = Button::primary("Reports (JSON)").locked(is_locked);
    let points = Button::normal("Points (CSV)").locked(is_locked);
    let cancel = Button::normal("Cancel");
    let size = vec2(ui.available_width(), button::HEIGHT);
    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
    let widths = [json.width(ui), points.width(ui), cancel.width(ui)];
    let [json_at, points_at, cancel_at] = button::row(place.right_center(), widths);
    let json = json.show(ui, "reports", json_at);
    let points = points.show(ui, "points", points_at);
    let cancel = cancel.show(ui, "cancel", cancel_at);
    let enter = !is_locked && ui.input(|input| input.key_pressed(Key::Enter));
    if cancel.clicked() {
        Some(Answer::Cancel)
    } else if points.clicked() {
        Some(Answer::Save(RowFormat::Csv))
    } else if json.clicked() || enter && !points.has_focus() && !cancel.has_focus() {
        Some(Answer::Save(RowFormat::Json))
    } else {
        None
    }
}
