//! Gate: the one check that every motion passes.
//!
//! Invariant: the gate owns the controller and hands out only its [`Device`] side, so no other code
//! can start a motion. To add a rule, extend [`RULES`] and the table of cases that proves each rule
//! necessary (`tests/each_rule.rs`).

mod detours;
mod hands;
mod intervals;
mod judged;
mod offsets;
mod permissions;
mod preview;
mod program;
mod rules;
mod settings;
mod way;

use std::sync::Arc;

use glam::DQuat;

use super::motion_watch::{Lead, MotionWatch};
use crate::{
    astro::{Angle, AzEl},
    clock::{Instant, Moment},
    contract::driver::{AxisLessons, Intent, Refusal},
    device::{
        AntennaState, Capabilities, Controller, Device, Motion, MotionRequest, Pointing, Variant,
        aimed,
        panel::{Act, Action},
    },
    plan::{Bounds, Sweep, bounds::Budget, on_board::Judge},
    station::{Antenna, LockOut, MotionLimits, Mount},
};
pub(super) use detours::{Detour, DetourQuestion, NoRoute};
use intervals::LastAngles;
pub(super) use intervals::{Interval, Intervals};
use judged::Judged;
pub(super) use judged::PathQuestion;
pub(super) use offsets::Demand;
use permissions::Permissions;
pub(super) use program::NextPass;
use rules::{RULES, Rule, RuleCheck};
pub(super) use settings::Shift;
pub(super) use way::Route;

const HALF_TURN: Angle = Angle::from_degrees(180.0);

/// State that the rules check besides the motion.
struct Situation<'a> {
    gate: &'a Gate,
    state: &'a AntennaState,
    can: Capabilities,
    intent: Intent,
    stopping: bool,
    /// `true` if the request includes a motion, even while the antenna stands.
    may_move: bool,
    /// `true` if the operator takes responsibility for an action with an unknown end.
    is_agreed: bool,
    limits: MotionLimits,
    mount: Mount,
    bounds: &'a Bounds,
    /// Intervals of the axes at the last position.
    intervals: Option<Intervals>,
    /// Rotation from the modelled beam direction to the true one on the sky, if axis offsets apply.
    to_sky: Option<DQuat>,
    /// Time after the last position for which the gate judges a jog, seconds.
    ahead_s: f64,
    lock_out: Option<&'a LockOut>,
    /// Limit on the path checks of one search; `None` for a single motion.
    budget: Option<&'a Budget>,
    now: Moment,
}

pub(super) struct Gate {
    controller: Box<dyn Controller>,
    variant: &'static Variant,
    rules: Vec<Rule>,
    limits: MotionLimits,
    mount: Mount,
    bounds: Bounds,
    /// Overrun: how long the axes continue at their rate after a STOP, seconds.
    overrun_s: f64,
    /// Target of the last motion of each axis, degrees as the mount counts; `None` if unknown or
    /// absent.
    to_deg: [Option<f64>; 2],
    /// Axes that the last motion turns; in a program track, all axes that it has turned.
    turns: [bool; 2],
    /// Angles of the axes at the start of the last motion, degrees as the mount counts.
    started_from_deg: Option<[f64; 2]>,
    last_angles: LastAngles,
    watch: MotionWatch,
    /// Receive time of the last position that the watch took.
    looked: Option<Instant>,
    /// Lock-out of the unit: the gate lets only queries and halts pass.
    lock_out: Option<LockOut>,
    /// Start of the last motion that is not known to be over.
    unproved_since: Option<Instant>,
    /// Pass for which the gate judges a start of the unit's own program.
    program: Option<Arc<Judge>>,
    /// Pass that the unit would track on its own.
    next_pass: NextPass,
    judged: Judged,
    /// Result of the last detour search.
    detour: Option<Detour>,
    /// The operator's permissions.
    permissions: Permissions,
    /// Rotation from the modelled beam direction of a tracking antenna to the true one on the sky,
    /// if axis offsets apply.
    to_sky: Option<DQuat>,
}

impl Gate {
    /// Creates the gate. `learned` contains the earlier lessons about each axis.
    pub(super) fn new(
        controller: Box<dyn Controller>,
        antenna: &Antenna,
        bounds: Bounds,
        learned: &[AxisLessons; 2],
    ) -> Self {
        let variant = antenna.connection.variant();
        let mount = bounds.mount();
        Self {
            controller,
            variant,
            rules: RULES.to_vec(),
            limits: antenna.limits,
            mount,
            bounds,
            overrun_s: variant.capabilities.standstill.overrun_s,
            to_deg: [None; 2],
            turns: [false; 2],
            started_from_deg: None,
            last_angles: LastAngles::default(),
            watch: hands::watch(variant.capabilities, mount, antenna.sway_deg, learned),
            looked: None,
            lock_out: None,
            unproved_since: None,
            program: None,
            next_pass: NextPass::Unread,
            judged: Judged::default(),
            detour: None,
            permissions: Permissions::default(),
            to_sky: None,
        }
    }

    /// Removes the rule with this name.
    #[cfg(test)]
    fn omit(mut self, name: &str) -> Self {
        let before = self.rules.len();
        self.rules.retain(|rule| rule.name != name);
        assert_eq!(self.rules.len() + 1, before, "no rule is called {name}");
        self
    }

    pub(super) fn lock_out(&self) -> Option<&LockOut> {
        self.lock_out.as_ref()
    }

    /// Sets the lock-out; `None` ends it.
    pub(super) fn set_lock_out(&mut self, lock_out: Option<LockOut>) {
        // The controller must not write pending setting changes during the lock-out either.
        self.controller.lock_changes(lock_out.is_some());
        self.lock_out = lock_out;
    }

    /// Returns the start of the last motion without proved standstill.
    pub(super) fn unproved_since(&self) -> Option<Instant> {
        self.unproved_since
    }

    /// Records a motion that another session started at this time without proving standstill.
    pub(super) fn note_earlier_motion(&mut self, moved_at: Option<Instant>) {
        self.unproved_since = moved_at;
        if let Some(moved_at) = moved_at {
            // A debt records the time of the motion, but not its target.
            self.watch.note_command([Some(Lead::Anywhere); 2], moved_at);
        }
    }

    pub(super) fn clear_unproved(&mut self) {
        self.unproved_since = None;
        // A motion that ended without a halt, such as a track of the unit, turns no axis any more.
        self.turns = [false; 2];
        self.watch.note_rest();
    }

    /// Returns the angles of the axes at the start of the last motion, degrees as the mount counts.
    pub(super) fn started_from_deg(&self) -> Option<[f64; 2]> {
        self.started_from_deg
    }

    /// Returns the target of the last motion of each axis, degrees as the mount counts. Returns
    /// `None` for an axis that the motion does not turn, and after a halt. In a program track, the
    /// last motion of each axis counts.
    pub(super) fn sent_to_deg(&self) -> [Option<f64>; 2] {
        let [first, second] = self.to_deg;
        let [turns_first, turns_second] = self.turns;
        [first.filter(|_| turns_first), second.filter(|_| turns_second)]
    }

    /// Records a halt, which ends the last motion.
    pub(super) fn note_halt(&mut self) {
        self.turns = [false; 2];
    }

    /// Returns the axes that Azel's last motion turns.
    pub(super) fn turning_axes(&self) -> [bool; 2] {
        self.turns
    }

    /// Starts a track: earlier targets do not count as a part of it.
    pub(super) fn begin_track(&mut self) {
        self.turns = [false; 2];
    }

    /// Records the target of a motion. A program track commands one axis while the other axis is
    /// still turning.
    fn remember_target(&mut self, motion: Motion, intent: Intent, now: Moment) {
        let (sent_to_deg, turned) = (self.end_angles(motion, now), self.moved_axes(motion));
        let goes_on = intent == Intent::Track && matches!(motion, Motion::Position { .. });
        let axes = self.to_deg.iter_mut().zip(&mut self.turns).zip(sent_to_deg).zip(turned);
        for (((to_deg, turns), sent_to_deg), is_turned) in axes {
            if is_turned || !(goes_on && *turns) {
                (*to_deg, *turns) = (sent_to_deg, is_turned);
            }
        }
    }

    fn moved_axes(&self, motion: Motion) -> [bool; 2] {
        match motion {
            Motion::Jog { x_deg_s: x, y_deg_s: y } | Motion::Step { x_deg: x, y_deg: y } => {
                [x, y].map(|turn| turn != 0.0)
            }
            Motion::Position { azimuth, elevation } if matches!(self.mount, Mount::AzEl { .. }) => {
                [azimuth.is_some(), elevation.is_some()]
            }
            // Any new direction turns both axes of an X/Y mount.
            Motion::Position { .. } | Motion::StartProgram | Motion::EnableAuto => [true; 2],
        }
    }

    /// Returns the last measured angles of the axes, degrees as the mount counts.
    pub(super) fn axes_deg(&self) -> Option<[f64; 2]> {
        self.state().measured?.axes_deg(self.variant.capabilities.has_elevation())
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub(super) fn keep_within(&mut self, bounds: Bounds) {
        self.bounds = bounds;
        // The bounds of a permitted track to the Sun derive from the bounds set here.
        self.lift_sun(self.lifts_sun());
    }

    /// Returns the overrun: how long the axes continue at their rate after a STOP, seconds.
    pub(super) fn overrun_s(&self) -> f64 {
        self.overrun_s
    }

    /// Replaces the overrun with a measured value, seconds.
    pub(super) fn set_overrun(&mut self, overrun_s: f64) {
        self.overrun_s = overrun_s;
    }

    /// Returns the time after the last position for which the gate judges a motion, seconds: the
    /// age of the position, the time until the next position, and the overrun.
    pub(super) fn ahead_s(&self, now: Moment) -> f64 {
        let Some(measured) = self.state().measured else { return self.overrun_s };
        let requested = self.oldest_request().unwrap_or(measured.requested);
        let age = now.steady.saturating_duration_since(requested);
        let reply = measured.received.saturating_duration_since(measured.requested);
        // Azel judges a motion again when the next position arrives, which may take as long as the
        // last.
        (age + reply + self.controller.poll_period()).as_secs_f64() + self.overrun_s
    }

    /// Returns the side of the controller that cannot start a motion.
    pub(super) fn device(&mut self) -> &mut dyn Device {
        &mut *self.controller
    }

    pub(super) fn state(&self) -> &AntennaState {
        self.controller.state()
    }

    /// Checks whether `motion` could start if the antenna were at rest.
    pub(super) fn check(&self, motion: Motion, intent: Intent, now: Moment) -> Result<(), Refusal> {
        self.check_within(motion, intent, None, now)
    }

    fn check_within(
        &self,
        motion: Motion,
        intent: Intent,
        budget: Option<&Budget>,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = Situation { budget, ..self.situation(intent, false, now) };
        self.examine(motion.into(), &situation)
    }

    /// Starts `motion`, or returns the reason not to. This is the only way to move an antenna.
    pub(super) fn start(
        &mut self,
        motion: Motion,
        intent: Intent,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        // A refused motion must not change the records of the previous motion.
        self.examine(motion.into(), &self.situation(intent, stopping, now))?;
        self.remember_target(motion, intent, now);
        // If the answer is lost, a turn since then proves that the unit received the motion.
        self.started_from_deg = self.axes_deg();
        self.unproved_since = Some(now.steady);
        self.watch_motion(motion, now);
        self.controller.start(motion);
        Ok(())
    }

    fn examine(&self, request: MotionRequest, situation: &Situation<'_>) -> Result<(), Refusal> {
        self.ask_rules(|check| match (check, &request) {
            (RuleCheck::Moving(check), request) => check(request, situation),
            (RuleCheck::Motion(check), MotionRequest::Motion(motion)) => check(motion, situation),
            _ => Ok(()),
        })
    }

    /// Returns the first refusal of a rule.
    fn ask_rules(&self, ask: impl Fn(RuleCheck) -> Result<(), Refusal>) -> Result<(), Refusal> {
        self.rules.iter().try_for_each(|rule| {
            ask(rule.check).inspect_err(|refusal| {
                tracing::debug!(rule = rule.name, ?refusal, "refused");
            })
        })
    }

    fn situation(&self, intent: Intent, stopping: bool, now: Moment) -> Situation<'_> {
        Situation {
            gate: self,
            state: self.controller.state(),
            can: self.variant.capabilities,
            intent,
            stopping,
            may_move: false,
            is_agreed: false,
            limits: self.limits,
            mount: self.mount,
            bounds: self.bounds_in(intent),
            intervals: self.intervals(),
            to_sky: self.to_sky_in(intent),
            ahead_s: self.ahead_s(now),
            lock_out: self.lock_out.as_ref(),
            // A single motion has no budget: a budget used up by others could refuse a motion that
            // a search just accepted.
            budget: None,
            now,
        }
    }

    /// Executes an action of the make, or returns the reason not to. `is_agreed`: the operator
    /// takes responsibility for an action with an unknown lead.
    pub(super) fn act(
        &mut self,
        act: Act,
        is_agreed: bool,
        intent: Intent,
        stopping: bool,
        now: Moment,
    ) -> Result<&'static Action, Refusal> {
        let action = self.variant.action(act.action).ok_or(Refusal::NotOffered)?;
        let situation = Situation { is_agreed, ..self.situation(intent, stopping, now) };
        self.ask_rules(|check| match check {
            RuleCheck::Act(check) => check(&act, &situation),
            _ => Ok(()),
        })?;
        if action.moves {
            self.examine(
                MotionRequest::Action(act.action),
                &self.situation(intent, stopping, now),
            )?;
            self.ask_rules(|check| match check {
                RuleCheck::MovingAct(check) => check(&act, &situation),
                _ => Ok(()),
            })?;
            self.to_deg = self.action_end(&act);
            self.watch_act(&act, now);
            self.turns = [true; 2];
            self.unproved_since = Some(now.steady);
            self.started_from_deg = self.axes_deg();
        }
        self.controller.act(act);
        Ok(action)
    }

    /// Converts a motion to a direction of the sky into axis angles, by the nearest position of the
    /// azimuth axis. If one angle stays, flipped axes stay flipped. Returns an error for an angle
    /// beyond the axis.
    pub(super) fn nearest(&self, motion: Motion) -> Result<Motion, Refusal> {
        let Motion::Position { azimuth, elevation } = motion else { return Ok(motion) };
        if let Some(asked_deg) = elevation.map(Angle::degrees).filter(|deg| *deg > 90.0 + 1e-9) {
            let lowest_deg = self.limits.minimum_elevation_deg;
            return Err(Refusal::Elevation { asked_deg, lowest_deg });
        }
        let stays_flipped = self.is_flipped() && (azimuth.is_none() || elevation.is_none());
        let flipped = |elevation| if stays_flipped { HALF_TURN - elevation } else { elevation };
        Ok(Motion::Position {
            azimuth: azimuth.map(|azimuth| self.nearest_azimuth(azimuth, stays_flipped)),
            elevation: elevation.map(flipped),
        })
    }

    /// Returns the nearest axis position for `azimuth`. An azimuth beyond one turn of the axis is
    /// an axis angle, not a direction.
    fn nearest_azimuth(&self, azimuth: Angle, is_flipped: bool) -> Angle {
        let [(from_deg, to_deg), _] = self.mount.travel_deg();
        let asked_deg = azimuth.degrees();
        let is_of_sky = (0.0..360.0).contains(&asked_deg);
        if !is_of_sky && (from_deg..=to_deg).contains(&asked_deg) {
            return azimuth;
        }
        let near_deg = self.state().measured.and_then(|measured| measured.axes[0].angle_deg);
        let side = if is_flipped { (azimuth + HALF_TURN).wrapped_360() } else { azimuth };
        self.mount.axis_azimuth(side, near_deg)
    }

    /// Returns the end of a motion to a position, with the angles sent to the unit.
    pub(super) fn aim(&self, motion: &Motion) -> Option<Pointing> {
        let motion = self.controller.as_sent(*motion);
        let Motion::Position { azimuth, elevation } = motion else { return None };
        if !self.mount.can_flip() {
            return Some(aimed(azimuth.map(Angle::wrapped_360), elevation, self.pointing()));
        }
        let elevation_now = self.elevation_axis_deg().map(Angle::from_degrees);
        let measured = self.state().measured;
        let azimuth_now = measured.and_then(|measured| measured.axes[0].angle_deg);
        let azimuth = azimuth.or(azimuth_now.map(Angle::from_degrees));
        let elevation = elevation.or(elevation_now);
        if elevation.is_none() && self.is_flipped() {
            // At its upper limit the axis has no angle, and the beam still points to the other
            // side.
            let azimuth = azimuth.map(|azimuth| (azimuth + HALF_TURN).wrapped_360());
            return Some(Pointing { azimuth, elevation });
        }
        Some(Pointing::of_axes(azimuth, elevation))
    }

    /// Returns the direction of the antenna. For an axis without an angle, uses its limit switch or
    /// an angle less than a second old.
    pub(super) fn pointing(&self) -> Option<Pointing> {
        let reported = self.state().measured?.pointing;
        let has_elevation = self.variant.capabilities.has_elevation();
        let is_whole =
            reported.azimuth.is_some() && (reported.elevation.is_some() || !has_elevation);
        if is_whole {
            return Some(reported);
        }
        let Some(axes_deg) = self.intervals().and_then(Intervals::angles_deg) else {
            return Some(reported);
        };
        let AzEl { azimuth, elevation } = self.mount.direction(axes_deg);
        let elevation = has_elevation.then_some(elevation);
        Some(Pointing { azimuth: Some(azimuth), elevation })
    }

    /// Returns the measured angle of the elevation axis, degrees; `None` without an angle.
    fn elevation_axis_deg(&self) -> Option<f64> {
        let is_one =
            matches!(self.mount, Mount::AzEl { .. }) && self.variant.capabilities.has_elevation();
        self.state().measured.filter(|_| is_one)?.axes[1].angle_deg
    }

    /// Returns `true` for flipped axes, also at the upper limit, where the axis may have no angle.
    fn is_flipped(&self) -> bool {
        let at_upper_end = || {
            let axis = self.state().measured.map(|measured| measured.axes[1]);
            axis.is_some_and(|axis| axis.angle_deg.is_none() && axis.plus_limit)
        };
        self.mount.is_flipped(self.elevation_axis_deg())
            || (self.mount.can_flip() && at_upper_end())
    }
}

#[cfg(test)]
mod tests;
