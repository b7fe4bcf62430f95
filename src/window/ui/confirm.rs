//! Confirmation of a key command that moves an antenna.

use egui::{Key, Ui};

use super::{
    text,
    widgets::{
        button::{self, Button},
        modal::modal,
    },
};
use crate::model::UiCommand;

/// A question, and the command for a yes.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    pub text: String,
    /// Text of the button that says yes.
    pub yes: &'static str,
    /// Command for a yes.
    pub command: UiCommand,
}

impl Question {
    /// Shows the question until the operator answers. Enter says yes unless Cancel has the focus;
    /// Esc says no.
    pub fn show(question: &mut Option<Self>, ui: &Ui, commands: &mut Vec<UiCommand>) {
        let Some(requested) = question else { return };
        let mut answer = None;
        let modal = modal(ui, "question").show(ui.ctx(), |ui| {
            ui.set_width(320.0);
            ui.label(egui::RichText::new(&requested.text).font(text::body()));
            ui.add_space(12.0);
            let yes = format!("{} (Enter)", requested.yes);
            let [yes, cancel] = button::pair(ui, Button::primary(&yes), Button::normal("Cancel"));
            let enter = ui.input(|input| input.key_pressed(Key::Enter));
            if cancel.clicked() {
                answer = Some(false);
            } else if yes.clicked() || enter && !cancel.has_focus() {
                answer = Some(true);
            }
        });
        if modal.should_close() {
            answer = answer.or(Some(false));
        }
        if let Some(yes) = answer {
            if yes {
                commands.push(requested.command.clone());
            }
            *question = None;
        }
    }
}
