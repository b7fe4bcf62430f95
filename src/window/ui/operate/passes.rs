//! Content of the parts that show passes: list, header and profile.

use egui::{Rect, Ui};
use jiff::Timestamp;

use super::{NEXT_FRAME, filter::FoundPasses};
use crate::{
    astro::time::seconds_between,
    contract::{
        CatalogState,
        antenna::AntennaModel,
        passes::{PassListKey, PredictedPass, Work},
    },
    model::{Model, UiCommand, plan::Standing},
    orbit::Pass,
    plan::{
        Sample, Trackability,
        schedule::{Conflict, LeftOutReason, Refusal},
    },
    ui::{
        format, menus,
        pass_header::{self, PassHeaderModel},
        pass_list::{self, Arrangement, LeftOut, PassListModel, PassListState, PassRow, Verdict},
        profile::{self, PastModel, ProfileModel, ProfileState},
        replay,
        state_sentence::short,
        words::{self, WayThere},
    },
};

pub(super) fn list(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    thumbnails: bool,
    state: &mut PassListState,
    found: &mut FoundPasses,
    commands: &mut Vec<UiCommand>,
) {
    let passes = model.upcoming();
    let listing = model.pass_lists.list(model.list.scope);
    let found = found.arrange(model, &state.filter);
    if found.is_some_and(|found| !found.is_whole()) {
        ui.request_repaint_after_for(NEXT_FRAME, egui::ViewportId::ROOT);
    }
    let row = |index: usize| {
        let place = found.map_or(Some(index), |found| found.place(index))?;
        passes.get(place).map(|predicted| pass_row(model, predicted))
    };
    let place = |key| {
        let place = passes.row(key)?;
        found.map_or(Some(place), |found| found.row(place))
    };
    let keys = || match found {
        Some(found) => {
            let found = found.places().filter_map(|place| passes.get(place));
            found.map(PredictedPass::key).collect()
        }
        None => passes.iter().map(PredictedPass::key).collect(),
    };
    let groups: Vec<&str> = match &model.catalog {
        CatalogState::Ready(catalog) => catalog.groups().map(|(name, _)| name).collect(),
        CatalogState::Loading | CatalogState::Failed => Vec::new(),
    };
    let work = listing.work;
    let none = format!("No pass in the next {} h. Choose a lower elevation.", model.list.span_h());
    let empty = match &model.catalog {
        CatalogState::Loading => "The elements are being read.",
        CatalogState::Failed => "No elements: they could not be read. See the alarms.",
        CatalogState::Ready(_) if matches!(work, Work::UnderWay { .. }) => {
            "The passes are being computed."
        }
        CatalogState::Ready(_) if work == Work::Cancelled => "The search was cancelled.",
        CatalogState::Ready(_) if found.is_some_and(|found| !found.is_whole()) => {
            "Checking which passes can be tracked."
        }
        CatalogState::Ready(_) if state.filter.arrangement != Arrangement::default() => {
            "No listed pass fits the filters."
        }
        CatalogState::Ready(_) if found.is_some() => "No listed pass has this name or number.",
        CatalogState::Ready(_) => &none,
    };
    let list = PassListModel {
        now: model.now,
        rows: found.map_or(passes.len(), FoundPasses::len),
        begun: found.map_or_else(|| passes.begun(model.now), |_| 0),
        total: passes.len(),
        groups: &groups,
        row: &row,
        place: &place,
        keys: &keys,
        selected: selected_key(model),
        scope: model.list.scope,
        span_h: model.list.span_h(),
        aos_elevation_deg: model.station.aos_elevation_deg,
        floor_deg: model.station.elevation_floor_deg,
        work,
        made: listing.made_at.map(|time| (listing.satellites.len(), time)),
        lock: replay::lock(model),
        thumbnails,
        empty,
        menu: &|ui, row, key, commands| menus::pass(ui, row, model, key, commands),
    };
    commands.extend(pass_list::show(ui, rect, &list, state));
}

/// Returns a pass as a row of a list, with the verdict for the selected antenna.
pub(in crate::ui) fn pass_row<'a>(model: &'a Model, predicted: &'a PredictedPass) -> PassRow<'a> {
    let pass = &predicted.pass;
    let antenna = model.antenna();
    let in_maintenance = antenna.is_some_and(|antenna| antenna.snapshot.lock_out.is_some());
    let misses = antenna.is_some_and(|antenna| antenna.misses().is_some());
    let trackability = predicted.trackability(model.selected_antenna);
    let verdict = trackability.map(|trackability| match trackability {
        _ if in_maintenance => Verdict::InMaintenance,
        Trackability::Nothing => Verdict::OutOfReach,
        Trackability::TooLow => Verdict::TooLow,
        Trackability::Whole | Trackability::Loses { .. } => {
            let in_part = match (trackability, predicted.clear_s()) {
                _ if misses => Verdict::Misses,
                (Trackability::Loses { seconds, loss, .. }, _) => Verdict::Loses { seconds, loss },
                (_, Some(clear_s)) => Verdict::Blocked {
                    seconds: pass.duration_s() - clear_s,
                    is_whole: clear_s <= 0.0,
                },
                _ => Verdict::Trackable,
            };
            let antenna = antenna.filter(|antenna| !is_taken(antenna, predicted));
            let way = || Some(Verdict::Way(way_there(model, antenna?, predicted)?));
            match antenna.and_then(|antenna| left_out(model, antenna, predicted)) {
                // The way there gives the same reason, and adds the part of the pass that is left.
                Some(reason @ (LeftOut::TooFar | LeftOut::UnderWay)) => {
                    way().unwrap_or(Verdict::LeftOut(reason))
                }
                Some(obstacle) => Verdict::LeftOut(obstacle),
                None => way().unwrap_or(in_part),
            }
        }
    });
    PassRow {
        key: predicted.key(),
        name: predicted.satellite.short_name(),
        aos: pass.aos.time,
        los: pass.los.time,
        starts_before: pass.starts_before,
        ends_after: pass.ends_after,
        max_elevation_deg: pass.max_elevation().degrees(),
        aos_azimuth_deg: pass.aos.direction.azimuth_deg(),
        los_azimuth_deg: pass.los.direction.azimuth_deg(),
        verdict,
        clear_s: predicted.clear_s(),
        path: predicted.path(),
    }
}

/// Returns `true` if the antenna tracks the satellite, or is on its way to this pass.
fn is_taken(antenna: &AntennaModel, predicted: &PredictedPass) -> bool {
    antenna.tracked_number() == Some(predicted.number())
}

/// Returns the reason why the schedule leaves out a pass that the antenna could track.
fn left_out<'a>(
    model: &'a Model,
    antenna: &AntennaModel,
    predicted: &'a PredictedPass,
) -> Option<LeftOut<'a>> {
    let (planned, standings) = (model.planned_pass(predicted), model.standings_on(antenna));
    let name = |conflict: &Conflict| {
        let found = model.pass_lists.satellite(conflict.pass.satellite);
        found.map_or("another pass", |listed| listed.short_name())
    };
    let reason = match standings.standing(&planned) {
        Standing::TakenBy(other) => {
            return Some(LeftOut::TakenBy(words::schedule::antenna_name(model, other)));
        }
        Standing::LeftOut(reason) => reason,
        _ => return None,
    };
    Some(match reason {
        LeftOutReason::Overlaps(conflict) => LeftOut::Overlaps(name(conflict)),
        LeftOutReason::SlewTooShort(conflict) => LeftOut::TooClose(name(conflict)),
        LeftOutReason::TooFar => LeftOut::TooFar,
        LeftOutReason::UnderWay => LeftOut::UnderWay,
        LeftOutReason::Refused(Refusal::Never) => LeftOut::Never,
        LeftOutReason::Refused(_)
        | LeftOutReason::Impossible(_)
        | LeftOutReason::OtherAntennas(_)
        | LeftOutReason::MaxPerDay(_) => LeftOut::Limit,
        LeftOutReason::Off(antenna_off) => LeftOut::Off(*antenna_off),
        LeftOutReason::NotFound => LeftOut::WorthLess,
    })
}

/// Returns the part of a current or imminent pass that is left after the antenna's slew. Returns
/// `None` if no slew shortens the pass, or Azel cannot judge the slew.
fn way_there(model: &Model, antenna: &AntennaModel, predicted: &PredictedPass) -> Option<WayThere> {
    let until_s = seconds_between(model.now, predicted.pass.aos.time);
    let config = &antenna.config;
    if predicted.is_always_up()
        || !antenna.is_live()
        || is_taken(antenna, predicted)
        || until_s > config.longest_slew_s() + config.set_up_s()
    {
        return None;
    }
    let has_elevation = antenna.variant().capabilities.has_elevation();
    antenna.snapshot.state.measured?.axes_deg(has_elevation)?;
    let find = || model.planned_from_here(antenna)?.joining(predicted.track());
    let joining = model.joinings.get_or_find(antenna.id(), predicted.key(), model.now, find);
    let is_in_time = joining.is_some_and(|joining| joining.late_s < 1.0);
    (!is_in_time).then_some(WayThere { joining })
}

/// Returns a sentence with the reason why an antenna gets nothing of the selected pass.
pub(super) fn nothing_left(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let predicted = model.selected_pass().filter(|other| !is_taken(antenna, other))?;
    let name = predicted.satellite.short_name();
    let place = model.antennas.iter().position(|candidate| candidate.id() == antenna.id())?;
    match predicted.trackability(place)? {
        Trackability::Nothing => Some(format!("{name} is out of the mount's reach.")),
        Trackability::TooLow => {
            Some(format!("{name} stays below the antenna's minimum elevation."))
        }
        Trackability::Whole | Trackability::Loses { .. } => {
            let way = way_there(model, antenna, predicted)?;
            let is_lost = way.joining.is_none();
            is_lost.then(|| format!("{} {} of {name}.", antenna.config.name, way.words()))
        }
    }
}

pub(super) fn selected_key(model: &Model) -> Option<PassListKey> {
    model.selected_pass().map(PredictedPass::key)
}

/// Shows the header of the selected pass; returns `true` after a click on its drawer button.
pub(super) fn header(ui: &mut Ui, rect: Rect, model: &Model, small: bool) -> bool {
    let Some(predicted) = model.selected_pass() else {
        let empty = PassHeaderModel {
            drawer_button: small,
            empty: Some("No pass is selected. Choose one from the list."),
            ..PassHeaderModel::default()
        };
        return pass_header::show(ui, rect, &empty);
    };
    let elements = &predicted.satellite.elements;
    let name = predicted.satellite.short_name();
    let other_name =
        elements.name().split_once(" (").map_or("", |(_, rest)| rest.trim_end_matches(')'));
    let detail = format!("{other_name} {}", elements.catalog_number());
    let pass = &predicted.pass;
    let time_to = |time: Timestamp| format::countdown(model.now, time);
    let (event, moment) = if predicted.in_progress(model.now) {
        ("LOS", pass.los.time)
    } else {
        ("AOS", pass.aos.time)
    };
    let always = pass.starts_before && pass.ends_after;
    let (event, countdown) =
        if always { ("", "always up".to_owned()) } else { (event, time_to(moment)) };
    let tca =
        if always || pass.tca.time < model.now { String::new() } else { time_to(pass.tca.time) };
    let [warning, second_line] = second_line(model, predicted);
    pass_header::show(
        ui,
        rect,
        &PassHeaderModel {
            name,
            detail: detail.trim(),
            warning: &warning,
            second_line: &second_line,
            tca_countdown: &tca,
            event,
            countdown: &countdown,
            drawer_button: small,
            empty: None,
        },
    )
}

/// Returns the cautions in the second line of the header, and the rest. Each starts with the most
/// important text, because a small window cuts the end.
fn second_line(model: &Model, predicted: &PredictedPass) -> [String; 2] {
    let age_s = predicted.satellite.elements.age_s(model.now);
    let number = predicted.satellite.elements.catalog_number();
    let on_board = model.antenna().and_then(|antenna| {
        let satellite = antenna.snapshot.state.on_board.satellite.as_ref()?;
        let is_same = !satellite.name.is_empty() && satellite.catalog_number == number;
        let word = match (satellite.name.is_empty(), is_same) {
            (true, _) => "has no satellite",
            (false, true) => "has the same satellite",
            (false, false) => "has another satellite",
        };
        Some((is_same, format!("{} {word}", antenna.config.name)))
    });
    let (same, other) = match on_board {
        Some((true, words)) => (Some(words), None),
        Some((false, words)) => (None, Some(words)),
        None => (None, None),
    };
    let mask = predicted.clear().map(|stretches| clear_of_mask(stretches, model.now));
    let is_blocked = predicted.clear().is_some_and(<[Pass]>::is_empty);
    let (blocked, mask) = if is_blocked { (mask, None) } else { (None, mask) };
    let age = Some(format!("elements {} old", format::age(age_s)));
    let (old, young) = if age_s > words::OLD_ELEMENTS_S { (age, None) } else { (None, age) };
    let light =
        model.sky.selected.map(|selected| if selected.sunlit { "sunlit" } else { "in shadow" });
    let joined = |parts: &[Option<String>]| {
        let parts: Vec<&str> = parts.iter().flatten().map(String::as_str).collect();
        parts.join(pass_header::SEPARATOR)
    };
    let way = model.antenna().and_then(|antenna| {
        let way = way_there(model, antenna, predicted)?;
        Some(format!("{} {}", antenna.config.name, way.words()))
    });
    let warning = words::capitalised(&joined(&[way, old, blocked]));
    let rest = joined(&[other, mask, same, light.map(str::to_owned), young]);
    let rest = if warning.is_empty() { words::capitalised(&rest) } else { rest };
    [warning, rest]
}

/// Describes the times in which a pass is clear of the horizon mask.
fn clear_of_mask(stretches: &[Pass], now: Timestamp) -> String {
    let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else {
        return "never clear of the mask".to_owned();
    };
    let parts =
        if stretches.len() > 1 { format!(" in {} parts", stretches.len()) } else { String::new() };
    let [start_text, end_text] =
        [first.aos.time, last.los.time].map(|time| format::moment(time, now));
    format!("clear of the mask{parts} {start_text} to {end_text}")
}

/// Shows the profile of the selected pass, with the time that is `marked` elsewhere. Returns the
/// time that the operator marks in the profile.
pub(super) fn profile(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    marked: Option<Timestamp>,
    state: &mut ProfileState,
) -> Option<Timestamp> {
    let past = past_tracks(model);
    let Some(predicted) = model.selected_pass() else {
        return profile::show(ui, rect, None, &past, state);
    };
    let number = predicted.satellite.elements.catalog_number();
    let antenna = model.antenna().filter(|antenna| antenna.tracked_number() == Some(number));
    let errors: Vec<(Timestamp, f32)> = antenna
        .into_iter()
        .flat_map(|antenna| antenna.errors.iter())
        .map(|error| (error.time, error.off_beam.degrees() as f32))
        .collect();
    let beam_width_deg = model.antenna().map_or(1.0, |antenna| antenna.config.beam_width_deg);
    let pass = &predicted.pass;
    profile::show(
        ui,
        rect,
        Some(&ProfileModel {
            now: model.now,
            name: predicted.satellite.short_name(),
            track: predicted.track(),
            tca: Sample { time: pass.tca.time, direction: pass.tca.direction },
            cut: pass.starts_before || pass.ends_after,
            mask: model.station.horizon_mask.as_ref(),
            errors: &errors,
            half_beam_deg: beam_width_deg / 2.0,
            marked,
        }),
        &past,
        state,
    )
}

/// Returns the last tracks of the selected antenna.
fn past_tracks(model: &Model) -> Vec<PastModel<'_>> {
    let Some(antenna) = model.antenna() else { return Vec::new() };
    let tracks = antenna.past_tracks.iter().map(|track| PastModel {
        now: model.now,
        name: short(&track.name),
        start: track.start,
        end: track.end,
        rms_deg: track.rms.degrees(),
        worst_deg: track.worst.off_beam.degrees(),
        worst_at: track.worst.time,
        errors: &track.errors,
        half_beam_deg: antenna.config.beam_width_deg / 2.0,
    });
    tracks.collect()
}
