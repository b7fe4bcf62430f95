//! Copying of content, by its menu or with Ctrl C while it has the focus.

use egui::{Event, Response, Ui};

use super::context_menu;

/// Offers to copy the text of `response`; `subject` names the text in the menu.
pub fn offer(ui: &Ui, response: &Response, subject: &str, text: impl Fn() -> String) {
    by_key(ui, response, &text);
    context_menu::show(ui, response, |ui| {
        if context_menu::entry(ui, response.id, &format!("Copy {subject}")) {
            ui.copy_text(text());
        }
    });
}

/// Copies the text of the focused control with Ctrl C.
pub fn by_key(ui: &Ui, response: &Response, text: impl Fn() -> String) {
    let copies = |event: &Event| matches!(event, Event::Copy);
    if response.has_focus() && ui.input(|input| input.events.iter().any(copies)) {
        ui.copy_text(text());
    }
}
