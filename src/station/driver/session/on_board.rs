//! Watch over an on-board track: by the unit's reports before the start, and by the measured
//! positions while it runs.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;

use super::{off_target::OffTarget, standstill::Figures};
use crate::{
    astro::{Angle, AzEl, TrackOffsets, time::add_seconds},
    clock::Instant,
    contract::driver::{Event, OnBoardView},
    device::{Capabilities, Measured, OnBoard},
    plan::{
        OnBoardPass, Supervision,
        on_board::{Judge, Ranked},
    },
};

/// Max ignored difference of the unit's clock, seconds, because the link delays its reports.
const SAME_CLOCK_S: f64 = 0.2;

/// Max pointing errors of a working antenna, and its fastest rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointingLimits {
    /// Max error within the beam; a larger one raises an alarm.
    pub(super) in_beam: Angle,
    /// Max error on target, including the arrival tolerance; a larger one stops the antenna.
    pub(super) on_target: Angle,
    pub(super) max_rate_deg_s: f64,
}

pub(super) struct OnBoardWatch {
    judge: Arc<Judge>,
    found: Arc<Supervision>,
    found_by: OnBoard,
    /// `true` if the unit has the target.
    holds_target: bool,
    /// Receive time of the last compared position.
    compared: Option<Instant>,
    was_on_target: bool,
    /// Latest expected arrival on the satellite.
    arrives: Option<Instant>,
    off_target: OffTarget,
    /// Error by this computer's clock that a deviation of the unit's clock does not explain.
    unexplained: OffTarget,
    /// Position at the last turn of the axes, and the satellite's direction at that time.
    turned: Option<(Measured, AzEl)>,
}

impl OnBoardWatch {
    pub(super) fn new(judge: Arc<Judge>, unit: &OnBoard) -> Self {
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

    /// Returns the cause of `error`, found in the unit's reports.
    pub(super) fn cause(&self, error: Angle) -> Option<Ranked> {
        self.found.cause_of(error).cloned()
    }

    /// Returns the pointing error that the clocks do not explain, with its duration. A unit that
    /// follows its own clock obeys, and this computer's clock may be wrong.
    pub(super) fn unexplained(&self) -> OffTarget {
        self.unexplained
    }

    /// Takes the pointing error outside the beam, and the error for which Azel gives up a pass;
    /// `None` for a smaller error.
    fn take_error(
        &mut self,
        error: Option<Angle>,
        is_on_target: bool,
        unexplained: Option<Angle>,
        slew: Duration,
        time: Instant,
    ) {
        self.was_on_target |= is_on_target;
        // Before its first arrival on target, the antenna may still be on its way.
        let slew = if self.was_on_target { Duration::ZERO } else { slew };
        let arrives = *self.arrives.get_or_insert(time + slew);
        let counts = self.was_on_target || time >= arrives;
        self.off_target.take(error.filter(|_| counts), time);
        self.unexplained.take(unexplained.filter(|_| counts), time);
    }

    /// Returns the direction of the satellite by the unit's clock; `None` without a known time.
    fn unit_clock_direction(
        &self,
        unit: &OnBoard,
        offsets: TrackOffsets,
        time: Timestamp,
    ) -> Option<AzEl> {
        let ahead_s = unit.clock.filter(|clock| clock.is_set)?.surely_ahead_s();
        offsets.demanded(add_seconds(time, ahead_s), |time| self.judge.direction(time))
    }

    /// Judges the pass again if the unit's report has changed.
    pub(super) fn judge_again(&mut self, unit: &OnBoard, holds_target: bool) {
        let same_clock = match (unit.clock, self.found_by.clock) {
            (Some(now), Some(last)) => {
                let changes_s =
                    [now.ahead_s - last.ahead_s, now.surely_ahead_s() - last.surely_ahead_s()];
                changes_s.iter().all(|change_s| change_s.abs() < SAME_CLOCK_S)
            }
            (now, last) => now.is_some() == last.is_some(),
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

    /// Returns the reason not to start the unit on the pass.
    pub(super) fn objection(&self) -> Option<Event> {
        self.would_miss().filter(|_| !self.judge.pass().is_agreed)
    }

    pub(super) fn is_over_pass(&self, pass: &OnBoardPass) -> bool {
        self.judge.pass() == pass
    }

    /// Returns `true` once for each position, while the satellite is up.
    pub(super) fn is_due(&mut self, measured: &Measured) -> bool {
        let target = &self.judge.pass().target;
        let is_up = (target.start..target.end).contains(&measured.time);
        is_up && self.compared.replace(measured.received) != Some(measured.received)
    }

    /// Returns `true` if neither axis has turned while the path of the unit, now at `target`,
    /// continued. `can_point`: the unit tracks, and the antenna reaches `target`.
    pub(super) fn stands_still(
        &mut self,
        measured: &Measured,
        target: AzEl,
        can_point: bool,
        figures: Figures,
        can: Capabilities,
    ) -> bool {
        let resting = self.turned.filter(|(before, _)| {
            can_point
                && figures.largest_turn(before, measured).is_none()
                && measured.direction().is_some()
        });
        let Some((before, start)) = resting else {
            self.turned = Some((*measured, target));
            return false;
        };
        let shows_after = Duration::try_from_secs_f64(can.effect.shows_after_s).unwrap_or_default();
        let finest_deg = can.arrives_within_deg
            + can.effect.ignores_deg
            + 2.0 * can.standstill.resolution_deg
            + 4.0 * figures.tolerance_deg();
        let error = measured.pointing.separation(target.into());
        start.separation(target).degrees() > finest_deg
            && error.is_some_and(|error| error.degrees() > finest_deg)
            && measured.requested.saturating_duration_since(before.requested) >= shows_after
    }

    /// Compares a position with the satellite at the desired `offsets`.
    pub(super) fn compare(
        &mut self,
        measured: &Measured,
        unit: &OnBoard,
        offsets: TrackOffsets,
        limits: PointingLimits,
        now: Instant,
    ) {
        let predicted = offsets.demanded(measured.time, |time| self.judge.direction(time));
        let error = predicted.and_then(|predicted| measured.pointing.separation(predicted.into()));
        let Some(error) = error else { return };
        // Both axes may have to turn by more than the beam.
        let slew_s = 2.0 * error.degrees() / limits.max_rate_deg_s;
        let slew = Duration::try_from_secs_f64(slew_s).unwrap_or_default();
        let is_off = |error: &Angle| *error > limits.on_target;
        let by_clock = self.unit_clock_direction(unit, offsets, measured.time);
        let by_clock =
            by_clock.and_then(|direction| measured.pointing.separation(direction.into()));
        let is_explained = by_clock.is_some_and(|error| !is_off(&error));
        let unexplained = Some(error).filter(|error| is_off(error) && !is_explained);
        let outside = Some(error).filter(|error| *error > limits.in_beam);
        self.take_error(outside, !is_off(&error), unexplained, slew, now);
    }

    /// Returns the event for a unit that would miss or misses the satellite.
    pub(super) fn would_miss(&self) -> Option<Event> {
        let name = self.judge.pass().target.name.clone();
        let missed = (!self.found.is_within_beam).then(|| Arc::clone(&self.found));
        missed.map(|found| Event::WouldMiss { name, found })
    }
}
