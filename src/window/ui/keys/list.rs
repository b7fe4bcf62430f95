//! List of keys, drawn from the table.

use std::sync::Arc;

use egui::{Align2, Galley, Id, Key, Modal, Modifiers, Rect, Sense, Ui, pos2, vec2};

use super::{ALL, Binding, CTRL_SHIFT};
use crate::ui::{
    operate, text, theme,
    widgets::{button::Button, modal::modal, paint},
};

/// Width of one of the two columns, points.
const COLUMN: f32 = 472.0;
/// Gap between the columns, points.
const GAP: f32 = 16.0;
const WIDTH: f32 = 2.0 * COLUMN + GAP;
const KEYS: f32 = 158.0;
const ROW: f32 = 22.0;
const HEAD: f32 = 36.0;
/// Width of the border of the list with its padding, points.
const BORDER: f32 = 17.0;
const ID: &str = "keys";
/// Distance of the list below the middle of the window, points: it leaves the top bar free.
const DOWN: f32 = 24.0;

/// Returns the distance of a list of this width to the left of the middle of the window, points.
/// The distance keeps the antenna cards of Operate free; it is 0 in a window without room for both.
fn side_margin(window: f32, width: f32) -> f32 {
    let room = (window - width) / 2.0;
    let cards = operate::card::WIDTH * (1 + operate::side_cards(window)) as f32;
    let margin = (cards + GAP - room).max(0.0);
    if margin <= room { margin } else { 0.0 }
}

/// Shows the list until Esc, `?`, a click outside or its button closes it.
pub fn show(ui: &Ui, open: &mut bool) {
    if !*open {
        return;
    }
    let again =
        |ui: &Ui| ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Questionmark));
    let window = ui.ctx().content_rect().width();
    let margin = side_margin(window, WIDTH + 2.0 * BORDER);
    let area = Modal::default_area(Id::unique(ID));
    let area = area.anchor(Align2::CENTER_CENTER, vec2(-margin, DOWN));
    let modal = modal(ui, ID).area(area).show(ui.ctx(), |ui| {
        let t = theme::tokens(ui);
        ui.spacing_mut().item_spacing.y = 0.0;
        let (head, _) = ui.allocate_exact_size(vec2(WIDTH, HEAD), Sense::hover());
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, "Keys", text::title(), t.t1);
        paint::name_text(ui, "head", head, "Keys");
        let close = Button::normal("Close");
        let place = head.with_min_x(head.right() - close.width(ui)).with_max_y(head.top() + 24.0);
        let closed = close.show(ui, "close", place).clicked();
        let rows: Vec<_> = ALL.iter().map(|binding| (binding, does(ui, binding))).collect();
        let height_of = |does: &Galley| (does.size().y + 6.0).max(ROW);
        let whole: f32 = rows.iter().map(|(_, does)| height_of(does)).sum();
        let mut position = head.left_bottom();
        let mut lowest = position.y;
        let mut is_second = false;
        for (index, (binding, does)) in rows.into_iter().enumerate() {
            if !is_second && position.y - head.bottom() >= whole / 2.0 {
                is_second = true;
                position = pos2(head.left() + COLUMN + GAP, head.bottom());
            }
            let row = Rect::from_min_size(position, vec2(COLUMN, height_of(&does)));
            ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
            let (keys, rest) = row.split_left_right_at_x(row.left() + KEYS);
            let words = in_words(binding);
            let font = text::body_medium();
            paint::text_in(ui, keys, Align2::LEFT_CENTER, &words, font, t.t1);
            let place = Align2::LEFT_CENTER.align_size_within_rect(does.size(), rest);
            ui.painter().galley(place.min, does, t.t2);
            paint::name_text(
                ui,
                ("key", index),
                row,
                &format!("{words}: {}", binding.does_where()),
            );
            position.y = row.bottom();
            lowest = lowest.max(position.y);
        }
        ui.allocate_exact_size(vec2(WIDTH, lowest - head.bottom()), Sense::hover());
        closed
    });
    if modal.inner || modal.should_close() || again(ui) {
        *open = false;
    }
}

/// Lays out the effect of a line's keys, wrapped in its column.
fn does(ui: &Ui, binding: &Binding) -> Arc<Galley> {
    let colour = theme::tokens(ui).t2;
    ui.painter().layout(binding.does_where(), text::small(), colour, COLUMN - KEYS)
}

/// Returns the keys of a line as labelled on the keyboard, such as "Ctrl 1 to 8".
pub fn in_words(binding: &Binding) -> String {
    let before = match binding.modifiers {
        Modifiers::COMMAND => "Ctrl ",
        Modifiers::SHIFT => "Shift ",
        Modifiers::ALT => "Alt ",
        CTRL_SHIFT => "Ctrl Shift ",
        _ => "",
    };
    let words: Vec<&str> = binding.keys().map(word).collect();
    // The four arrow keys have a common name.
    if words.len() == 4 && binding.keys().all(is_arrow) {
        return if before.is_empty() { "Arrows".to_owned() } else { format!("{before}arrows") };
    }
    // A comma as separator would look like the comma key.
    let separator = if words.contains(&",") { "   " } else { ", " };
    let runs = words.chunk_by(|one, next| follows(one, next)).flat_map(|run| match run {
        [first, _, .., last] => vec![format!("{first} to {last}")],
        few => few.iter().map(|word| (*word).to_owned()).collect(),
    });
    format!("{before}{}", runs.collect::<Vec<_>>().join(separator))
}

/// Returns `true` if two keys with numbers are next to each other, such as F1 and F2.
fn follows(one: &str, next: &str) -> bool {
    let numbered = |word: &str| -> Option<(bool, u32)> {
        let number = word.strip_prefix('F');
        Some((number.is_some(), number.unwrap_or(word).parse().ok()?))
    };
    match (numbered(one), numbered(next)) {
        (Some((row, one)), Some((next_row, next))) => row == next_row && one + 1 == next,
        _ => false,
    }
}

fn is_arrow(key: Key) -> bool {
    matches!(key, Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown)
}

/// Returns the label of a key on the keyboard.
pub fn word(key: Key) -> &'static str {
    match key {
        Key::Escape => "Esc",
        Key::ArrowUp => "Up",
        Key::ArrowDown => "Down",
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::PageUp => "Page Up",
        Key::PageDown => "Page Down",
        Key::Comma => ",",
        Key::Period => ".",
        other => other.symbol_or_name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_in_a_row_are_named_by_the_first_and_the_last() {
        let all: Vec<String> = ALL.iter().map(in_words).collect();
        for words in ["Ctrl 1 to 8", "F1 to F4", "Space, F, 1 to 5, U", "Up, Down", "T, K"] {
            assert!(all.iter().any(|name| name == words), "{words}: {all:?}");
        }
    }
}
