//! Rules of the gate. Each rule is one reason to refuse.

use super::{Intervals, Situation, way};
use crate::{
    astro::{Angle, xy_mount},
    contract::driver::{Intent, Refusal, position_for},
    device::{
        Motion, MotionRequest, SecondAxis, aimed,
        panel::{Act, Lead},
        settings::Hindrance,
    },
    station::Mount,
};

#[derive(Clone, Copy)]
pub(super) struct Rule {
    /// Unique name of the rule.
    pub(super) name: &'static str,
    pub(super) check: RuleCheck,
}

#[derive(Clone, Copy)]
pub(super) enum RuleCheck {
    /// Rule for any motion, and for any action that moves the antenna.
    Moving(fn(&MotionRequest, &Situation<'_>) -> Result<(), Refusal>),
    Motion(fn(&Motion, &Situation<'_>) -> Result<(), Refusal>),
    Act(fn(&Act, &Situation<'_>) -> Result<(), Refusal>),
    /// Rule for an action that moves the antenna, after the rules of motions.
    MovingAct(fn(&Act, &Situation<'_>) -> Result<(), Refusal>),
    AnySetting(fn(&Situation<'_>) -> Result<(), Refusal>),
    /// Rule for a setting that decides where the antenna points.
    Setting(fn(&Situation<'_>) -> Option<Hindrance>),
}

/// Builds a list of rules, each with the name of its function.
macro_rules! rules {
    ($($kind:ident($check:ident),)*) => {
        &[$(Rule { name: stringify!($check), check: RuleCheck::$kind($check) },)*]
    };
}

/// All rules; the simplest reason of each kind comes first.
pub(super) const RULES: &[Rule] = rules![
    Moving(unit_is_not_locked_out),
    Motion(something_is_asked_for),
    Moving(safety_settings_are_read),
    Motion(controller_offers_it),
    Moving(position_is_fresh),
    Moving(no_stop_under_way),
    Moving(intent_allows_it),
    Moving(no_fault_forbids_it),
    Motion(no_limit_switch_in_that_direction),
    Motion(within_rates_and_steps),
    Motion(no_blind_jog),
    Motion(within_travel),
    Motion(within_reach),
    Motion(way_is_clear),
    Motion(program_is_clear),
    Motion(auto_track_is_clear),
    Moving(controller_agrees),
    Act(no_action_while_locked_out),
    MovingAct(the_end_of_the_action_can_be_known),
    MovingAct(the_operator_answers_for_an_unseen_end),
    MovingAct(an_unseen_way_is_watched),
    MovingAct(end_of_the_action_is_within_reach),
    MovingAct(way_of_the_action_is_clear),
    AnySetting(no_setting_while_locked_out),
    Setting(no_setting_while_stopping),
    Setting(no_setting_while_the_unit_may_move),
    Setting(no_setting_after_a_motion_was_asked_for),
];

fn unit_is_not_locked_out(_: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    situation.lock_out.map_or(Ok(()), |lock_out| Err(lock_out.into()))
}

fn something_is_asked_for(motion: &Motion, _: &Situation<'_>) -> Result<(), Refusal> {
    // A non-finite number would pass every comparison of the rules below.
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

/// Requires readable safety settings. Only the operator can answer for unknown bounds, and only for
/// a manual motion.
fn safety_settings_are_read(
    request: &MotionRequest,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let Some(place) = situation.bounds.unread() else { return Ok(()) };
    let refusal = Refusal::SettingsUnread { place: place.clone() };
    let rates_deg_s = match *request {
        MotionRequest::Motion(Motion::Jog { x_deg_s, y_deg_s }) => {
            Some(situation.actual_rates([x_deg_s, y_deg_s]))
        }
        MotionRequest::Motion(Motion::Step { .. }) => None,
        MotionRequest::Motion(
            Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto,
        )
        | MotionRequest::Action(_) => return Err(refusal),
    };
    way::slowly_by_permission(rates_deg_s, refusal, situation)
}

fn controller_offers_it(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let can = situation.can;
    let turns_second = |y: f64| y == 0.0 || can.second_axis != SecondAxis::Absent;
    let offered = match *motion {
        Motion::Jog { x_deg_s: x, y_deg_s: y } => {
            if can.jogs_one_axis && x != 0.0 && y != 0.0 {
                return Err(Refusal::OneAxis);
            }
            turns_second(y)
        }
        Motion::Step { y_deg, .. } => can.steps && turns_second(y_deg),
        Motion::Position { elevation, .. } => {
            can.takes_positions && (can.has_elevation() || elevation.is_none())
        }
        Motion::StartProgram | Motion::EnableAuto => can.has_program,
    };
    if offered { Ok(()) } else { Err(Refusal::NotOffered) }
}

fn position_is_fresh(request: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    // The window locks its controls with the same function, so both agree.
    position_for(request, situation.state, situation.now.steady).map(drop)
}

fn no_stop_under_way(_: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    if situation.stopping { Err(Refusal::Stopping) } else { Ok(()) }
}

fn intent_allows_it(request: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    let intent = situation.intent;
    let allowed = match request {
        MotionRequest::Motion(Motion::Jog { .. } | Motion::Step { .. }) => intent == Intent::Manual,
        MotionRequest::Motion(Motion::Position { .. }) => {
            matches!(intent, Intent::Position | Intent::Park | Intent::Track)
        }
        MotionRequest::Motion(Motion::StartProgram) => intent == Intent::Track,
        // The unit starts on its own in any mode; `auto_track_is_clear` judges its pass.
        MotionRequest::Motion(Motion::EnableAuto) => true,
        MotionRequest::Action(_) => matches!(intent, Intent::Manual | Intent::Position),
    };
    if allowed { Ok(()) } else { Err(Refusal::Intent(intent)) }
}

fn no_fault_forbids_it(_: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    match situation.state.motion_lock {
        Some(false) => Ok(()),
        Some(true) => Err(Refusal::Fault),
        // Missing information forbids motion.
        None => Err(Refusal::FaultsUnknown),
    }
}

/// Refuses a motion towards an active limit switch; the opposite direction stays free.
fn no_limit_switch_in_that_direction(
    motion: &Motion,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    let (Motion::Jog { x_deg_s: x, y_deg_s: y } | Motion::Step { x_deg: x, y_deg: y }) = *motion
    else {
        return Ok(());
    };
    let measured = situation.state.measured.ok_or(Refusal::PositionUnknown)?;
    for ((turn, axis), name) in [x, y].into_iter().zip(measured.axes).zip(situation.can.axes) {
        if turn > 0.0 && axis.plus_limit {
            return Err(Refusal::Limit { axis: name, plus: true });
        }
        if turn < 0.0 && axis.minus_limit {
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
        // The unit turns to these targets at its own rates.
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => {}
    }
    Ok(())
}

/// Refuses a jog of an axis without a known angle: nobody would see its motion, and it would not
/// end if the link were lost.
fn no_blind_jog(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let (Motion::Jog { x_deg_s: x, y_deg_s: y } | Motion::Step { x_deg: x, y_deg: y }) = *motion
    else {
        return Ok(());
    };
    let Intervals(axes) = situation.intervals.ok_or(Refusal::PositionUnknown)?;
    for ((turn, axis), name) in [x, y].into_iter().zip(axes).zip(situation.can.axes) {
        if turn != 0.0 && !axis.is_known && !situation.can.ends_jogs {
            return Err(Refusal::AngleUnknown { axis: name });
        }
    }
    Ok(())
}

/// Keeps manual motions within the travel of the axes; the way back into the travel is free.
fn within_travel(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let ahead_deg = match *motion {
        // Check as far as the axes turn until the next position is judged.
        Motion::Jog { x_deg_s, y_deg_s } => {
            situation.actual_rates([x_deg_s, y_deg_s]).map(|rate| rate * situation.ahead_s)
        }
        Motion::Step { x_deg, y_deg } => [x_deg, y_deg],
        // `within_reach` judges the end of a position, and a worker judges the path of a program.
        Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => return Ok(()),
    };
    let Intervals(axes) = situation.intervals.ok_or(Refusal::PositionUnknown)?;
    let axes = axes.into_iter().zip(situation.mount.travel_deg()).zip(situation.can.axes);
    let axes = axes.take(situation.can.axis_count());
    for (ahead_deg, ((axis, (from_deg, to_deg)), name)) in ahead_deg.into_iter().zip(axes) {
        // An axis that the unit stops at its limits may turn unseen.
        if !axis.is_known {
            continue;
        }
        let asked_deg = axis.from_deg + ahead_deg;
        let outward =
            (ahead_deg > 0.0 && asked_deg > to_deg) || (ahead_deg < 0.0 && asked_deg < from_deg);
        if outward {
            return Err(Refusal::Travel { axis: name, asked_deg, from_deg, to_deg });
        }
    }
    Ok(())
}

pub(super) fn within_reach(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    let Motion::Position { azimuth, elevation } = *motion else { return Ok(()) };
    let lowest_deg = situation.limits.minimum_elevation_deg;
    if let Some(elevation) = elevation {
        let is_over = situation.mount.can_flip() && elevation.degrees() > 90.0;
        // Beyond the zenith, use the elevation on the other side.
        let asked_deg = if is_over { 180.0 - elevation.degrees() } else { elevation.degrees() };
        // Angles come from decimal degrees: allow for rounding.
        if asked_deg < lowest_deg - 1e-9 || asked_deg > 90.0 + 1e-9 {
            return Err(Refusal::Elevation { asked_deg, lowest_deg });
        }
    }
    let measured = situation.state.measured.map(|measured| measured.pointing);
    let aim = aimed(azimuth, elevation, measured);
    let asked_deg = match situation.mount {
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let direction = aim.direction().ok_or(Refusal::PositionUnknown)?;
            let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
            let axes = xy_mount::axes_from_azel(direction, lower_axis);
            // The controller counts 90 at the zenith.
            [axes.lower, axes.upper].map(|angle| Some(angle.degrees() + 90.0))
        }
        // An axis without a new angle does not move.
        Mount::AzEl { .. } => [azimuth, elevation].map(|angle| angle.map(Angle::degrees)),
    };
    let ends = situation.mount.travel_deg().into_iter().zip(situation.can.axes);
    for (asked_deg, ((from_deg, to_deg), axis)) in asked_deg.into_iter().zip(ends) {
        let Some(asked_deg) = asked_deg else { continue };
        if asked_deg < from_deg - 1e-9 || asked_deg > to_deg + 1e-9 {
            return Err(Refusal::Travel { axis, asked_deg, from_deg, to_deg });
        }
    }
    Ok(())
}

/// Refuses a blocked path. Judges the angles that the unit receives, which it may have rounded.
fn way_is_clear(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    way::is_clear(&situation.gate.controller.as_sent(*motion), situation)
}

fn program_is_clear(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    if *motion != Motion::StartProgram {
        return Ok(());
    }
    situation.gate.program_is_clear(situation.now)
}

fn auto_track_is_clear(motion: &Motion, situation: &Situation<'_>) -> Result<(), Refusal> {
    if *motion != Motion::EnableAuto {
        return Ok(());
    }
    situation.gate.next_pass_is_clear(situation.now)
}

fn controller_agrees(request: &MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
    let objection = situation.gate.controller.objection(request, situation.now);
    objection.map_or(Ok(()), |reason| Err(Refusal::Controller(reason)))
}

/// Refuses all actions during a lock-out: even an action without motion may endanger hands.
fn no_action_while_locked_out(_: &Act, situation: &Situation<'_>) -> Result<(), Refusal> {
    situation.lock_out.map_or(Ok(()), |lock_out| Err(lock_out.into()))
}

/// Refuses an action whose end nobody can know, even with permission.
fn the_end_of_the_action_can_be_known(act: &Act, situation: &Situation<'_>) -> Result<(), Refusal> {
    match situation.gate.controller.lead_of(act) {
        Lead::Unknown(reason) => Err(Refusal::Controller(reason)),
        Lead::Nowhere | Lead::To(_) | Lead::Unseen(_) => Ok(()),
    }
}

fn the_operator_answers_for_an_unseen_end(
    act: &Act,
    situation: &Situation<'_>,
) -> Result<(), Refusal> {
    match situation.gate.controller.lead_of(act) {
        Lead::Unseen(reason) if !situation.is_agreed => {
            let is_watched = situation.intervals.is_some_and(|axes| axes.unknown().is_none());
            Err(Refusal::Unseen { act: act.clone(), reason, is_watched })
        }
        _ => Ok(()),
    }
}

/// Refuses an unseen path: nobody would stop the antenna before a barrier.
fn an_unseen_way_is_watched(act: &Act, situation: &Situation<'_>) -> Result<(), Refusal> {
    let is_unseen = matches!(situation.gate.controller.lead_of(act), Lead::Unseen(_));
    if !is_unseen || !situation.bounds.forbid_anything() {
        return Ok(());
    }
    let intervals = situation.intervals.ok_or(Refusal::PositionUnknown)?;
    let Some(unknown) = intervals.unknown() else { return Ok(()) };
    let axis = situation.can.axes.get(unknown).copied().unwrap_or_default();
    Err(Refusal::AngleUnknown { axis })
}

fn end_of_the_action_is_within_reach(act: &Act, situation: &Situation<'_>) -> Result<(), Refusal> {
    let motion = situation.gate.lead_motion(act)?;
    motion.map_or(Ok(()), |motion| within_reach(&motion, situation))
}

fn way_of_the_action_is_clear(act: &Act, situation: &Situation<'_>) -> Result<(), Refusal> {
    let motion = situation.gate.lead_motion(act)?;
    motion.map_or(Ok(()), |motion| way::is_clear(&motion, situation))
}

fn no_setting_while_locked_out(situation: &Situation<'_>) -> Result<(), Refusal> {
    situation.lock_out.map_or(Ok(()), |lock_out| Err(lock_out.into()))
}

fn no_setting_while_stopping(situation: &Situation<'_>) -> Option<Hindrance> {
    situation.stopping.then_some(Hindrance::Stopping)
}

fn no_setting_while_the_unit_may_move(situation: &Situation<'_>) -> Option<Hindrance> {
    Hindrance::from_state(situation.state, situation.can, situation.now.steady)
}

fn no_setting_after_a_motion_was_asked_for(situation: &Situation<'_>) -> Option<Hindrance> {
    situation.may_move.then_some(Hindrance::Moves)
}
