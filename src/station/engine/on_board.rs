//! On-board track: the tracking window for the unit, and a judgement of its pass by the unit's
//! settings.

use std::sync::Arc;

use jiff::Timestamp;

use super::{Antenna, Engine};
use crate::{
    astro::{Angle, Site, time::add_seconds},
    contract::{
        CatalogState,
        alarms::AlarmKind,
        antenna::{AntennaModel, Judged},
        driver::{self, Event, OffTargetCause, Refusal, Snapshot},
        passes::{PassListKey, PredictedPass, window},
    },
    device::{OnBoard, TrackTarget, UnitClock},
    engine::alarms::KeepAlarms,
    plan::{
        OnBoardPass,
        on_board::{Ability, Judge, KnownOrbit},
    },
    station,
};

/// Returns the on-board pass for the unit of `antenna`.
pub(super) fn pass_for(
    predicted: &PredictedPass,
    antenna: &station::Antenna,
    site: Site,
    now: Timestamp,
) -> Result<OnBoardPass, Refusal> {
    let (start, end) = window(predicted, antenna, site, now)?;
    let elements = predicted.satellite.elements.clone();
    let target = TrackTarget {
        catalog_number: elements.catalog_number(),
        name: elements.name().to_owned(),
        element_file: antenna.connection.element_file(),
        // The window of a pass under way begins now.
        start: start.max(add_seconds(now, -1.0)),
        end,
    };
    Ok(OnBoardPass { target, elements, site, is_agreed: false })
}

impl Engine {
    /// Starts on-board track of a pass. With `is_agreed`, the operator accepts that the unit may
    /// miss.
    pub(super) fn track_on_board(&mut self, index: usize, pass: PassListKey, is_agreed: bool) {
        // If the pass has ended since the request, Azel does not take another one.
        let Some(predicted) = self.pass(pass) else { return };
        let (site, now) = (self.station.site, self.now);
        let Some(antenna) = self.antennas.get(index) else { return };
        match pass_for(predicted, &antenna.shown.config, site, now) {
            Ok(pass) => {
                let pass = OnBoardPass { is_agreed, ..pass };
                self.send(index, driver::Command::Track(Box::new(pass)));
            }
            Err(refusal) => {
                if let Some(antenna) = self.antennas.get_mut(index) {
                    antenna.shown.news = Some((Event::NotSent(refusal), now));
                }
            }
        }
    }

    /// Judges how the unit of an antenna would track the selected or next pass.
    pub(super) fn judge_unit(&mut self, index: usize) {
        let judged = self.antennas.get(index).and_then(|antenna| self.judged(&antenna.shown));
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.shown.judged = judged;
        }
    }

    /// Returns the judgement of `antenna`'s unit; keeps the previous one if nothing has changed.
    fn judged(&self, antenna: &AntennaModel) -> Option<Judged> {
        // Azel takes back the offsets of the current track after the track.
        let unit =
            &antenna.snapshot.state.on_board.without_offsets(antenna.snapshot.meant_offsets());
        let is_told = unit.place.is_some() || unit.clock.is_some() || unit.offsets.is_some();
        let can = antenna.variant().capabilities.has_program && antenna.snapshot.link.is_open();
        if !can || !is_told {
            return None;
        }
        let selected = self.attention.selected.and_then(|key| self.pass(key));
        let predicted = selected.or_else(|| self.pass_lists.next(self.now))?;
        let basis = (predicted.key(), rounded(unit));
        if let Some(before) = antenna.judged.as_ref().filter(|judged| judged.basis == basis) {
            return Some(before.clone());
        }
        let pass = pass_for(predicted, &antenna.config, self.station.site, self.now);
        let judge = pass
            .ok()
            .and_then(|pass| Judge::new(pass, Ability::from_antenna(&antenna.config)).ok());
        let found = judge.map(|judge| Arc::new(judge.supervise(&basis.1, false)));
        Some(Judged { found, basis })
    }
}

impl Engine {
    /// Sends the session of an antenna the orbit for judging on-board track.
    pub(super) fn tell_orbit(&mut self, index: usize) {
        let CatalogState::Ready(catalog) = &self.catalog else { return };
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let shown = &mut antenna.shown;
        let satellite = shown.snapshot.state.on_board.satellite.as_ref();
        let elements = satellite.and_then(|satellite| catalog.get(satellite.catalog_number));
        let site = self.station.site;
        let is_told = match (elements, &shown.orbit) {
            (Some(elements), Some(orbit)) => orbit.elements == *elements && orbit.site == site,
            (None, None) => true,
            _ => false,
        };
        if is_told {
            return;
        }
        let orbit = elements.map(|set| Arc::new(KnownOrbit { elements: set.clone(), site }));
        shown.orbit.clone_from(&orbit);
        antenna.handle.know_orbit(orbit);
    }

    /// Raises and clears alarms about current or judged on-board track.
    pub(super) fn watch_on_board(&mut self, index: usize) {
        let Some(Antenna { shown: antenna, .. }) = self.antennas.get(index) else { return };
        let (alarms, now, antenna_id) = (&mut self.alarms, self.now, Some(antenna.id()));
        let on_board = antenna.snapshot.on_board.as_ref().and_then(|view| {
            let deviation = view.missing?;
            Some((deviation, view.found.cause_of(deviation).cloned()))
        });
        let from_here = antenna.snapshot.program_track.as_ref().and_then(|view| view.missing);
        let missed =
            on_board.or(from_here.map(|angle| (angle, None))).map(|(deviation, reported)| {
                let cause = off_because(antenna, deviation, reported.map(OffTargetCause::Reported));
                AlarmKind::OffTarget { deviation, cause }
            });
        let is_missed = |kind: &AlarmKind| matches!(kind, AlarmKind::OffTarget { .. });
        alarms.follow(antenna_id, now, missed, is_missed);
        let differs = antenna.misses().and_then(|found| found.causes.first());
        // Two causes of nearly the same size would alternate, so the active one stays.
        let standing = antenna.misses().into_iter().flat_map(|found| &found.causes).find(|cause| {
            let kind = AlarmKind::UnitDiffers((*cause).clone());
            let is_large = differs.is_some_and(|first| {
                first.max_error.is_none_or(|max_error| cause.can_make(max_error))
            });
            is_large && alarms.stands(antenna_id, &kind)
        });
        let differs = standing.or(differs).cloned().map(AlarmKind::UnitDiffers);
        alarms.follow(antenna_id, now, differs, |kind| matches!(kind, AlarmKind::UnitDiffers(_)));
        let left = antenna.snapshot.unit_offsets.as_ref();
        let left = left.and_then(|unit| Some((unit.offsets, unit.left.clone()?)));
        let left = left.filter(|(offsets, _)| !offsets.is_none());
        let left = left.map(|(offsets, reason)| AlarmKind::OffsetsLeft { offsets, reason });
        alarms.follow(antenna_id, now, left, |kind| matches!(kind, AlarmKind::OffsetsLeft { .. }));
        let is_loading = matches!(self.catalog, CatalogState::Loading);
        let not_compared = not_compared(antenna).filter(|_| !is_loading);
        alarms.follow(antenna_id, now, not_compared, |kind| {
            matches!(kind, AlarmKind::NotCompared { .. })
        });
    }
}

/// Returns why the antenna is `deviation` off its satellite: the measured cause, such as a stopped
/// axis, or else the reported one.
pub(super) fn off_because(
    antenna: &AntennaModel,
    deviation: Angle,
    reported: Option<OffTargetCause>,
) -> Option<OffTargetCause> {
    let explained = antenna.explained.as_ref().filter(|explained| explained.can_make(deviation));
    explained.cloned().map(OffTargetCause::Measured).or(reported)
}

/// Returns an alarm if elements cannot confirm on-board track: the operator must watch it.
fn not_compared(antenna: &AntennaModel) -> Option<AlarmKind> {
    let Snapshot { state, program_track, link, .. } = &*antenna.snapshot;
    let tracks = state.program.is_some_and(|program| program.enabled);
    if !tracks || !link.is_open() || program_track.is_some() || antenna.orbit.is_some() {
        return None;
    }
    match &state.on_board.satellite {
        Some(unnamed) if unnamed.catalog_number == 0 && unnamed.name.is_empty() => None,
        Some(named) => Some(AlarmKind::NotCompared { satellite: Some(named.name.clone()) }),
        // A unit that takes satellites from Azel soon reports the one it has.
        None if antenna.variant().capabilities.has_program => None,
        None => Some(AlarmKind::NotCompared { satellite: None }),
    }
}

/// Returns `unit` without values that change from one reading to the next.
fn rounded(unit: &OnBoard) -> OnBoard {
    let tenths = |seconds: f64| (seconds * 5.0).round() / 5.0;
    OnBoard {
        clock: unit.clock.map(|clock| UnitClock {
            ahead_s: tenths(clock.ahead_s),
            error_s: tenths(clock.error_s),
            read_at: Timestamp::UNIX_EPOCH,
            ..clock
        }),
        satellite: None,
        window: None,
        ..unit.clone()
    }
}
