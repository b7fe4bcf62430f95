//! A radio button with its words.

use egui::{Response, Ui};

use super::{button::RADIUS, paint};

/// Adds a radio button; a click on it makes `choice` the current one.
pub fn show<T: PartialEq>(ui: &mut Ui, current: &mut T, choice: T, words: &str) -> Response {
    let response = ui.radio_value(current, choice, words);
    paint::focus_ring(ui, &response, RADIUS);
    response
}
