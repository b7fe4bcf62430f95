//! Behaviour of a Satrak: one request outstanding, matched by its word, halts
//! past everything else.

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
mod spec;
mod state;
mod words;
mod write_settings;

use std::{collections::VecDeque, time::Duration};

pub use checks::checks;
pub use element_files::ELEMENT_FILES;
use settings::GROUPS;
pub use spec::{ELEMENT_FILE, SPEC, VARIANT};
pub use words::meaning;

use crate::{
    clock::{Instant, Moment},
    device::{
        AntennaState, ControllerEvent, Motion, PrepareError, settings::ChangeQueue, wire::WireQueue,
    },
    protocol::satrak::{Decoder, Halt, Query, Request},
    station::PollRates,
};
use exchange::{Outstanding, Purpose, unit_motion};
use prepare::Preparation;
use reported::Reported;
use schedule::Schedule;

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
    reported: Reported,
    schedule: Option<Schedule>,
    outstanding: Option<Outstanding>,
    drain_until: Option<Instant>,
    /// Asks for the position while something else waits for its reply.
    probe: Option<Outstanding>,
    /// When the first status was asked for that has not come.
    missing_since: Option<Moment>,
    /// Metal moves on this program's word.
    is_watched: bool,
    /// When tracking or auto-track was last switched on by us.
    program_switched_on: Option<Instant>,
    /// Halts that were sent past the queue and not answered yet.
    halts: VecDeque<(Halt, Instant)>,
    motions: VecDeque<Motion>,
    calm: VecDeque<Halt>,
    preparation: Option<Preparation>,
    /// Questions that the operator wants answered.
    wanted: VecDeque<Query>,
    changes: ChangeQueue,
    /// A setting that takes the unit long; other questions go on meanwhile.
    slow: Option<Outstanding>,
    events: VecDeque<ControllerEvent>,
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
            missing_since: None,
            is_watched: false,
            program_switched_on: None,
            halts: VecDeque::new(),
            motions: VecDeque::new(),
            calm: VecDeque::new(),
            preparation: None,
            wanted: VecDeque::new(),
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
                    self.events
                        .push_back(ControllerEvent::Refused(motion.into(), error.to_string()));
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
            if let Some(request) = self.write_request(now) {
                return Some((request, Purpose::WriteSettings));
            }
            if let Some(query) = self.wanted.pop_front() {
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
