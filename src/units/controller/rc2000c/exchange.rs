//! One command and its reply: matching, time-outs, effects.

use std::time::Duration;

use super::{QueuedRequest, Rc2000c, axes::Axes, checks, line::GAP, line::Line, readings, refusal};
use crate::{
    clock::{Instant, Moment},
    controller::reply_clock::ReplyClock,
    device::{ControllerEvent, Measured, Motion, MotionRequest, Phase, Program},
    protocol::rc2000c::{
        AutoMove, Command, Frame, FrameError, Motion as UnitMotion, PolarizationMotion,
        PolarizationUnits, Query, Reply, ReplyError, Request, Status,
    },
};

/// Max number of times that Azel asks a question in a row; it sends other commands once.
const MAX_TRIES: usize = 3;
/// Time in which an axis turns by less than half a turn.
const CONTINUOUS: Duration = Duration::from_secs(5);
const REMOTE_DISABLED: &str = "remote mode is disabled on the unit";

/// Reason for a command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Purpose {
    /// A poll that was due.
    Poll,
    /// A question other than a poll.
    Question,
    /// A request of the operator; `None` for a part of a halt.
    Order(Option<MotionRequest>),
    /// A halt, which precedes all other commands.
    Halt,
    /// A request that a halt has overtaken: its reply does not matter.
    Disowned,
}

#[derive(Debug)]
pub(super) struct Outstanding {
    request: Request,
    pub(super) purpose: Purpose,
    pub(super) clock: ReplyClock,
}

impl Outstanding {
    pub(super) fn new(request: Request, purpose: Purpose, line: Line, now: Moment) -> Self {
        Self { request, purpose, clock: ReplyClock::new(now, line.reply_wait(&request)) }
    }

    pub(super) fn code(&self) -> u8 {
        self.request.command().code()
    }

    pub(super) fn is_order(&self) -> bool {
        matches!(self.purpose, Purpose::Order(_))
    }

    pub(super) fn disown(&mut self) {
        if self.is_order() {
            self.purpose = Purpose::Disowned;
        }
    }

    fn is_answered_by(&self, reply: &Reply) -> bool {
        self.code()
            == match reply {
                Reply::DeviceType(_) => Command::DeviceType.code(),
                Reply::Status { command, .. } => command.code(),
                Reply::SatelliteName(_) => Command::SatelliteName.code(),
                Reply::Offline { code } | Reply::Refused { code } => *code,
            }
    }
}

impl Rc2000c {
    /// Takes a received frame.
    pub(super) fn take_frame(&mut self, frame: Result<Frame, FrameError>, now: Moment) {
        let frame = match frame {
            Ok(frame) => frame,
            Err(error) => {
                self.state.traffic.damaged += 1;
                self.state.traffic.last_unreadable = Some(now.steady);
                self.record_broken(error, now);
                return tracing::debug!(%error, "damaged frame");
            }
        };
        self.record_frame(&frame, now);
        match Reply::parse(&frame) {
            Ok(reply) => self.match_reply(&reply, now),
            // Adapters for such lines return the bytes that they receive.
            Err(ReplyError::Echo { .. }) => self.state.traffic.odd += 1,
            Err(error) => {
                self.state.traffic.unreadable += 1;
                self.state.traffic.last_unreadable = Some(now.steady);
                tracing::debug!(%error, "unreadable reply");
            }
        }
    }

    fn match_reply(&mut self, reply: &Reply, now: Moment) {
        let answered = self
            .outstanding
            .take_if(|sent| sent.is_answered_by(reply))
            .or_else(|| self.halt.take_if(|sent| sent.is_answered_by(reply)));
        let Some(answered) = answered else { return self.take_surplus(reply, now) };
        self.count_reply(now);
        if answered.purpose == Purpose::Halt {
            // The unit answers in order, so the answer to a question before the halt is lost.
            let overtaken = self.outstanding.take_if(|sent| sent.purpose == Purpose::Poll);
            if let Some(lost) = overtaken {
                self.miss(&lost, false, now);
            }
        }
        let moment = self.question_time(&answered);
        let has_surplus = match answered.purpose {
            Purpose::Poll => !self.missing.is_empty(),
            _ => answered.clock.is_repeated(),
        };
        if has_surplus {
            self.drain_until = Some(now.steady + self.line.longest_wait());
        }
        self.take_reply(&answered, reply, moment, now);
        self.refresh_panel();
    }

    /// Takes a reply without an open request: a status may answer a missing question.
    fn take_surplus(&mut self, reply: &Reply, now: Moment) {
        if let Reply::Status { command: Command::Status, status } = reply
            && let Some(moment) = self.missing.pop_front()
        {
            self.count_reply(now);
            self.end_drain();
            self.take_status(*status, moment, moment, now);
            return self.refresh_panel();
        }
        self.state.traffic.unsolicited += 1;
        tracing::debug!(?reply, "nobody asked for this");
    }

    fn count_reply(&mut self, now: Moment) {
        self.state.traffic.replies += 1;
        self.state.traffic.last_reply = Some(now.steady);
        self.gap_until = Some(now.steady + GAP);
    }

    /// Returns the earliest time at which the question that `answered` answers was sent. The unit
    /// answers each question at most once and in order. A status is therefore at least as young as
    /// the oldest unanswered question.
    fn question_time(&mut self, answered: &Outstanding) -> Moment {
        let sent = answered.clock.sent;
        if answered.purpose != Purpose::Poll {
            // The unit answers in order: the answers to earlier questions have come or are lost.
            self.missing.retain(|question| question.steady >= sent.steady);
            self.end_drain();
            return sent;
        }
        self.missing.push_back(sent);
        self.missing.pop_front().unwrap_or(sent)
    }

    /// Ends the wait for surplus answers once none can come.
    fn end_drain(&mut self) {
        self.drain_until.take_if(|_| self.missing.is_empty());
    }

    /// Returns the end of the pause in which only a halt may go out. Azel waits for surplus answers
    /// to recognise them. While the antenna moves and one status is missing, Azel continues to ask,
    /// and counts each answer as asked one question earlier.
    pub(super) fn quiet_until(&self) -> Option<Instant> {
        let drain = self.drain_until.filter(|_| !self.is_watched || self.missing.len() != 1);
        self.gap_until.max(drain)
    }

    fn take_reply(&mut self, answered: &Outstanding, reply: &Reply, moment: Moment, now: Moment) {
        match reply {
            Reply::Offline { .. } => {
                self.is_offline = true;
                self.state.checked_at = Some(now.utc);
                self.fail(answered, REMOTE_DISABLED.to_owned(), now);
            }
            Reply::Refused { .. } => {
                let reason = refusal::likely_reason(&answered.request, self.status.as_ref());
                self.fail(answered, reason, now);
            }
            Reply::DeviceType(device) => {
                self.wants_device = false;
                self.device = Some(*device);
                self.state.identity = Some(device.to_string());
                self.state.unit_name = Some(device.to_string());
            }
            Reply::SatelliteName(entry) => self.names.take(entry),
            Reply::Status { status, .. } => {
                self.take_status(*status, moment, answered.clock.sent, now);
                // The period counts from question to question, which does not slow down a slow line
                // further.
                let period = self.rates.period(self.moving());
                self.poll_at = Some(answered.clock.sent.steady + period);
                if let Purpose::Order(origin) = answered.purpose {
                    self.events.extend(origin.map(ControllerEvent::Accepted));
                }
                let is_jog = matches!(answered.request, Request::Motion(UnitMotion::Jog(_)));
                if answered.purpose != Purpose::Poll && !is_jog {
                    self.look_soon(now);
                }
            }
        }
    }

    /// Takes a status. `moment` is the earliest time at which its question was sent, `sent` the
    /// latest.
    fn take_status(&mut self, status: Status, moment: Moment, sent: Moment, now: Moment) {
        // An offline unit did not report its type, so Azel asks once the unit is online.
        self.wants_device |= std::mem::take(&mut self.is_offline) && self.device.is_none();
        let axes = self.axes.read(&status, self.past.before(now.steady));
        self.past.push(status, now.steady);
        self.status = Some(status);
        let pointing = Axes::pointing(axes, &self.mount);
        let [azimuth, elevation] = axes;
        let before =
            self.state.measured.as_ref().filter(|before| {
                now.steady.saturating_duration_since(before.requested) <= CONTINUOUS
            });
        let before = before.map(|before| &before.axes[0]);
        let azimuth = Axes::unwrapped(azimuth, status.azimuth, before, &self.mount);
        let way = now.steady.saturating_duration_since(sent.steady) / 2;
        self.state.measured = Some(Measured {
            time: now.utc.checked_sub(way).unwrap_or(now.utc),
            requested: moment.steady,
            received: now.steady,
            pointing,
            axes: [azimuth, elevation],
        });
        self.state.motion_lock = Some(checks::forbids_motion(&status));
        self.state.checked_at = Some(now.utc);
        self.state.program = refusal::is_tracking(&status).then_some(Program {
            enabled: true,
            phase: Phase::Tracking,
            auto: None,
        });
        self.state.turns_besides = status.polarization_motion != PolarizationMotion::Still;
        self.hold_polarization(&status);
    }

    /// Sends the polarization to its current position, because a stop of the axes leaves it
    /// turning. A jog of the polarization ends on the unit's timer.
    fn hold_polarization(&mut self, status: &Status) {
        if !std::mem::take(&mut self.holds_polarization) {
            return;
        }
        let is_automatic = status.polarization_mode.is_none_or(|mode| mode.is_automatic);
        let is_under_way = status.polarization_motion == PolarizationMotion::ToStored;
        let units = status.feed.units().filter(|_| is_under_way && !is_automatic);
        if let Some(here) = units.and_then(|units| PolarizationUnits::new(units).ok()) {
            let request = Request::Motion(UnitMotion::AutoMove(AutoMove::polarization(here)));
            self.orders.push_back(QueuedRequest { request, origin: None });
        }
    }

    /// Handles a refusal of the unit.
    fn fail(&mut self, answered: &Outstanding, reason: String, now: Moment) {
        self.end_jog(answered, |origin| ControllerEvent::Refused(origin, reason.clone()));
        match answered.purpose {
            Purpose::Poll | Purpose::Question => self.question_failed(&answered.request, now),
            Purpose::Order(Some(origin)) => {
                self.orders.clear();
                self.events.push_back(ControllerEvent::Refused(origin, reason));
                self.look_soon(now);
            }
            Purpose::Halt | Purpose::Order(None) => {
                self.events.push_back(ControllerEvent::HaltRefused(reason));
                self.look_soon(now);
            }
            Purpose::Disowned => self.look_soon(now),
        }
    }

    fn question_failed(&mut self, request: &Request, now: Moment) {
        match request {
            Request::Query(Query::DeviceType) => self.wants_device = false,
            Request::Query(Query::SatelliteName(_)) => self.names.end(),
            _ => self.poll_at = Some(now.steady + self.rates.period(self.moving())),
        }
    }

    /// Ends the held jog: Azel renews it no more, and the unit's timer stops it. Reports the end
    /// unless the failed command was the jog.
    fn end_jog(
        &mut self,
        failed: &Outstanding,
        tell: impl FnOnce(MotionRequest) -> ControllerEvent,
    ) {
        let is_told = matches!(
            failed.purpose,
            Purpose::Order(Some(MotionRequest::Motion(Motion::Jog { .. })))
        );
        let ended = self.jog.take().filter(|_| !is_told);
        self.events.extend(ended.map(|jog| tell(jog.motion.into())));
    }

    /// Handles a missing reply. Azel repeats a question but never another command, because the next
    /// status shows whether that command arrived.
    pub(super) fn expire(&mut self, now: Moment) -> Option<Vec<u8>> {
        if let Some(late) = self.halt.take_if(|halt| now.steady >= halt.clock.deadline()) {
            self.miss(&late, false, now);
            self.look_soon(now);
        }
        // A second command would be on the line together with the halt.
        if self.halt.is_some() {
            return None;
        }
        let is_late = self
            .outstanding
            .as_ref()
            .is_some_and(|outstanding| now.steady >= self.deadline(outstanding));
        let mut late = self.outstanding.take_if(|_| is_late)?;
        let tries = match late.purpose {
            Purpose::Poll => {
                self.missing.push_back(late.clock.sent);
                self.missing.len()
            }
            Purpose::Question => late.clock.tries.into(),
            Purpose::Order(_) | Purpose::Halt | Purpose::Disowned => MAX_TRIES,
        };
        let is_repeated = tries < MAX_TRIES;
        self.miss(&late, is_repeated, now);
        if is_repeated {
            late.clock.repeat(now);
            let bytes = late.request.to_bytes(self.address);
            self.outstanding = Some(late);
            return Some(bytes);
        }
        match late.purpose {
            Purpose::Poll | Purpose::Question => self.question_failed(&late.request, now),
            Purpose::Order(origin) => {
                self.orders.clear();
                self.events.extend(origin.map(ControllerEvent::Unanswered));
                self.look_soon(now);
            }
            Purpose::Halt | Purpose::Disowned => self.look_soon(now),
        }
        None
    }

    /// Returns the time from which the reply to `sent` counts as missing.
    pub(super) fn deadline(&self, sent: &Outstanding) -> Instant {
        let is_question = matches!(sent.purpose, Purpose::Poll | Purpose::Question);
        if self.is_watched && is_question {
            sent.clock.sent.steady + self.line.prompt(&sent.request)
        } else {
            sent.clock.deadline()
        }
    }

    fn miss(&mut self, late: &Outstanding, is_repeated: bool, now: Moment) {
        self.state.traffic.unanswered += 1;
        if late.purpose == Purpose::Poll {
            self.state.traffic.miss_position(now.steady);
        }
        self.wire.no_reply(late.clock.waited(now), is_repeated, now);
        self.end_jog(late, ControllerEvent::Unanswered);
    }

    pub(super) fn refresh_panel(&mut self) {
        let (status, device) = (self.status.as_ref(), self.device);
        let readings = status.map(|status| readings::readings(status, device, &self.names));
        self.state.show_readings(readings.unwrap_or_default());
        let checks = checks::checks(status, device, self.is_offline, self.axes.are_calibrated());
        self.state.show_checks(checks);
    }
}
