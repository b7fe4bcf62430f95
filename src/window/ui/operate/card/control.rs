//! Programs on the network: the program in control of the antenna, a program that asks for control,
//! and the buttons that hand control over and take it back.

use egui::{Rect, Ui};

use super::{Card, Cursor, remark};
use crate::{
    clock::Instant,
    contract::{
        self,
        antenna::AntennaModel,
        control::{Control, NetworkClient, Party, PortState},
    },
    model::UiCommand,
    ui::{
        format,
        icons::Icon,
        theme,
        widgets::button::{self, Button},
        words,
    },
};

/// Space between two buttons, points.
const GAP: f32 = 8.0;

/// Shows the party in control once a program is connected, and the error of a port that cannot be
/// opened.
pub(super) fn show(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>) {
    let control = &card.antenna.control;
    let t = theme::tokens(ui);
    if let PortState::Failed(reason) = &control.port {
        let words = words::port_failed(reason);
        remark(ui, at, "port failed", Icon::Warning, t.warn, &words);
        at.skip(6.0);
    }
    if control.clients.is_empty() && control.missed.is_none() {
        return;
    }
    let now = card.model.steady;
    if let Some(client) = control.client_in_control() {
        let words = in_control(client, now);
        remark(ui, at, "in control", Icon::Prompt, t.t1, &words);
        take_back(ui, at, card);
    } else if let Some(client) = asking(control) {
        let words = words::asks_for_control(client, control.party);
        remark(ui, at, "asks for control", Icon::Question, t.warn, &words);
        hand_over(ui, at, card, client);
    } else if let Some(client) = &control.missed {
        let words = words::asked_for_control(client);
        remark(ui, at, "asked for control", Icon::Question, t.warn, &words);
        hand_over(ui, at, card, client);
    } else {
        let words = words::connected(&control.clients, control.party);
        remark(ui, at, "connected programs", Icon::Prompt, t.t2, &words);
        // Automatic operation has a separate switch and needs no button here.
        if matches!(control.party, Some(Party::Window | Party::Command)) {
            release(ui, at, card);
        }
    }
    at.skip(6.0);
}

/// Returns the program that has waited longest for the operator's decision.
fn asking(control: &Control) -> Option<&NetworkClient> {
    let asking = control.clients.iter().filter(|client| client.asks_since.is_some());
    asking.min_by_key(|client| client.asks_since)
}

fn in_control(client: &NetworkClient, now: Instant) -> String {
    let last = client.last_line.as_ref().map(|(line, time)| {
        let age = now.saturating_duration_since(*time);
        (line.as_str(), format::age(age.as_secs_f64()))
    });
    words::in_control(client, last.as_ref().map(|(line, age)| (*line, age.as_str())))
}

fn take_back(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>) {
    let command = contract::Command::TakeControl(card.antenna.id());
    let clicked = row(ui, at, card.model.replay.is_some(), &[("Take control", "take control")]);
    card.commands.extend(clicked.map(|_| UiCommand::Station(command)));
}

fn release(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>) {
    let command = contract::Command::ReleaseControl(card.antenna.id());
    let buttons = [("Release control", "release control")];
    let clicked = row(ui, at, card.model.replay.is_some(), &buttons);
    card.commands.extend(clicked.map(|_| UiCommand::Station(command)));
}

fn hand_over(ui: &Ui, at: &mut Cursor, card: &mut Card<'_>, client: &NetworkClient) {
    let AntennaModel { control, .. } = card.antenna;
    let buttons = [("Hand over", "hand over"), ("Always allow", "always allow")];
    // Without a port of its own, the antenna keeps no list of allowed programs.
    let has_port = !matches!(control.port, PortState::Closed);
    let buttons = if has_port { &buttons[..] } else { &buttons[..1] };
    let clicked = row(ui, at, card.model.replay.is_some(), buttons);
    let antenna = card.antenna.id();
    card.commands.extend(clicked.map(|index| {
        let always = index == 1;
        let client = client.address;
        UiCommand::Station(contract::Command::HandOver { antenna, client, always })
    }));
}

/// Shows buttons side by side; returns the index of the pressed button.
fn row(ui: &Ui, at: &mut Cursor, is_locked: bool, buttons: &[(&str, &str)]) -> Option<usize> {
    at.skip(4.0);
    let row = at.take(button::SMALL_HEIGHT);
    let mut left = row.left();
    let mut pressed = None;
    for (index, (label, id)) in buttons.iter().enumerate() {
        let button = Button::normal(label).locked(is_locked);
        let width = button.width(ui);
        let place = Rect::from_x_y_ranges(left..=left + width, row.y_range());
        if button.show(ui, id, place).clicked() {
            pressed = Some(index);
        }
        left += width + GAP;
    }
    pressed
}
