//! The dialog for a password or a passphrase.

use egui::{Id, Key, RichText, TextEdit, Ui, text_edit::TextEditState};

use super::WIDTH;
use crate::{
    contract::uploads::SecretWanted,
    secret::Secret,
    ui::{
        text, theme,
        widgets::{
            check_box::CheckBox,
            modal::modal,
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

/// The typed password, which leaves the dialog only as a [`Secret`].
#[derive(Default)]
pub struct PasswordDialog {
    typed: String,
    keep: bool,
    is_open: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SecretAnswer {
    /// A typed secret.
    Typed {
        secret: Secret,
        /// Flag: keep the secret in the keyring of the operating system.
        keep: bool,
    },
    /// Cancel, by its button or Esc.
    Cancelled,
}

impl PasswordDialog {
    /// Shows the question until the operator answers. Enter submits the input.
    pub fn show(&mut self, ui: &Ui, request: &SecretWanted) -> Option<SecretAnswer> {
        let mut answer = None;
        let modal = modal(ui, "password").show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
            answer = self.content(ui, request);
        });
        self.is_open = true;
        if modal.should_close() {
            answer = answer.or(Some(SecretAnswer::Cancelled));
        }
        if answer.is_some() {
            self.clear();
            forget(ui);
        }
        answer
    }

    fn content(&mut self, ui: &mut Ui, request: &SecretWanted) -> Option<SecretAnswer> {
        let t = theme::tokens(ui);
        let subject = if request.is_passphrase { "Passphrase" } else { "Password" };
        let words = format!("{subject} of {}", request.user);
        ui.label(RichText::new(words).font(text::value()));
        ui.label(RichText::new(format!("for {}", request.address)).font(text::body()).color(t.t2));
        if let Some(refused) = &request.refused {
            line(ui, Tone::Bad, &sentence(refused));
        }
        let edit = TextEdit::singleline(&mut self.typed).password(true).id(field());
        let label = ui.label(RichText::new(subject).font(text::small()).color(t.t3)).id;
        let edit = ui.add(edit.desired_width(f32::INFINITY)).labelled_by(label);
        if !self.is_open {
            edit.request_focus();
        }
        match &request.keyring_problem {
            None => {
                ui.add(CheckBox::new(&mut self.keep, "Keep it in the keyring of this computer"));
                let words = "Otherwise Azel asks for it once in each session.";
                ui.label(RichText::new(words).font(text::small()).color(t.t3));
            }
            Some(problem) => {
                line(ui, Tone::Caution, &sentence(problem));
                let words = "Azel asks for it once in each session and stores it nowhere.";
                ui.label(RichText::new(words).font(text::small()).color(t.t3));
            }
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let can = !self.typed.is_empty();
            let enter = can && ui.input(|input| input.key_pressed(Key::Enter));
            let sends = ui.add_enabled(can, egui::Button::new("Log in (Enter)")).clicked() || enter;
            if sends {
                let keep = self.keep && request.keyring_problem.is_none();
                return Some(SecretAnswer::Typed { secret: Secret::take(&mut self.typed), keep });
            }
            ui.button("Cancel").clicked().then_some(SecretAnswer::Cancelled)
        })
        .inner
    }

    /// Wipes the typed password and resets the dialog.
    pub fn clear(&mut self) {
        // `Secret` wipes the text when it is dropped.
        drop(Secret::take(&mut self.typed));
        (self.keep, self.is_open) = (false, false);
    }
}

fn field() -> Id {
    Id::unique("password field")
}

/// Clears the undo history of the field, which contains the typed text.
fn forget(ui: &Ui) {
    TextEditState::default().store(ui.ctx(), field());
}
