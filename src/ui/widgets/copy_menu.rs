//! Copies what is shown, by a menu of the secondary mouse button or with Ctrl C on the focus.

use egui::{Event, Response, Ui};

/// Offers to copy the text of what `response` shows; `what` names it in the menu.
pub fn offer(ui: &Ui, response: &Response, what: &str, text: impl Fn() -> String) {
    let copies = |event: &Event| matches!(event, Event::Copy);
    if response.has_focus() && ui.input(|input| input.events.iter().any(copies)) {
        ui.copy_text(text());
    }
    response.context_menu(|ui| {
        if ui.button(format!("Copy {what}")).clicked() {
            ui.copy_text(text());
        }
    });
}
