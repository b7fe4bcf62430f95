//! Watches an on-board track: before it starts by what the unit reports, and while it runs by
//! where it points.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;

use super::{Session, activity::Slew, off_target::OffTarget};
use crate::{
    astro::{
        Angle, AzEl, TrackOffsets,
        time::{add_seconds, seconds_between},
    },
    clock::{Instant, Moment},
    contract::driver::{Event, Intent, OnBoardView, TrackProblem},
    device::{LONGEST_WINDOW_S, Measured, OnBoard, Phase},
    driver::gate::{Held, NoRoute},
    plan::{
        OnBoardPass, Supervision,
        on_board::{Judge, Ranked},
    },
};

/// The unit's clock is reported with the delay of the link: smaller differences are ignored,
/// seconds.
const SAME_CLOCK_S: f64 = 0.2;

pub(super) struct Watch {
    judge: Arc<Judge>,
    found: Arc<Supervision>,
    found_by: OnBoard,
    /// The unit holds the target.
    holds_target: bool,
    /// When the position that was compared last came in.
    compared: Option<Instant>,
    was_on_target: bool,
    /// Latest expected arrival on the satellite.
    arrives: Option<Instant>,
    off_target: OffTarget,
    /// Error by this computer's clock that a different clock of the unit does not explain.
    unexplained: OffTarget,
    /// The position when the axes last turned, and where the satellite was then.
    turned: Option<(Measured, AzEl)>,
}

impl Watch {
    fn new(judge: Arc<Judge>, unit: &OnBoard) -> Self {
        Self {
            found: Arc::new(judge.supervise(unit, false)),
            judge,
            found_by: unit.clone(),
            holds_target: false,
            compared: None,
            was_on_target: false,
            arrives: None,
            off_target: OffTarget::default(),
            unexplained: OffTarget::default(),
            turned: None,
        }
    }

    pub(super) fn judge(&self) -> &Arc<Judge> {
        &self.judge
    }

    pub(super) fn view(&self) -> OnBoardView {
        OnBoardView {
            found: Arc::clone(&self.found),
            missing: self.off_target.missing(),
            arrives: self.arrives.filter(|_| !self.was_on_target),
        }
    }

    /// Returns the cause, found in the unit's reports, that makes an error of `off`.
    pub(super) fn cause(&self, off: Angle) -> Option<Ranked> {
        self.found.cause_of(off).cloned()
    }

    /// How long the antenna has been off its target for another reason than the clocks. A unit that
    /// follows its own clock obeys, and this computer's clock may be the wrong one.
    pub(super) fn unexplained(&self) -> OffTarget {
        self.unexplained
    }

    /// Takes the pointing error outside the beam, and the one for which a pass is given up; `None` where
    /// it is less.
    fn take_off(
        &mut self,
        off: Option<Angle>,
        is_on_target: bool,
        unexplained: Option<Angle>,
        slew: Duration,
        at: Instant,
    ) {
        self.was_on_target |= is_on_target;
        let slew = if self.was_on_target { Duration::ZERO } else { slew };
        let arrives = *self.arrives.get_or_insert(at + slew);
        let counts = self.was_on_target || at >= arrives;
        self.off_target.take(off.filter(|_| counts), at);
        self.unexplained.take(unexplained.filter(|_| counts), at);
    }

    /// Direction of the satellite at the time of the unit's clock; `None` if that is not known.
    fn by_unit_clock(&self, unit: &OnBoard, meant: TrackOffsets, at: Timestamp) -> Option<AzEl> {
        let ahead_s = unit.clock.filter(|clock| clock.is_set)?.surely_ahead_s();
        meant.demanded(add_seconds(at, ahead_s), |at| self.judge.direction(at))
    }

    /// Judges again if the unit reports something else.
    fn judge_again(&mut self, unit: &OnBoard, holds_target: bool) {
        let same_clock = match (unit.clock, self.found_by.clock) {
            (Some(now), Some(then)) => {
                let changes_s =
                    [now.ahead_s - then.ahead_s, now.surely_ahead_s() - then.surely_ahead_s()];
                changes_s.iter().all(|change_s| change_s.abs() < SAME_CLOCK_S)
            }
            (now, then) => now.is_some() == then.is_some(),
        };
        let with_clock = OnBoard { clock: self.found_by.clock, ..unit.clone() };
        let is_same = same_clock && with_clock == self.found_by;
        if is_same && holds_target == self.holds_target {
            return;
        }
        self.holds_target = holds_target;
        self.found = Arc::new(self.judge.supervise(unit, holds_target));
        self.found_by = unit.clone();
    }

    /// The reason not to start the unit on the pass.
    fn objection(&self) -> Option<Event> {
        self.would_miss().filter(|_| !self.judge.pass().is_agreed)
    }

    /// The event for a unit that would not point, or does not point, at the satellite.
    pub(super) fn would_miss(&self) -> Option<Event> {
        let name = self.judge.pass().target.name.clone();
        let missed = (!self.found.is_within_beam).then(|| Arc::clone(&self.found));
        missed.map(|found| Event::WouldMiss { name, found })
    }
}

impl Session {
    /// Checks a pass before the unit is started on it, and finds the way to where it begins if the
    /// antenna has to be taken there. Returns `None` until the path is judged. The error is the event
    /// to report.
    pub(super) fn examine_pass(
        &mut self,
        pass: OnBoardPass,
        now: Moment,
    ) -> Result<Option<(Watch, Option<Slew>)>, Event> {
        let name = pass.target.name.clone();
        let judge = Judge::new(pass, self.setup.ability)
            .map_err(|error| Event::CannotProgramTrack(name, TrackProblem::Orbit(error)))?;
        // Azel takes back the offsets of another track before this one begins.
        let watch = Watch::new(Arc::new(judge), &self.plain_unit());
        if let Some(event) = watch.objection() {
            return Err(event);
        }
        let unit = self.gate.state().on_board.clone();
        if !self.is_judged(&watch.judge, &[unit]) {
            return Ok(None);
        }
        let to = match self.gate.way_to_pass(&watch.judge, now) {
            Ok(to) => to,
            Err(NoRoute::Refused(refusal)) => return Err(Event::NotSent(refusal)),
            Err(NoRoute::Open(question)) => {
                self.look_for(question);
                return Ok(None);
            }
        };
        let slew = to.map(|to| self.slew(to, Intent::Track, now)).transpose();
        Ok(Some((watch, slew.map_err(Event::NotSent)?)))
    }

    /// The objection to the pass now that the unit holds it and has been read again.
    pub(super) fn objection_to_pass(&mut self) -> Option<Event> {
        let watch = &mut self.activity.on_board_mut()?.watch;
        watch.judge_again(&self.gate.state().on_board, true);
        watch.objection()
    }

    /// Returns the pass that the unit would track on its own from now on.
    pub(super) fn held(&self, now: Moment) -> Held {
        let unit = &self.gate.state().on_board;
        let Some(satellite) = &unit.satellite else { return Held::Unread };
        if satellite.catalog_number == 0 {
            return Held::Nothing;
        }
        let (Some(clock), Some((start, stop))) = (unit.clock, unit.window) else {
            return Held::Unread;
        };
        let own_now = add_seconds(now.utc, clock.ahead_s);
        if own_now >= stop {
            return Held::Nothing;
        }
        let start = start.max(own_now);
        let span_s = seconds_between(start, stop);
        if span_s > LONGEST_WINDOW_S as f64 {
            return Held::TooLong { hours: span_s / 3600.0 };
        }
        let from_now_on = OnBoard { window: Some((start, stop)), ..unit.clone() };
        let orbit = self.wires.orbit.borrow().clone();
        let pass = orbit.and_then(|orbit| orbit.pass_of(&from_now_on));
        let judge = pass.and_then(|pass| Judge::new(pass, self.setup.ability).ok());
        judge.map_or_else(
            || Held::Unknown { name: satellite.name.clone() },
            |judge| Held::Pass(Arc::new(judge)),
        )
    }

    /// The watch over the on-board track, whoever asked for it.
    pub(super) fn on_board_watch(&self) -> Option<&Watch> {
        self.activity.on_board().map(|track| &track.watch).or(self.unasked.as_ref())
    }

    /// Begins or ends the watch over a track that nobody asked for from here.
    fn watch_unasked(&mut self) {
        let state = self.gate.state();
        let is_on = !self.contact.unread && state.program.is_some_and(|program| program.enabled);
        let orbit = self
            .wires
            .orbit
            .borrow()
            .clone()
            .filter(|_| is_on && self.activity.program().is_none());
        let Some(pass) = orbit.and_then(|orbit| orbit.pass_of(&state.on_board)) else {
            self.unasked = None;
            return;
        };
        if self.unasked.as_ref().is_some_and(|watch| *watch.judge.pass() == pass) {
            return;
        }
        // Elements that describe no orbit give no direction to compare with.
        let judge = Judge::new(pass, self.setup.ability).ok();
        self.unasked = judge.map(|judge| Watch::new(Arc::new(judge), &state.on_board));
    }

    /// Returns `true` if neither axis has turned while the path of the unit, at `to` now, went on.
    fn stands_while_it_should_track(&mut self, measured: &Measured, to: AzEl, now: Moment) -> bool {
        let (figures, can) = (self.figures(), self.variant.capabilities);
        let tracks = self.gate.state().program.is_some_and(|it| it.phase == Phase::Tracking);
        let can_point = tracks && self.gate.reaches(to, now);
        let Some(track) = self.activity.on_board_mut() else { return false };
        let turned = &mut track.watch.turned;
        let known = turned.filter(|(before, _)| {
            can_point
                && figures.turned(before, measured).is_none()
                && measured.direction().is_some()
        });
        let Some((before, from)) = known else {
            *turned = Some((*measured, to));
            return false;
        };
        let shows_after = Duration::try_from_secs_f64(can.effect.shows_after_s).unwrap_or_default();
        let finest_deg = can.arrives_within_deg
            + can.effect.ignores_deg
            + 2.0 * can.standstill.resolution_deg
            + 4.0 * figures.tolerance_deg();
        let off = measured.pointing.separation(to.into());
        from.separation(to).degrees() > finest_deg
            && off.is_some_and(|off| off.degrees() > finest_deg)
            && measured.asked.saturating_duration_since(before.asked) >= shows_after
    }

    /// Checks whether the unit points where it should.
    pub(super) fn watch_on_board(&mut self, now: Moment) {
        if self.activity.on_board().is_none() {
            self.watch_unasked();
        }
        let state = self.gate.state();
        let is_on = state.program.is_some_and(|program| program.enabled);
        if !is_on || self.activity.is_pending() {
            return;
        }
        let (unit, meant, measured) = (self.plain_unit(), self.meant_offsets(), state.measured);
        // Outside the beam is an alarm; to stop the antenna, the tolerance of an arrival counts too.
        let (in_beam, on_target) = (self.in_beam(), self.on_target());
        let asked = self.activity.on_board_mut().map(|track| &mut track.watch);
        let Some(watch) = asked.or(self.unasked.as_mut()) else { return };
        watch.judge_again(&unit, true);
        let Some(measured) = measured else { return };
        let target = &watch.judge.pass().target;
        let is_up = (target.from..target.until).contains(&measured.at);
        if !is_up || watch.compared == Some(measured.received) {
            return;
        }
        watch.compared = Some(measured.received);
        let predicted = meant.demanded(measured.at, |at| watch.judge.direction(at));
        // Where this unit goes, by its own minimum elevation, clock and window.
        let own = watch.judge.start(&unit, measured.at);
        if own.is_some_and(|to| self.stands_while_it_should_track(&measured, to, now)) {
            return self.end_without_effect(None, now);
        }
        let asked = self.activity.on_board_mut().map(|track| &mut track.watch);
        let Some(watch) = asked.or(self.unasked.as_mut()) else { return };
        let off = predicted.and_then(|predicted| measured.pointing.separation(predicted.into()));
        let Some(off) = off else { return };
        // Both axes may have to turn by more than the beam.
        let slew_s = 2.0 * off.degrees() / self.setup.ability.maximum_rate_deg_s;
        let slew = Duration::try_from_secs_f64(slew_s).unwrap_or_default();
        let is_off = |off: &Angle| *off > on_target;
        let by_clock = watch.by_unit_clock(&unit, meant, measured.at);
        let by_clock = by_clock.and_then(|to| measured.pointing.separation(to.into()));
        let is_explained = by_clock.is_some_and(|off| !is_off(&off));
        let unexplained = Some(off).filter(|off| is_off(off) && !is_explained);
        let outside = Some(off).filter(|off| *off > in_beam);
        watch.take_off(outside, !is_off(&off), unexplained, slew, now.steady);
    }
}
