//! Behaviour of a Rotator Genius: one request outstanding, replies matched by their words,
//! STOP ahead of everything else.
//!
//! One unit turns two rotators and has one STOP for both. The station says what they turn:
//! both angles of one antenna, or its azimuth and something else.

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
/// While a rescue is armed, only STOP ends a motion: an answer that takes longer than this is
/// missing.
const RESCUE_REPLY: Duration = Duration::from_millis(400);
/// Longest interval between questions while a rescue is armed.
const RESCUE_POLL: Duration = Duration::from_millis(250);
/// After a repeated question both answers may come. Nothing is asked until the surplus one
/// must have come.
const DRAIN: Duration = Duration::from_millis(1100);
/// Number of missing answers that are kept count of: a unit that answers everything else but no
/// question is of no use.
const MAX_MISSING: usize = 1000;
/// After this long without a byte, an unfinished reply is given up.
const QUIET: Duration = Duration::from_millis(250);
/// After this long without a good reply, the link is given up.
const PATIENCE: Duration = Duration::from_secs(8);

#[derive(Debug)]
pub struct Genius {
    rates: PollRates,
    rotators: Rotators,
    decoder: Decoder,
    /// Bytes that the decoder has not finished with, for the wire log.
    unfinished: VecDeque<u8>,
    /// When unfinished bytes are given up.
    quiet_at: Option<Instant>,
    state: AntennaState,
    /// The last one on this link.
    status: Option<Status>,
    /// By the number of the rotator.
    turning: [Turning; 2],
    /// When the status is asked for next; `None` without a link.
    next_poll: Option<Instant>,
    outstanding: Option<Outstanding>,
    /// Times of the questions whose answers may still come, oldest first.
    missing: VecDeque<Instant>,
    drain_until: Option<Instant>,
    /// Azel has the antenna moving.
    is_watched: bool,
    /// For each STOP sent, until when an answer is expected.
    halts: VecDeque<Instant>,
    orders: VecDeque<QueuedMotion>,
    /// To be armed with the next look at the clock.
    is_rescue_wanted: bool,
    /// The operator has asked for the status.
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
    /// A unit polled at `rates`, silent until the link is up.
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

    /// The next request, the most urgent first.
    fn next_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        // However fast requests come, the position must not grow old.
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

    /// Asks for the status that shows the effect of a command.
    fn look_soon(&mut self, now: Moment) {
        if let Some(due) = &mut self.next_poll {
            *due = now.steady.min(*due);
        }
    }
}

#[cfg(test)]
mod tests;
