//! The bar below the cards: what came of the last changes, and what is not sent
//! yet.

use egui::{Align2, Color32, Key, Modifiers, Rect, Ui, pos2, vec2};

use super::{
    form::{Count, Form},
    unit::Unit,
};
use crate::{
    app::UiCommand,
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{Button, HEIGHT as BUTTON},
            paint,
        },
    },
};

const LEAST_HEIGHT: f32 = 64.0;
const PADDING: f32 = 16.0;
const LINE_GAP: f32 = 4.0;
/// The report may take this part of the width.
const REPORT: f32 = 0.5;

/// The laid-out sentences of the report.
struct Lines {
    galleys: Vec<(bool, String, std::sync::Arc<egui::Galley>)>,
    height: f32,
}

impl Lines {
    fn of(ui: &Ui, form: &Form, width: f32) -> Self {
        let t = theme::tokens(ui);
        let lay = |(is_good, words): (bool, String)| {
            let galley = ui.painter().layout(words.clone(), text::small(), t.t1, width);
            (is_good, words, galley)
        };
        let galleys: Vec<_> = form.report.lines().into_iter().map(lay).collect();
        let height = galleys.iter().map(|(_, _, galley)| galley.size().y + LINE_GAP).sum();
        Self { galleys, height }
    }
}

/// The height that the bar needs in a view of this width.
pub(super) fn height(ui: &Ui, form: &Form, width: f32) -> f32 {
    (Lines::of(ui, form, report_width(width)).height + 16.0).max(LEAST_HEIGHT)
}

fn report_width(width: f32) -> f32 {
    width * REPORT - PADDING - 24.0
}

/// Shows the bar in `rect` and does what it was asked for.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    unit: &Unit<'_>,
    form: &mut Form,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    report(ui, rect, form);
    let count = form.count_all(unit);
    let can_apply = count.ready > 0 && count.sending == 0 && unit.is_open();
    let changes = if count.ready == 1 { "change" } else { "changes" };
    let words = match count.ready {
        0 => "Apply (Ctrl Enter)".to_owned(),
        ready => format!("Apply {ready} {changes} (Ctrl Enter)"),
    };
    let place = |right: f32, width: f32| {
        let min = pos2(right - width, rect.center().y - BUTTON / 2.0);
        Rect::from_min_size(min, vec2(width, BUTTON))
    };
    let apply = Button::primary(&words).locked(!can_apply);
    let applying = place(rect.right() - PADDING, apply.width(ui));
    let revert = Button::normal("Revert").locked(count.edited == 0);
    let reverting = place(applying.left() - 8.0, revert.width(ui));
    let (said, colour) = pending(ui, unit, count);
    let left = rect.left() + rect.width() * REPORT;
    let room = Rect::from_x_y_ranges(left..=reverting.left() - 12.0, rect.y_range());
    let galley = ui.painter().layout(said.clone(), text::small(), colour, room.width());
    let at = Align2::RIGHT_CENTER.align_size_within_rect(galley.size(), room);
    ui.painter().galley(at.min, galley, colour);
    paint::name_text(ui, "pending", room, &said);
    if revert.show(ui, "revert settings", reverting).clicked() {
        form.revert();
    }
    let key = ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Enter));
    let clicked = apply.show(ui, "apply settings", applying).clicked();
    if (clicked || key) && can_apply {
        form.apply(unit, commands);
    }
}

fn report(ui: &Ui, rect: Rect, form: &Form) {
    let t = theme::tokens(ui);
    let lines = Lines::of(ui, form, report_width(rect.width()));
    let mut y = rect.center().y - lines.height / 2.0;
    for (index, (is_good, words, galley)) in lines.galleys.into_iter().enumerate() {
        let (icon, colour) = if is_good { (Icon::Check, t.ok) } else { (Icon::Cross, t.bad) };
        let at = pos2(rect.left() + PADDING, y);
        icons::paint(ui.painter(), paint::square(at + vec2(7.0, 8.0), 13.0), icon, colour);
        let place = Rect::from_min_size(at + vec2(20.0, 0.0), galley.size());
        y += galley.size().y + LINE_GAP;
        ui.painter().galley(place.min, galley, t.t1);
        let said = paint::name_text(ui, ("report", index), place, &words);
        let live = egui::accesskit::Live::Polite;
        ui.ctx().accesskit_node_builder(said.id, |node| node.set_live(live));
    }
}

/// What is not sent yet, and why not.
fn pending(ui: &Ui, unit: &Unit<'_>, count: Count) -> (String, Color32) {
    let t = theme::tokens(ui);
    if count.sending > 0 {
        return (format!("Sending {}", count.sending), t.cmd);
    }
    if count.edited == 0 {
        return ("Nothing to send.".to_owned(), t.t3);
    }
    let plural = if count.edited == 1 { "change" } else { "changes" };
    let mut said = vec![format!("{} {plural} not sent", count.edited)];
    let needs = if count.to_confirm == 1 { "needs" } else { "need" };
    for (number, words) in [
        (count.to_confirm, format!("{needs} confirmation")),
        (count.locked, "locked by Service".to_owned()),
        (count.invalid, "cannot be used".to_owned()),
    ] {
        if number > 0 {
            said.push(format!("{number} {words}"));
        }
    }
    if !unit.is_open() {
        said.push("no link".to_owned());
    }
    (said.join(", "), t.t2)
}
