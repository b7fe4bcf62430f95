//! What the edits of a page change, before they are saved.

use egui::{Align2, Rect, Sense, Ui, vec2};

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

/// Shows `content`, which is of a page that `is_edited`, in a card, or below a fold that says `value` while it is closed.
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

/// Says at the right of the title that nothing is saved yet.
fn live(ui: &Ui) {
    let t = theme::tokens(ui);
    let max = ui.max_rect();
    let title = Rect::from_min_size(max.min, vec2(max.width(), 16.0));
    paint::text_in(ui, title, Align2::RIGHT_CENTER, "live, not saved", text::small(), t.sat);
}
