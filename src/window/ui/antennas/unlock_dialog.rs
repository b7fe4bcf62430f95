//! Dialog that asks for the name of the station before the service functions open.

use egui::{RichText, Sense, TextEdit, Ui, vec2};

use super::{unit::ShownUnit, unlock};
use crate::ui::{
    text, theme,
    widgets::{
        button::{Button, HEIGHT},
        hold_button::{self, HoldState},
        modal::modal,
    },
};

const WIDTH: f32 = 360.0;
const HOLD: &str = "Hold 1 s to unlock";

/// State of the dialog, with the typed text.
#[derive(Default)]
pub(super) struct UnlockDialog {
    typed: String,
    is_shown: bool,
    hold: HoldState,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UnlockAnswer {
    Open,
    Closed,
    Unlock,
}

impl UnlockDialog {
    /// Shows the dialog in the middle of the window. Esc closes the dialog and sends STOP.
    pub(super) fn show(&mut self, ui: &Ui, unit: &ShownUnit<'_>) -> UnlockAnswer {
        let shown = modal(ui, "unlock").show(ui.ctx(), |ui| self.fill(ui, unit));
        if shown.should_close() && shown.inner == UnlockAnswer::Open {
            return UnlockAnswer::Closed;
        }
        shown.inner
    }

    fn fill(&mut self, ui: &mut Ui, unit: &ShownUnit<'_>) -> UnlockAnswer {
        let t = theme::tokens(ui);
        ui.set_width(WIDTH);
        let station = unit.model.station.name.trim();
        ui.label(RichText::new("Unlock the service functions").font(text::value()));
        let words = format!(
            "A wrong value can make {} point wrongly, or move. To unlock, type the name of the \
             station, {station}.",
            unit.name()
        );
        ui.label(RichText::new(words).font(text::body()).color(t.t2));
        let edit = TextEdit::singleline(&mut self.typed).desired_width(WIDTH - 16.0);
        let edit = ui.add(edit).accessible_name("Name of the station");
        if !std::mem::replace(&mut self.is_shown, true) {
            edit.request_focus();
        }
        let is_named = self.typed.trim() == station;
        let refusal = unlock::refusal(unit);
        if let Some(refusal) = refusal {
            ui.label(RichText::new(refusal).font(text::small()).color(t.bad));
        } else if !is_named && !self.typed.is_empty() {
            let words = "This is not the name of the station.";
            ui.label(RichText::new(words).font(text::small()).color(t.t3));
        }
        let (row, _) = ui.allocate_exact_size(vec2(WIDTH, HEIGHT), Sense::hover());
        let cancel = Button::normal("Cancel");
        let (hold, cancelling) = row.split_left_right_at_x(row.right() - cancel.width(ui));
        let hold = hold.with_max_x(hold.right() - 8.0);
        if cancel.show(ui, "cancel unlock", cancelling).clicked() {
            return UnlockAnswer::Closed;
        }
        if !is_named || refusal.is_some() {
            self.hold = HoldState::Released;
            Button::normal(HOLD).locked(true).show(ui, "unlock locked", hold);
            return UnlockAnswer::Open;
        }
        if hold_button::show(ui, hold, HOLD, &mut self.hold) {
            return UnlockAnswer::Unlock;
        }
        UnlockAnswer::Open
    }
}
