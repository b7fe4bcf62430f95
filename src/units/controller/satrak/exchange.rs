//! One request and its reply: matching, time-outs, effects.

use super::{
    DRAIN, LATE_FOR, LONGEST_DRAIN, MAX_MISSING, REPLY, SLOW_REPLY, Satrak, prepare::Outcome,
    state::DECIMAL_COMMAS,
};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    controller::reply_clock::ReplyClock,
    device::{ControllerEvent, Motion, PROMPT, PrepareError, settings::ReadFailure},
    protocol::satrak::{
        self as unit, Frame, FrameError, Goto, Halt, Move, Query, Reply, ReplyError, Request, Step,
        ValueError, Verb, Word,
    },
};

/// Reason for a request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Purpose {
    /// A poll that was due.
    Poll(Query),
    /// A question of the operator.
    Asked(Query),
    /// A step of transferring a target to the unit.
    Prepare,
    /// A step of changing a group of settings.
    WriteSettings,
    /// A question for the faults ahead of a pending motion.
    BeforeMotion,
    /// A command that starts a motion.
    Motion(Motion),
    /// A command that switches a program off, without priority.
    Calm(Halt),
    /// A request that a halt has overtaken: its reply does not matter.
    Disowned,
}

#[derive(Debug)]
pub(super) struct Outstanding {
    request: Request,
    purpose: Purpose,
    clock: ReplyClock,
}

impl Outstanding {
    pub(super) fn new(request: Request, purpose: Purpose, sent: Moment) -> Self {
        Self { request, purpose, clock: ReplyClock::new(sent, REPLY) }
    }

    pub(super) fn deadline(&self) -> Instant {
        self.clock.deadline()
    }

    /// Returns the time from which the reply counts as missing while the antenna moves.
    fn prompt_deadline(&self) -> Instant {
        self.clock.sent.steady + PROMPT
    }

    /// Returns `true` for a setting that may make the unit fetch or read a file before it answers.
    fn is_slow(&self) -> bool {
        let word = self.request.word();
        self.request.verb() == Verb::Set
            && self.clock.patience == REPLY
            && matches!(
                word,
                Word::Satellite | Word::SatelliteHttp | Word::SatelliteFtp | Word::LoadImage
            )
            && self.purpose == Purpose::WriteSettings
    }

    pub(super) fn is_status(&self) -> bool {
        self.request == Request::Query(Query::Status)
    }

    pub(super) fn is_motion(&self) -> bool {
        matches!(self.purpose, Purpose::Motion(_))
    }

    /// Returns `true` for the command of a change of settings.
    pub(super) fn is_setting(&self) -> bool {
        self.purpose == Purpose::WriteSettings && self.request.verb() == Verb::Set
    }

    /// Marks a request that a halt or a newer request has overtaken. Settings move nothing and
    /// stay.
    pub(super) fn disown(&mut self) {
        if !matches!(self.purpose, Purpose::Poll(_) | Purpose::Asked(_) | Purpose::WriteSettings) {
            self.purpose = Purpose::Disowned;
        }
    }

    /// Marks a read of current values whose change is over.
    pub(super) fn disown_look(&mut self) {
        if self.purpose == Purpose::WriteSettings {
            self.purpose = Purpose::Disowned;
        }
    }

    /// Returns `true` for a poll that is not a repetition.
    pub(super) fn is_regular_poll(&self) -> bool {
        !self.clock.is_repeated() && matches!(self.purpose, Purpose::Poll(_))
    }

    /// Returns the time of the first transmission of the question.
    pub(super) fn first_sent(&self) -> Instant {
        self.clock.first_sent.steady
    }

    pub(super) fn answers(&self, command: (Word, Verb)) -> bool {
        (self.request.word(), self.request.verb()) == command
    }
}

impl Satrak {
    /// Takes a received line.
    pub(super) fn take_line(&mut self, line: Result<Frame, FrameError>, now: Moment) {
        let frame = match line {
            Ok(frame) => frame,
            Err(error) => {
                self.state.traffic.damaged += 1;
                self.state.traffic.last_unreadable = Some(now.steady);
                return tracing::debug!(%error, "damaged line");
            }
        };
        if !frame.oddities().is_empty() {
            self.state.traffic.odd += 1;
        }
        let command = frame.command();
        let expected = command.is_some_and(|command| {
            self.outstanding.as_ref().is_some_and(|sent| sent.answers(command))
        });
        if expected {
            if let Some(mut outstanding) = self.outstanding.take() {
                self.date(&mut outstanding);
                self.take_reply(&outstanding, Reply::parse(&frame), now);
            }
        } else if let Some(slow) =
            self.slow.take_if(|slow| command.is_some_and(|word| slow.answers(word)))
        {
            self.take_reply(&slow, Reply::parse(&frame), now);
        } else if let Some(mut probe) =
            self.probe.take_if(|probe| command.is_some_and(|pair| probe.answers(pair)))
        {
            self.date(&mut probe);
            self.take_reply(&probe, Reply::parse(&frame), now);
        } else if let Some(late) = self.late_status(command) {
            self.late_until = Some(now.steady + LATE_FOR);
            self.take_reply(&late, Reply::parse(&frame), now);
        } else if let Some(halt) = self.answered_halt(command) {
            self.take_halt_reply(halt, &frame, now);
        } else {
            self.state.traffic.unsolicited += 1;
            tracing::debug!(line = %frame.redacted(), "nobody asked for this");
        }
    }

    fn answered_halt(&mut self, command: Option<(Word, Verb)>) -> Option<Halt> {
        let (word, verb) = command?;
        let place =
            self.halts.iter().position(|(halt, _)| halt.word() == word && verb == Verb::Set)?;
        self.halts.remove(place).map(|(halt, _)| halt)
    }

    fn count_reply(&mut self, now: Moment) {
        self.state.traffic.replies += 1;
        self.state.traffic.last_reply = Some(now.steady);
    }

    fn take_halt_reply(&mut self, halt: Halt, frame: &Frame, now: Moment) {
        match Reply::parse(frame).map(|parsed| parsed.reply) {
            Ok(Reply::Refused { code }) => {
                self.count_reply(now);
                self.events.push_back(match halt {
                    Halt::AutoTrackOff => ControllerEvent::AutoStaysOn,
                    Halt::Stop | Halt::TrackOff => ControllerEvent::HaltRefused(refusal(&code)),
                });
            }
            Ok(_) => self.count_reply(now),
            Err(error) => {
                self.state.traffic.unreadable += 1;
                tracing::debug!(%error, ?halt, "unreadable reply");
            }
        }
    }

    fn take_reply(
        &mut self,
        outstanding: &Outstanding,
        parsed: Result<unit::ParsedReply, ReplyError>,
        now: Moment,
    ) {
        let parsed = match parsed {
            Ok(parsed) => parsed,
            Err(error) => {
                self.state.traffic.unreadable += 1;
                self.state.traffic.last_unreadable = Some(now.steady);
                if let ReplyError::Count { word: Word::Status, looks_like_decimal_commas, .. } =
                    error
                {
                    self.state.unreadable = looks_like_decimal_commas.then_some(DECIMAL_COMMAS);
                }
                tracing::debug!(%error, "unreadable reply");
                return self.give_up(outstanding.purpose, now);
            }
        };
        self.count_reply(now);
        self.await_surplus(outstanding, now);
        if !parsed.notes.is_empty() {
            self.state.traffic.odd += 1;
        }
        match (parsed.reply, outstanding.purpose) {
            (Reply::Refused { code }, purpose) => self.take_refusal(refusal(&code), purpose, now),
            (reply, Purpose::Poll(query) | Purpose::Asked(query)) => {
                let fault_before = self.reported.fault_flag;
                self.take_report(reply, outstanding.clock.first_sent, now);
                self.polled(query, fault_before, now);
            }
            (reply, Purpose::BeforeMotion) => {
                let fault_before = self.reported.fault_flag;
                self.take_report(reply, outstanding.clock.first_sent, now);
                self.polled(Query::Faults, fault_before, now);
                self.judge_waiting_motion();
            }
            (reply, Purpose::Prepare) => {
                self.advance_preparation(&reply);
                self.take_report(reply, outstanding.clock.first_sent, now);
            }
            (reply, Purpose::WriteSettings) => {
                self.take_report(reply.clone(), outstanding.clock.first_sent, now);
                self.change_answered(&reply, now);
            }
            (_, Purpose::Motion(motion)) => {
                self.events.push_back(ControllerEvent::Accepted(motion.into()));
                self.look_soon(now);
            }
            (_, Purpose::Calm(_) | Purpose::Disowned) => self.look_soon(now),
        }
    }

    fn polled(&mut self, query: Query, fault_before: bool, now: Moment) {
        let period = self.rates.period(self.moving());
        let fault = self.reported.fault_flag;
        if let Some(schedule) = &mut self.schedule {
            schedule.done(query, now.steady, period, fault);
            if fault != fault_before {
                schedule.hurry(Query::Faults, now.steady);
            }
        }
    }

    /// Handles a question that the unit does not know or does not answer.
    fn poll_failed(&mut self, query: Query, failure: ReadFailure, now: Moment) {
        let is_unanswered = matches!(failure, ReadFailure::Unanswered);
        self.take_read_failure(query, failure);
        let fault = self.reported.fault_flag;
        if query == Query::Faults {
            // A unit that cannot name its faults still reports that a fault exists.
            let was_locked = self.state.motion_lock == Some(true);
            self.state.motion_lock = Some(fault || was_locked);
        }
        let period = self.rates.period(self.moving());
        if let Some(schedule) = &mut self.schedule {
            schedule.unknown(query, now.steady, period, fault);
            if is_unanswered {
                schedule.missed(query, now.steady);
            }
        }
    }

    fn no_faults_before_motion(&mut self, failure: ReadFailure, now: Moment) {
        self.poll_failed(Query::Faults, failure, now);
        self.drop_waiting_motion("nothing about its faults");
    }

    fn advance_preparation(&mut self, reply: &Reply) {
        let Some(preparation) = &mut self.preparation else { return };
        match preparation.answered(reply) {
            Ok(Outcome::Onward) => {}
            Ok(Outcome::Done) => {
                let target = preparation.target.clone();
                self.preparation = None;
                self.events.push_back(ControllerEvent::Prepared(target));
            }
            Err(reason) => self.fail_preparation(reason),
        }
    }

    fn take_refusal(&mut self, answer: String, purpose: Purpose, now: Moment) {
        match purpose {
            Purpose::Poll(query) | Purpose::Asked(query) => {
                self.poll_failed(query, ReadFailure::Refused(answer), now);
            }
            Purpose::BeforeMotion => {
                self.no_faults_before_motion(ReadFailure::Refused(answer), now);
            }
            Purpose::Prepare => self.fail_preparation(PrepareError::Refused(answer)),
            Purpose::WriteSettings => self.change_refused(answer, now),
            Purpose::Motion(motion) => {
                self.events.push_back(ControllerEvent::Refused(motion.into(), answer));
                self.look_soon(now);
            }
            Purpose::Calm(Halt::AutoTrackOff) => {
                self.events.push_back(ControllerEvent::AutoStaysOn);
            }
            Purpose::Calm(_) => self.events.push_back(ControllerEvent::HaltRefused(answer)),
            Purpose::Disowned => {}
        }
    }

    /// Gives up a setting whose reply is overdue.
    pub(super) fn expire_slow(&mut self, now: Moment) {
        if let Some(late) = self.slow.take_if(|slow| now.steady >= slow.deadline()) {
            self.state.traffic.unanswered += 1;
            self.wire.no_reply(SLOW_REPLY, false, now);
            self.give_up(late.purpose, now);
        }
    }

    /// Repeats a late question once. Azel never repeats other requests, because the state shows
    /// whether they arrived.
    pub(super) fn expire(&mut self, now: Moment) -> Option<Vec<u8>> {
        let is_late = |sent: &mut Outstanding| now.steady >= sent.prompt_deadline();
        if let Some(late) = self.probe.take_if(is_late) {
            self.missed(&late, false, now);
        }
        if self.outstanding.as_ref().is_none_or(|sent| now.steady < self.deadline(sent)) {
            return None;
        }
        let mut late = self.outstanding.take()?;
        if late.is_slow() {
            late.clock.patience = SLOW_REPLY;
            self.slow = Some(late);
            return None;
        }
        let is_repeated = late.request.verb() == Verb::Query
            && !late.clock.is_repeated()
            // A repeated question would delay the motion long after its check.
            && late.purpose != Purpose::BeforeMotion;
        self.missed(&late, is_repeated, now);
        if is_repeated {
            late.clock.repeat(now);
            let bytes = late.request.to_bytes();
            self.outstanding = Some(late);
            return Some(bytes);
        }
        self.give_up(late.purpose, now);
        None
    }

    fn missed(&mut self, late: &Outstanding, is_repeated: bool, now: Moment) {
        self.state.traffic.unanswered += 1;
        // Noise may never contain the end of a line.
        if self.decoder.is_within_line() {
            self.state.traffic.last_unreadable = Some(now.steady);
        }
        self.wire.no_reply(late.clock.waited(now), is_repeated, now);
        if late.is_status() {
            self.state.traffic.miss_position(now.steady);
            if self.missing.len() < MAX_MISSING {
                self.missing.push_back(late.clock.sent);
            }
        }
    }

    /// Returns the outstanding entry of a request. A status may answer an earlier question.
    pub(super) fn outstanding_of(
        &self,
        request: Request,
        purpose: Purpose,
        now: Moment,
    ) -> Outstanding {
        let mut outstanding = Outstanding::new(request, purpose, now);
        if let Some(missing) = self.missing.front().filter(|_| outstanding.is_status()) {
            outstanding.clock = outstanding.clock.standing_for(*missing);
        }
        outstanding
    }

    /// Sets the time of the question that `answered` answers: a status answers the first open
    /// question, so the reply to the last question may still come.
    fn date(&mut self, answered: &mut Outstanding) {
        if answered.is_status() {
            self.missing.push_back(answered.clock.sent);
            answered.clock.first_sent = self.missing.pop_front().unwrap_or(answered.clock.sent);
        }
    }

    /// Returns the question of a late status that Azel had given up.
    fn late_status(&mut self, command: Option<(Word, Verb)>) -> Option<Outstanding> {
        let query = Query::Status;
        let sent = *self.missing.front()?;
        let late = Outstanding::new(Request::Query(query), Purpose::Poll(query), sent);
        command.filter(|command| late.answers(*command))?;
        self.missing.pop_front();
        Some(late)
    }

    /// Pauses the questions while surplus answers may come, for as long as this answer took. While
    /// the antenna moves and answers are known to be late, Azel continues to ask, and each status
    /// counts as asked earlier.
    fn await_surplus(&mut self, answered: &Outstanding, now: Moment) {
        let is_expected = if answered.is_status() {
            !self.missing.is_empty()
        } else {
            answered.clock.is_repeated()
        };
        let are_late = self.late_until.is_some_and(|end| now.steady < end);
        let took = now.steady.saturating_duration_since(answered.first_sent());
        let pause = if self.is_watched { DRAIN } else { took.clamp(DRAIN, LONGEST_DRAIN) };
        let asks_on = self.is_watched && are_late;
        self.drain_until = (is_expected && !asks_on).then(|| now.steady + pause);
    }

    /// Asks for the position while a slow reply would delay the next position question of a motion.
    pub(super) fn begin_probe(&mut self, now: Moment) -> Option<Vec<u8>> {
        let waits = self.probe_due().is_some_and(|instant| now.steady >= instant);
        let drains = self.drain_until.is_some_and(|end| now.steady < end);
        if !waits || drains || self.probe.is_some() {
            return None;
        }
        let request = Request::Query(Query::Status);
        let bytes = request.to_bytes();
        self.probe = Some(self.outstanding_of(request, Purpose::Poll(Query::Status), now));
        Some(bytes)
    }

    fn probe_due(&self) -> Option<Instant> {
        let outstanding = self.outstanding.as_ref().filter(|sent| !sent.is_status())?;
        let is_due = self.is_watched && self.schedule.is_some();
        is_due.then(|| outstanding.prompt_deadline())
    }

    fn deadline(&self, sent: &Outstanding) -> Instant {
        if self.is_watched && sent.is_status() { sent.prompt_deadline() } else { sent.deadline() }
    }

    /// Returns `true` while a reply is pending, when Azel may ask nothing else.
    pub(super) fn is_waiting(&self) -> bool {
        self.outstanding.is_some() || self.probe.is_some()
    }

    /// Returns the time at which a reply counts as missing, or at which Azel asks for the position
    /// in addition.
    pub(super) fn reply_due(&self) -> Option<Instant> {
        let deadline = self.outstanding.as_ref().map(|sent| self.deadline(sent));
        let probe = match &self.probe {
            Some(probe) => Some(probe.prompt_deadline()),
            None => self
                .probe_due()
                .map(|instant| self.drain_until.map_or(instant, |end| instant.max(end))),
        };
        deadline.into_iter().chain(probe).min()
    }

    fn give_up(&mut self, purpose: Purpose, now: Moment) {
        match purpose {
            Purpose::Poll(query) | Purpose::Asked(query) => {
                self.poll_failed(query, ReadFailure::Unanswered, now);
            }
            Purpose::BeforeMotion => self.no_faults_before_motion(ReadFailure::Unanswered, now),
            Purpose::Prepare => self.fail_preparation(PrepareError::Unanswered),
            Purpose::WriteSettings => self.change_unanswered(now),
            Purpose::Motion(motion) => {
                self.events.push_back(ControllerEvent::Unanswered(motion.into()));
                self.look_soon(now);
            }
            Purpose::Calm(Halt::AutoTrackOff) => {
                self.events.push_back(ControllerEvent::AutoStaysOn);
            }
            Purpose::Calm(_) | Purpose::Disowned => self.look_soon(now),
        }
    }
}

pub(super) fn unit_motion(motion: Motion) -> Result<unit::Motion, ValueError> {
    // The unit reports hundredths; more digits would only hide the requested value.
    let hundredths = |angle: Angle| (angle.degrees() * 100.0).round() / 100.0;
    Ok(match motion {
        Motion::Jog { x_deg_s, y_deg_s } => unit::Motion::Move(Move::new(x_deg_s, y_deg_s)?),
        Motion::Step { x_deg, y_deg } => unit::Motion::Step(Step::new(x_deg, y_deg)?),
        Motion::Position { azimuth, elevation } => {
            let azimuth = azimuth.map(|angle| hundredths(angle.wrapped_360()) % 360.0);
            unit::Motion::Goto(Goto::new(azimuth, elevation.map(hundredths))?)
        }
        Motion::StartProgram => unit::Motion::TrackOn,
        Motion::EnableAuto => unit::Motion::AutoTrackOn,
    })
}

/// Returns the refusal as the unit wrote it after its echo of the command.
fn refusal(code: &str) -> String {
    if code.is_empty() { "ERR".to_owned() } else { format!("ERR,{code}") }
}
