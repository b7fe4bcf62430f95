//! State machine for the next step of an antenna's automatic operation. It has no clock, links or
//! schedule.

use std::mem;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::{
        automatic::{
            Attempt, Doing, GivenUp, Interruption, NotReady, OffBecause, On, Operation, Taking,
        },
        passes::PassListKey,
    },
    plan::Loss,
};

/// Number of failed passes in a row that switches automatic operation off.
const FAILURES: u8 = 2;
/// Max number of requests without effect before Azel gives a pass up.
const REQUESTS: u8 = 2;
/// Min remaining time of a pass for automatic operation to begin the pass, seconds.
const WORTH_S: f64 = 10.0;
/// Max difference in AOS of the same pass in two schedules, seconds.
const SAME_AOS_S: f64 = 60.0;
/// Duration of a unit's own tracking after which Azel leaves the unit to others, seconds.
const COASTS_S: f64 = 5.0;
/// Time before a pass at which an antenna not on its way raises an alarm, seconds. Also the min
/// time between two requests for one pass.
pub(super) const LATE_S: f64 = 30.0;
/// Max time before LOS at which a unit's own tracking may end, seconds: its window has whole
/// seconds.
pub(super) const WINDOW_STEP_S: f64 = 1.0;

/// Returns `true` if the rest of the pass is skipped.
fn is_skipped(taking: &Taking) -> bool {
    taking.given_up.is_some_and(|reason| is_final(reason) || taking.requests >= REQUESTS)
}

/// Returns `false` if Azel judges the rest of the pass again.
fn is_final(reason: GivenUp) -> bool {
    match reason {
        GivenUp::Refused | GivenUp::OffTarget => true,
        // The operator may correct a clock or a setting before the pass is over.
        GivenUp::WouldMiss => false,
    }
}

/// Pass that the schedule gives to the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Duty {
    pub pass: PassListKey,
    /// First and last time that count.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// Latest time at which Azel sends the antenna to the pass.
    pub go_at: Timestamp,
    /// Seconds between `start` and `end` that count.
    pub counted_s: f64,
    /// Reason why the mount loses part of the pass.
    pub lost_at: Option<Loss>,
    /// `true` if the schedule leaves out a part before `start`, or after `end`.
    pub begins_late: bool,
    pub ends_early: bool,
}

/// Known state of the antenna at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::engine) struct Observation {
    /// `true` if the unit answers in time.
    pub(in crate::engine) is_live: bool,
    /// `true` if the unit has been silent for longer than a hiccup of the link.
    pub(in crate::engine) is_silent: bool,
    pub(in crate::engine) is_locked_out: bool,
    /// `true` if Azel can send commands: no STOP is owed and nothing else forbids them.
    pub(in crate::engine) can_be_sent: bool,
    /// Reason why the unit cannot begin a pass now.
    pub(in crate::engine) not_ready: Option<NotReady>,
    /// Satellite that the unit tracks for Azel or is on its way to.
    pub(in crate::engine) takes: Option<u32>,
    /// `true` if the satellite in `takes` is proved: the antenna tracks it or is on its way to it.
    pub(in crate::engine) is_proved: bool,
    /// `true` if the track waits for the operator after an outage.
    pub(in crate::engine) awaits_operator: bool,
    /// Satellite that the unit tracks on its own, and that Azel can take over without a motion.
    pub(in crate::engine) offers: Option<u32>,
    /// `true` if the schedule being made may give the antenna the satellite that its unit tracks.
    pub(in crate::engine) may_be_planned: bool,
    pub(in crate::engine) moves: bool,
    /// `true` if the antenna turns without a request, for example at the end of an earlier motion.
    /// Azel sends nothing until it stops.
    pub(in crate::engine) turns_unasked: bool,
    /// `true` if the unit tracks on its own, or another satellite than requested.
    pub(in crate::engine) is_moved_elsewhere: bool,
}

/// Operator's wishes for automatic operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::engine) struct Wishes {
    /// Max duration of both ways for parking between passes, seconds; `None` for no parking.
    pub(in crate::engine) parks_within_s: Option<f64>,
    pub(in crate::engine) longest_rest_s: f64,
    pub(in crate::engine) announced_for_s: f64,
    /// Last pass that automatic operation proved, in this run or the previous one. The unit may
    /// still track it on its own.
    pub(in crate::engine) pass_list_key: Option<PassListKey>,
}

/// Action of the station for automatic operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::engine) enum Act {
    Take(Duty),
    /// Take-over of a pass that the unit already tracks; nothing moves.
    TakeOver(Duty),
    Park,
}

/// Outcome of a request for a pass, as the session reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::engine) enum Outcome {
    /// The pass cannot be loaded or proved, or the unit refused it.
    Failed,
    /// The path of the unit leads into a keep-out.
    Blocked,
    /// The session ended the track because the antenna stayed off its target.
    OffTarget,
    /// The unit's clock, site or elements would make the unit miss the pass.
    WouldMiss,
}

/// Returns `true` if the operator must be alerted because another cause than the operator ended
/// automatic operation.
pub(super) fn is_alarming(reason: OffBecause) -> bool {
    use OffBecause::{Changed, Failures, NotAsLeft, Safety};
    matches!(reason, Safety | Changed | NotAsLeft | Failures)
}

/// Operations of an antenna's automatic operation. They use no clock and no link.
pub(in crate::engine) trait Operate {
    fn switched_on() -> Self;

    /// Returns the state without the time of the last motion, which changes while the antenna
    /// moves.
    fn without_motion(self) -> Self;

    /// Returns `true` while automatic operation is on and requests nothing of the antenna.
    fn is_idle(&self) -> bool;

    /// Returns the reason why the unit did not get the current pass.
    fn not_ready(&self) -> Option<NotReady>;

    /// Returns `true` if the antenna is proved to be on its way to the pass that it takes.
    fn is_proved(&self) -> bool;

    /// Switches automatic operation off, unless it is already off.
    fn switch_off(&mut self, because: OffBecause);

    fn suspend(&mut self, interruption: Interruption, now: Timestamp);

    /// Resumes after a suspension, for the operator.
    fn go_on(&mut self, now: Timestamp);

    /// Handles the outcome of the request for the current pass.
    fn take_outcome(&mut self, outcome: Outcome);

    /// Handles a motion that the unit ended early and Azel did not. If the track had not begun, it
    /// counts as failed.
    fn ended_by_unit(&mut self, now: Timestamp);

    /// Returns the action at `now`. `duties` are in order of time; past ones are ignored.
    fn step(
        &mut self,
        duties: &[Duty],
        observation: Observation,
        wishes: Wishes,
        now: Timestamp,
    ) -> Option<Act>;
}

impl Operate for Operation {
    fn switched_on() -> Self {
        Self::On(On { doing: Doing::Rests, failures: 0, moved_at: None, moves_since: None })
    }

    fn without_motion(mut self) -> Self {
        if let Self::On(active) = &mut self {
            active.moved_at = None;
        }
        self
    }

    fn is_idle(&self) -> bool {
        matches!(self, Self::On(On { doing: Doing::Rests | Doing::Parks, .. }))
    }

    fn not_ready(&self) -> Option<NotReady> {
        let given_up = self.taking()?.given_up?;
        (given_up == GivenUp::WouldMiss).then_some(NotReady::WouldMiss)
    }

    fn is_proved(&self) -> bool {
        self.taking().is_some_and(|taking| taking.proved_at.is_some())
    }

    fn switch_off(&mut self, because: OffBecause) {
        if !matches!(self, Self::Off(_)) || because == OffBecause::Operator {
            *self = Self::Off(because);
        }
    }

    fn suspend(&mut self, interruption: Interruption, now: Timestamp) {
        if self.is_on() {
            *self = Self::Suspended { interruption, start: now };
        }
    }

    fn go_on(&mut self, now: Timestamp) {
        if matches!(self, Self::Suspended { .. }) {
            *self = Self::switched_on();
            // The operator has just acted, so the next motion needs no announcement.
            if let Self::On(active) = self {
                active.moved_at = Some(now);
            }
        }
    }

    fn take_outcome(&mut self, outcome: Outcome) {
        let Self::On(active) = self else { return };
        let Doing::Takes(taking) = &mut active.doing else { return };
        if is_skipped(taking) {
            return;
        }
        match outcome {
            Outcome::Failed => {
                taking.given_up = Some(GivenUp::Refused);
                active.failures += 1;
                end_after_failures(self);
            }
            // A blocked path does not affect the next pass.
            Outcome::Blocked => taking.given_up = Some(GivenUp::Refused),
            // The antenna must be proved still before the next pass.
            Outcome::OffTarget => taking.given_up = Some(GivenUp::OffTarget),
            // The unit may be able to take the rest of the pass, or the next pass.
            Outcome::WouldMiss => {
                if taking.given_up.is_none() {
                    // From here on, count only attempts that have begun.
                    taking.requests = 0;
                }
                if taking.attempt == Attempt::Begun {
                    taking.attempt = Attempt::Objected;
                }
                (taking.given_up, taking.proved_at) = (Some(GivenUp::WouldMiss), None);
            }
        }
    }

    fn ended_by_unit(&mut self, now: Timestamp) {
        let Self::On(active) = self else { return };
        match &active.doing {
            Doing::Takes(taking) if is_skipped(taking) => {}
            Doing::Rests | Doing::Announces { .. } => {}
            Doing::Takes(Taking { proved_at: None, .. }) => self.take_outcome(Outcome::Failed),
            Doing::Takes(_) | Doing::Parks => self.suspend(Interruption::EndedByUnit, now),
        }
    }

    fn step(
        &mut self,
        duties: &[Duty],
        observation: Observation,
        wishes: Wishes,
        now: Timestamp,
    ) -> Option<Act> {
        if observation.is_locked_out {
            self.switch_off(OffBecause::LockedOut);
        }
        let Self::On(active) = self else { return None };
        see(active, observation, now);
        if let Some(duty) = found_at_work(active, duties, observation, wishes, now) {
            take(active, duty, 1, now);
            return Some(Act::TakeOver(duty));
        }
        if observation.is_moved_elsewhere {
            if is_moved_for_long(active, now) && !observation.may_be_planned {
                self.suspend(Interruption::Elsewhere, now);
            }
            return None;
        }
        if observation.turns_unasked {
            return None;
        }
        let act = step(active, duties, observation, wishes, now);
        end_after_failures(self);
        act
    }
}

/// Updates the activity.
fn see(active: &mut On, observation: Observation, now: Timestamp) {
    forget_the_future(active, now);
    if !observation.is_moved_elsewhere {
        active.moves_since = None;
    } else if active.moves_since.is_none() {
        active.moves_since = Some(now);
    }
    if let Doing::Takes(taking) = &mut active.doing {
        if observation.takes == Some(taking.pass.0) && observation.is_live {
            if observation.moves {
                active.moved_at = Some(now);
            }
            if taking.attempt == Attempt::NotBegun {
                taking.attempt = Attempt::Begun;
            }
            if observation.is_proved && taking.proved_at.is_none() {
                taking.proved_at = Some(now);
                taking.requests = 0;
                taking.given_up = taking.given_up.filter(|given_up| is_final(*given_up));
            }
        }
        if now >= taking.end {
            // A track from Azel counts as proved before the unit has answered.
            if taking.proved_at.is_some() && taking.given_up.is_none() {
                active.failures = 0;
            }
            active.doing = Doing::Rests;
        }
    }
}

/// Removes times after `now`, which come from before the clock was set back.
fn forget_the_future(active: &mut On, now: Timestamp) {
    active.moved_at = active.moved_at.filter(|time| *time <= now);
    active.moves_since = active.moves_since.filter(|start| *start <= now);
    if matches!(&active.doing, Doing::Takes(taking) if taking.asked_at > now) {
        active.doing = Doing::Rests;
    }
}

/// Returns the scheduled pass that the unit tracks on its own, as automatic operation left it.
fn found_at_work(
    active: &On,
    duties: &[Duty],
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) -> Option<Duty> {
    let is_free = !matches!(active.doing, Doing::Takes(_)) && observation.can_be_sent;
    let held_pass = wishes
        .pass_list_key
        .filter(|held_pass| is_free && observation.offers == Some(held_pass.0))?;
    let is_it = |duty: &&Duty| is_same_pass(duty.pass, held_pass) && now < duty.end;
    duties.iter().find(is_it).copied()
}

fn is_moved_for_long(active: &On, now: Timestamp) -> bool {
    active.moves_since.is_some_and(|start| seconds_between(start, now) >= COASTS_S)
}

/// Returns the time since the last motion, seconds.
fn rest_s(active: &On, now: Timestamp) -> f64 {
    active.moved_at.map_or(f64::INFINITY, |time| seconds_between(time, now))
}

fn step(
    active: &mut On,
    duties: &[Duty],
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) -> Option<Act> {
    if let Doing::Takes(taking) = &active.doing {
        return again(active, *taking, duties, observation, wishes, now);
    }
    let left = |duty: &&Duty| seconds_between(now, duty.end) > WORTH_S;
    let next = duties.iter().find(left).copied();
    let Some(duty) = next else {
        if matches!(active.doing, Doing::Announces { .. }) {
            active.doing = Doing::Rests;
        }
        return park(active, None, observation, wishes, now);
    };
    // The operator already has Azel tracking this pass.
    if observation.is_live && observation.takes == Some(duty.pass.0) && now >= duty.go_at {
        take(active, duty, 1, now);
        return None;
    }
    keep_announcement(active, duty, observation, wishes, now);
    let is_announced = rest_s(active, now) >= wishes.longest_rest_s;
    let lead_s = if is_announced { wishes.announced_for_s } else { 0.0 };
    if seconds_between(now, duty.go_at) > lead_s {
        return park(active, Some(duty), observation, wishes, now);
    }
    let can_be_made =
        observation.is_live && observation.can_be_sent && observation.not_ready.is_none();
    match &active.doing {
        Doing::Announces { moves_at, pass } if is_same_pass(*pass, duty.pass) => {
            let is_over = now >= *moves_at;
            is_over.then_some(())?;
        }
        Doing::Rests | Doing::Announces { .. } | Doing::Parks | Doing::Takes(_) => {
            if is_announced && can_be_made {
                let moves_at = add_seconds(now, wishes.announced_for_s);
                active.doing = Doing::Announces { moves_at, pass: duty.pass };
            }
            if is_announced {
                return None;
            }
        }
    }
    can_be_made.then(|| {
        take(active, duty, 1, now);
        Act::Take(duty)
    })
}

/// Withdraws an announcement whose motion is no longer next or no longer possible. A single late
/// reply does not withdraw it: frequent ones would restart the warning without end.
fn keep_announcement(
    active: &mut On,
    next: Duty,
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) {
    let Doing::Announces { pass, .. } = &active.doing else { return };
    let is_near = seconds_between(now, next.go_at) <= wishes.announced_for_s;
    let is_it = is_same_pass(*pass, next.pass) && is_near;
    if !is_it
        || observation.is_silent
        || !observation.can_be_sent
        || observation.not_ready.is_some()
    {
        active.doing = Doing::Rests;
    }
}

fn take(active: &mut On, duty: Duty, requests: u8, now: Timestamp) {
    let Duty { pass, start, end, .. } = duty;
    active.moved_at = Some(now);
    active.doing = Doing::Takes(Taking {
        pass,
        start,
        end,
        asked_at: now,
        requests,
        attempt: Attempt::NotBegun,
        proved_at: None,
        given_up: None,
    });
}

/// Requests a pass again that an outage interrupted, once the unit answers and is idle. Gives the
/// pass up after [`REQUESTS`] attempts.
fn again(
    active: &mut On,
    taking: Taking,
    duties: &[Duty],
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) -> Option<Act> {
    let is_asked = seconds_between(taking.asked_at, now) < LATE_S;
    let is_idle = observation.takes != Some(taking.pass.0) && !observation.moves;
    // Somebody may be repairing the unit: announce its next motion.
    if observation.not_ready.is_some() && is_idle && !is_skipped(&taking) {
        (active.doing, active.moved_at) = (Doing::Rests, None);
        return None;
    }
    let is_ready = observation.is_live && observation.can_be_sent;
    if is_skipped(&taking) || is_asked || !is_idle || !is_ready {
        return None;
    }
    let duty = duties.iter().find(|duty| is_same_pass(duty.pass, taking.pass))?;
    if taking.given_up.is_some() {
        return judge_again(active, *duty, wishes, now);
    }
    if taking.requests >= REQUESTS {
        if let Doing::Takes(taking) = &mut active.doing {
            taking.given_up = Some(GivenUp::Refused);
        }
        active.failures += 1;
        return None;
    }
    let is_worth_it = seconds_between(now, duty.end) > WORTH_S;
    is_worth_it.then(|| {
        take(active, *duty, taking.requests + 1, now);
        Act::Take(*duty)
    })
}

/// Requests a pass again that the unit would have missed. The session judges the rest of the pass.
fn judge_again(active: &mut On, duty: Duty, wishes: Wishes, now: Timestamp) -> Option<Act> {
    let is_announced = rest_s(active, now) >= wishes.longest_rest_s;
    let Doing::Takes(taking) = &mut active.doing else { return None };
    if seconds_between(now, duty.end) <= WORTH_S {
        return None;
    }
    let attempt = mem::replace(&mut taking.attempt, Attempt::NotBegun);
    if attempt != Attempt::NotBegun {
        taking.requests += 1;
    }
    if taking.requests >= REQUESTS {
        if attempt == Attempt::Begun {
            taking.given_up = Some(GivenUp::Refused);
            active.failures += 1;
        }
        return None;
    }
    // The unit may have been corrected and would now move: announce the motion.
    if is_announced {
        (active.doing, active.moved_at) = (Doing::Rests, None);
        return None;
    }
    // Keep the reason, and with it the alarm, until the unit is proved to take the pass.
    taking.asked_at = now;
    Some(Act::Take(duty))
}

/// Parks until the next pass if there is time for both ways.
fn park(
    active: &mut On,
    next: Option<Duty>,
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) -> Option<Act> {
    let park_s = wishes.parks_within_s?;
    let has_time = next.is_none_or(|duty| seconds_between(now, duty.go_at) > park_s);
    // After a rest or before its first pass, the antenna stays: Azel does not announce parking.
    let is_awake =
        active.moved_at.is_some_and(|time| seconds_between(time, now) < wishes.longest_rest_s);
    let is_due = matches!(active.doing, Doing::Rests) && is_awake;
    if !has_time || !is_due || !observation.is_live || !observation.can_be_sent || observation.moves
    {
        return None;
    }
    active.doing = Doing::Parks;
    active.moved_at = Some(now);
    Some(Act::Park)
}

fn end_after_failures(operation: &mut Operation) {
    if matches!(operation, Operation::On(On { failures: FAILURES.., .. })) {
        *operation = Operation::Off(OffBecause::Failures);
    }
}

/// Returns `true` if both are the same pass: newer elements move its AOS a little.
pub(in crate::engine) fn is_same_pass(one: PassListKey, other: PassListKey) -> bool {
    one.0 == other.0 && seconds_between(one.1, other.1).abs() < SAME_AOS_S
}

#[cfg(test)]
mod tests;
