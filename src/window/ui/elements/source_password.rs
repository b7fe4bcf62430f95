//! Password of a source with a log-in.

use egui::Ui;

use crate::{
    contract::{Command, sources::SPACE_TRACK_HOST, uploads::SecretWanted},
    model::{Model, UiCommand},
    orbit::{Source, SourcePlace},
    ui::dialogs::{PasswordDialog, SecretAnswer},
};

/// Dialog for the password, while it is open for a source.
#[derive(Default)]
pub(super) struct SourcePassword {
    /// Name of the source that the dialog is open for.
    source: Option<String>,
    dialog: PasswordDialog,
}

impl SourcePassword {
    pub(super) fn open(&mut self, source: &Source) {
        self.source = Some(source.name.clone());
    }

    /// Shows the dialog until the operator answers or the source is gone.
    pub(super) fn show(&mut self, ui: &Ui, model: &Model, commands: &mut Vec<UiCommand>) {
        let Some(name) = self.source.clone() else { return };
        let Some(user) = user_of(model, &name) else {
            self.close();
            return;
        };
        let request = SecretWanted {
            user: user.to_owned(),
            address: SPACE_TRACK_HOST.to_owned(),
            is_passphrase: false,
            refused: None,
            keyring_problem: None,
        };
        match self.dialog.show(ui, &request) {
            None => {}
            Some(SecretAnswer::Cancelled) => self.close(),
            Some(SecretAnswer::Typed { secret, keep }) => {
                let command = Command::SetSourcePassword { name, secret, keep };
                commands.push(UiCommand::Station(command));
                self.close();
            }
        }
    }

    fn close(&mut self) {
        self.source = None;
        self.dialog.clear();
    }
}

/// Returns the log-in name of the source called `name`, if it has one.
fn user_of<'a>(model: &'a Model, name: &str) -> Option<&'a str> {
    let source = model.sources.list.iter().find(|source| source.name == name)?;
    match &source.place {
        SourcePlace::SpaceTrack(user) => Some(user),
        SourcePlace::Web(_) | SourcePlace::File(_) | SourcePlace::Folder(_) => None,
    }
}
