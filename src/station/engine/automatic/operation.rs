//! Next step of automatic operation of one antenna: a state machine without clock, links or
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

/// Automatic operation switches itself off after this many failed passes in a row.
const FAILURES: u8 = 2;
/// A pass is given up after this many requests without effect.
const REQUESTS: u8 = 2;
/// Automatic operation does not begin a pass with less than this left, seconds.
const WORTH_S: f64 = 10.0;
/// Largest difference in AOS of one pass between two schedules, seconds.
const SAME_AOS_S: f64 = 60.0;
/// A unit that tracks unasked is left to whoever did it after this time, seconds.
const COASTS_S: f64 = 5.0;
/// An antenna that is not on its way this many seconds before its pass raises an alarm. Also the
/// least time between two requests for one pass.
pub(super) const LATE_S: f64 = 30.0;
/// Time before LOS at which a unit that tracks on its own may end: its window has whole seconds.
pub(super) const WINDOW_STEP_S: f64 = 1.0;

/// Returns `true` if the rest of the pass is skipped.
fn is_skipped(taking: &Taking) -> bool {
    taking.given_up.is_some_and(|reason| is_final(reason) || taking.requests >= REQUESTS)
}

/// Returns `false` if Azel judges the rest of the pass again.
fn is_final(reason: GivenUp) -> bool {
    match reason {
        GivenUp::Refused | GivenUp::OffTarget => true,
        // A clock or a setting may be corrected before the pass is over.
        GivenUp::WouldMiss => false,
    }
}

/// A pass that the schedule gives to the antenna.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Duty {
    pub pass: PassListKey,
    /// First and last moment that count.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// When the antenna is sent there, at the latest.
    pub go_at: Timestamp,
    /// Seconds between them that count.
    pub counted_s: f64,
    /// Where the mount loses some of the pass.
    pub lost_at: Option<Loss>,
    /// A part of the pass is left out before `start`, or after `end`.
    pub begins_late: bool,
    pub ends_early: bool,
}

/// State of the antenna at one moment, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::engine) struct Observation {
    /// The unit answers in time.
    pub(in crate::engine) is_live: bool,
    /// No reply has come for longer than a hiccup of the link lasts.
    pub(in crate::engine) is_silent: bool,
    pub(in crate::engine) is_locked_out: bool,
    /// Commands can be sent: no STOP is owed and nothing else forbids them.
    pub(in crate::engine) can_be_sent: bool,
    /// Reason why the unit cannot begin a pass now.
    pub(in crate::engine) not_ready: Option<NotReady>,
    /// The satellite that it tracks from here or is on its way to.
    pub(in crate::engine) takes: Option<u32>,
    /// The satellite in `takes` is proved: the antenna tracks it or is on its way to it.
    pub(in crate::engine) is_proved: bool,
    /// After an outage it waits for the operator's word to track on.
    pub(in crate::engine) awaits_operator: bool,
    /// Satellite that the unit tracks on its own, and that can be taken over without a motion.
    pub(in crate::engine) offers: Option<u32>,
    /// The schedule that is being made may give the antenna what its unit tracks.
    pub(in crate::engine) may_be_planned: bool,
    pub(in crate::engine) moves: bool,
    /// It turns, and nothing is asked of it: it may end an earlier motion. Until it stands, nothing is
    /// sent.
    pub(in crate::engine) turns_unasked: bool,
    /// Its unit tracks on its own, or another satellite than it was asked to.
    pub(in crate::engine) is_moved_elsewhere: bool,
}

/// How the operator wants it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::engine) struct Wishes {
    /// Parks between passes where the time allows; `None` where it does not park. Seconds that
    /// both ways take at most.
    pub(in crate::engine) parks_within_s: Option<f64>,
    pub(in crate::engine) longest_rest_s: f64,
    pub(in crate::engine) announced_for_s: f64,
    /// The pass that automatic operation proved last, in this run or the one before: the unit may
    /// go on with it on its own.
    pub(in crate::engine) pass_list_key: Option<PassListKey>,
}

/// Action of the station for automatic operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::engine) enum Act {
    Take(Duty),
    /// The unit tracks the pass already, and nothing moves.
    TakeOver(Duty),
    Park,
}

/// Outcome of a request for a pass, as the session reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::engine) enum Outcome {
    /// The pass cannot be loaded or proved, or the unit refused it.
    Failed,
    /// The path of the unit leads into a barrier.
    Blocked,
    /// The session ended the track, because the antenna stayed off its target.
    OffTarget,
    /// The unit's clock, site or elements would make it miss the pass.
    WouldMiss,
}

/// Returns `true` if the operator must be alerted, because somebody or something else ended it.
pub(super) fn is_alarming(reason: OffBecause) -> bool {
    use OffBecause::{Changed, Failures, NotAsLeft, Safety};
    matches!(reason, Safety | Changed | NotAsLeft | Failures)
}

/// Carries on automatic operation of an antenna. Nothing here has a clock or a link.
pub(in crate::engine) trait Operate {
    fn switched_on() -> Self;

    /// Without the time that goes on for as long as the antenna moves.
    fn without_motion(self) -> Self;

    /// Returns `true` while it is on and asks nothing of the antenna.
    fn is_idle(&self) -> bool;

    /// Returns why the unit was not given the current pass.
    fn not_ready(&self) -> Option<NotReady>;

    /// Returns `true` if the antenna is proved to be on its way to the pass that it takes.
    fn is_proved(&self) -> bool;

    /// Ends it, unless it is off.
    fn switch_off(&mut self, because: OffBecause);

    fn suspend(&mut self, interruption: Interruption, now: Timestamp);

    /// The operator lets it go on.
    fn go_on(&mut self, now: Timestamp);

    /// Takes the outcome of the request for the present pass.
    fn take_outcome(&mut self, outcome: Outcome);

    /// The unit ended a motion before its end, and Azel had not. A unit that has not begun its track
    /// yet has failed to.
    fn ended_by_unit(&mut self, now: Timestamp);

    /// Returns the action for `now`. `duties` are in the order of time; those that are over are
    /// ignored.
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
            // The operator is there, and has just said it.
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
            // A blocked path says nothing about the next pass.
            Outcome::Blocked => taking.given_up = Some(GivenUp::Refused),
            // The antenna must be proved still before the next pass.
            Outcome::OffTarget => taking.given_up = Some(GivenUp::OffTarget),
            // The unit may be able to take the rest, or the next pass.
            Outcome::WouldMiss => {
                if taking.given_up.is_none() {
                    // From now on only attempts that have begun count.
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

/// Brings the activity up to date.
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
            // A track from here counts as proved before the unit has answered to it.
            if taking.proved_at.is_some() && taking.given_up.is_none() {
                active.failures = 0;
            }
            active.doing = Doing::Rests;
        }
    }
}

/// Drops times of the old clock after it was set back.
fn forget_the_future(active: &mut On, now: Timestamp) {
    active.moved_at = active.moved_at.filter(|time| *time <= now);
    active.moves_since = active.moves_since.filter(|start| *start <= now);
    if matches!(&active.doing, Doing::Takes(taking) if taking.asked_at > now) {
        active.doing = Doing::Rests;
    }
}

/// The pass of the schedule that the unit tracks on its own, as automatic operation left it.
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

/// Seconds since the last motion.
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
    // The operator has it tracked already, from here.
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

/// An announcement stands only while its motion can be made and is still the next. One late reply
/// does not end it: with frequent ones, the warning would begin again for ever.
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

/// A pass that an outage took away is asked for again once the unit answers and does nothing,
/// and given up if that leads to nothing.
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
    // Somebody may stand beside the unit to repair it: announce its next motion.
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

/// Asks again for a pass that the unit would have missed. The session judges what is left of it.
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
    // The unit may have been put right, so that it moves now.
    if is_announced {
        (active.doing, active.moved_at) = (Doing::Rests, None);
        return None;
    }
    // The reason stands until the unit is proved to take the pass, so that its alarm stands too.
    taking.asked_at = now;
    Some(Act::Take(duty))
}

/// Parks until the next pass, where the time is enough for both ways.
fn park(
    active: &mut On,
    next: Option<Duty>,
    observation: Observation,
    wishes: Wishes,
    now: Timestamp,
) -> Option<Act> {
    let park_s = wishes.parks_within_s?;
    let has_time = next.is_none_or(|duty| seconds_between(now, duty.go_at) > park_s);
    // After a rest, or before its first pass, it stays where it is: parking is not announced.
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

/// Returns `true` if both are one pass: newer elements move its AOS a little.
pub(in crate::engine) fn is_same_pass(one: PassListKey, other: PassListKey) -> bool {
    one.0 == other.0 && seconds_between(one.1, other.1).abs() < SAME_AOS_S
}

#[cfg(test)]
mod tests;
