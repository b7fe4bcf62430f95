//! The dialog for the path of a file, where the desktop shows none.

use std::path::PathBuf;

use egui::{Key, RichText, TextEdit, Ui};

use super::WIDTH;
use crate::{
    model::{
        UiCommand,
        export::{PathRequest, TypedPath},
    },
    ui::{
        text, theme,
        widgets::{
            button::{self, Button},
            modal::modal,
            told::{Tone, line},
        },
        words::sentence,
    },
};

/// Input of the dialog.
#[derive(Debug, Clone)]
pub struct SavePathDialog {
    request: PathRequest,
    typed: String,
    is_shown: bool,
}

enum PathAnswer {
    Open,
    Cancelled,
    Typed(TypedPath),
}

impl SavePathDialog {
    pub fn new(request: PathRequest) -> Self {
        let typed = request.proposed.path.display().to_string();
        Self { request, typed, is_shown: false }
    }

    /// Shows the dialog, if it is open, until it is answered. Enter saves unless Cancel has the
    /// focus, Esc cancels.
    pub fn show(dialog: &mut Option<Self>, ui: &Ui, commands: &mut Vec<UiCommand>) {
        let Some(open) = dialog else { return };
        let shown = modal(ui, "path of a file").show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
            open.content(ui)
        });
        open.is_shown = true;
        let is_left = shown.should_close();
        match shown.inner {
            PathAnswer::Open if !is_left => return,
            PathAnswer::Open | PathAnswer::Cancelled => {}
            PathAnswer::Typed(path) => {
                commands.push(UiCommand::SaveAs(open.request.export.clone(), path));
            }
        }
        *dialog = None;
    }

    fn content(&mut self, ui: &mut Ui) -> PathAnswer {
        let t = theme::tokens(ui);
        ui.label(RichText::new("Save to a file").font(text::value()));
        line(ui, Tone::Caution, &sentence(&self.request.why));
        let label = RichText::new("Path of the file").font(text::small()).color(t.t2);
        let label = ui.label(label).id;
        let edit =
            TextEdit::singleline(&mut self.typed).id_salt("path").desired_width(f32::INFINITY);
        let edit = ui.add(edit).labelled_by(label);
        if !self.is_shown {
            edit.request_focus();
        }
        ui.add_space(8.0);
        let path = PathBuf::from(self.typed.trim());
        // Another path replaces nothing before it was looked at.
        let replaces = self.request.proposed.replaces && path == self.request.proposed.path;
        let yes = if replaces { "Replace it (Enter)" } else { "Save (Enter)" };
        let [yes, cancel] = button::pair(ui, Button::primary(yes), Button::normal("Cancel"));
        let enter = ui.input(|input| input.key_pressed(Key::Enter)) && !cancel.has_focus();
        if cancel.clicked() {
            PathAnswer::Cancelled
        } else if yes.clicked() || enter {
            PathAnswer::Typed(TypedPath { path, replaces })
        } else {
            PathAnswer::Open
        }
    }
}
