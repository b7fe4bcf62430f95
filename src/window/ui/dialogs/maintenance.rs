//! The dialog that locks a unit out for maintenance, or ends the lock-out.

use egui::{RichText, Sense, TextEdit, Ui, vec2};

use crate::{
    contract::{antenna::AntennaModel, driver::Command},
    model::{Model, UiCommand},
    station::LockOut,
    ui::{
        confirm::Question,
        format, text, theme,
        widgets::{
            button::{Button, HEIGHT},
            hold_button::{self, HoldState},
            modal::modal,
            status_line::{Tone, line},
        },
        words,
    },
};

const WIDTH: f32 = 380.0;
const LOCK: &str = "Hold 1 s to lock out";
const TAKE_OFF: &str = "Hold 1 s to remove the lock-out";

/// Input of the dialog.
#[derive(Debug, Clone, Default)]
pub struct MaintenanceDialog {
    name: String,
    reason: String,
    is_shown: bool,
    hold: HoldState,
}

enum MaintenanceAnswer {
    Open,
    Closed,
    Held,
}

impl MaintenanceDialog {
    /// Shows the dialog about `antenna`, if it is open, at the centre of the window.
    pub fn show(
        dialog: &mut Option<Self>,
        ui: &Ui,
        model: &Model,
        antenna: &AntennaModel,
        question: &mut Option<Question>,
        commands: &mut Vec<UiCommand>,
    ) {
        let Some(open) = dialog.as_mut() else { return };
        let for_antenna = |command| UiCommand::antenna(antenna.id(), command);
        let lock_out = antenna.snapshot.lock_out.clone();
        let shown = modal(ui, "maintenance").show(ui.ctx(), |ui| {
            ui.set_width(WIDTH);
            match &lock_out {
                Some(lock_out) => open.take_off(ui, antenna, lock_out),
                None => open.lock_out(ui, antenna),
            }
        });
        let is_left = shown.should_close();
        match (shown.inner, lock_out) {
            (MaintenanceAnswer::Open, _) if !is_left => return,
            (MaintenanceAnswer::Held, Some(_)) => commands.push(for_antenna(Command::Unlock)),
            (MaintenanceAnswer::Held, None) => {
                let command = for_antenna(Command::LockOut(open.typed(model)));
                // Name a running activity once more before the lock-out ends it.
                match what_ends(antenna) {
                    None => commands.push(command),
                    Some(what_ends) => {
                        let name = &antenna.config.name;
                        let text = format!("{what_ends} Lock out {name} anyway?");
                        *question = Some(Question { text, yes: "Lock out", command });
                    }
                }
            }
            _ => {}
        }
        *dialog = None;
    }

    fn lock_out(&mut self, ui: &mut Ui, antenna: &AntennaModel) -> MaintenanceAnswer {
        let t = theme::tokens(ui);
        let name = &antenna.config.name;
        ui.label(RichText::new(format!("Lock out {name}")).font(text::value()));
        let words = "For work at the antenna. Until the lock-out is removed, only queries and \
                     STOP go to the unit, even after a restart.";
        ui.label(RichText::new(words).font(text::body()).color(t.t2));
        for (label, typed) in [("Your name", &mut self.name), ("Reason", &mut self.reason)] {
            let label = ui.label(RichText::new(label).font(text::small()).color(t.t3)).id;
            let edit = TextEdit::singleline(typed).desired_width(WIDTH - 16.0).char_limit(80);
            let edit = ui.add(edit).labelled_by(label);
            if !std::mem::replace(&mut self.is_shown, true) {
                edit.request_focus();
            }
        }
        ui.add_space(4.0);
        if let Some(what_ends) = what_ends(antenna) {
            line(ui, Tone::Caution, &what_ends);
        }
        let is_told = !self.name.trim().is_empty() && !self.reason.trim().is_empty();
        if !is_told {
            line(ui, Tone::Plain, "Both are required: the next person at the antenna has to know.");
        }
        self.keys(ui, LOCK, is_told)
    }

    fn take_off(
        &mut self,
        ui: &mut Ui,
        antenna: &AntennaModel,
        lock_out: &LockOut,
    ) -> MaintenanceAnswer {
        let t = theme::tokens(ui);
        let LockOut { operator: name, reason, start } = lock_out;
        let title = format!("Remove the lock-out of {}", antenna.config.name);
        ui.label(RichText::new(title).font(text::value()));
        for (label, value) in [
            ("Locked out by", name.clone()),
            ("Reason", reason.clone()),
            ("Since", format::dated(*start)),
        ] {
            ui.label(RichText::new(label).font(text::small()).color(t.t3));
            ui.label(RichText::new(value).font(text::body_medium()).color(t.t1));
        }
        ui.add_space(4.0);
        let words = "Make sure that nobody is still at the antenna: once the lock-out is removed, \
                     it may move again.";
        line(ui, Tone::Caution, words);
        self.keys(ui, TAKE_OFF, true)
    }

    fn keys(&mut self, ui: &mut Ui, words: &str, is_possible: bool) -> MaintenanceAnswer {
        let (row, _) = ui.allocate_exact_size(vec2(WIDTH, HEIGHT), Sense::hover());
        let cancel = Button::normal("Cancel");
        let (hold, cancelling) = row.split_left_right_at_x(row.right() - cancel.width(ui));
        let hold = hold.with_max_x(hold.right() - 8.0);
        if cancel.show(ui, "cancel maintenance", cancelling).clicked() {
            return MaintenanceAnswer::Closed;
        }
        if !is_possible {
            self.hold = HoldState::Released;
            Button::normal(words).locked(true).show(ui, "maintenance locked", hold);
        } else if hold_button::show(ui, hold, words, &mut self.hold) {
            return MaintenanceAnswer::Held;
        }
        MaintenanceAnswer::Open
    }

    fn typed(&self, model: &Model) -> LockOut {
        LockOut {
            operator: self.name.trim().to_owned(),
            reason: self.reason.trim().to_owned(),
            start: model.now,
        }
    }
}

/// Returns the activity that a lock-out ends; `None` if there is none.
fn what_ends(antenna: &AntennaModel) -> Option<String> {
    let name = &antenna.config.name;
    let program = antenna.snapshot.state.program;
    let stake = antenna
        .stake()
        .map(|stake| format!("{} STOP is sent first and ends that.", words::stake(name, &stake)));
    let auto = program.is_some_and(|program| program.auto == Some(true));
    let auto = auto.then(|| format!("Auto-track of {name} is switched off."));
    let sentences: Vec<String> = stake.into_iter().chain(auto).collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}
