//! A box over the window that waits for an answer.

use egui::{Event, Frame, Id, Key, LayerId, Modal, Order, Ui};

use crate::ui::tokens;

/// Padding of the box, points.
const PADDING: i8 = 16;

/// Returns a box with a veil above the rest of the window. The Enter press that opened the box does
/// not answer it, even if the operator holds the key.
pub fn modal(ui: &Ui, id: &str) -> Modal {
    let id = Id::unique(id);
    let layer = LayerId::new(Order::Foreground, id);
    let is_new = !ui.memory(|memory| memory.areas().visible_last_frame(&layer));
    let opened_it = |event: &Event| match event {
        Event::Key { key: Key::Enter, pressed: true, repeat, .. } => is_new || *repeat,
        _ => false,
    };
    ui.input_mut(|input| input.events.retain(|event| !opened_it(event)));
    Modal::new(id)
        .backdrop_color(tokens::VEIL)
        .frame(Frame::popup(ui.style()).inner_margin(PADDING))
}
