//! Effect of the unsaved edits of a page.

use egui::{Align2, Color32, FontId, Rect, Sense, Ui, pos2, vec2};

use super::form;
use crate::ui::{
    text, theme,
    widgets::{
        card as card_frame,
        fold::{self, FoldModel},
        paint,
    },
};

const TITLE: &str = "What this changes";
const ROW: f32 = 22.0;
/// Width of each of the two columns of numbers, points.
const NUMBER: f32 = 72.0;

/// Shows `content` in a card, or below a fold that shows `value` while it is closed. `is_edited`
/// marks the card as not saved.
pub(super) fn card(
    ui: &mut Ui,
    fold: Option<&mut bool>,
    value: &str,
    is_edited: bool,
    content: impl FnOnce(&mut Ui),
) {
    let Some(is_open) = fold else {
        form::card(ui, TITLE, |ui| {
            if is_edited {
                live(ui);
            }
            content(ui);
        });
        return;
    };
    let width = ui.available_width();
    let (line, _) = ui.allocate_exact_size(vec2(width, fold::HEIGHT), Sense::hover());
    fold::show(ui, line, &FoldModel { title: TITLE, value, mark: None }, is_open);
    ui.add_space(8.0);
    if *is_open {
        card_frame::show(ui, f32::INFINITY, content);
    }
}

/// Marks at the right of the title that nothing is saved yet.
fn live(ui: &Ui) {
    let t = theme::tokens(ui);
    let max = ui.max_rect();
    let title = Rect::from_min_size(max.min, vec2(max.width(), 16.0));
    paint::text_in(ui, title, Align2::RIGHT_CENTER, "live, not saved", text::small(), t.sat);
}

/// Draws the heads of the two columns of numbers.
pub(super) fn heads(ui: &mut Ui) {
    let t = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let heads = [("new".to_owned(), t.t3), ("was".to_owned(), t.t3)];
    numbers(ui, row, heads, [text::small(), text::small()]);
}

/// Shows a row with the saved and the edited value.
pub(super) fn cells(ui: &mut Ui, label: &str, was: (String, Color32), new: (String, Color32)) {
    let t = theme::tokens(ui);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
    let room = row.with_max_x(row.right() - 2.0 * NUMBER);
    paint::text_in(ui, room, Align2::LEFT_CENTER, label, text::small(), t.t2);
    let spoken = format!("{label}: was {}, new {}", was.0, new.0);
    numbers(ui, row, [new, was], [text::small_strong(), text::small()]);
    paint::name_text(ui, ("changed", label), row, &spoken);
}

/// Draws numbers in the columns of `row`, starting at its right end.
fn numbers(ui: &Ui, row: Rect, numbers: [(String, Color32); 2], fonts: [FontId; 2]) {
    let mut right = row.right();
    for ((words, colour), font) in numbers.into_iter().zip(fonts) {
        let cell = Rect::from_min_max(pos2(right - NUMBER, row.top()), pos2(right, row.bottom()));
        paint::text_in(ui, cell, Align2::RIGHT_CENTER, &words, font, colour);
        right -= NUMBER;
    }
}
