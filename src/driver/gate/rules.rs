//! The rules of the gate, each one reason to refuse.

use std::time::Duration;

use super::{Refusal, Situation};
use crate::{
    astro::{Angle, xy_mount},
    controller::{Motion, aimed_direction},
    driver::intent::Intent,
    station::Mount,
};

/// A jog or step needs a position younger than this.
const FRESH: Duration = Duration::from_secs(1);
/// A jog is looked at again after this long at the latest, seconds.
const JOG_HORIZON_S: f64 = 0.3;
/// Anything else needs a position younger than this.
const RECENT: Duration = Duration::from_secs(5);

type Rule = fn(&Motion, &Situation<'_>) -> Result<(), Refusal>;

/// All rules, the plainest reason first.
pub(super) const RULES: [Rule; 9] = [
    something_is_asked_for,
    position_is_fresh,
    no_stop_under_way,
    intent_allows_it,
    no_fault_forbids_it,
    no_limit_switch_in_that_direction,
    within_rates_and_steps,
    within_travel,
    within_reach,
];

fn something_is_asked_for(motion: &Motion, _: &Situation<'_>) -> Result<(), Refusal> {
    let sound = match *motion {
        Motion::Jog { x_deg_s: x, y_deg_s: y } | Motion::Step { x_deg: x, y_deg: y } => {
            x.is_finite() && y.is_finite() && (x != 0.0 || y != 0.0)
        }
        Motion::Position { azimuth, elevation } => {
            let finite = |angle: Option<Angle>| angle.is_none_or(Angle::is_finite);
            finite(azimuth) && finite(elevation) && (azimuth.is_some() || elevation.is_some())
        }
        Motion::StartProgram | Motion::EnableAuto => true,
    };
    if sound { Ok(()) } else { Err(Refusal::Nothing) }
}

fn position_is_fresh(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let measured = situation
        .state
        .measured
        .filter(|measured| situation.state.link_since.is_some_and(|since| measured.asked >= since))
        .ok_or(Refusal::PositionUnknown)?;
    let age = situation.now.steady.saturating_duration_since(measured.asked);
    let allowed = match motion {
        Motion::Jog { .. } | Motion::Step { .. } => FRESH,
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => RECENT,
    };
    if age < allowed { Ok(()) } else { Err(Refusal::PositionOld(age)) }
}

fn no_stop_under_way(_: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    if situation.stopping { Err(Refusal::Stopping) } else { Ok(()) }
}

fn intent_allows_it(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let allowed = match motion {
        Motion::Jog { .. } | Motion::Step { .. } => situation.intent == Intent::Manual,
        Motion::Position { .. } => matches!(situation.intent, Intent::Position | Intent::Park),
        Motion::StartProgram => situation.intent == Intent::Track,
        Motion::EnableAuto => true,
    };
    if allowed { Ok(()) } else { Err(Refusal::Intent(situation.intent)) }
}

fn no_fault_forbids_it(_: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    match situation.state.motion_lock {
        Some(false) => Ok(()),
        Some(true) => Err(Refusal::Fault),
        None => Err(Refusal::FaultsUnknown),
    }
}

/// A limit blocks one direction only: the way out of it stays free.
fn no_limit_switch_in_that_direction(
    motion: &Motion,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let (Motion::Jog { x_deg_s: x, y_deg_s: y } | Motion::Step { x_deg: x, y_deg: y }) = *motion
    else {
        return Ok(());
    };
    let measured = situation.state.measured.ok_or(Refusal::PositionUnknown)?;
    for ((asked, axis), name) in [x, y].into_iter().zip(measured.axes).zip(situation.axes) {
        if asked > 0.0 && axis.plus_limit {
            return Err(Refusal::Limit { axis: name, plus: true });
        }
        if asked < 0.0 && axis.minus_limit {
            return Err(Refusal::Limit { axis: name, plus: false });
        }
    }
    Ok(())
}

fn within_rates_and_steps(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    match *motion {
        Motion::Jog { x_deg_s, y_deg_s } => {
            let asked_deg_s = x_deg_s.abs().max(y_deg_s.abs());
            let allowed_deg_s = situation.limits.maximum_rate_deg_s;
            if asked_deg_s > allowed_deg_s {
                return Err(Refusal::TooFast { asked_deg_s, allowed_deg_s });
            }
        }
        Motion::Step { x_deg, y_deg } => {
            let asked_deg = x_deg.abs().max(y_deg.abs());
            let allowed_deg = situation.limits.maximum_step_deg;
            if asked_deg > allowed_deg {
                return Err(Refusal::StepTooLarge { asked_deg, allowed_deg });
            }
        }
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => {}
    }
    Ok(())
}

/// By hand the axes stay within their travel; the way back into it is free.
fn within_travel(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let ahead_deg = match *motion {
        // As far as it gets before the next position is looked at.
        Motion::Jog { x_deg_s, y_deg_s } => [x_deg_s * JOG_HORIZON_S, y_deg_s * JOG_HORIZON_S],
        Motion::Step { x_deg, y_deg } => [x_deg, y_deg],
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => return Ok(()),
    };
    let measured = situation.state.measured.ok_or(Refusal::PositionUnknown)?;
    let Mount::Xy { travel_from_deg, travel_to_deg, .. } = situation.mount;
    for ((ahead_deg, axis), name) in ahead_deg.into_iter().zip(measured.axes).zip(situation.axes) {
        let asked_deg = axis.angle_deg + ahead_deg;
        let outward = (ahead_deg > 0.0 && asked_deg > travel_to_deg)
            || (ahead_deg < 0.0 && asked_deg < travel_from_deg);
        if outward {
            return Err(Refusal::Travel {
                axis: name,
                asked_deg,
                from_deg: travel_from_deg,
                to_deg: travel_to_deg,
            });
        }
    }
    Ok(())
}

fn within_reach(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let Motion::Position { azimuth, elevation } = *motion else { return Ok(()) };
    let lowest_deg = situation.limits.minimum_elevation_deg;
    if let Some(asked) = elevation {
        let asked_deg = asked.degrees();
        // Angles come from decimal degrees: allow for the rounding.
        if asked_deg < lowest_deg - 1e-9 || asked_deg > 90.0 + 1e-9 {
            return Err(Refusal::Elevation { asked_deg, lowest_deg });
        }
    }
    let measured = situation.state.measured.map(|measured| measured.direction);
    let direction =
        aimed_direction(azimuth, elevation, measured).ok_or(Refusal::PositionUnknown)?;
    let Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } = situation.mount;
    let axes = xy_mount::axes_from_azel(direction, Angle::from_degrees(lower_axis_azimuth_deg));
    for (angle, name) in [axes.lower, axes.upper].into_iter().zip(situation.axes) {
        // The controller counts 90 at the zenith.
        let asked_deg = angle.degrees() + 90.0;
        if asked_deg < travel_from_deg || asked_deg > travel_to_deg {
            return Err(Refusal::Travel {
                axis: name,
                asked_deg,
                from_deg: travel_from_deg,
                to_deg: travel_to_deg,
            });
        }
    }
    Ok(())
}
