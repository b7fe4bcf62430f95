//! The strip "Next 12 hours": the passes of one or all antennas as bars over time, with day and
//! night below. A low strip has a single lane.

mod axis;
mod bars;
mod head;
pub(super) mod labels;
mod scale;
mod sun;
mod zoom;

use std::ops::RangeInclusive;

use egui::{Align2, Rangef, Rect, Role, Sense, Ui, Vec2, WidgetInfo, vec2};
use jiff::Timestamp;

use super::{format, menus::PassMenu, text, theme, widgets::paint};
use crate::{
    contract::passes::ListedSatellite,
    model::{UiCommand, daylight::SunSpan, plan::Standing},
    ui::time_axis::TimeAxis,
};
use bars::LaneOf;
use scale::axis;
pub use zoom::Zoom;

#[derive(Debug, Clone, Copy)]
pub struct Bar<'a> {
    /// Key of the pass: catalog number and a time that does not change.
    pub key: (u32, Timestamp),
    pub name: BarName<'a>,
    pub aos: Timestamp,
    pub los: Timestamp,
    /// Maximum elevation, degrees, 0 to 90; `None` if it is no longer known.
    pub max_elevation_deg: Option<f64>,
    /// `true` if the mount loses part of the pass, for example at its keyhole.
    pub loses: bool,
    pub state: State<'a>,
}

/// The short name of a satellite. The strip looks it up only for visible bars, because there may be
/// very many.
#[derive(Debug, Clone, Copy)]
pub enum BarName<'a> {
    Of(&'a ListedSatellite),
    Known(&'a str),
}

/// Known state of a pass on the antenna of its lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum State<'a> {
    /// State from the mount, while there is no schedule.
    Mount {
        can_track: bool,
    },
    Plan(Standing<'a>),
}

impl<'a> BarName<'a> {
    fn text(self) -> &'a str {
        match self {
            Self::Of(satellite) => satellite.short_name(),
            Self::Known(name) => name,
        }
    }
}

impl Bar<'_> {
    /// Returns `true` if the antenna tracks or tracked the pass, or without a schedule, could track
    /// it.
    fn is_taken(&self) -> bool {
        match self.state {
            State::Mount { can_track } => can_track,
            State::Plan(standing) => match standing {
                Standing::Flown(_)
                | Standing::Running
                | Standing::Proved(_)
                | Standing::Sent(_)
                | Standing::Planned(_) => true,
                Standing::TakenBy(_) | Standing::LeftOut(_) | Standing::NotKnown => false,
            },
        }
    }
}

/// The passes of one antenna.
#[derive(Debug, Clone)]
pub struct Lane<'a> {
    pub name: &'a str,
    /// Passes in any order, without satellites that never set.
    pub bars: Vec<Bar<'a>>,
}

#[derive(Clone, Copy)]
pub struct TimelineModel<'a> {
    /// Time of the now-line.
    pub now: Timestamp,
    /// Time that the sky plot shows; `None` for now.
    pub time: Option<Timestamp>,
    pub hours: f64,
    /// Lanes of the antennas, in the order of the station; at least one.
    pub lanes: &'a [Lane<'a>],
    /// Index of the lane of the selected antenna.
    pub main: usize,
    /// `true` if the bars show the schedule.
    pub is_planned: bool,
    /// Key of the selected pass.
    pub selected: Option<(u32, Timestamp)>,
    /// Day and night, the earliest span first.
    pub sun: &'a [SunSpan],
    /// Function that describes the status of a pass on an antenna of this name.
    pub says: &'a dyn Fn(Standing<'_>, &str) -> String,
    /// Function that shows the menu entries of a pass for the bar with this id.
    pub menu: &'a PassMenu<'a>,
}

/// Height below which the strip has its small form, points.
pub const SMALL_BELOW: f32 = 120.0;
/// Min size of the strip, points; in less room nothing would be legible.
const MIN: Vec2 = vec2(160.0, 60.0);
/// Height from which each antenna has a lane, points.
const ALL_LANES_FROM: f32 = 240.0;
/// Min height of the lane of an antenna, points.
const LOWEST_LANE: f32 = 44.0;
/// Share of a high lane that its highest bar fills.
const GROWN: f32 = 0.55;
/// Height below which all passes share one lane, points.
const TWO_LANES_FROM: f32 = 190.0;
const MARGIN: f32 = 16.0;
const SMALL_MARGIN: f32 = 12.0;
/// Width at the left for the names of the lanes, points.
const NAMES: f32 = 96.0;
const SMALL_NAMES: f32 = 84.0;
/// Gap between the name of a lane and the lane, points.
const NAMES_GAP: f32 = 8.0;
/// Max length by which the name of a bar extends into that gap, points.
const REACH: f32 = 2.0;
const HEAD: f32 = 32.0;
const AXIS: f32 = 24.0;
const SMALL_AXIS: f32 = 21.0;
/// Height of the lane of passes that the antenna does not track, points.
const OUT_LANE: f32 = 34.0;
const SUN_LANE: f32 = 9.0;
const SUN_WORDS: f32 = 20.0;
const LANE_GAP: f32 = 4.0;
const BOTTOM: f32 = 6.0;
/// Heights of the bars for 0° and 90° of maximum elevation, points.
const HEIGHTS: RangeInclusive<f32> = 14.0..=44.0;
const OUT_HEIGHTS: RangeInclusive<f32> = 9.0..=28.0;

/// Shows the strip in `rect`. A click on a bar or Enter selects its pass.
pub fn show(ui: &mut Ui, rect: Rect, model: &TimelineModel<'_>, commands: &mut Vec<UiCommand>) {
    let is_small = rect.height() < SMALL_BELOW;
    let hours = model.hours;
    let title = match format::number(hours, 0).as_str() {
        "1" => "Next hour".to_owned(),
        count => format!("Next {count} hours"),
    };
    let group = ui.interact(rect, ui.make_persistent_id("timeline"), Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(Role::ListBox, true, &title));
    if rect.width() < MIN.x || rect.height() < MIN.y {
        return;
    }
    let names = if is_small { SMALL_NAMES } else { NAMES };
    let x = Rangef::new(rect.left() + names, rect.right() - MARGIN);
    let scale = axis(model.now, hours, x);
    if is_small {
        return small(ui, rect, x, &scale, model, commands);
    }
    head::show(ui, rect.with_max_y(rect.top() + HEAD), &title, model);
    let below = rect.with_min_y(rect.top() + HEAD);
    let room = below.height() - AXIS - LANE_GAP - SUN_LANE - SUN_WORDS - BOTTOM;
    let count = model.lanes.len();
    if count > 1 && rect.height() >= ALL_LANES_FROM && room / count as f32 >= LOWEST_LANE {
        return all_lanes(ui, below, x, &scale, model, commands);
    }
    full(ui, below, x, &scale, model, commands);
}

/// Shows a lane for each antenna; untracked passes are outlines.
fn all_lanes(
    ui: &Ui,
    rect: Rect,
    x: Rangef,
    scale: &TimeAxis,
    model: &TimelineModel<'_>,
    commands: &mut Vec<UiCommand>,
) {
    let band = |bottom: f32, height: f32| Rect::from_x_y_ranges(x, bottom - height..=bottom);
    let words = band(rect.bottom() - BOTTOM, SUN_WORDS);
    let sun = band(words.top(), SUN_LANE);
    let names = band(rect.top() + AXIS, AXIS);
    let room = Rect::from_x_y_ranges(x, names.bottom()..=sun.top() - LANE_GAP);
    axis::show(ui, scale, room, names);
    let height = room.height() / model.lanes.len() as f32;
    let mut standing = Vec::new();
    for (index, lane) in model.lanes.iter().enumerate() {
        let top = room.top() + index as f32 * height;
        let place = Rect::from_x_y_ranges(x, top..=top + height);
        if index > 0 {
            ui.painter().hline(x, top, (1.0, theme::tokens(ui).line));
        }
        lane_name(ui, rect.left() + MARGIN, place, lane.name, index == model.main);
        let heights = bars::fitting(&grown(place), place);
        let bars = bars::stand(&lane.bars, |_| true, model.selected, scale, place, &heights);
        let lane_of = LaneOf { antenna: lane.name, is_one_of_several: true };
        bars::show(ui, &bars, lane_of, model, commands);
        standing.push((place, bars));
    }
    lane_name(ui, rect.left() + MARGIN, sun, "Sun", false);
    sun::show(ui, scale, model.now, model.sun, sun, words);
    axis::time_lines(ui, scale, model, Rangef::new(room.top() - 4.0, sun.bottom()));
    for (place, bars) in &standing {
        let room = place.with_min_x(place.left() - REACH);
        bars::show_names(ui, bars, model.selected, room);
    }
}

/// Returns the heights of bars for 0° and 90° of maximum elevation, points. They grow in a high
/// lane.
fn grown(lane: Rect) -> RangeInclusive<f32> {
    *HEIGHTS.start()..=HEIGHTS.end().max(GROWN * lane.height())
}

fn full(
    ui: &Ui,
    rect: Rect,
    x: Rangef,
    scale: &TimeAxis,
    model: &TimelineModel<'_>,
    commands: &mut Vec<UiCommand>,
) {
    let band = |bottom: f32, height: f32| Rect::from_x_y_ranges(x, bottom - height..=bottom);
    let two_lanes = HEAD + rect.height() >= TWO_LANES_FROM;
    let words = band(rect.bottom() - BOTTOM, SUN_WORDS);
    let sun = band(words.top(), SUN_LANE);
    let out = band(sun.top() - LANE_GAP, if two_lanes { OUT_LANE } else { 0.0 });
    let names = band(rect.top() + AXIS, AXIS);
    let lane = Rect::from_x_y_ranges(x, names.bottom()..=out.top());

    axis::show(ui, scale, lane.with_max_y(out.bottom()), names);
    let Some(shown) = model.lanes.get(model.main) else { return };
    lane_name(ui, rect.left() + MARGIN, lane, shown.name, true);
    let lane_of = LaneOf { antenna: shown.name, is_one_of_several: false };
    let heights = bars::fitting(&grown(lane), lane);
    let is_shown = |bar: &Bar<'_>| bar.is_taken() || !two_lanes;
    let main = bars::stand(&shown.bars, is_shown, model.selected, scale, lane, &heights);
    bars::show(ui, &main, lane_of, model, commands);
    if two_lanes {
        ui.painter().hline(x, out.top(), (1.0, theme::tokens(ui).line));
        let name = if model.is_planned { "Left out" } else { "Out of reach" };
        lane_name(ui, rect.left() + MARGIN, out, name, false);
        let others = bars::stand(
            &shown.bars,
            |bar| !bar.is_taken(),
            model.selected,
            scale,
            out,
            &OUT_HEIGHTS,
        );
        bars::show(ui, &others, lane_of, model, commands);
    }
    lane_name(ui, rect.left() + MARGIN, sun, "Sun", false);
    sun::show(ui, scale, model.now, model.sun, sun, words);
    axis::time_lines(ui, scale, model, Rangef::new(lane.top() - 4.0, sun.bottom()));
    let room = lane.with_min_x(lane.left() - REACH);
    bars::show_names(ui, &main, model.selected, room);
}

fn small(
    ui: &Ui,
    rect: Rect,
    x: Rangef,
    scale: &TimeAxis,
    model: &TimelineModel<'_>,
    commands: &mut Vec<UiCommand>,
) {
    let names = Rect::from_x_y_ranges(x, rect.top()..=rect.top() + SMALL_AXIS);
    let lane = Rect::from_x_y_ranges(x, names.bottom()..=rect.bottom());
    axis::show(ui, scale, lane, names);
    let Some(shown) = model.lanes.get(model.main) else { return };
    lane_name(ui, rect.left() + SMALL_MARGIN, lane, shown.name, true);
    let lane_of = LaneOf { antenna: shown.name, is_one_of_several: false };
    let heights = bars::fitting(&HEIGHTS, lane);
    let standing = bars::stand(&shown.bars, |_| true, model.selected, scale, lane, &heights);
    bars::show(ui, &standing, lane_of, model, commands);
    axis::time_lines(ui, scale, model, Rangef::new(lane.top() - 4.0, lane.bottom()));
    let room = lane.with_min_x(lane.left() - REACH);
    bars::show_names(ui, &standing, model.selected, room);
}

/// Paints the name of a lane at its left, cut if it does not fit.
fn lane_name(ui: &Ui, left: f32, lane: Rect, name: &str, main: bool) {
    let t = theme::tokens(ui);
    let room = Rect::from_x_y_ranges(left..=lane.left() - NAMES_GAP, lane.y_range());
    let (font, colour) = if main { (text::small_strong(), t.t1) } else { (text::caption(), t.t2) };
    paint::text_in(ui, room, Align2::RIGHT_CENTER, name, font, colour);
}

#[cfg(test)]
mod stories;
