//! Programs on the network: the program in control of the antenna, a program that asks for control,
//! and the buttons that hand control over and take it back.

use egui::{Rect, Ui};

use super::{Card, Cursor, show_remark};
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
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>) {
    let control = &card.antenna.control;
    let t = theme::tokens(ui);
    if let PortState::Failed(reason) = &control.port {
        let words = words::port_failed(reason);
        show_remark(ui, cursor, "port failed", Icon::Warning, t.warn, &words);
        cursor.skip(6.0);
    }
    if control.clients.is_empty() && control.missed.is_none() {
        return;
    }
    let now = card.model.steady;
    if let Some(client) = control.client_in_control() {
        let words = describe_control(client, now);
        show_remark(ui, cursor, "in control", Icon::Prompt, t.t1, &words);
        show_take_back(ui, cursor, card);
    } else if let Some(client) = first_requester(control) {
        let words = words::asks_for_control(client, control.party);
        show_remark(ui, cursor, "asks for control", Icon::Question, t.warn, &words);
        show_hand_over(ui, cursor, card, client);
    } else if let Some(client) = &control.missed {
        let words = words::asked_for_control(client);
        show_remark(ui, cursor, "asked for control", Icon::Question, t.warn, &words);
        show_hand_over(ui, cursor, card, client);
    } else {
        let words = words::connected(&control.clients, control.party);
        show_remark(ui, cursor, "connected programs", Icon::Prompt, t.t2, &words);
        // Automatic operation has a separate switch and needs no button here.
        if matches!(control.party, Some(Party::Window | Party::Command)) {
            show_release(ui, cursor, card);
        }
    }
    cursor.skip(6.0);
}

/// Returns the program that has waited longest for the operator's decision.
fn first_requester(control: &Control) -> Option<&NetworkClient> {
    let clients = control.clients.iter().filter(|client| client.asks_since.is_some());
    clients.min_by_key(|client| client.asks_since)
}

fn describe_control(client: &NetworkClient, now: Instant) -> String {
    let last = client.last_line.as_ref().map(|(line, time)| {
        let age = now.saturating_duration_since(*time);
        (line.as_str(), format::age(age.as_secs_f64()))
    });
    words::in_control(client, last.as_ref().map(|(line, age)| (*line, age.as_str())))
}

fn show_take_back(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>) {
    let command = contract::Command::TakeControl(card.antenna.id());
    let clicked =
        show_buttons(ui, cursor, card.model.replay.is_some(), &[("Take control", "take control")]);
    card.commands.extend(clicked.map(|_| UiCommand::Station(command)));
}

fn show_release(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>) {
    let command = contract::Command::ReleaseControl(card.antenna.id());
    let buttons = [("Release control", "release control")];
    let clicked = show_buttons(ui, cursor, card.model.replay.is_some(), &buttons);
    card.commands.extend(clicked.map(|_| UiCommand::Station(command)));
}

fn show_hand_over(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, client: &NetworkClient) {
    let AntennaModel { control, .. } = card.antenna;
    let buttons = [("Hand over", "hand over"), ("Always allow", "always allow")];
    // Without a port of its own, the antenna keeps no list of allowed programs.
    let has_port = !matches!(control.port, PortState::Closed);
    let buttons = if has_port { &buttons[..] } else { &buttons[..1] };
    let clicked = show_buttons(ui, cursor, card.model.replay.is_some(), buttons);
    let antenna = card.antenna.id();
    card.commands.extend(clicked.map(|index| {
        let always = index == 1;
        let client = client.address;
        UiCommand::Station(contract::Command::HandOver { antenna, client, always })
    }));
}

/// Shows buttons side by side; returns the index of the pressed button.
fn show_buttons(
    ui: &Ui,
    cursor: &mut Cursor,
    is_locked: bool,
    buttons: &[(&str, &str)],
) -> Option<usize> {
    cursor.skip(4.0);
    let row = cursor.take(button::SMALL_HEIGHT);
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
