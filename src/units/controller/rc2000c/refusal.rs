//! The reason why the unit has refused a command. The unit reports none, so Azel infers it from the
//! last status and the causes in the manual.

use crate::protocol::rc2000c::{
    AutoMove, DriveReset, Motion, PolarizationDevice, PolarizationMove, Position, Request, Setting,
    Status,
};

pub(super) const AUTOMATIC: &str = "automatic polarization is on";

/// Returns the likely reason according to the last status.
pub(super) fn likely_reason(request: &Request, status: Option<&Status>) -> String {
    let Some(status) = status else { return "the unit does not say why".to_owned() };
    let is_automatic = status.polarization_mode.is_some_and(|mode| mode.is_automatic);
    let tracks = is_tracking(status);
    let reason = match request {
        Request::Motion(Motion::AutoMove(target)) => auto_move(target, is_automatic),
        Request::Motion(Motion::Jog(_)) if tracks => "TRACK is peaking or searching",
        Request::Motion(Motion::Jog(_)) if is_at_limit(status) => "the axis is at its limit",
        Request::Motion(Motion::Polarization(_)) if is_automatic => AUTOMATIC,
        Request::Motion(Motion::Polarization(PolarizationMove::ToStored(_))) => {
            "no satellite is stored near this azimuth"
        }
        Request::Motion(Motion::Polarization(_)) if tracks => "TRACK is peaking",
        Request::Motion(Motion::ResetDrive(DriveReset::Polarization))
        | Request::Setting(Setting::AutoPolarization(_))
            if status.feed.device != PolarizationDevice::RotatingFeed =>
        {
            "there is no rotating feed"
        }
        Request::Motion(Motion::RestartTracking) | Request::Setting(Setting::Band(_))
            if !tracks =>
        {
            "TRACK is not active"
        }
        Request::Setting(Setting::Band(_)) => "the satellite has one band only",
        _ => "the unit does not say why",
    };
    reason.to_owned()
}

/// Returns `true` if the track mode is on. An unknown mode counts as on.
pub(super) fn is_tracking(status: &Status) -> bool {
    status.track.is_some_and(|track| track.submode.is_active())
}

fn auto_move(target: &AutoMove, is_automatic: bool) -> &'static str {
    match (target.to_satellite(), target.to_polarization()) {
        (Some((_, Some(_))), _) | (_, Some(_)) if is_automatic => AUTOMATIC,
        (Some(_), _) => "no satellite of this name is stored, or it lies beyond a limit",
        (_, Some(_)) => "the polarization does not reach so far",
        _ => "the position lies beyond a limit of the unit",
    }
}

fn is_at_limit(status: &Status) -> bool {
    [status.azimuth, status.elevation].iter().any(|position| matches!(position, Position::Limit(_)))
}
