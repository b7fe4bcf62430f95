//! Bar below the cards: results of the last changes, and edits not sent yet.

use std::sync::Arc;

use egui::{Align2, Color32, Galley, Key, Modifiers, Rect, Ui, pos2, vec2};

use super::{form::Form, unit::ShownUnit};
use crate::{
    model::UiCommand,
    ui::{
        icons::{self, Icon},
        replay, text, theme,
        widgets::{
            button::{self, Button},
            paint,
        },
        words,
    },
};

const MIN_HEIGHT: f32 = 64.0;
const PADDING: f32 = 16.0;
const LINE_GAP: f32 = 4.0;
/// Share of the width for the report, 0 to 1.
const REPORT: f32 = 0.5;
/// View width below which the report gets all the width that the buttons leave, points.
const NARROW: f32 = 900.0;
const BUTTONS: f32 = 390.0;

/// Sentences of the report after layout.
struct Lines {
    galleys: Vec<(Mark, String, Arc<Galley>)>,
    height: f32,
}

/// Mark before a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    Good,
    Bad,
    Pending,
}

impl Lines {
    /// Lays the sentences out. A narrow view adds the sentence about the edits not sent yet.
    fn new(ui: &Ui, unit: &ShownUnit<'_>, form: &Form, width: f32) -> Self {
        let t = theme::tokens(ui);
        let is_narrow = width < NARROW;
        let room = if is_narrow { width - BUTTONS } else { width * REPORT - PADDING } - 24.0;
        let pending = is_narrow.then(|| (Mark::Pending, pending(ui, unit, form).0));
        let report = form.report.lines(unit.model.now).into_iter();
        let report = report.map(|(good, words)| (if good { Mark::Good } else { Mark::Bad }, words));
        let lay = |(mark, words): (Mark, String)| {
            let galley = ui.painter().layout(words.clone(), text::small(), t.t1, room);
            (mark, words, galley)
        };
        let galleys: Vec<_> = pending.into_iter().chain(report).map(lay).collect();
        let height = galleys.iter().map(|(_, _, galley)| galley.size().y + LINE_GAP).sum();
        Self { galleys, height }
    }
}

/// Returns the height of the bar in a view of this width, points.
pub(super) fn height(ui: &Ui, unit: &ShownUnit<'_>, form: &Form, width: f32) -> f32 {
    (Lines::new(ui, unit, form, width).height + 16.0).max(MIN_HEIGHT)
}

/// Shows the bar in `rect` and carries out its buttons.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    unit: &ShownUnit<'_>,
    form: &mut Form,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    report(ui, rect, unit, form);
    let count = form.count_all(unit);
    let hindrance = form.hindrance(unit);
    let can_apply = count.ready > 0 && count.sending == 0 && unit.is_open() && hindrance.is_none();
    let is_replayed = unit.model.replay.is_some();
    let can_apply = can_apply && !is_replayed;
    let changes = if count.ready == 1 { "change" } else { "changes" };
    let words = match count.ready {
        0 => "Apply (Ctrl Enter)".to_owned(),
        ready => format!("Apply {ready} {changes} (Ctrl Enter)"),
    };
    let apply = Button::primary(&words).locked(!can_apply);
    let revert = Button::normal("Revert").locked(count.edited == 0);
    let right = rect.right_center() - vec2(PADDING, 0.0);
    let [reverting, applying] = button::row(right, [revert.width(ui), apply.width(ui)]);
    if rect.width() >= NARROW {
        let (spoken, colour) = pending(ui, unit, form);
        let left = rect.left() + rect.width() * REPORT;
        let room = Rect::from_x_y_ranges(left..=reverting.left() - 12.0, rect.y_range());
        paint::named_text_in(
            ui,
            "pending",
            room,
            Align2::RIGHT_CENTER,
            &spoken,
            text::small(),
            colour,
        );
    }
    if revert.show(ui, "revert settings", reverting).clicked() {
        form.revert();
    }
    // An open dialog handles Enter itself.
    let is_free = ui.memory(|memory| memory.top_modal_layer().is_none());
    let key = is_free && ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Enter));
    let applied = apply.show(ui, "apply settings", applying);
    let clicked = applied.clicked();
    if is_replayed {
        applied.on_hover_text(replay::locked(unit.name()));
    }
    if (clicked || key) && can_apply {
        form.apply(unit, commands);
    }
}

fn report(ui: &Ui, rect: Rect, unit: &ShownUnit<'_>, form: &Form) {
    let t = theme::tokens(ui);
    let lines = Lines::new(ui, unit, form, rect.width());
    let painter = ui.painter_at(rect);
    let mut y = rect.center().y - lines.height / 2.0;
    for (index, (mark, words, galley)) in lines.galleys.into_iter().enumerate() {
        let (icon, colour) = match mark {
            Mark::Good => (Icon::Check, t.ok),
            Mark::Bad => (Icon::Cross, t.bad),
            Mark::Pending => (Icon::Pencil, t.t2),
        };
        let position = pos2(rect.left() + PADDING, y);
        icons::paint(&painter, paint::square(position + vec2(7.0, 8.0), 13.0), icon, colour);
        let place = Rect::from_min_size(position + vec2(20.0, 0.0), galley.size());
        y += galley.size().y + LINE_GAP;
        painter.galley(place.min, galley, t.t1);
        let response = paint::name_text(ui, ("report", index), place, &words);
        let live = egui::accesskit::Live::Polite;
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_live(live));
    }
}

/// Returns a sentence about the edits not sent yet, with its colour.
fn pending(ui: &Ui, unit: &ShownUnit<'_>, form: &Form) -> (String, Color32) {
    let t = theme::tokens(ui);
    let count = form.count_all(unit);
    if count.sending > 0 {
        return (format!("Sending {}", count.sending), t.cmd);
    }
    if count.edited == 0 {
        return ("Nothing to send.".to_owned(), t.t3);
    }
    let plural = if count.edited == 1 { "change" } else { "changes" };
    let mut sentences = vec![format!("{} {plural} not sent", count.edited)];
    let needs = if count.to_confirm == 1 { "needs" } else { "need" };
    for (number, words) in [
        (count.to_confirm, format!("{needs} confirmation")),
        (count.locked, "locked by Service".to_owned()),
        (count.invalid, "invalid".to_owned()),
        (count.held_back, "held back by another field".to_owned()),
    ] {
        if number > 0 {
            sentences.push(format!("{number} {words}"));
        }
    }
    if !unit.is_open() {
        sentences.push("no link".to_owned());
    }
    match form.hindrance(unit) {
        Some(reason) => (format!("{}. {}", sentences.join(", "), words::hindrance(reason)), t.warn),
        None => (sentences.join(", "), t.t2),
    }
}
