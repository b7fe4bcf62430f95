//! Layout of a page: its cards in columns, and the effect of the edits next to them.

use egui::{Align, Layout, Rect, ScrollArea, Ui, UiBuilder, vec2};

use super::PADDING;
use crate::ui::widgets::paint;

/// Gap between two columns, points. The scroll bar takes the left part of the gap.
const GAP: f32 = 16.0;
/// Min width of a column, points.
const MIN_WIDTH: f32 = 500.0;
/// Max width of one of several columns, and of a single column, points.
const MAX_WIDTHS: [f32; 2] = [592.0, 800.0];
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// A card, by its index.
    Card(usize),
    /// The effect of the edits: next to the cards, or as a fold above them.
    Preview { is_fold: bool },
    /// The list of invalid values.
    Findings,
}

/// Shows a page of cards with these numbers of `rows`; `draw` draws each part. The parts next to
/// the cards do not scroll.
pub(super) fn show(
    ui: &mut Ui,
    page: Rect,
    salt: impl egui::AsIdSalt + Copy,
    rows: &[usize],
    has_aside: bool,
    mut draw: impl FnMut(&mut Ui, Part),
) {
    let inner = page.shrink2(vec2(PADDING, 0.0));
    let fitting = ((inner.width() + GAP) / (MIN_WIDTH + GAP)).floor().max(1.0) as usize;
    let stands_aside = has_aside && fitting > 1;
    let forms = (fitting - usize::from(stands_aside)).min(rows.len()).max(1);
    let count = forms + usize::from(stands_aside);
    let gaps = GAP * (count - 1) as f32;
    let [one_of_many, only] = MAX_WIDTHS;
    let max = if count > 1 { one_of_many } else { only };
    let width = max.min((inner.width() - gaps) / count as f32);
    let columns = columns_of(rows, forms);
    // The scroll bar stands in the gap, or at the edge of the page.
    let gap = inner.left() + forms as f32 * (width + GAP) - 4.0;
    let right = if stands_aside { gap } else { page.right() - 4.0 };
    scrolled(ui, page.with_min_x(inner.left()).with_max_x(right), (salt, "cards"), |ui| {
        if has_aside && !stands_aside {
            centred(ui, width, |ui| draw(ui, Part::Preview { is_fold: true }));
        }
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            for column in 0..forms {
                centred(ui, width, |ui| {
                    ui.spacing_mut().item_spacing.x = 8.0;
                    for (card, _) in
                        columns.iter().enumerate().filter(|(_, total)| **total == column)
                    {
                        draw(ui, Part::Card(card));
                    }
                });
            }
        });
        if has_aside && !stands_aside {
            centred(ui, width, |ui| draw(ui, Part::Findings));
        }
    });
    if stands_aside {
        let left = inner.left() + forms as f32 * (width + GAP);
        let place = page.with_min_x(left).with_max_x(page.right() - 4.0);
        scrolled(ui, place, (salt, "aside"), |ui| {
            centred(ui, width, |ui| {
                draw(ui, Part::Preview { is_fold: false });
                draw(ui, Part::Findings);
            });
        });
    }
}

/// Shows `content` in a column of this width.
fn centred(ui: &mut Ui, width: f32, content: impl FnOnce(&mut Ui)) {
    ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
        ui.set_width(width);
        content(ui);
    });
}

fn scrolled(ui: &mut Ui, place: Rect, salt: impl egui::AsIdSalt, content: impl FnOnce(&mut Ui)) {
    let builder = UiBuilder::new().id_salt(salt).max_rect(place);
    ui.scope_builder(builder, |ui| {
        // A focus ring and the border of a card extend slightly beyond the column.
        ui.set_clip_rect(place.expand2(vec2(4.0, 0.0)).intersect(ui.clip_rect()));
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.add_space(PADDING);
            content(ui);
            paint::follow_focus(ui);
            ui.add_space(8.0);
        });
    });
}

/// Returns the column of each card. The cards keep their order, and the columns have about the same
/// height.
fn columns_of(rows: &[usize], columns: usize) -> Vec<usize> {
    let height = |rows: &usize| rows + 2;
    let total: usize = rows.iter().map(height).sum();
    let (mut column, mut above, mut placed) = (0, 0, Vec::new());
    for rows in rows {
        let height = height(rows);
        let is_full = (2 * above + height) * columns >= 2 * total * (column + 1);
        if is_full && column + 1 < columns && placed.contains(&column) {
            column += 1;
        }
        placed.push(column);
        above += height;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cards_keep_their_order_and_fill_columns_evenly() {
        assert_eq!(columns_of(&[4, 10, 6, 4], 1), [0, 0, 0, 0]);
        assert_eq!(columns_of(&[4, 10, 6, 4], 2), [0, 0, 1, 1]);
        assert_eq!(columns_of(&[4, 10, 2, 6, 4], 3), [0, 1, 1, 2, 2]);
        assert_eq!(columns_of(&[30, 1, 1], 3), [0, 1, 2]);
        assert_eq!(columns_of(&[1, 30, 1], 3), [0, 1, 2]);
    }
}
