//! The menu that a control opens.

use egui::{Popup, Response, Ui};

/// Shows `popup` with the menu of `opener`. An entry that is chosen closes it, by keys as by the
/// pointer, and by keys the focus goes back to `opener`.
pub fn show(opener: &Response, popup: Popup<'_>, contents: impl FnOnce(&mut Ui)) {
    let shown = popup.show(|ui| {
        contents(ui);
        let is_chosen = chosen_by_key(ui);
        if is_chosen {
            ui.close();
        }
        is_chosen
    });
    if shown.is_some_and(|shown| shown.inner) {
        opener.request_focus();
    }
}

/// Whether an entry was chosen without the pointer, whose clicks close the menu anyway.
fn chosen_by_key(ui: &Ui) -> bool {
    if ui.input(|input| input.pointer.any_click()) {
        return false;
    }
    let layer = ui.layer_id();
    let entries: Vec<_> = ui.viewport(|viewport| {
        let widgets = viewport.this_pass.widgets.get_layer(layer);
        widgets.filter(|of| of.enabled && of.sense.senses_click()).map(|of| of.id).collect()
    });
    entries.into_iter().any(|id| ui.read_response(id).is_some_and(|entry| entry.clicked()))
}
