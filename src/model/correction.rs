//! What would correct the error of a recorded pass. Nothing is changed here.

use super::Model;
use crate::{
    astro::{Angle, Offset, TrackOffsets},
    device::settings::Value,
    engine::antenna::AntennaModel,
    plan::pass_report::Cause,
    record::{RecordedPass, TrackedBy},
    station::{AntennaId, OffsetsOf},
};

/// A correction that the operator may take over.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    pub antenna: AntennaId,
    pub how: How,
}

#[derive(Debug, Clone, PartialEq)]
pub enum How {
    /// A value for a setting of the unit, by the keys of its group and itself.
    Setting { group: &'static str, field: &'static str, value: Value },
    /// Offsets with which the antenna begins its tracks, in place of those that are remembered.
    Remembered(TrackOffsets),
}

/// What would correct `cause` in the passes to come; `None` where nothing here does, or where it
/// seems to be corrected already.
pub fn correction(model: &Model, pass: &RecordedPass, cause: &Cause) -> Option<Correction> {
    let antenna = model.antennas.iter().find(|antenna| antenna.id() == pass.antenna)?;
    let how = match pass.report.about.tracked_by {
        TrackedBy::ProgramTrack => remembered(model, antenna, pass, cause),
        TrackedBy::OnBoard | TrackedBy::Elsewhere => setting(antenna, pass, cause),
    };
    how.filter(|_| model.replay.is_none()).map(|how| Correction { antenna: antenna.id(), how })
}

/// The offsets with which the pass was flown, less its error: the same however often it is taken
/// over.
fn remembered(
    model: &Model,
    antenna: &AntennaModel,
    pass: &RecordedPass,
    cause: &Cause,
) -> Option<How> {
    let less = |offset_deg: f64| Angle::from_degrees(-offset_deg);
    let step = match *cause {
        Cause::AzimuthOffset { offset_deg } => Offset::Azimuth(less(offset_deg)),
        Cause::ElevationOffset { offset_deg } => Offset::Elevation(less(offset_deg)),
        _ => return None,
    };
    let flown = pass.report.about.offsets.changes().last();
    let flown = flown.map_or(TrackOffsets::NONE, |(_, offsets)| *offsets);
    let of = OffsetsOf::Antenna(antenna.id());
    let offsets = of.part(flown).plus(step)?;
    (model.station.kept_offsets(of) != offsets).then_some(How::Remembered(offsets))
}

/// An offset below this changes no setting, degrees.
const LEAST_DEG: f64 = 0.005;

/// What the unit holds, less the error. What was written after the pass may correct it already.
fn setting(antenna: &AntennaModel, pass: &RecordedPass, cause: &Cause) -> Option<How> {
    let fields = antenna.variant().track_offsets?;
    let state = antenna.snapshot.state.held.get(fields.group)?;
    if state.written.as_ref().is_some_and(|written| written.at > pass.report.from) {
        return None;
    }
    let held = &state.held.as_ref()?.values;
    let degrees = |field: &'static str, offset_deg: f64| match held.get(field)? {
        Value::Decimal(held_deg) if offset_deg.abs() >= LEAST_DEG => {
            Some((field, Value::Decimal(held_deg - offset_deg)))
        }
        _ => None,
    };
    let (field, value) = match *cause {
        Cause::AzimuthOffset { offset_deg } => degrees(fields.azimuth_deg, offset_deg)?,
        Cause::ElevationOffset { offset_deg } => degrees(fields.elevation_deg, offset_deg)?,
        Cause::Late { late_s } => match held.get(fields.time_ms)? {
            Value::Integer(held_ms) => {
                let late_ms = (late_s * 1000.0).round() as i64;
                (fields.time_ms, Value::Integer(held_ms.saturating_add(late_ms)))
            }
            _ => return None,
        },
        _ => return None,
    };
    Some(How::Setting { group: fields.group, field, value })
}
