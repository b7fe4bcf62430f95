//! The list of keys, drawn from the table.

use egui::{Align2, Frame, Key, Modal, Modifiers, Sense, Ui, vec2};

use super::{ALL, Binding, own::OwnKeys};
use crate::ui::{
    text, theme,
    widgets::{button::Button, paint},
};

const WIDTH: f32 = 648.0;
const KEYS: f32 = 176.0;
const ROW: f32 = 15.5;

/// Shows the list until Esc, `?`, a click outside or its button closes it.
pub fn show(ui: &Ui, open: &mut bool, own: &OwnKeys) {
    if !*open {
        return;
    }
    let again =
        |ui: &Ui| ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Questionmark));
    let frame = Frame::popup(ui.style()).inner_margin(16);
    let modal = Modal::new(egui::Id::unique("keys")).frame(frame).show(ui.ctx(), |ui| {
        let t = theme::tokens(ui);
        ui.spacing_mut().item_spacing.y = 0.0;
        let (head, _) = ui.allocate_exact_size(vec2(WIDTH, 36.0), Sense::hover());
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, "Keys", text::title(), t.t1);
        paint::name_text(ui, "head", head, "Keys");
        let close = Button::normal("Close");
        let place = head.with_min_x(head.right() - close.width(ui)).with_max_y(head.top() + 24.0);
        let closed = close.show(ui, "close", place).clicked();
        for (index, binding) in ALL.iter().enumerate() {
            let (row, _) = ui.allocate_exact_size(vec2(WIDTH, ROW), Sense::hover());
            ui.painter().hline(row.x_range(), row.top(), (1.0, t.line));
            let (keys, does) = row.split_left_right_at_x(row.left() + KEYS);
            let words = in_words(binding, own);
            let font = text::body_medium();
            paint::text_in(ui, keys, Align2::LEFT_CENTER, &words, font, t.t1);
            paint::text_in(ui, does, Align2::LEFT_CENTER, binding.does, text::body(), t.t2);
            paint::name_text(ui, ("key", index), row, &format!("{words}: {}", binding.does));
        }
        closed
    });
    if modal.inner || modal.should_close() || again(ui) {
        *open = false;
    }
}

/// The keys of a line as labelled on the keyboard, such as "Ctrl 1, 6".
pub fn in_words(binding: &Binding, own: &OwnKeys) -> String {
    let before = match binding.modifiers {
        Modifiers::COMMAND => "Ctrl ",
        Modifiers::SHIFT => "Shift ",
        Modifiers::ALT => "Alt ",
        _ => "",
    };
    let words: Vec<&str> = own.keys(binding).map(word).collect();
    // The four arrow keys have a common name.
    if words.len() == 4 && own.keys(binding).all(is_arrow) {
        return if before.is_empty() { "Arrows".to_owned() } else { format!("{before}arrows") };
    }
    format!("{before}{}", words.join(", "))
}

fn is_arrow(key: Key) -> bool {
    matches!(key, Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown)
}

/// A key as labelled on the keyboard.
pub fn word(key: Key) -> &'static str {
    match key {
        Key::Escape => "Esc",
        Key::ArrowUp => "Up",
        Key::ArrowDown => "Down",
        Key::ArrowLeft => "Left",
        Key::ArrowRight => "Right",
        Key::PageUp => "Page Up",
        Key::PageDown => "Page Down",
        other => other.symbol_or_name(),
    }
}
