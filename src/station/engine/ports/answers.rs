//! Answers of rotctld that come directly from a snapshot.

use std::time::Duration;

use crate::{
    astro::AzEl,
    clock::Instant,
    contract::{
        antenna::AntennaModel,
        driver::{Refusal, TrackProblem},
    },
    device::{AxisMotion, Measured},
    protocol::rotctld::{ErrorCode, Limits, Position, StatusWord},
    station::Mount,
};

/// Max age of an answered position. A session polls at least twice a second. Gpredict hangs up
/// after five errors, and one late reply of the unit must not cause that.
const MAX_AGE: Duration = Duration::from_secs(3);

/// Valid azimuths from clients, degrees. rotctld's own dummy takes -180 to 450, and Gpredict sends
/// negative angles for a rotator that turns from -180 to 180.
const AZIMUTHS_DEG: std::ops::RangeInclusive<f64> = -180.0..=540.0;

/// Returns the measured position of the beam, degrees.
pub(super) fn position(antenna: &AntennaModel, now: Instant) -> Result<Position, ErrorCode> {
    let measured = measured(antenna, now).ok_or(ErrorCode::TIMED_OUT)?;
    let azimuth = measured.pointing.azimuth.ok_or(ErrorCode::TIMED_OUT)?;
    // A mount without an elevation axis points at the horizon.
    let elevation = measured.pointing.elevation.unwrap_or_default();
    let model = antenna.config.track_model();
    let (azimuth_deg, elevation_deg) = if model.is_none() {
        // Report the mount's own angles: clients accept 400° and -90°.
        (azimuth.degrees(), elevation.degrees())
    } else {
        let direction = model.direction(AzEl { azimuth, elevation });
        (direction.azimuth_deg(), direction.elevation_deg())
    };
    Position::new(azimuth_deg, elevation_deg).map_err(|_| ErrorCode::TIMED_OUT)
}

fn measured(antenna: &AntennaModel, now: Instant) -> Option<Measured> {
    let measured = antenna.snapshot.state.measured_on_link()?;
    let is_open = antenna.snapshot.link.is_open();
    let age = now.saturating_duration_since(measured.requested);
    (is_open && age <= MAX_AGE).then_some(measured)
}

/// Returns the words for the moving axes, by the last position.
pub(super) fn status(antenna: &AntennaModel, now: Instant) -> Result<Vec<StatusWord>, ErrorCode> {
    let measured = measured(antenna, now).ok_or(ErrorCode::TIMED_OUT)?;
    if !measured.moving() {
        return Ok(Vec::new());
    }
    let axes = match antenna.config.mount {
        Mount::AzEl { .. } => [StatusWord::MovingAzimuth, StatusWord::MovingElevation],
        // Each axis of an X/Y mount changes both angles.
        Mount::Xy { .. } => return Ok(StatusWord::ALL.to_vec()),
    };
    let turns = |axis: &crate::device::Axis| axis.motion != AxisMotion::Still;
    let axes = measured.axes.iter().zip(axes).filter(|(axis, _)| turns(axis)).map(|(_, word)| word);
    Ok(std::iter::once(StatusWord::Moving).chain(axes).collect())
}

/// Valid directions for clients, which libhamlib enforces before it sends anything. Azel chooses
/// the turn of the azimuth axis.
pub(super) const LIMITS: Limits = Limits {
    min_azimuth_deg: 0.0,
    max_azimuth_deg: 360.0,
    // Clients that follow a satellite from the horizon send 0° before its rise.
    min_elevation_deg: 0.0,
    max_elevation_deg: MAX_ELEVATION_DEG,
};

/// Zenith, degrees. Azel does not flip an antenna for a client.
const MAX_ELEVATION_DEG: f64 = 90.0;

/// Returns the antenna's reach for display: `HamClock` treats a max elevation of 0° as no elevation
/// axis.
pub(super) fn capabilities(antenna: &AntennaModel) -> Limits {
    if antenna.variant().capabilities.has_elevation() {
        LIMITS
    } else {
        Limits { max_elevation_deg: 0.0, ..LIMITS }
    }
}

/// Returns the direction of a position that a client sent.
pub(super) fn direction(antenna: &AntennaModel, position: Position) -> Result<AzEl, ErrorCode> {
    let (azimuth_deg, elevation_deg) = (position.azimuth_deg(), position.elevation_deg());
    let elevations_deg = 0.0..=MAX_ELEVATION_DEG;
    if !AZIMUTHS_DEG.contains(&azimuth_deg) || !elevations_deg.contains(&elevation_deg) {
        return Err(ErrorCode::INVALID);
    }
    // Below its min elevation, the antenna waits at the azimuth where the satellite will rise.
    let elevation_deg = elevation_deg.max(antenna.config.limits.minimum_elevation_deg).min(90.0);
    Ok(AzEl::from_degrees(azimuth_deg.rem_euclid(360.0), elevation_deg))
}

/// Returns the error code of a problem.
pub(super) fn code(problem: &TrackProblem) -> ErrorCode {
    match problem {
        TrackProblem::Refused(refusal) => refusal_code(refusal),
        TrackProblem::NoAngle => ErrorCode::TIMED_OUT,
        TrackProblem::NoPass | TrackProblem::Orbit(_) => ErrorCode::REJECTED,
    }
}

fn refusal_code(refusal: &Refusal) -> ErrorCode {
    match refusal {
        Refusal::Travel { .. }
        | Refusal::Forbidden { .. }
        | Refusal::Inside(_)
        | Refusal::Unchecked { .. }
        | Refusal::Elevation { .. }
        | Refusal::TooFast { .. }
        | Refusal::StepTooLarge { .. }
        | Refusal::TooLow { .. }
        | Refusal::Nothing => ErrorCode::INVALID,
        Refusal::PositionUnknown
        | Refusal::PositionOld(_)
        | Refusal::FaultsUnknown
        | Refusal::AngleUnknown { .. } => ErrorCode::TIMED_OUT,
        Refusal::NotOffered | Refusal::OneAxis => ErrorCode::NOT_AVAILABLE,
        // Programs learn only of the refusal; the operator sees the reason.
        _ => ErrorCode::REJECTED,
    }
}
