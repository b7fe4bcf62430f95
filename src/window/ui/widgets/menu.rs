//! The menu that a control opens.

use egui::{FocusDirection, Id, Key, Popup, Response, Ui};

/// Shows `popup` with the menu of `opener`. A choice by pointer or key closes the menu; after a
/// key, `opener` gets the focus back. Left also closes the menu, because Esc would also be STOP.
pub fn show(opener: &Response, popup: Popup<'_>, contents: impl FnOnce(&mut Ui)) {
    let shown = popup.show(|ui| {
        contents(ui);
        let entries = entries(ui);
        take_arrows(ui, &entries);
        let pass = ui.cumulative_pass_nr();
        ui.data_mut(|data| data.insert_temp(shown_in(), pass));
        let is_over =
            chosen_by_key(ui, &entries) || ui.input(|input| input.key_pressed(Key::ArrowLeft));
        if is_over {
            ui.close();
        }
        is_over
    });
    if shown.is_some_and(|shown| shown.inner) {
        opener.ctx.memory_mut(|memory| memory.move_focus(FocusDirection::None));
        opener.request_focus();
    }
}

/// Returns the id of the egui pass in which a menu was last shown.
fn shown_in() -> Id {
    Id::unique("menu shown in")
}

/// Returns `true` if a menu is open. The menu then takes the keys of the view behind it.
pub fn is_open(ui: &Ui) -> bool {
    let pass = ui.data(|data| data.get_temp::<u64>(shown_in()));
    pass.is_some_and(|pass| pass + 1 >= ui.cumulative_pass_nr())
}

/// Returns the enabled entries in their order.
fn entries(ui: &Ui) -> Vec<Id> {
    let layer = ui.layer_id();
    ui.viewport(|viewport| {
        let widgets = viewport.this_pass.widgets.get_layer(layer);
        widgets
            .filter(|widget| widget.enabled && widget.sense.is_focusable())
            .map(|widget| widget.id)
            .collect()
    })
}

/// Moves the focus between entries with the arrow keys, also in a menu opened with the pointer.
fn take_arrows(ui: &Ui, entries: &[Id]) {
    let [up, down] =
        [Key::ArrowUp, Key::ArrowDown].map(|key| ui.input(|input| input.key_pressed(key)));
    if up == down {
        return;
    }
    let focused = ui.memory(egui::Memory::focused);
    let place = focused.and_then(|id| entries.iter().position(|entry| *entry == id));
    let next = match place {
        Some(place) if up => place.checked_sub(1),
        Some(place) => place.checked_add(1).filter(|next| *next < entries.len()),
        None if up => entries.len().checked_sub(1),
        None => Some(0),
    };
    ui.memory_mut(|memory| {
        memory.move_focus(FocusDirection::None);
        if let Some(next) = next.and_then(|next| entries.get(next)) {
            memory.request_focus(*next);
        }
    });
}

/// Returns `true` if the operator chose an entry by key. A click with the pointer closes the menu
/// anyway.
fn chosen_by_key(ui: &Ui, entries: &[Id]) -> bool {
    let is_clicked = |id: &Id| ui.read_response(*id).is_some_and(|entry| entry.clicked());
    !ui.input(|input| input.pointer.any_click()) && entries.iter().any(is_clicked)
}
