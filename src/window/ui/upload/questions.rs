//! The operator's decisions during an upload.

use egui::Ui;

use crate::{
    contract,
    contract::uploads::{Ask, Busy, Stage},
    model::{Model, UiCommand},
    ui::dialogs::{self, Answer, PasswordDialog, SecretAnswer},
};

/// Input of the operator into the questions.
#[derive(Default)]
pub(super) struct Questions {
    password: PasswordDialog,
}

/// Shows the open question, if any. Esc answers no.
pub(super) fn show(ui: &Ui, model: &Model, state: &mut Questions, commands: &mut Vec<UiCommand>) {
    let answer = match &model.uploads.stage {
        Stage::AsksAboutTracking(busy) => yes_or_no(
            dialogs::question(ui, about_tracking(*busy), "Continue"),
            Ask::AgreeToTracking,
        ),
        Stage::AsksAboutHostKey(key) => yes_or_no(dialogs::host_key(ui, key), Ask::TrustHostKey),
        Stage::AsksForSecret(request) => match state.password.show(ui, request) {
            None => None,
            Some(SecretAnswer::Cancelled) => Some(Ask::Cancel),
            Some(SecretAnswer::Typed { secret, keep }) => Some(Ask::Secret { secret, keep }),
        },
        _ => {
            state.password.clear();
            None
        }
    };
    commands.extend(answer.map(|answer| UiCommand::Station(contract::Command::Upload(answer))));
}

fn yes_or_no(answer: Option<Answer>, yes: Ask) -> Option<Ask> {
    answer.map(|answer| if answer == Answer::Yes { yes } else { Ask::Cancel })
}

fn about_tracking(busy: Busy) -> &'static str {
    match busy {
        Busy::Tracks => {
            "The unit is tracking. Its tracking is stopped before it is told to use the new file. \
             Continue?"
        }
        Busy::MayTrack => {
            "Auto-track is on: the antenna may move by itself. It is switched off before the unit \
             is told to use the new file, and stays off. Continue?"
        }
    }
}
