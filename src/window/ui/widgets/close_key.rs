//! The button that closes a popup. Esc is also STOP, so it must not be the only way.

use egui::{Align, Layout, Ui, vec2};

use super::button::SMALL_HEIGHT;

/// Shows the button below the content of a popup without widening it.
pub fn show(ui: &mut Ui) {
    ui.add_space(4.0);
    let size = vec2(ui.min_rect().width(), SMALL_HEIGHT);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        if ui.button("Close").clicked() {
            ui.close();
        }
    });
}
