//! Behaviour of a Satrak: one request outstanding, replies matched by their word, halts ahead of
//! all other requests.

mod changes;
mod checks;
mod device;
mod element_files;
mod exchange;
mod on_board;
mod prepare;
mod record;
mod reported;
mod schedule;
pub mod settings;
mod settings_plan;
mod spec;
mod state;
mod waiting_motion;
mod words;

use std::{collections::VecDeque, time::Duration};

pub use checks::checks;
pub use element_files::ELEMENT_FILES;
use settings::{GROUPS, TRACK_OFFSETS};
pub use spec::{ELEMENT_FILE, SPEC, VARIANT};
pub use words::meaning;

use crate::{
    clock::{Instant, Moment},
    device::{AntennaState, ControllerEvent, PrepareError, settings::ChangeQueue, wire::WireQueue},
    protocol::satrak::{Decoder, Halt, Query, Request},
    station::PollRates,
};
use exchange::{Outstanding, Purpose};
use prepare::Preparation;
use reported::Reported;
use schedule::QuerySchedule;
use waiting_motion::WaitingMotion;

/// Time limit for an answer.
const REPLY: Duration = Duration::from_secs(2);
/// Time limit for the answer to a setting for which the unit must fetch or read a file.
const SLOW_REPLY: Duration = Duration::from_secs(15);
/// Pause after a repeated question, whose first answer may still come. Without the pause, Azel
/// would match every later answer to the wrong question.
const DRAIN: Duration = Duration::from_secs(1);
/// Max pause because of surplus answers.
const LONGEST_DRAIN: Duration = Duration::from_secs(5);
/// Time for which one surplus answer shows that answers are late.
const LATE_FOR: Duration = Duration::from_secs(30);
/// Max number of missing statuses that Azel keeps count of.
const MAX_MISSING: usize = 100;

#[derive(Debug)]
pub struct Satrak {
    rates: PollRates,
    element_file: String,
    decoder: Decoder,
    state: AntennaState,
    reported: Reported,
    schedule: Option<QuerySchedule>,
    outstanding: Option<Outstanding>,
    drain_until: Option<Instant>,
    /// Question for the position that Azel asks while another request waits for its reply.
    probe: Option<Outstanding>,
    /// Send times of the statuses whose replies are missing, oldest first. Replies come in the
    /// order of their questions.
    missing: VecDeque<Moment>,
    /// End of the time in which replies count as late and not as lost, after a surplus status.
    late_until: Option<Instant>,
    /// `true` while Azel has the antenna moving.
    is_watched: bool,
    /// Time at which Azel last switched tracking or auto-track on.
    program_switched_on: Option<Instant>,
    /// Halts that Azel sent past the queue and the unit has not answered, each with its deadline.
    halts: VecDeque<(Halt, Instant)>,
    motion: Option<WaitingMotion>,
    calm: VecDeque<Halt>,
    preparation: Option<Preparation>,
    /// Pending questions of the operator.
    pending: VecDeque<Query>,
    changes: ChangeQueue,
    /// A setting that takes the unit long; Azel asks other questions during the wait.
    slow: Option<Outstanding>,
    events: VecDeque<ControllerEvent>,
    wire: WireQueue,
    /// `true` once a frame has come over this link.
    has_heard_frame: bool,
}

impl Satrak {
    /// Returns a unit polled at `rates`, silent until the link is up. The unit takes satellites
    /// from its file `element_file`, or from the file in use if that is empty.
    pub fn new(rates: PollRates, element_file: String) -> Self {
        Self {
            rates,
            element_file,
            decoder: Decoder::new(),
            state: AntennaState {
                checks: checks(None).into(),
                questions: words::questions().into(),
                ..AntennaState::default()
            },
            reported: Reported::default(),
            schedule: None,
            outstanding: None,
            drain_until: None,
            probe: None,
            missing: VecDeque::new(),
            late_until: None,
            is_watched: false,
            program_switched_on: None,
            halts: VecDeque::new(),
            motion: None,
            calm: VecDeque::new(),
            preparation: None,
            pending: VecDeque::new(),
            changes: ChangeQueue::new(GROUPS),
            slow: None,
            events: VecDeque::new(),
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
        self.motion.is_some() || self.outstanding.as_ref().is_some_and(Outstanding::is_motion)
    }

    /// Returns `true` if the tracking program is on, or may be on because Azel has read no status
    /// since it switched the program on.
    fn program_may_run(&self) -> bool {
        let switched_on = self.program_switched_on.is_some_and(|instant| {
            self.state.measured.is_none_or(|measured| measured.requested <= instant)
        });
        switched_on || self.state.program.is_none_or(|program| program.enabled)
    }

    /// Returns the next request, the most urgent first.
    fn next_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        if self.motion.is_some() {
            return self.motion_request(now);
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
        // The position must stay fresh even if other questions are pending.
        if due != Some(Query::Status) {
            if let Some(request) = self.write_request(now) {
                return Some((request, Purpose::WriteSettings));
            }
            if let Some(query) = self.pending.pop_front() {
                return Some((Request::Query(query), Purpose::Asked(query)));
            }
        }
        due.map(|query| (Request::Query(query), Purpose::Poll(query)))
    }

    fn fail_preparation(&mut self, reason: PrepareError) {
        if let Some(preparation) = self.preparation.take() {
            self.events.push_back(ControllerEvent::NotPrepared(preparation.target, reason));
        }
    }

    /// Queues a question of the operator unless it is already pending.
    fn want(&mut self, query: Query) {
        if self.schedule.is_some() && !self.pending.contains(&query) {
            self.pending.push_back(query);
        }
    }

    /// Schedules a status question for now to show the effect of a command.
    fn look_soon(&mut self, now: Moment) {
        if let Some(schedule) = &mut self.schedule {
            schedule.hurry(Query::Status, now.steady);
        }
    }
}
