//! The alarm button of the top bar and the list that it opens.

mod row;

use std::time::Duration;

use egui::{
    Align2, Color32, Popup, PopupCloseBehavior, Rect, RectAlign, Response, Role, Sense, Stroke,
    StrokeKind, Ui, ViewportId, WidgetInfo, pos2, vec2,
};

use super::{
    button::{Button, SMALL_HEIGHT},
    close_key, paint,
};
use crate::{
    contract,
    contract::alarms::{AlarmState, Priority},
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
/// Width of the list in a small and in a normal window, points. The list leaves the countdown of
/// the pass free.
const WIDTHS: [f32; 2] = [288.0, 328.0];
/// Distance of the list from the edge of the window, points.
const EDGE: f32 = 8.0;
/// Height of the line with the button for all alarms, and of a heading, points.
const HEADER_HEIGHT: f32 = 30.0;
const ALL_BUTTON: f32 = 140.0;
/// Half of the blink period of the bell, seconds. The bell blinks until the operator opens the
/// list.
const HALF_BLINK_S: f64 = 0.5;

/// A section of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Section {
    /// Alarms that are active or not acknowledged.
    Open,
    Shelved,
    /// Alarms that are over and acknowledged.
    Over,
}

impl Section {
    pub fn new(state: AlarmState) -> Self {
        match state {
            AlarmState::New | AlarmState::NewAndOver { .. } | AlarmState::Seen => Self::Open,
            AlarmState::Shelved { .. } => Self::Shelved,
            AlarmState::Over { .. } => Self::Over,
        }
    }

    fn heading(self) -> Option<&'static str> {
        match self {
            Self::Open => None,
            Self::Shelved => Some("Shelved"),
            Self::Over => Some("Over today (UTC)"),
        }
    }
}

#[derive(Debug, Clone, Copy)]
pub struct AlarmRow<'a> {
    /// Id of the alarm for the operator's answer.
    pub id: u64,
    pub priority: Priority,
    pub state: AlarmState,
    /// `true` if the alarm follows from an alarm above it.
    pub follows: bool,
    pub text: &'a str,
    /// Formatted times of the alarm, and its number of occurrences.
    pub time: &'a str,
    pub state_words: &'a str,
    /// The antenna that the alarm offers to move away from its position.
    pub moves_away: Option<AntennaId>,
}

impl AlarmRow<'_> {
    fn is_new(&self) -> bool {
        matches!(self.state, AlarmState::New | AlarmState::NewAndOver { .. })
    }

    fn is_standing_red(&self) -> bool {
        let stands = match self.state {
            AlarmState::New | AlarmState::Seen => true,
            AlarmState::NewAndOver { .. }
            | AlarmState::Over { .. }
            | AlarmState::Shelved { .. } => false,
        };
        stands && self.priority.is_red()
    }

    fn can_be_shelved(&self) -> bool {
        self.state == AlarmState::Seen && self.priority < Priority::First
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub struct AlarmModel<'a> {
    /// Rows in the order of the list, section by section.
    pub rows: &'a [AlarmRow<'a>],
    /// `true` if an alarm is newer than the last opening of the list, so that the bell blinks.
    pub unopened: bool,
}

impl AlarmModel<'_> {
    fn active(&self) -> usize {
        self.rows.iter().filter(|row| Section::new(row.state) == Section::Open).count()
    }

    /// Returns the colour of the most severe alarm that is not shelved.
    fn colour(&self, t: &Tokens) -> Color32 {
        let open = || self.rows.iter().filter(|row| Section::new(row.state) == Section::Open);
        if open().any(AlarmRow::is_standing_red) {
            t.bad
        } else if open().next().is_some() {
            t.warn
        } else {
            t.t2
        }
    }

    fn unacknowledged(&self) -> usize {
        self.rows.iter().filter(|row| row.is_new()).count()
    }
}

/// Shows the button in `rect`, and after a click the list below the bar, which ends at `below`.
pub fn show(
    ui: &Ui,
    (rect, below): (Rect, f32),
    model: &AlarmModel<'_>,
    one_line: bool,
    commands: &mut Vec<UiCommand>,
) {
    let response = button(ui, rect, model, one_line);
    let was_open = Popup::is_id_open(ui.ctx(), Popup::default_response_id(&response));
    if response.clicked() && !was_open {
        commands.push(UiCommand::Station(contract::Command::OpenedAlarms));
    }
    let [small, default] = WIDTHS;
    let width = if one_line { small } else { default };
    let right = ui.ctx().content_rect().right() - EDGE;
    Popup::from_toggle_button_response(&response)
        .anchor(rect.with_max_x(right).with_max_y(below))
        .align(RectAlign::BOTTOM_END)
        .width(width)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .accessible_name("Alarms")
        .show(|ui| {
            ui.set_min_width(width);
            list(ui, model, !was_open, commands);
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
    let colour = model.colour(t);
    let border = if new > 0 { colour } else { t.line };
    let fill = if response.hovered() { t.bg3 } else { t.bg2 };
    ui.painter().rect(rect, RADIUS, fill, Stroke::new(1.0, border), StrokeKind::Inside);
    if bell_is_lit(ui, model.unopened && new > 0) {
        let inset = if one_line { 16.0 } else { 18.0 };
        let area = paint::square(pos2(rect.left() + inset, rect.center().y), 16.0);
        icons::paint(ui.painter(), area, Icon::Bell, colour);
    }
    let strong = text::sized(13.0, Weight::SemiBold);
    if one_line {
        let position = pos2(rect.left() + 30.0, rect.center().y);
        paint::text(ui, position, Align2::LEFT_CENTER, active, strong, t.t1);
    } else {
        let position = pos2(rect.left() + 32.0, rect.center().y);
        let up = position - vec2(0.0, 7.0);
        paint::text(ui, up, Align2::LEFT_CENTER, first, strong, t.t1);
        let down = position + vec2(0.0, 8.5);
        paint::text(ui, down, Align2::LEFT_CENTER, second, text::small(), t.t2);
    }
    paint::focus_ring(ui, &response, RADIUS);
    // The tool-tip explains the number, which has no label in one line.
    if one_line { response.on_hover_text(name) } else { response }
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

fn list(ui: &mut Ui, model: &AlarmModel<'_>, opens: bool, commands: &mut Vec<UiCommand>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    if model.rows.is_empty() {
        ui.label("No alarms today.");
        return;
    }
    if model.unacknowledged() > 1 {
        let size_of_line = vec2(ui.available_width(), HEADER_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(size_of_line, Sense::hover());
        let size = vec2(ALL_BUTTON, SMALL_HEIGHT);
        let bounds = Rect::from_min_size(pos2(rect.right() - size.x, rect.top()), size);
        if Button::normal("Acknowledge all").show(ui, "acknowledge all", bounds).clicked()
            && let Some(newest) = model.rows.iter().map(|row| row.id).max()
        {
            commands.push(UiCommand::Station(contract::Command::AcknowledgeAlarms { newest }));
        }
    }
    let mut area = egui::ScrollArea::vertical().max_height(8.0 * row::HEIGHT);
    if opens {
        // The list opens at the top with the most severe alarm, wherever the operator left it.
        area = area.vertical_scroll_offset(0.0);
    }
    area.show(ui, |ui| {
        let mut section = Section::Open;
        for (index, alarm) in model.rows.iter().enumerate() {
            let now = Section::new(alarm.state);
            if std::mem::replace(&mut section, now) != now {
                heading(ui, now);
            } else if index > 0 {
                let line = ui.available_rect_before_wrap();
                let t = theme::tokens(ui);
                ui.painter().hline(line.x_range(), line.top(), (1.0, t.line));
            }
            row::show(ui, alarm, commands);
        }
    });
}

fn heading(ui: &mut Ui, section: Section) {
    if let Some(words) = section.heading() {
        let t = theme::tokens(ui);
        let size = vec2(ui.available_width(), HEADER_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let strong = text::sized(12.0, Weight::SemiBold);
        paint::text(ui, rect.left_center(), Align2::LEFT_CENTER, words, strong, t.t2);
        ui.painter().hline(rect.x_range(), rect.bottom(), (1.0, t.line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{contract, ui::widgets::testing};
    use egui_kittest::kittest::Queryable as _;

    const ROWS: [AlarmRow<'_>; 2] = [
        AlarmRow {
            id: 7,
            priority: Priority::Warning,
            state: AlarmState::New,
            follows: false,
            state_words: "new",
            text: "RC2000C does not reply",
            time: "11:05:58Z",
            moves_away: None,
        },
        AlarmRow {
            id: 5,
            priority: Priority::Caution,
            state: AlarmState::Seen,
            follows: false,
            state_words: "seen",
            text: "METEOR-M2 3 elements are 9 days old",
            time: "10:41:10Z",
            moves_away: None,
        },
    ];

    /// Returns the height of the row of an alarm with this text, points.
    fn row_height(text: &str) -> f32 {
        let row = AlarmRow { text, ..ROWS[0] };
        let mut window = testing::window([500.0, 300.0], (), move |ui, ()| {
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(104.0, 40.0));
            let model = AlarmModel { rows: &[row], unopened: false };
            show(ui, (rect, rect.bottom()), &model, false, &mut Vec::new());
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
        assert!((one - row::HEIGHT).abs() < 0.5, "{one}");
        assert!(more > one + 2.0 * 15.0, "{more}");
    }

    #[test]
    fn the_bell_has_the_colour_of_the_gravest_alarm_that_is_not_shelved() {
        let t = crate::model::ThemeName::Dark.tokens();
        let colour = |rows: &[AlarmRow<'_>]| AlarmModel { rows, unopened: false }.colour(t);
        let [red, amber] = ROWS;
        let now = jiff::Timestamp::UNIX_EPOCH;
        let shelved = AlarmRow { state: AlarmState::Shelved { end: now }, ..red };
        let alarm_row = AlarmRow { state: AlarmState::NewAndOver { over_since: now }, ..red };
        let done = AlarmRow { state: AlarmState::Over { over_since: now }, ..red };
        assert_eq!(colour(&[red, amber]), t.bad);
        assert_eq!(colour(&[AlarmRow { state: AlarmState::Seen, ..red }]), t.bad);
        assert_eq!(colour(&[amber, shelved, done]), t.warn);
        assert_eq!(colour(&[alarm_row]), t.warn);
        assert_eq!(colour(&[shelved, done]), t.t2);
    }

    #[test]
    fn an_alarm_is_acknowledged_from_the_list() {
        let mut window = testing::window([500.0, 300.0], Vec::new(), |ui, commands| {
            let model = AlarmModel { rows: &ROWS, unopened: false };
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(104.0, 40.0));
            show(ui, (rect, rect.bottom()), &model, false, commands);
        });
        window.get_by_label("2 alarms, 1 new").click();
        window.run();
        assert_eq!(*window.state(), [UiCommand::Station(contract::Command::OpenedAlarms)]);
        window.get_by_label("METEOR-M2 3 elements are 9 days old, 10:41:10Z, seen");
        window.get_by_label("Acknowledge: RC2000C does not reply").click();
        window.run();
        assert_eq!(
            *window.state(),
            [
                UiCommand::Station(contract::Command::OpenedAlarms),
                UiCommand::Station(contract::Command::AcknowledgeAlarm(7))
            ]
        );
    }
}
