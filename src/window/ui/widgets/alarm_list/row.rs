//! One row of the alarm list.

use std::sync::Arc;

use egui::{Color32, Galley, Id, Rect, Sense, Ui, pos2, vec2};

use super::AlarmRow;
use crate::{
    contract::{
        self,
        alarms::{AlarmState, ShelveTime},
        driver::Command,
    },
    model::UiCommand,
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            paint,
        },
    },
};

/// Min height of a row, points: one line of text and one button.
pub(super) const HEIGHT: f32 = 52.0;
/// Gap between the text and its times, and between two buttons, points.
const GAP: f32 = 1.0;
const BUTTON_GAP: f32 = 6.0;
const BUTTON: f32 = 100.0;
/// Room at the right for the scroll bar, points.
const RIGHT: f32 = 8.0;
/// Room for the mark at the left of the text, points.
const TEXT_LEFT: f32 = 34.0;
/// Additional room at the left of an alarm that follows from another, points.
const INDENT: f32 = 16.0;
/// Padding above the text and below the times, points.
const PADDING: f32 = 9.0;

/// A button of a row.
struct RowButton {
    words: &'static str,
    command: Option<UiCommand>,
}

/// Shows a row. While the operator shelves the alarm, the choice of times stands below it.
pub(super) fn show(ui: &mut Ui, row: &AlarmRow<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let indent = if row.follows { INDENT } else { 0.0 };
    let whole = ui.available_width();
    let width = whole - TEXT_LEFT - indent - BUTTON - RIGHT - 8.0;
    let (weight, ink) =
        if row.is_new() { (Weight::SemiBold, t.t1) } else { (Weight::Regular, t.t2) };
    let lay = |words: String, font, ink| ui.painter().layout(words, font, ink, width);
    let words = lay(row.text.to_owned(), text::sized(13.0, weight), ink);
    let times = lay(format!("{}, {}", row.time, row.state_words), text::small(), t.t3);
    let buttons = buttons(row);
    let count = buttons.len() as f32;
    let of_buttons = count * (SMALL_HEIGHT + BUTTON_GAP) - BUTTON_GAP;
    let of_text = words.size().y + GAP + times.size().y;
    let requested = of_text.max(of_buttons) + 2.0 * PADDING;
    let size = vec2(whole, requested.max(HEIGHT));
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    mark(ui, rect.translate(vec2(indent, 0.0)), row, t);
    let room = Rect::from_min_size(
        pos2(rect.left() + TEXT_LEFT + indent, rect.top()),
        vec2(width, rect.height()),
    );
    tell(ui, row, room, [words, times], of_text);
    let shelving = Id::unique("the alarm being shelved");
    let being: Option<u64> = ui.data(|data| data.get_temp(shelving));
    let mut top = rect.center().y - of_buttons / 2.0;
    for button in buttons {
        let area = Rect::from_min_size(
            pos2(rect.right() - RIGHT - BUTTON, top),
            vec2(BUTTON, SMALL_HEIGHT),
        );
        top += SMALL_HEIGHT + BUTTON_GAP;
        let pressed = Button::normal(button.words).show(ui, (button.words, row.id), area);
        if pressed.accessible_name(format!("{}: {}", button.words, row.text)).clicked() {
            match button.command {
                Some(command) => commands.push(command),
                None if being == Some(row.id) => ui.data_mut(|data| data.remove::<u64>(shelving)),
                None => ui.data_mut(|data| {
                    data.insert_temp(shelving, row.id);
                }),
            }
        }
    }
    if being == Some(row.id) && row.can_be_shelved() && choose_time(ui, row, commands) {
        ui.data_mut(|data| data.remove::<u64>(shelving));
    }
}

fn tell(ui: &Ui, row: &AlarmRow<'_>, room: Rect, galleys: [Arc<Galley>; 2], height: f32) {
    let t = theme::tokens(ui);
    let [words, times] = galleys;
    let top = pos2(room.left(), room.center().y - height / 2.0);
    let below = pos2(top.x, top.y + words.size().y + GAP);
    ui.painter().galley(top, words, t.t1);
    ui.painter().galley(below, times, t.t3);
    let follows = if row.follows { ", follows from the one above" } else { "" };
    let name = format!("{}, {}, {}{follows}", row.text, row.time, row.state_words);
    paint::name_text(ui, ("alarm", row.id), room, &name);
}

fn buttons(row: &AlarmRow<'_>) -> Vec<RowButton> {
    let station = |command| Some(UiCommand::Station(command));
    let mut buttons = Vec::new();
    if let Some(antenna) = row.moves_away {
        let command = Some(UiCommand::antenna(antenna, Command::MoveAway));
        buttons.push(RowButton { words: "Move away", command });
    }
    if row.is_new() {
        let command = station(contract::Command::AcknowledgeAlarm(row.id));
        buttons.push(RowButton { words: "Acknowledge", command });
    }
    if let AlarmState::Shelved { .. } = row.state {
        let command = station(contract::Command::UnshelveAlarm(row.id));
        buttons.push(RowButton { words: "Unshelve", command });
    }
    if row.can_be_shelved() {
        buttons.push(RowButton { words: "Shelve", command: None });
    }
    buttons
}

/// Shows the times for which an alarm can be shelved. Returns `true` once the operator has chosen
/// one.
fn choose_time(ui: &mut Ui, row: &AlarmRow<'_>, commands: &mut Vec<UiCommand>) -> bool {
    let size = vec2(ui.available_width(), SMALL_HEIGHT + PADDING);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let width = (rect.width() - TEXT_LEFT - RIGHT - 2.0 * BUTTON_GAP) / 3.0;
    let mut is_chosen = false;
    let mut left = rect.left() + TEXT_LEFT;
    for time in ShelveTime::ALL {
        let words = match time {
            ShelveTime::TenMinutes => "10 min",
            ShelveTime::OneHour => "1 h",
            ShelveTime::EightHours => "8 h",
        };
        let area = Rect::from_min_size(pos2(left, rect.top()), vec2(width, SMALL_HEIGHT));
        left += width + BUTTON_GAP;
        let pressed = Button::normal(words).show(ui, (words, row.id), area);
        if pressed.accessible_name(format!("Shelve for {words}: {}", row.text)).clicked() {
            let shelve = contract::Command::ShelveAlarm { id: row.id, time };
            commands.push(UiCommand::Station(shelve));
            is_chosen = true;
        }
    }
    is_chosen
}

/// Paints the mark of a row. The icon shows the state and priority of the alarm. A dot shows that
/// nobody has acknowledged the alarm.
fn mark(ui: &Ui, rect: Rect, row: &AlarmRow<'_>, t: &Tokens) {
    let (icon, colour) = icon(row, t);
    let centre = pos2(rect.left() + 17.0, rect.center().y);
    icons::paint(ui.painter(), paint::square(centre, 18.0), icon, colour);
    if row.is_new() {
        ui.painter().circle_filled(pos2(rect.left() + 3.0, centre.y), 2.5, t.warn);
    }
}

fn icon(row: &AlarmRow<'_>, t: &Tokens) -> (Icon, Color32) {
    match (row.state, row.priority) {
        (AlarmState::Shelved { .. }, _) => (Icon::Clock, t.t2),
        (AlarmState::NewAndOver { .. }, _) => (Icon::Check, t.warn),
        (AlarmState::Over { .. }, _) => (Icon::Check, t.t3),
        (AlarmState::New | AlarmState::Seen, _) if row.is_standing_red() => (Icon::Octagon, t.bad),
        (AlarmState::New | AlarmState::Seen, _) => (Icon::Warning, t.warn),
    }
}
