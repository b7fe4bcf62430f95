//! Behaviour of a Rotator Genius: one request outstanding, replies matched by their words, STOP
//! ahead of all other requests.
//!
//! One unit turns two rotators and has one STOP for both. The station file assigns them: both axes
//! of one antenna, or its azimuth and another device.

mod actions;
mod changes;
mod device;
mod exchange;
mod meaning;
mod orders;
mod panel;
mod record;
mod roles;
mod settings;
mod spec;
mod state;
mod turning;

use std::{collections::VecDeque, time::Duration};

use crate::{
    clock::{Instant, Moment},
    device::{AntennaState, ControllerEvent, Question, settings::ChangeQueue, wire::WireQueue},
    protocol::rotator_genius::{Decoder, Request, Status},
    station::PollRates,
};
pub use actions::{OTHER, RESCUE};
use exchange::{Outstanding, Purpose};
use orders::QueuedMotion;
pub use settings::GROUPS;
pub use spec::{ALONE, PAIR, ROTATORS, Rotators, SPEC};
use turning::Turning;

/// Time limit for an answer.
const REPLY: Duration = Duration::from_secs(1);
/// Time limit for an answer while a rescue is armed, when only STOP ends a motion.
const RESCUE_REPLY: Duration = Duration::from_millis(400);
/// Max interval between questions while a rescue is armed.
const RESCUE_POLL: Duration = Duration::from_millis(250);
/// Pause after a repeated question, whose first answer may still come: Azel asks nothing during the
/// pause.
const DRAIN: Duration = Duration::from_millis(1100);
/// Max number of missing answers that Azel keeps count of. A unit that answers everything except
/// questions is of no use.
const MAX_MISSING: usize = 1000;
/// Silence after which Azel gives up an unfinished reply.
const QUIET: Duration = Duration::from_millis(250);
/// Time without a good reply after which Azel gives up the link.
const PATIENCE: Duration = Duration::from_secs(8);

#[derive(Debug)]
pub struct Genius {
    rates: PollRates,
    rotators: Rotators,
    decoder: Decoder,
    /// Received bytes that the decoder has not finished with, for the wire log.
    unfinished: VecDeque<u8>,
    /// Time at which Azel gives up unfinished bytes.
    quiet_at: Option<Instant>,
    state: AntennaState,
    /// The last status on this link.
    status: Option<Status>,
    /// Turning states, indexed by the number of the rotator.
    turning: [Turning; 2],
    /// Time of the next status question; `None` without a link.
    next_poll: Option<Instant>,
    outstanding: Option<Outstanding>,
    /// Send times of the questions whose answers may still come, oldest first.
    missing: VecDeque<Instant>,
    drain_until: Option<Instant>,
    /// `true` while Azel has the antenna moving.
    is_watched: bool,
    /// Deadlines for the answers to the STOPs that Azel has sent.
    halts: VecDeque<Instant>,
    orders: VecDeque<QueuedMotion>,
    /// `true` until the next poll arms the rescue that the operator asked for.
    is_rescue_wanted: bool,
    /// `true` if the operator has asked for the status.
    is_asked: bool,
    rescue_until: Option<Instant>,
    changes: ChangeQueue,
    events: VecDeque<ControllerEvent>,
    wire: WireQueue,
}

const STATUS: &str = "STATUS";

fn questions() -> [Question; 1] {
    [Question {
        key: STATUS.into(),
        subject: "Asks for the status".into(),
        bytes: Request::Read.to_bytes().into(),
    }]
}

impl Genius {
    /// Returns a unit polled at `rates`, silent until the link is up.
    pub fn new(rates: PollRates, rotators: Rotators) -> Self {
        Self {
            rates,
            rotators,
            decoder: Decoder::new(),
            unfinished: VecDeque::new(),
            quiet_at: None,
            state: AntennaState { questions: questions().into(), ..AntennaState::default() },
            status: None,
            turning: Default::default(),
            next_poll: None,
            outstanding: None,
            missing: VecDeque::new(),
            drain_until: None,
            is_watched: false,
            halts: VecDeque::new(),
            orders: VecDeque::new(),
            is_rescue_wanted: false,
            is_asked: false,
            rescue_until: None,
            changes: ChangeQueue::new(GROUPS),
            events: VecDeque::new(),
            wire: WireQueue::default(),
        }
    }

    fn moving(&self) -> bool {
        self.state.measured.is_some_and(|measured| measured.moving()) || !self.halts.is_empty()
    }

    fn motion_waits(&self) -> bool {
        !self.orders.is_empty() || self.outstanding.as_ref().is_some_and(Outstanding::is_motion)
    }

    /// Returns the next request, the most urgent first.
    fn next_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        // The position must stay fresh even while many requests are pending.
        let is_overdue =
            self.next_poll.is_some_and(|due| due + self.rates.period(true) <= now.steady);
        if !is_overdue && let Some(QueuedMotion { request, origin }) = self.orders.pop_front() {
            return Some((Request::Motion(request), Purpose::Motion(origin)));
        }
        if self.next_poll.is_some() && std::mem::take(&mut self.is_asked) {
            return Some((Request::Read, Purpose::Asked));
        }
        let is_due = self.next_poll.is_some_and(|due| due <= now.steady);
        if !is_due && let Some(request) = self.write_request(now) {
            return Some(request);
        }
        is_due.then_some((Request::Read, Purpose::Poll))
    }

    fn period(&self, now: Instant) -> Duration {
        let period = self.rates.period(self.moving());
        if self.is_rescue_armed(now) { period.min(RESCUE_POLL) } else { period }
    }

    fn is_rescue_armed(&self, now: Instant) -> bool {
        self.rescue_until.is_some_and(|end| now < end)
    }

    /// Returns `true` if something can be sent before the next poll.
    fn has_something_to_send(&self) -> bool {
        !self.orders.is_empty()
            || self.is_rescue_wanted
            || self.is_asked
            || !self.changes.is_empty()
    }

    /// Schedules a status question for now to show the effect of a command.
    fn look_soon(&mut self, now: Moment) {
        if let Some(due) = &mut self.next_poll {
            *due = now.steady.min(*due);
        }
    }
}

#[cfg(test)]
mod tests;
