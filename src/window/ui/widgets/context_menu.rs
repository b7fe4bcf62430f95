//! The context menu, opened by the secondary mouse button, or on a focused control by the menu key
//! or Shift F10.

use egui::{Button, Id, Key, Modifiers, Popup, Response, SetOpenCommand, Ui};

use super::{close_key, menu};

/// Returns the id of a flag: a key opened the menu, and the first entry has no focus yet.
fn wants_focus(response: Id) -> Id {
    response.with("menu wants focus")
}

fn opened_by_key(response: Id) -> Id {
    response.with("menu by key")
}

/// Shows the menu of `response` while it is open.
pub fn show(ui: &Ui, response: &Response, contents: impl FnOnce(&mut Ui)) {
    let is_key = response.has_focus()
        && ui.input_mut(|input| {
            input.consume_key(Modifiers::SHIFT, Key::F10)
                || input.consume_key(Modifiers::NONE, Key::Menu)
        });
    let is_pointer = response.secondary_clicked();
    let id = response.id;
    if is_key || is_pointer {
        ui.data_mut(|data| {
            data.insert_temp(opened_by_key(id), is_key);
            data.insert_temp(wants_focus(id), is_key);
        });
    }
    let opens = match (is_key || is_pointer, response.clicked()) {
        (true, _) => Some(SetOpenCommand::Bool(true)),
        (false, true) => Some(SetOpenCommand::Bool(false)),
        (false, false) => None,
    };
    if opens.is_none() && !Popup::is_id_open(ui, Popup::default_response_id(response)) {
        return;
    }
    let by_key = ui.data(|data| data.get_temp(opened_by_key(id)).unwrap_or(false));
    let popup = Popup::menu(response).open_memory(opens);
    let popup = if by_key { popup } else { popup.at_pointer_fixed() };
    menu::show(response, popup.accessible_name("Menu"), |ui| {
        contents(ui);
        close_key::show(ui);
    });
}

/// Shows an entry of the menu of `response`. Returns `true` if the operator chose it.
pub fn entry(ui: &mut Ui, response: Id, words: &str) -> bool {
    entry_locked_by(ui, response, words, None)
}

/// Shows an entry like [`entry`]. A `reason` locks the entry and appears as its tool-tip.
pub fn entry_locked_by(ui: &mut Ui, response: Id, words: &str, reason: Option<&str>) -> bool {
    let entry = ui.add_enabled(reason.is_none(), Button::new(words));
    let entry = entry.on_disabled_hover_text(reason.unwrap_or_default());
    if reason.is_none()
        && ui.data_mut(|data| data.remove_temp(wants_focus(response)).unwrap_or(false))
    {
        entry.request_focus();
    }
    entry.clicked()
}
