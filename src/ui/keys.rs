//! Keys that work in every view. STOP's key is older than all of them and is
//! taken by the app itself.

use egui::{Key, Modifiers, Ui};

use super::{confirm::Question, operate::OperateState, theme};
use crate::{
    app::{Model, UiCommand, View, antenna::AntennaModel},
    driver::{self, Intent},
};

/// Takes the keys of this frame.
pub fn take(
    ui: &Ui,
    model: &Model,
    question: &mut Option<Question>,
    operate: &mut OperateState,
    commands: &mut Vec<UiCommand>,
) {
    let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND, Key::L) {
        commands.push(UiCommand::SetTheme(theme::name(ui).next()));
    }
    if pressed(Modifiers::COMMAND, Key::Num1) {
        commands.push(UiCommand::Show(View::Operate));
    }
    if pressed(Modifiers::COMMAND, Key::Num6) {
        commands.push(UiCommand::Show(View::Preferences));
    }
    for (index, key) in [Key::F1, Key::F2, Key::F3, Key::F4].into_iter().enumerate() {
        if index < model.antennas.len() && pressed(Modifiers::NONE, key) {
            commands.push(UiCommand::SelectAntenna(index));
        }
    }
    // A letter that is typed is no command.
    if ui.text_edit_focused() || question.is_some() {
        return;
    }
    if pressed(Modifiers::NONE, Key::A)
        && let Some(id) = model.alarms.newest_unseen()
    {
        commands.push(UiCommand::AcknowledgeAlarm(id));
    }
    if model.view != View::Operate {
        return;
    }
    if pressed(Modifiers::NONE, Key::P) {
        operate.drawer_open = !operate.drawer_open;
    }
    if pressed(Modifiers::NONE, Key::G) {
        operate.card.drive.go_to.focus();
    }
    let rate = i32::from(pressed(Modifiers::NONE, Key::PageUp))
        - i32::from(pressed(Modifiers::NONE, Key::PageDown));
    let manual = |antenna: &&AntennaModel| antenna.snapshot.intent == Intent::Manual;
    if rate != 0
        && let Some(antenna) = model.antenna().filter(manual)
    {
        operate.card.drive.change_rate(rate, antenna.config.limits.maximum_rate_deg_s);
    }
    if pressed(Modifiers::NONE, Key::N)
        && let Some(next) = model.next_pass()
    {
        commands.push(UiCommand::SelectPass(next.key()));
    }
    if pressed(Modifiers::NONE, Key::T) {
        *question = ask_to_track(model);
    }
    if pressed(Modifiers::NONE, Key::M) {
        let manual = UiCommand::Antenna(model.selected_antenna, driver::Command::Manual);
        if model.antenna().is_some_and(AntennaModel::tracks) {
            *question = Some(Question {
                text: "End tracking and move by hand?".to_owned(),
                yes: "Manual",
                command: manual,
            });
        } else {
            commands.push(manual);
        }
    }
}

fn ask_to_track(model: &Model) -> Option<Question> {
    let antenna = model.antenna()?;
    let forecast = model.selected_pass()?;
    Some(Question {
        text: format!(
            "Track {} with {}? The antenna moves.",
            forecast.satellite.short_name(),
            antenna.config.name
        ),
        yes: "Track",
        command: UiCommand::track_selected(model)?,
    })
}
