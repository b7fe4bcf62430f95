//! The bar at the top of every view: station, clock, antennas, alarms, STOP.

mod chips;
mod clock;
mod station;

use egui::{Align2, Area, Id, Order, Rect, Ui, UiBuilder, pos2, vec2};

use super::{
    icons, text, theme,
    widgets::{
        alarm_list::{self, AlarmModel},
        link_chip::ChipModel,
        paint,
        stop_button::{self, StopLook},
    },
};
use crate::model::{Stations, UiCommand};
pub use clock::{ClockHealth, ClockModel, ClockMood};

/// Height of the bar, points.
pub const HEIGHT: f32 = 56.0;
/// Height of the bar in a low window, points.
pub const SMALL_HEIGHT: f32 = 48.0;
/// Window height below which the bar is small, points.
pub const SMALL_BELOW: f32 = 800.0;
/// Min width for date and local time, points; in a narrower bar they move to a tool-tip.
const DATE_FROM: f32 = 1360.0;
/// Min width of a bar whose chips have two lines, points.
const TWO_LINES_FROM: f32 = 1200.0;
/// Width of the words about antennas that STOP does not reach, points.
const LEFT_OUT: f32 = 56.0;

/// Content of the bar.
#[derive(Debug, Clone, Copy)]
pub struct TopBarModel<'a> {
    pub station: &'a str,
    /// `true` for the demo station.
    pub demo: bool,
    /// Stations for the station menu.
    pub stations: &'a Stations,
    /// Formatted coordinates of the station.
    pub coordinates: &'a str,
    /// Formatted times and date.
    pub clock: ClockModel<'a>,
    /// Chips of the antennas, one for each, in the order of the keys F1 to F4.
    pub chips: &'a [ChipModel<'a>],
    pub alarms: AlarmModel<'a>,
    /// Outcome of the last STOP.
    pub stop: StopLook<'a>,
    /// Effect of STOP, in one or more sentences.
    pub stop_about: &'a str,
    /// Antennas that STOP leaves alone, if any.
    pub stop_left_out: Option<StopLeftOut<'a>>,
}

/// The antennas that STOP leaves alone.
#[derive(Debug, Clone, Copy)]
pub struct StopLeftOut<'a> {
    /// Number of antennas that STOP stops, of all antennas.
    pub count: &'a str,
    /// Sentence that names the antennas left alone, and the reason.
    pub sentence: &'a str,
}

/// Returns the height of the bar for a window of this height, points.
pub fn height(window_height: f32) -> f32 {
    if window_height < SMALL_BELOW { SMALL_HEIGHT } else { HEIGHT }
}

/// Shows the bar in `rect`. Call this function first in a frame, so that STOP comes first in Tab
/// order.
pub fn show(ui: &mut Ui, rect: Rect, model: &TopBarModel<'_>) -> Vec<UiCommand> {
    let mut commands = Vec::new();
    let builder = UiBuilder::new().id_salt("top bar").max_rect(rect);
    ui.scope_builder(builder, |ui| fill(ui, rect, model, &mut commands));
    commands
}

fn fill(ui: &mut Ui, rect: Rect, model: &TopBarModel<'_>, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let small = rect.height() < HEIGHT;
    let wide = rect.width() >= TWO_LINES_FROM;
    let edge = if wide { 16.0 } else { 8.0 };
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));

    let size = if small { stop_button::SMALL_SIZE } else { stop_button::SIZE };
    let min = pos2(rect.right() - edge - size.x, rect.center().y - size.y / 2.0);
    let stop = Rect::from_min_size(min, size);
    if stop_clicked(ui, stop, model) {
        commands.push(UiCommand::Stop);
    }

    let rail = if wide { 72.0 } else { 48.0 };
    let sign = paint::square(pos2(rect.left() + rail / 2.0, rect.center().y), 30.0);
    icons::paint_sign(ui.painter(), sign, t.t1, t.sat);

    let width = if wide { 200.0 } else { station::one_line_width(ui, model.station) };
    let start = rect.left() + rail;
    let selector = rect.with_min_x(start + 4.0).with_max_x(start + width);
    station::show(ui, selector, model, wide, commands);
    let mut left = selector.right();
    if wide {
        ui.painter().vline(left, rect.y_range().shrink(8.0), (1.0, t.line));
        left += 18.0;
    } else {
        left += 24.0;
    }

    let alarm_width = if wide { 104.0 } else { 48.0 };
    let control = if small { 32.0 } else { 40.0 };
    let gap = match (model.stop_left_out, wide) {
        (None, true) => 16.0,
        (None, false) => 12.0,
        (Some(_), _) => LEFT_OUT,
    };
    let min = pos2(stop.left() - gap - alarm_width, rect.center().y - control / 2.0);
    let alarms = Rect::from_min_size(min, vec2(alarm_width, control));

    if let Some(left_out) = model.stop_left_out {
        let area = Rect::from_min_max(alarms.right_top(), stop.left_bottom());
        mark_left_out(ui, area, left_out);
    }

    let clock = clock::show(ui, rect.with_min_x(left), &model.clock, wide);
    let chips_left = chips::show(
        ui,
        Rect::from_min_max(
            pos2(clock.utc.right() + 12.0, alarms.top()),
            pos2(alarms.left() - 8.0, alarms.bottom()),
        ),
        model.chips,
        wide,
        commands,
    );
    let free = rect.with_max_x(chips_left - 8.0);
    if let StopLook::NotConfirmed { text } = model.stop {
        clock::not_confirmed(ui, rect, free.with_min_x(clock.utc.right() + 10.0), text);
    }
    let said_left_out = match model.stop {
        StopLook::Stopping | StopLook::AllStopped => model.stop_left_out,
        StopLook::Ready | StopLook::NotConfirmed { .. } => None,
    };
    if let Some(left_out) = said_left_out {
        let room = free.with_min_x(clock.utc.right() + 10.0);
        clock::left_out(ui, rect, room, left_out.sentence);
    }
    let has_date = rect.width() >= DATE_FROM
        && said_left_out.is_none()
        && !matches!(model.stop, StopLook::NotConfirmed { .. });
    let date = free.with_min_x(clock.time + 10.0);
    let is_announced = has_date && clock::date(ui, date, &model.clock);
    if !is_announced && model.clock.health.mood == ClockMood::Bad {
        clock::warn(ui, clock.utc, &model.clock.health);
    }

    alarm_list::show(ui, (alarms, rect.bottom()), &model.alarms, !wide, commands);
}

/// Shows between the alarms and STOP that STOP does not reach every antenna.
fn mark_left_out(ui: &Ui, rect: Rect, left_out: StopLeftOut<'_>) {
    let t = theme::tokens(ui);
    for (words, down) in [("STOP", -13.0), ("reaches", 0.0), (left_out.count, 13.0)] {
        let line =
            Rect::from_center_size(rect.center() + vec2(0.0, down), vec2(rect.width(), 13.0));
        paint::text_in(ui, line, Align2::CENTER_CENTER, words, text::caption(), t.warn);
    }
    let words = format!("STOP reaches {} antennas. {}", left_out.count, left_out.sentence);
    paint::name_text(ui, "left out of stop", rect, &words).on_hover_text(&words);
}

/// Shows STOP in a separate layer above all others, so that it works while a dialog is open.
/// Returns `true` if the operator clicks STOP.
fn stop_clicked(ui: &Ui, rect: Rect, model: &TopBarModel<'_>) -> bool {
    Area::new(Id::unique("stop layer"))
        // With this parent, screen readers also read STOP first. They would otherwise read its
        // layer last.
        .accessibility_parent(ui.unique_id())
        .order(Order::Tooltip)
        .fixed_pos(rect.min)
        .default_size(rect.size())
        .constrain(false)
        .show(ui.ctx(), |ui| {
            ui.set_clip_rect(rect.expand(6.0));
            ui.allocate_rect(rect, egui::Sense::hover());
            stop_button::show(ui, rect, model.stop, model.stop_about).clicked()
        })
        .inner
}

#[cfg(test)]
mod tests;
