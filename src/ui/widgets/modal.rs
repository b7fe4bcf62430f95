//! A box over the window that waits for an answer.

use egui::{Frame, Id, Modal, Ui};

use crate::ui::tokens;

/// Padding of the box.
const PADDING: i8 = 16;

/// A box with a veil over the rest of the window.
pub fn modal(ui: &Ui, id: &str) -> Modal {
    Modal::new(Id::unique(id))
        .backdrop_color(tokens::VEIL)
        .frame(Frame::popup(ui.style()).inner_margin(PADDING))
}
