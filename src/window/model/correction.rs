//! Corrections for the error of a recorded pass. This module only proposes them.

use std::sync::Arc;

use super::Model;
use crate::{
    astro::{Angle, Offset, TrackOffsets},
    contract::{
        antenna::AntennaModel,
        driver::is_ticket_of_session,
        record::{RecordedPass, TrackedBy},
    },
    device::settings::{Value, Written},
    plan::pass_report::{Cause, Explanation},
    station::{AntennaId, OffsetsSubject},
};

/// A correction that the operator may accept.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    pub antenna: AntennaId,
    pub method: CorrectionMethod,
}

#[derive(Debug, Clone, PartialEq)]
pub enum CorrectionMethod {
    /// Values for settings of the unit, by the key of the setting and the key of its group.
    Settings {
        group: &'static str,
        values: Vec<(&'static str, Value)>,
        /// `true` if one of the settings is a time; no document gives the sign of that setting.
        has_time: bool,
    },
    /// Offsets with which the antenna begins its tracks, in place of the remembered ones.
    Remembered(TrackOffsets),
}

/// Returns a correction for the causes of `explanation` that a setting can correct. `None` if no
/// setting corrects a cause, if an earlier correction seems to cover it, and in a replay.
pub fn correction(
    model: &Model,
    pass: &RecordedPass,
    explanation: &Explanation,
) -> Option<Correction> {
    let antenna = model.antennas.iter().find(|antenna| antenna.id() == pass.antenna)?;
    let method = match pass.report.track.tracked_by {
        TrackedBy::ProgramTrack => remembered(model, antenna, pass, explanation),
        TrackedBy::OnBoard | TrackedBy::Elsewhere => settings(antenna, pass, explanation),
    };
    method
        .filter(|_| model.replay.is_none())
        .map(|method| Correction { antenna: antenna.id(), method })
}

/// Returns the offsets of the pass less its error. Accepting the correction again gives the same
/// result.
fn remembered(
    model: &Model,
    antenna: &AntennaModel,
    pass: &RecordedPass,
    explanation: &Explanation,
) -> Option<CorrectionMethod> {
    let less = |offset_deg: f64| Angle::from_degrees(-offset_deg);
    let step = |cause: &Cause| match *cause {
        Cause::AzimuthOffset { offset_deg } => Some(Offset::Azimuth(less(offset_deg))),
        Cause::ElevationOffset { offset_deg } => Some(Offset::Elevation(less(offset_deg))),
        _ => None,
    };
    let mut steps = explanation.causes().filter_map(step).peekable();
    steps.peek()?;
    let flown = pass.report.track.offsets.changes().last();
    let flown = flown.map_or(TrackOffsets::NONE, |(_, offsets)| *offsets);
    let offsets_subject = OffsetsSubject::Antenna(antenna.id());
    let offsets = steps.try_fold(offsets_subject.part(flown), TrackOffsets::plus)?;
    (model.station.kept_offsets(offsets_subject) != offsets)
        .then_some(CorrectionMethod::Remembered(offsets))
}

/// Smallest offset that changes a setting, degrees.
const MIN_DEG: f64 = 0.005;

/// Returns the current settings of the unit less the error. `None` after a write since the pass,
/// because that write may already contain the correction.
fn settings(
    antenna: &AntennaModel,
    pass: &RecordedPass,
    explanation: &Explanation,
) -> Option<CorrectionMethod> {
    let fields = antenna.variant().track_offsets?;
    let state = antenna.snapshot.state.groups.get(fields.group)?;
    // A session removes its own additions after the pass.
    let is_later = |written: &Arc<Written>| {
        written.time > pass.report.start && !is_ticket_of_session(written.change.ticket)
    };
    if state.written.as_ref().is_some_and(is_later) {
        return None;
    }
    let current = &state.last_read.as_ref()?.values;
    let degrees = |field: &'static str, offset_deg: f64| match current.get(field)? {
        Value::Decimal(held_deg) if offset_deg.abs() >= MIN_DEG => {
            Some((field, Value::Decimal(held_deg - offset_deg)))
        }
        _ => None,
    };
    let value = |cause: &Cause| match *cause {
        Cause::AzimuthOffset { offset_deg } => degrees(fields.azimuth_deg, offset_deg),
        Cause::ElevationOffset { offset_deg } => degrees(fields.elevation_deg, offset_deg),
        Cause::Late { late_s } => match current.get(fields.time_ms)? {
            Value::Integer(held_ms) => {
                let late_ms = (late_s * 1000.0).round() as i64;
                Some((fields.time_ms, Value::Integer(held_ms.saturating_add(late_ms))))
            }
            _ => None,
        },
        _ => None,
    };
    let values: Vec<_> = explanation.causes().filter_map(value).collect();
    let has_time = values.iter().any(|(field, _)| *field == fields.time_ms);
    (!values.is_empty()).then_some(CorrectionMethod::Settings {
        group: fields.group,
        values,
        has_time,
    })
}
