//! Start and supervision of a track that the unit computes.

use std::sync::Arc;

use super::{
    Session,
    activity::Slew,
    on_board::{OnBoardWatch, PointingLimits},
};
use crate::{
    astro::{
        AzEl,
        time::{add_seconds, seconds_between},
    },
    clock::Moment,
    contract::driver::{Event, Intent, TrackProblem},
    device::{LONGEST_WINDOW_S, Measured, OnBoard, Phase},
    driver::gate::{NextPass, NoRoute},
    plan::{OnBoardPass, on_board::Judge},
};

impl Session {
    /// Checks a pass before its start, and finds the path to its start if Azel must move the
    /// antenna there. Returns `None` until the path is judged. The error is the event to report.
    pub(super) fn examine_pass(
        &mut self,
        pass: OnBoardPass,
        now: Moment,
    ) -> Result<Option<(OnBoardWatch, Option<Slew>)>, Event> {
        let name = pass.target.name.clone();
        let judge = Judge::new(pass, self.setup.ability())
            .map_err(|error| Event::CannotProgramTrack(name, TrackProblem::Orbit(error)))?;
        // Azel removes the offsets of another track before this one begins.
        let watch = OnBoardWatch::new(Arc::new(judge), &self.plain_unit());
        if let Some(event) = watch.objection() {
            return Err(event);
        }
        let unit = self.gate.state().on_board.clone();
        if !self.is_judged(watch.judge(), &[unit]) {
            return Ok(None);
        }
        let motion = match self.gate.way_to_pass(watch.judge(), now) {
            Ok(motion) => motion,
            Err(NoRoute::Refused(refusal)) => return Err(Event::NotSent(refusal)),
            Err(NoRoute::Open(question)) => {
                self.judging.look_for(question);
                return Ok(None);
            }
        };
        let slew = motion.map(|motion| self.slew(motion, Intent::Track, now)).transpose();
        Ok(Some((watch, slew.map_err(Event::NotSent)?)))
    }

    /// Returns the objection to the pass after the unit has the target and a new reading has
    /// arrived.
    pub(super) fn objection_to_pass(&mut self) -> Option<Event> {
        let watch = &mut self.commanded.activity.on_board_mut()?.watch;
        watch.judge_again(&self.gate.state().on_board, true);
        watch.objection()
    }

    /// Returns the pass that the unit would track on its own from now on.
    pub(super) fn next_pass(&self, now: Moment) -> NextPass {
        let unit = &self.gate.state().on_board;
        let Some(satellite) = &unit.satellite else { return NextPass::Unread };
        if satellite.catalog_number == 0 {
            return NextPass::Nothing;
        }
        let (Some(clock), Some((start, stop))) = (unit.clock, unit.window) else {
            return NextPass::Unread;
        };
        let own_now = add_seconds(now.utc, clock.ahead_s);
        if own_now >= stop {
            return NextPass::Nothing;
        }
        let start = start.max(own_now);
        let span_s = seconds_between(start, stop);
        if span_s > LONGEST_WINDOW_S as f64 {
            return NextPass::TooLong { hours: span_s / 3600.0 };
        }
        let from_now_on = OnBoard { window: Some((start, stop)), ..unit.clone() };
        let orbit = self.wires.orbit();
        let pass = orbit.and_then(|orbit| orbit.pass_of(&from_now_on));
        let judge = pass.and_then(|pass| Judge::new(pass, self.setup.ability()).ok());
        judge.map_or_else(
            || NextPass::Unknown { name: satellite.name.clone() },
            |judge| NextPass::Pass(Arc::new(judge)),
        )
    }

    /// Returns the watch over the on-board track, also over a track that Azel did not request.
    pub(super) fn on_board_watch(&self) -> Option<&OnBoardWatch> {
        self.commanded
            .activity
            .on_board()
            .map(|track| &track.watch)
            .or(self.observed.unasked.as_ref())
    }

    /// Starts or ends the watch over a track that Azel did not request.
    fn watch_unasked(&mut self) {
        let state = self.gate.state();
        let is_on =
            !self.contact.is_unread() && state.program.is_some_and(|program| program.enabled);
        let orbit =
            self.wires.orbit().filter(|_| is_on && self.commanded.activity.program().is_none());
        let Some(pass) = orbit.and_then(|orbit| orbit.pass_of(&state.on_board)) else {
            self.observed.unasked = None;
            return;
        };
        if self.observed.unasked.as_ref().is_some_and(|watch| watch.is_over_pass(&pass)) {
            return;
        }
        // Elements without a valid orbit give no direction for a comparison.
        let judge = Judge::new(pass, self.setup.ability()).ok();
        self.observed.unasked =
            judge.map(|judge| OnBoardWatch::new(Arc::new(judge), &state.on_board));
    }

    /// Returns `true` if the antenna stands while the path of the unit, now at `target`, continues.
    fn stands_while_it_should_track(
        &mut self,
        measured: &Measured,
        target: AzEl,
        now: Moment,
    ) -> bool {
        let (figures, can) = (self.figures(), self.setup.can());
        let program = self.gate.state().program;
        let tracks = program.is_some_and(|program| program.phase == Phase::Tracking);
        let can_point = tracks && self.gate.reaches(target, now);
        let Some(track) = self.commanded.activity.on_board_mut() else { return false };
        track.watch.stands_still(measured, target, can_point, figures, can)
    }

    /// Returns the watch over the on-board track, also over a track that Azel did not request.
    fn on_board_watch_mut(&mut self) -> Option<&mut OnBoardWatch> {
        self.commanded
            .activity
            .on_board_mut()
            .map(|track| &mut track.watch)
            .or(self.observed.unasked.as_mut())
    }

    /// Checks the direction of the unit against its track.
    pub(super) fn watch_on_board(&mut self, now: Moment) {
        if self.commanded.activity.on_board().is_none() {
            self.watch_unasked();
        }
        let state = self.gate.state();
        let is_on = state.program.is_some_and(|program| program.enabled);
        if !is_on || self.commanded.activity.is_pending() {
            return;
        }
        let (unit, offsets, measured) = (self.plain_unit(), self.desired_offsets(), state.measured);
        let figures = self.figures();
        let limits = PointingLimits {
            in_beam: self.setup.in_beam(figures),
            on_target: self.setup.on_target(figures),
            max_rate_deg_s: self.setup.ability().maximum_rate_deg_s,
        };
        let Some(watch) = self.on_board_watch_mut() else { return };
        watch.judge_again(&unit, true);
        let Some(measured) = measured else { return };
        if !watch.is_due(&measured) {
            return;
        }
        // Find the direction of this unit by its own minimum elevation, clock and window.
        let own = watch.judge().start(&unit, measured.time);
        if own.is_some_and(|target| self.stands_while_it_should_track(&measured, target, now)) {
            return self.end_without_effect(None, now);
        }
        if let Some(watch) = self.on_board_watch_mut() {
            watch.compare(&measured, &unit, offsets, limits, now.steady);
        }
    }
}
