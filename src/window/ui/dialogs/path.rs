//! Dialog for the path of a file, for desktops that show no file dialog.

use std::path::PathBuf;

use egui::{Key, RichText, TextEdit, Ui};

use super::WIDTH;
use crate::{
    model::{
        UiCommand,
        typed_path::{OpenedFile, PathPurpose, PathRequest, TypedPath},
    },
    ui::{
        text, theme,
        widgets::{
            button::{self, Button},
            modal::modal,
            status_line::{Tone, line},
        },
        words::sentence,
    },
};

/// Input of the dialog.
#[derive(Debug, Clone)]
pub struct PathDialog {
    request: PathRequest,
    typed: String,
    is_shown: bool,
}

enum PathAnswer {
    Open,
    Cancelled,
    Typed(UiCommand),
}

impl PathDialog {
    pub fn new(request: PathRequest) -> Self {
        let typed = request.path.display().to_string();
        Self { request, typed, is_shown: false }
    }

    /// Shows the dialog, if it is open, until the operator answers. Enter saves or opens unless
    /// Cancel has the focus; Esc cancels.
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
            PathAnswer::Typed(command) => commands.push(command),
        }
        *dialog = None;
    }

    fn content(&mut self, ui: &mut Ui) -> PathAnswer {
        let t = theme::tokens(ui);
        let title = match &self.request.purpose {
            PathPurpose::Save { .. } => "Save to a file",
            PathPurpose::Open(OpenedFile::Station) => "Open a station file",
            PathPurpose::Open(OpenedFile::Elements) => "Open a file of elements",
        };
        ui.label(RichText::new(title).font(text::value()));
        line(ui, Tone::Caution, &sentence(&self.request.reason));
        if self.request.purpose == PathPurpose::Open(OpenedFile::Elements) {
            let words = "Files can also be dropped on this window, and elements pasted into it.";
            line(ui, Tone::Plain, words);
        }
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
        let (yes, command) = match &self.request.purpose {
            PathPurpose::Save { export, replaces } => {
                // A new path replaces no file until Azel has checked the path.
                let replaces = *replaces && path == self.request.path;
                let yes = if replaces { "Replace it (Enter)" } else { "Save (Enter)" };
                (yes, UiCommand::SaveAs(export.clone(), TypedPath { path, replaces }))
            }
            PathPurpose::Open(file) => ("Open (Enter)", UiCommand::OpenFile(*file, path)),
        };
        let [yes, cancel] = button::pair(ui, Button::primary(yes), Button::normal("Cancel"));
        let enter = ui.input(|input| input.key_pressed(Key::Enter)) && !cancel.has_focus();
        if cancel.clicked() {
            PathAnswer::Cancelled
        } else if yes.clicked() || enter {
            PathAnswer::Typed(command)
        } else {
            PathAnswer::Open
        }
    }
}
