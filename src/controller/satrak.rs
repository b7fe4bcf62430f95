//! Behaviour of a Satrak: one request outstanding, matched by its word, halts
//! past everything else.

mod changes;
mod exchange;
mod prepare;
mod record;
mod schedule;
mod settings;
mod settle;
mod state;

use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

pub use settings::{FROM_GPS, FROM_THIS_PC, GROUPS};
pub use state::{SatrakState, UnitClock};

use super::{
    AntennaState, Capabilities, Device, Extent, Happening, Moment, Motion, Moves, PrepareError,
    Question, TrackTarget, WireLine,
    settings::{Change, Group, SettleError, SettleStep},
    wire::WireQueue,
};
use crate::{
    protocol::satrak::{Decoder, Halt, Query, Request},
    station::PollRates,
};
use exchange::{Outstanding, Purpose, unit_motion};
use prepare::Preparation;
use schedule::Schedule;
use settings::Plan;
use settle::Settling;

/// No answer within this is none.
const REPLY: Duration = Duration::from_secs(2);
/// No answer to a setting within this is none, where the unit has to fetch or
/// read a file for it.
const SLOW_REPLY: Duration = Duration::from_secs(15);
/// After a question had to be repeated, the answers to both may come. Nothing
/// is asked until the surplus one must have come, or every later answer would
/// be taken for the one after it.
const DRAIN: Duration = Duration::from_secs(1);

/// A Satrak, seen from the near end of its link.
#[derive(Debug)]
pub struct Satrak {
    rates: PollRates,
    element_file: String,
    decoder: Decoder,
    state: AntennaState,
    schedule: Option<Schedule>,
    outstanding: Option<Outstanding>,
    drain_until: Option<Instant>,
    /// When tracking or auto-track was last switched on by us.
    program_switched_on: Option<Instant>,
    /// Halts that were sent past the queue and not answered yet.
    halts: VecDeque<(Halt, Instant)>,
    motions: VecDeque<Motion>,
    calm: VecDeque<Halt>,
    preparation: Option<Preparation>,
    /// Questions that the operator wants answered.
    wanted: VecDeque<Query>,
    /// The change that is under way.
    settling: Option<Settling>,
    /// Changes that wait for it to be over.
    changes: VecDeque<Change>,
    /// A setting that takes the unit long; other questions go on meanwhile.
    slow: Option<Outstanding>,
    happenings: VecDeque<Happening>,
    wire: WireQueue,
    /// Something with a header has come over this link.
    has_heard_frame: bool,
}

impl Satrak {
    /// A unit that is asked at `rates`. Satellites are chosen from
    /// `element_file` on the unit; empty for the file that it uses already.
    /// Silent until the link is up.
    pub fn new(rates: PollRates, element_file: String) -> Self {
        Self {
            rates,
            element_file,
            decoder: Decoder::new(),
            state: AntennaState::default(),
            schedule: None,
            outstanding: None,
            drain_until: None,
            program_switched_on: None,
            halts: VecDeque::new(),
            motions: VecDeque::new(),
            calm: VecDeque::new(),
            preparation: None,
            wanted: VecDeque::new(),
            settling: None,
            changes: VecDeque::new(),
            slow: None,
            happenings: VecDeque::new(),
            wire: WireQueue::default(),
            has_heard_frame: false,
        }
    }

    fn moving(&self) -> bool {
        self.state.measured.is_some_and(|measured| measured.moving())
            || self.state.program.is_some_and(|program| program.enabled)
            || !self.halts.is_empty()
    }

    fn motion_waits(&self) -> bool {
        !self.motions.is_empty() || self.outstanding.as_ref().is_some_and(Outstanding::is_motion)
    }

    /// The tracking program is on, or may be: nothing was read since it was
    /// switched on.
    fn program_may_run(&self) -> bool {
        let switched_on = self
            .program_switched_on
            .is_some_and(|at| self.state.measured.is_none_or(|measured| measured.asked <= at));
        switched_on || self.state.program.is_none_or(|program| program.enabled)
    }

    /// What is to be sent next, the most urgent first.
    fn next_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        if let Some(motion) = self.motions.pop_front() {
            if matches!(motion, Motion::StartProgram | Motion::EnableAuto) {
                self.program_switched_on = Some(now.steady);
            }
            return match unit_motion(motion) {
                Ok(request) => Some((Request::Motion(request), Purpose::Motion(motion))),
                Err(error) => {
                    self.happenings.push_back(Happening::Refused(motion, error.to_string()));
                    None
                }
            };
        }
        if let Some(halt) = self.calm.pop_front() {
            return Some((Request::Halt(halt), Purpose::Calm(halt)));
        }
        if let Some(preparation) = &self.preparation {
            match preparation.request(&self.element_file) {
                Ok(request) => return Some((request, Purpose::Prepare)),
                Err(reason) => self.fail_preparation(reason),
            }
        }
        let due = self.schedule.as_ref()?.next(now.steady);
        // Whatever else there is to ask, the position must not grow old.
        if due != Some(Query::Status) {
            if let Some(request) = self.settling_request(now) {
                return Some((request, Purpose::Settle));
            }
            if let Some(query) = self.wanted.pop_front() {
                return Some((Request::Query(query), Purpose::Asked(query)));
            }
        }
        due.map(|query| (Request::Query(query), Purpose::Poll(query)))
    }

    fn fail_preparation(&mut self, reason: PrepareError) {
        if let Some(preparation) = self.preparation.take() {
            self.happenings.push_back(Happening::NotPrepared(preparation.target, reason));
        }
    }

    /// The operator wants this answered; once is enough.
    fn want(&mut self, query: Query) {
        if self.schedule.is_some() && !self.wanted.contains(&query) {
            self.wanted.push_back(query);
        }
    }

    /// The next status tells what a command has brought about.
    fn look_soon(&mut self, now: Moment) {
        if let Some(schedule) = &mut self.schedule {
            schedule.hurry(Query::Status, now.steady);
        }
    }
}

impl Device for Satrak {
    fn capabilities(&self) -> Capabilities {
        Capabilities { axes: ["X", "Y"] }
    }

    fn link_up(&mut self, now: Moment) {
        self.link_down(now);
        self.state.link_since = Some(now.steady);
        self.state.motion_lock = None;
        self.schedule = Some(Schedule::new(now.steady));
    }

    fn link_down(&mut self, now: Moment) {
        self.record_unfinished(now);
        self.has_heard_frame = false;
        self.decoder = Decoder::new();
        self.schedule = None;
        self.outstanding = None;
        self.drain_until = None;
        self.halts.clear();
        self.motions.clear();
        self.calm.clear();
        self.fail_preparation(PrepareError::Unanswered);
        self.wanted.clear();
        self.slow = None;
        self.abandon_changes(now);
    }

    fn sent(&mut self, bytes: &[u8], now: Moment) {
        self.record_sent(bytes, now);
    }

    fn next_wire_line(&mut self) -> Option<WireLine> {
        self.wire.pop()
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.decoder.push(bytes);
        // Taken out one by one, because each one may change what is expected.
        while let Some(line) = self.decoder.next_line() {
            self.record_received(&line, now);
            self.take_line(line.frame, now);
        }
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        self.halts.retain(|(_, until)| *until > now.steady);
        if let Some(again) = self.expire(now) {
            return Some(again);
        }
        self.expire_slow(now);
        self.begin_change(now);
        if self.outstanding.is_some() || self.drain_until.is_some_and(|until| now.steady < until) {
            return None;
        }
        self.drain_until = None;
        let (request, purpose) = self.next_request(now)?;
        let bytes = request.to_bytes();
        self.outstanding = Some(Outstanding::new(request, purpose, now));
        Some(bytes)
    }

    fn due(&self, now: Moment) -> Instant {
        if let Some(outstanding) = &self.outstanding {
            return outstanding.deadline();
        }
        if let Some(until) = self.drain_until {
            return until;
        }
        let slow = self.slow.as_ref().map(Outstanding::deadline);
        let far = now.steady + Duration::from_hours(1);
        let Some(schedule) = &self.schedule else { return far };
        let waits = !self.motions.is_empty()
            || !self.calm.is_empty()
            || !self.wanted.is_empty()
            || self.preparation.is_some();
        if waits {
            return now.steady;
        }
        let due = schedule.due().into_iter().chain(slow).chain(self.settling_due(now));
        due.min().unwrap_or(far)
    }

    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8> {
        let program = extent == Extent::Everything || self.program_may_run();
        self.motions.clear();
        self.fail_preparation(PrepareError::Stopped);
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
        }
        self.halts.retain(|(_, until)| *until > now.steady);
        // STOP alone may leave the tracking switched on, and the antenna starts
        // again by itself.
        let halts = [Halt::Stop].into_iter().chain(program.then_some(Halt::TrackOff));
        let until = now.steady + REPLY;
        self.halts.extend(halts.clone().map(|halt| (halt, until)));
        self.look_soon(now);
        halts.flat_map(|halt| Request::Halt(halt).to_bytes()).collect()
    }

    fn prepare(&mut self, target: TrackTarget) {
        // An answer to a step of the former preparation must not move this one.
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
        }
        self.preparation = Some(Preparation::new(target));
    }

    fn groups(&self) -> &'static [&'static Group] {
        GROUPS
    }

    fn read_group(&mut self, group: &str) {
        if let Some(Plan { query, .. }) = Plan::of(group) {
            self.want(query);
        }
    }

    fn settle(&mut self, change: Change, now: Moment) {
        if self.schedule.is_none() {
            return self.settled(change, Err(SettleError::NoLink), now);
        }
        self.state.group(change.group).step = Some(SettleStep::Waiting);
        self.changes.push_back(change);
    }

    fn ask(&mut self, question: Question) {
        let Question::Satrak(query) = question;
        self.want(query);
    }

    fn disable_auto(&mut self) {
        self.calm.push_back(Halt::AutoTrackOff);
    }

    fn motion_under_way(&self) -> bool {
        self.motion_waits()
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_happening(&mut self) -> Option<Happening> {
        self.happenings.pop_front()
    }

    fn patience(&self) -> Duration {
        // One question and its repetition, on top of the wait for it.
        self.poll_period() + REPLY * 2 + DRAIN
    }

    fn poll_period(&self) -> Duration {
        self.rates.period(self.moving())
    }
}

impl Moves for Satrak {
    fn start(&mut self, motion: Motion) {
        // A newer wish replaces one that has not gone out yet.
        self.motions.clear();
        self.motions.push_back(motion);
    }
}
