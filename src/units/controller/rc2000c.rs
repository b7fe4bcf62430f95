//! Behaviour of an RC2000C: one command on the line at a time, replies matched by their code, halts
//! ahead of all other commands.
//!
//! An acknowledgement says that the unit understood a command. The effect shows in a later status.

mod actions;
mod axes;
mod checks;
mod device;
mod exchange;
mod line;
mod meaning;
mod names;
mod past;
mod readings;
mod record;
mod refusal;
mod spec;

use std::{collections::VecDeque, time::Duration};

use crate::{
    clock::{Instant, Moment},
    device::{AntennaState, ControllerEvent, Motion, MotionRequest, Question, wire::WireQueue},
    protocol::rc2000c::{
        self as unit, Address, Decoder, DeviceType, NameIndex, Query, Request, Speed, Status,
    },
    station::{Antenna, Mount, PollRates},
};
use axes::Axes;
use exchange::{Outstanding, Purpose};
use line::Line;
use names::SatelliteNames;
use past::Past;
pub use spec::{AZIMUTH_POINTS, BAUD, BUS_ADDRESS, Calibration, ELEVATION_POINTS, SPEC, VARIANT};

/// Duration of a jog after each command. The unit's own timer is the dead-man.
const JOG: Duration = Duration::from_millis(600);
/// Interval at which Azel renews a held jog.
const RENEWAL: Duration = Duration::from_millis(300);

#[derive(Debug)]
pub struct Rc2000c {
    rates: PollRates,
    mount: Mount,
    maximum_rate_deg_s: f64,
    address: Address,
    axes: Axes,
    line: Line,
    decoder: Decoder,
    state: AntennaState,
    status: Option<Status>,
    /// Earlier statuses, which show the axes that move.
    past: Past,
    /// `true` while Azel has to ask the unit for its type.
    wants_device: bool,
    /// `true` if the operator has asked for the status.
    is_status_asked: bool,
    /// `true` if the pending status is a request of the operator.
    is_poll_by_hand: bool,
    /// `true` if the operator has asked for the type of the unit.
    is_device_asked: bool,
    device: Option<DeviceType>,
    /// `true` if the unit's configuration accepts no commands.
    is_offline: bool,
    names: SatelliteNames,
    /// Time of the next status question; `None` without a link.
    poll_at: Option<Instant>,
    /// End of the gap after a reply, in which only a halt may go out.
    gap_until: Option<Instant>,
    outstanding: Option<Outstanding>,
    /// Times of the status questions whose answers may still come, oldest first.
    missing: VecDeque<Moment>,
    /// Time by which the surplus answers have come.
    drain_until: Option<Instant>,
    /// `true` while Azel has the antenna moving.
    is_watched: bool,
    /// Halt that was sent past the queue and is not answered yet.
    halt: Option<Outstanding>,
    /// Requests that wait to be sent.
    orders: VecDeque<QueuedRequest>,
    jog: Option<HeldJog>,
    /// `true` after a STOP while the polarization may be turning.
    holds_polarization: bool,
    events: VecDeque<ControllerEvent>,
    /// Received bytes that are not recorded yet; `heard_at` is the time of the last byte.
    heard: Vec<u8>,
    heard_at: Option<Instant>,
    wire: WireQueue,
}

#[derive(Debug, Clone, Copy)]
struct QueuedRequest {
    request: Request,
    /// The request that this command belongs to; `None` for a part of a halt.
    origin: Option<MotionRequest>,
}

/// A jog that continues until a halt, a refusal or a missing reply.
#[derive(Debug, Clone, Copy)]
struct HeldJog {
    motion: Motion,
    direction: unit::Direction,
    speed: Speed,
    sent: Option<Instant>,
}

const STATUS: &str = "STATUS";
const DEVICE_TYPE: &str = "DEVICE TYPE";

fn questions(address: Address) -> [Question; 2] {
    let question = |key: &str, subject: &'static str, query| Question {
        key: key.into(),
        subject: subject.into(),
        bytes: Request::Query(query).to_bytes(address).into(),
    };
    [
        question(STATUS, "Asks for the status", Query::Status),
        question(DEVICE_TYPE, "Asks for the type of the unit", Query::DeviceType),
    ]
}

impl Rc2000c {
    /// Returns the unit of `antenna` with the settings of its connection, silent until the link is
    /// up.
    pub fn new(antenna: &Antenna) -> Self {
        let connection = &antenna.connection;
        let bus_address = u8::try_from(connection.whole(&BUS_ADDRESS)).ok();
        let address =
            bus_address.and_then(|number| Address::new(number).ok()).unwrap_or(Address::FACTORY);
        Self {
            rates: antenna.poll,
            mount: antenna.mount,
            maximum_rate_deg_s: antenna.limits.maximum_rate_deg_s,
            address,
            axes: Axes::new(&Calibration::from_connection(connection)),
            line: Line::new(connection.whole(&BAUD)),
            decoder: Decoder::new(address),
            state: AntennaState { questions: questions(address).into(), ..AntennaState::default() },
            status: None,
            past: Past::default(),
            wants_device: false,
            is_status_asked: false,
            is_poll_by_hand: false,
            is_device_asked: false,
            device: None,
            is_offline: false,
            names: SatelliteNames::default(),
            poll_at: None,
            gap_until: None,
            outstanding: None,
            missing: VecDeque::new(),
            drain_until: None,
            is_watched: false,
            halt: None,
            orders: VecDeque::new(),
            jog: None,
            holds_polarization: false,
            events: VecDeque::new(),
            heard: Vec::new(),
            heard_at: None,
            wire: WireQueue::default(),
        }
    }

    fn moving(&self) -> bool {
        let is_commanded = self.jog.is_some() || self.halt.is_some() || !self.orders.is_empty();
        let polarization = self.status.is_some_and(|status| status.is_moving());
        is_commanded
            || polarization
            || self.state.measured.is_some_and(|measured| measured.moving())
            || self.state.program.is_some()
    }

    /// Returns the next request to send, the most urgent first.
    fn next_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        if let Some(QueuedRequest { request, origin }) = self.orders.pop_front() {
            return Some((request, Purpose::Order(origin)));
        }
        if let Some(jog) = self.next_jog(now) {
            return Some(jog);
        }
        let poll_at = self.poll_at?;
        // The reply to each renewal is a status. A question in between could hold up the next
        // renewal until the unit has ended the jog.
        if self.jog.is_some() {
            return None;
        }
        if self.wants_device {
            return Some((Request::Query(Query::DeviceType), Purpose::Question));
        }
        if now.steady >= poll_at || self.is_status_asked {
            self.is_poll_by_hand = std::mem::take(&mut self.is_status_asked);
            return Some((Request::Query(Query::Status), Purpose::Poll));
        }
        if self.may_ask_device() {
            self.is_device_asked = false;
            return Some((Request::Query(Query::DeviceType), Purpose::Question));
        }
        let index = self.next_name()?;
        Some((Request::Query(Query::SatelliteName(index)), Purpose::Question))
    }

    /// Returns `true` if the operator has asked for the type, and no important position is pending.
    fn may_ask_device(&self) -> bool {
        self.is_device_asked && self.jog.is_none() && !self.is_watched
    }

    /// Returns the next entry of the list to read. The list waits while Azel renews a jog or the
    /// unit does not answer.
    fn next_name(&self) -> Option<NameIndex> {
        let is_calm = self.jog.is_none() && self.status.is_some() && !self.is_offline;
        self.names.next().filter(|_| is_calm)
    }

    /// Returns the command that keeps a held jog alive when it is due. Azel sends no renewal that
    /// is too late, because it would start a new jog.
    fn next_jog(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        let held_jog = self.jog.as_mut()?;
        let age = held_jog.sent.map(|sent| now.steady.saturating_duration_since(sent));
        if age.is_some_and(|age| age < RENEWAL) {
            return None;
        }
        let motion = held_jog.motion;
        let jog = unit::Jog::new(held_jog.direction, held_jog.speed, JOG).ok();
        let jog = jog.filter(|_| age.is_none_or(|age| age < JOG));
        let Some(jog) = jog else {
            self.jog = None;
            self.events.push_back(ControllerEvent::Unanswered(motion.into()));
            return None;
        };
        held_jog.sent = Some(now.steady);
        Some((Request::Motion(unit::Motion::Jog(jog)), Purpose::Order(Some(motion.into()))))
    }

    /// Queues the command for `origin`, or reports why there is none.
    fn order(&mut self, origin: MotionRequest, request: Result<Request, String>) {
        match request {
            Ok(request) => self.orders.push_back(QueuedRequest { request, origin: Some(origin) }),
            Err(reason) => self.events.push_back(ControllerEvent::Refused(origin, reason)),
        }
    }

    /// Makes the next status due now: it shows the effect of a command.
    fn look_soon(&mut self, now: Moment) {
        self.poll_at = self.poll_at.map(|instant| instant.min(now.steady));
    }
}

#[cfg(test)]
mod tests;
