//! Content of the strip: the passes of each antenna, from the schedule once there is one.

use egui::{Rect, Ui};
use jiff::Timestamp;

use super::passes::selected_key;
use crate::{
    astro::time::add_seconds,
    contract::{antenna::AntennaModel, automatic::Flown, passes::PredictedPass},
    model::{
        Model, UiCommand,
        plan::{PlannedPass, Standing},
    },
    plan::Trackability,
    ui::{
        menus,
        timeline::{self, Bar, BarName, Lane, State, TimelineModel, Zoom},
        words,
    },
};

/// Max number of outlines computed in one frame, some milliseconds of work. With many favourites
/// the schedule is ready before all outlines, and the strip then needs none.
const NEW_OUTLINES: usize = 48;

/// Min width of a strip that shows a whole day, points.
const LONG_FROM: f32 = 1000.0;

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    time: Option<Timestamp>,
    zoom: &mut Zoom,
    commands: &mut Vec<UiCommand>,
) {
    let default = match (rect.height() < timeline::SMALL_BELOW, rect.width() >= LONG_FROM) {
        (true, _) => 4,
        (false, true) => 24,
        (false, false) => 12,
    };
    let hours = f64::from(zoom.hours(default));
    let end = add_seconds(model.now, hours * 3600.0);
    let is_planned = model.schedule.made_at.is_some();
    let antennas = model.antennas.iter();
    let mut lanes: Vec<Lane<'_>> = if is_planned && !model.antennas.is_empty() {
        let planned = model.planned_passes_until(end);
        let lanes = antennas.map(|antenna| Lane {
            name: &antenna.config.name,
            bars: bars_of_plan(model, antenna, &planned),
        });
        lanes.collect()
    } else {
        let lanes = antennas.enumerate().map(|(index, antenna)| Lane {
            name: &antenna.config.name,
            bars: bars_of_mount(model, index, end),
        });
        lanes.collect()
    };
    if lanes.is_empty() {
        lanes.push(Lane { name: "Passes", bars: bars_of_mount(model, 0, end) });
    }
    let strip = TimelineModel {
        now: model.now,
        time,
        hours,
        lanes: &lanes,
        main: model.selected_antenna,
        is_planned,
        selected: selected_key(model),
        sun: &model.sky.sun_spans,
        says: &|standing, antenna| words::schedule::standing(model, standing, antenna),
        menu: &|ui, bar, key, commands| menus::pass(ui, bar, model, key, commands),
    };
    timeline::show(ui, rect, &strip, commands);
}

/// Returns the upcoming passes, with the mount's ability to track each. A pass counts as trackable
/// until Azel has computed its outline.
fn bars_of_mount(model: &Model, antenna: usize, end: Timestamp) -> Vec<Bar<'_>> {
    let mut left = NEW_OUTLINES;
    let ahead = model.pass_lists.favourites.upcoming(model.now);
    let bars = ahead.starting_before(end).map(|predicted| {
        let is_new = !predicted.has_outline();
        let trackability = if is_new && left == 0 { None } else { predicted.trackability(antenna) };
        left = left.saturating_sub(usize::from(is_new));
        let impossible = matches!(trackability, Some(Trackability::Nothing | Trackability::TooLow));
        let loses = matches!(trackability, Some(Trackability::Loses { .. }));
        bar(predicted, State::Mount { can_track: !impossible }, loses)
    });
    bars.collect()
}

/// Returns the passes that have just ended for an antenna, and the upcoming ones.
fn bars_of_plan<'a>(
    model: &'a Model,
    antenna: &AntennaModel,
    planned: &[PlannedPass<'a>],
) -> Vec<Bar<'a>> {
    let standings = model.standings_on(antenna);
    let ahead = planned.iter().map(|planned| {
        let standing = standings.standing(planned);
        let mut own = planned.entries.iter().filter(|entry| entry.antenna == antenna.id());
        let loses = own.any(|entry| entry.lost.is_some());
        bar(planned.predicted, State::Plan(standing), loses)
    });
    let ended = model.flown_by(antenna.id()).filter_map(|flown| {
        let predicted = model.pass_lists.favourites.find(flown.pass);
        let has_set = predicted.is_none_or(|pass| pass.pass.los.time <= model.now);
        has_set.then(|| flown_bar(flown, predicted))
    });
    ended.chain(ahead).collect()
}

fn bar<'a>(predicted: &'a PredictedPass, state: State<'a>, loses: bool) -> Bar<'a> {
    Bar {
        key: predicted.key(),
        name: BarName::Of(&predicted.satellite),
        aos: predicted.pass.aos.time,
        los: predicted.pass.los.time,
        max_elevation_deg: Some(predicted.pass.max_elevation().degrees()),
        loses,
        state,
    }
}

/// Returns the bar of a pass that has set. `predicted` is the pass, while the list still has it.
fn flown_bar<'a>(flown: &'a Flown, predicted: Option<&PredictedPass>) -> Bar<'a> {
    let los = predicted.map(|pass| pass.pass.los.time);
    let max = predicted.map(|pass| pass.pass.max_elevation().degrees());
    Bar {
        key: flown.pass,
        name: BarName::Known(&flown.name),
        aos: flown.pass.1,
        los: los.unwrap_or_else(|| add_seconds(flown.pass.1, flown.of_s)),
        max_elevation_deg: max,
        loses: false,
        state: State::Plan(Standing::Flown(flown)),
    }
}
