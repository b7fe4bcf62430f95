//! The alarm button of the top bar and the list that it opens.

use std::{sync::Arc, time::Duration};

use egui::{
    Align2, Color32, Galley, Popup, PopupCloseBehavior, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, ViewportId, WidgetInfo, pos2, vec2,
};

use super::{
    button::{Button, SMALL_HEIGHT},
    close_key, paint,
};
use crate::{
    driver::Command,
    engine::{self, alarms::Priority},
    model::UiCommand,
    station::AntennaId,
    ui::{
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
    },
};

const RADIUS: u8 = 6;
const LIST_WIDTH: f32 = 360.0;
/// Height of a row with one line of text; more lines make it higher.
const ROW_HEIGHT: f32 = 52.0;
/// Gap between the text and its time.
const TIME_GAP: f32 = 1.0;
/// Height of the line with the time.
const TIME_HEIGHT: f32 = 16.0;
/// Width of a button.
const BUTTON: f32 = 100.0;
/// Room for the mark at the left of the text.
const TEXT_LEFT: f32 = 32.0;
/// Padding above the text and below the time.
const ROW_PADDING: f32 = 9.0;
/// The bell goes on and off once a second until the list was opened.
const HALF_BLINK_S: f64 = 0.5;

/// State of an alarm in its life cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmState {
    New,
    /// Acknowledged, but the cause persists.
    Seen,
    /// The cause is gone.
    Cleared,
}

#[derive(Debug, Clone, Copy)]
pub struct AlarmRow<'a> {
    /// Identifies the alarm in the operator's answer.
    pub id: u64,
    pub priority: Priority,
    pub state: AlarmState,
    pub text: &'a str,
    /// Time of the alarm, formatted.
    pub time: &'a str,
    /// Index of the antenna that the alarm offers to move away from its position.
    pub moves_away: Option<AntennaId>,
}

#[derive(Debug, Clone, Copy, Default)]
pub struct AlarmModel<'a> {
    /// Newest first.
    pub rows: &'a [AlarmRow<'a>],
    /// An alarm is newer than the last opening of the list; the bell blinks.
    pub unopened: bool,
}

impl AlarmModel<'_> {
    fn count(&self, wanted: impl Fn(AlarmState) -> bool) -> usize {
        self.rows.iter().filter(|row| wanted(row.state)).count()
    }

    fn active(&self) -> usize {
        self.count(|state| matches!(state, AlarmState::New | AlarmState::Seen))
    }

    fn unacknowledged(&self) -> usize {
        self.count(|state| state == AlarmState::New)
    }
}

/// Shows the button in `rect` and, when it was clicked, the list below it.
pub fn show(
    ui: &Ui,
    rect: Rect,
    model: &AlarmModel<'_>,
    one_line: bool,
    commands: &mut Vec<UiCommand>,
) {
    let response = button(ui, rect, model, one_line);
    let was_open = Popup::is_id_open(ui.ctx(), Popup::default_response_id(&response));
    if response.clicked() && !was_open {
        commands.push(UiCommand::Station(engine::Command::OpenedAlarms));
    }
    Popup::from_toggle_button_response(&response)
        .width(LIST_WIDTH)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .accessible_name("Alarms")
        .show(|ui| {
            list(ui, model, commands);
            close_key::show(ui);
        });
}

fn button(ui: &Ui, rect: Rect, model: &AlarmModel<'_>, one_line: bool) -> Response {
    let t = theme::tokens(ui);
    let (active, new) = (model.active(), model.unacknowledged());
    let first = match active {
        0 => "No alarms".to_owned(),
        1 => "1 alarm".to_owned(),
        more => format!("{more} alarms"),
    };
    let second = match (active, new) {
        (0, _) => "all quiet".to_owned(),
        (_, 0) => "seen".to_owned(),
        (_, new) => format!("{new} new"),
    };
    let response = ui.interact(rect, ui.make_persistent_id("alarms"), Sense::click());
    let name = format!("{first}, {second}");
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let colour = if new > 0 { t.warn } else { t.t2 };
    let border = if new > 0 { t.warn } else { t.line };
    let fill = if response.hovered() { t.bg3 } else { t.bg2 };
    ui.painter().rect(rect, RADIUS, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    if bell_is_lit(ui, model.unopened && new > 0) {
        let inset = if one_line { 16.0 } else { 18.0 };
        let at = paint::square(pos2(rect.left() + inset, rect.center().y), 16.0);
        icons::paint(ui.painter(), at, Icon::Bell, colour);
    }
    let strong = text::sized(13.0, Weight::SemiBold);
    if one_line {
        let at = pos2(rect.left() + 30.0, rect.center().y);
        paint::text(ui, at, Align2::LEFT_CENTER, active, strong, t.t1);
    } else {
        let at = pos2(rect.left() + 32.0, rect.center().y);
        let up = at - vec2(0.0, 7.0);
        paint::text(ui, up, Align2::LEFT_CENTER, first, strong, t.t1);
        let down = at + vec2(0.0, 8.5);
        paint::text(ui, down, Align2::LEFT_CENTER, second, text::small(), t.t2);
    }
    paint::focus_ring(ui, &response, RADIUS);
    response
}

fn bell_is_lit(ui: &Ui, blinking: bool) -> bool {
    if !blinking {
        return true;
    }
    let phase = ui.input(|input| input.time) % (2.0 * HALF_BLINK_S);
    let rest = HALF_BLINK_S - phase % HALF_BLINK_S;
    let rest = Duration::try_from_secs_f64(rest).unwrap_or_default();
    ui.ctx().request_repaint_after_for(rest, ViewportId::ROOT);
    phase < HALF_BLINK_S
}

fn list(ui: &mut Ui, model: &AlarmModel<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    ui.spacing_mut().item_spacing.y = 0.0;
    if model.rows.is_empty() {
        ui.label("No alarms since the program was started.");
        return;
    }
    egui::ScrollArea::vertical().max_height(8.0 * ROW_HEIGHT).show(ui, |ui| {
        for (index, row) in model.rows.iter().enumerate() {
            let words = words_of(ui, row);
            let wanted = words.size().y + TIME_GAP + TIME_HEIGHT + 2.0 * ROW_PADDING;
            let size = vec2(LIST_WIDTH, wanted.max(row_height(row)));
            let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
            if index > 0 {
                ui.painter().hline(rect.x_range(), rect.top(), (1.0, t.line));
            }
            list_row(ui, rect, row, words, commands);
        }
    });
}

fn words_of(ui: &Ui, row: &AlarmRow<'_>) -> Arc<Galley> {
    let t = theme::tokens(ui);
    let (weight, ink) = match row.state {
        AlarmState::New => (Weight::SemiBold, t.t1),
        _ => (Weight::Regular, t.t2),
    };
    let width = LIST_WIDTH - TEXT_LEFT - right_of_text(row);
    ui.painter().layout(row.text.to_owned(), text::sized(13.0, weight), ink, width)
}

/// Room at the right for the button or the state.
fn right_of_text(row: &AlarmRow<'_>) -> f32 {
    match row.state {
        _ if row.moves_away.is_some() => BUTTON + 4.0,
        AlarmState::New => BUTTON + 4.0,
        AlarmState::Seen | AlarmState::Cleared => 60.0,
    }
}

/// Minimum height of a row with two buttons, one above the other.
fn row_height(row: &AlarmRow<'_>) -> f32 {
    if row.moves_away.is_some() { 2.0 * SMALL_HEIGHT + 3.0 * ROW_PADDING } else { ROW_HEIGHT }
}

fn list_row(
    ui: &Ui,
    rect: Rect,
    row: &AlarmRow<'_>,
    galley: Arc<Galley>,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let (icon, colour) = mark(row, t);
    let glyph = paint::square(pos2(rect.left() + 12.0, rect.center().y), 18.0);
    icons::paint(ui.painter(), glyph, icon, colour);
    let new = row.state == AlarmState::New;
    let right = right_of_text(row);
    let room = rect.with_min_x(rect.left() + TEXT_LEFT).with_max_x(rect.right() - right);
    let height = galley.size().y + TIME_GAP + TIME_HEIGHT;
    let top = pos2(room.left(), room.center().y - height / 2.0);
    let time = pos2(top.x, top.y + galley.size().y + TIME_GAP);
    ui.painter().galley(top, galley, t.t1);
    paint::text(ui, time, Align2::LEFT_TOP, row.time, text::small(), t.t3);
    let words = match row.state {
        AlarmState::New => "new".to_owned(),
        AlarmState::Seen => "seen".to_owned(),
        AlarmState::Cleared => "cleared".to_owned(),
    };
    let name = format!("{}, {}, {words}", row.text, row.time);
    paint::name_text(ui, ("alarm", row.id), room, &name);
    let mut centre = rect.center().y;
    let button = |centre: f32, words: &'static str, salt: &'static str| {
        let min = pos2(rect.right() - BUTTON, centre - SMALL_HEIGHT / 2.0);
        let at = Rect::from_min_size(min, vec2(BUTTON, SMALL_HEIGHT));
        let pressed = Button::normal(words).show(ui, (salt, row.id), at);
        pressed.accessible_name(format!("{words}: {}", row.text)).clicked()
    };
    if let Some(antenna) = row.moves_away {
        let apart = f32::midpoint(SMALL_HEIGHT, ROW_PADDING);
        if button(centre - apart, "Move away", "move away") {
            commands.push(UiCommand::antenna(antenna, Command::MoveAway));
        }
        centre += apart;
    }
    if new {
        if button(centre, "Acknowledge", "acknowledge") {
            commands.push(UiCommand::Station(engine::Command::AcknowledgeAlarm(row.id)));
        }
        return;
    }
    let at = pos2(rect.right() - 4.0, centre);
    paint::text(ui, at, Align2::RIGHT_CENTER, words, text::small(), t.t2);
}

fn mark(row: &AlarmRow<'_>, t: &Tokens) -> (Icon, Color32) {
    match (row.state, row.priority) {
        (AlarmState::Cleared, _) => (Icon::Check, t.t3),
        (_, Priority::Warning) => (Icon::Octagon, t.bad),
        (_, Priority::Caution) => (Icon::Warning, t.warn),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing;
    use egui_kittest::kittest::Queryable as _;

    const ROWS: [AlarmRow<'_>; 2] = [
        AlarmRow {
            id: 7,
            priority: Priority::Warning,
            state: AlarmState::New,
            text: "RC2000C does not reply",
            time: "11:05:58Z",
            moves_away: None,
        },
        AlarmRow {
            id: 5,
            priority: Priority::Caution,
            state: AlarmState::Seen,
            text: "METEOR-M2 3 elements are 9 days old",
            time: "10:41:10Z",
            moves_away: None,
        },
    ];

    /// The height of the row of an alarm with this text.
    fn row_height(text: &str) -> f32 {
        let row = AlarmRow { text, ..ROWS[0] };
        let mut window = testing::window([500.0, 300.0], (), move |ui, ()| {
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(104.0, 40.0));
            let model = AlarmModel { rows: &[row], unopened: false };
            show(ui, rect, &model, false, &mut Vec::new());
        });
        window.get_by_label("1 alarm, 1 new").click();
        window.run();
        window.get_by_label(&format!("{text}, 11:05:58Z, new")).rect().height()
    }

    #[test]
    fn a_long_text_gets_the_lines_that_it_needs() {
        let long = "Satrak seems to write decimal commas. Its position cannot be read. Set it \
                    to points, in its own settings.";
        let (one, more) = (row_height(ROWS[0].text), row_height(long));
        assert!((one - ROW_HEIGHT).abs() < 0.5, "{one}");
        assert!(more > one + 2.0 * 15.0, "{more}");
    }

    #[test]
    fn an_alarm_is_acknowledged_from_the_list() {
        let mut window = testing::window([500.0, 300.0], Vec::new(), |ui, commands| {
            let model = AlarmModel { rows: &ROWS, unopened: false };
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(104.0, 40.0));
            show(ui, rect, &model, false, commands);
        });
        window.get_by_label("2 alarms, 1 new").click();
        window.run();
        assert_eq!(*window.state(), [UiCommand::Station(engine::Command::OpenedAlarms)]);
        window.get_by_label("METEOR-M2 3 elements are 9 days old, 10:41:10Z, seen");
        window.get_by_label("Acknowledge: RC2000C does not reply").click();
        window.run();
        assert_eq!(
            *window.state(),
            [
                UiCommand::Station(engine::Command::OpenedAlarms),
                UiCommand::Station(engine::Command::AcknowledgeAlarm(7))
            ]
        );
    }
}
