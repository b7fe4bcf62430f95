//! Modal questions. Esc says no and sends STOP, as everywhere.

pub mod changing;
pub mod closing;
mod maintenance;
mod password;
mod path;

use egui::{Key, Label, RichText, Ui};

use super::{
    confirm::Question,
    text, theme,
    widgets::{
        button::{self, Button},
        modal::modal,
        status_line::{Tone, fact, line},
    },
};
use crate::{contract::host_keys::DoubtfulKey, model::UiCommand};
pub use maintenance::MaintenanceDialog;
pub use password::{PasswordDialog, SecretAnswer};
pub use path::PathDialog;

const WIDTH: f32 = 400.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    Yes,
    /// No, or Esc.
    No,
}

/// Asks `words`; `yes` is the label of the button that agrees. Enter also agrees, unless No has the
/// focus.
pub fn question(ui: &Ui, words: &str, yes: &str) -> Option<Answer> {
    ask(ui, "question", yes, true, |ui| {
        ui.label(RichText::new(words).font(text::body()));
    })
}

/// Asks about a new host key. Enter does nothing here, because the operator must compare the
/// fingerprint first.
pub fn host_key(ui: &Ui, key: &DoubtfulKey) -> Option<Answer> {
    ask(ui, "host key", "It is the right key", false, |ui| {
        let t = theme::tokens(ui);
        let words = format!("{} is new here", key.address);
        ui.label(RichText::new(words).font(text::value()));
        let words = "Compare its key with the one that ssh-keygen -l shows on the unit. You are \
                     asked once; any other key is refused from then on.";
        ui.label(RichText::new(words).font(text::body()));
        for line in [&key.algorithm, &key.fingerprint] {
            ui.add(Label::new(RichText::new(line).font(text::raw()).color(t.t1)).wrap());
        }
    })
}

/// Reports a refused host key, with both fingerprints and instructions. The command `forget`
/// removes the known key after a second confirmation.
pub fn changed_key(
    ui: &mut Ui,
    key: &DoubtfulKey,
    forget: UiCommand,
    question: &mut Option<Question>,
) {
    let address = &key.address;
    line(ui, Tone::Bad, &format!("Refused: the host key of {address} is not the known one."));
    for pinned in &key.pinned {
        fact(ui, "Known", pinned);
    }
    fact(ui, "Now", &key.fingerprint);
    fact(ui, "Kind", &key.algorithm);
    let words = "Either the unit was replaced or reinstalled, or another computer sits in \
                 between. Nothing was sent. Ask the person who maintains the unit; ssh-keygen -l \
                 on the unit shows the right fingerprint.";
    line(ui, Tone::Plain, words);
    if ui.button("Forget the known key…").clicked() {
        *question = Some(Question {
            text: format!(
                "Forget the known host key of {address}? Do so only if you know why it has \
                 changed. The new key is shown next."
            ),
            yes: "Forget it",
            command: forget,
        });
    }
}

fn ask(
    ui: &Ui,
    id: &str,
    yes: &str,
    enter_says_yes: bool,
    content: impl FnOnce(&mut Ui),
) -> Option<Answer> {
    let mut answer = None;
    let modal = modal(ui, id).show(ui.ctx(), |ui| {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
        content(ui);
        ui.add_space(12.0);
        let word = if enter_says_yes { format!("{yes} (Enter)") } else { yes.to_owned() };
        let enter = enter_says_yes && ui.input(|input| input.key_pressed(Key::Enter));
        let yes = if enter_says_yes { Button::primary(&word) } else { Button::normal(&word) };
        let [yes, no] = button::pair(ui, yes, Button::normal("No"));
        if no.clicked() {
            answer = Some(Answer::No);
        } else if yes.clicked() || enter && !no.has_focus() {
            answer = Some(Answer::Yes);
        }
    });
    if modal.should_close() {
        answer = answer.or(Some(Answer::No));
    }
    answer
}
