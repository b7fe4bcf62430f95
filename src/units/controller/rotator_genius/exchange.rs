//! One request and its reply: matching, time-outs, effects.

use super::{DRAIN, Genius, MAX_MISSING, QUIET, REPLY, RESCUE_REPLY};
use crate::{
    clock::{Instant, Moment},
    controller::reply_clock::ReplyClock,
    device::{ControllerEvent, MotionRequest, PROMPT},
    protocol::rotator_genius::{
        self as unit, Acknowledgement, Direction, Received, Reply, Request, Status,
    },
};

/// Size of the pieces in which Azel decodes bytes: less than the decoder's capacity.
const PIECE: usize = 1024;

/// Reason for a request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Purpose {
    /// A poll that was due.
    Poll,
    /// A question of the operator.
    Asked,
    /// A command that starts a motion.
    Motion(MotionRequest),
    /// A step of changing the configuration.
    WriteSettings,
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
    pub(super) fn new(request: Request, purpose: Purpose, sent: Moment, is_rescue: bool) -> Self {
        let patience = if is_rescue { RESCUE_REPLY } else { REPLY };
        Self { request, purpose, clock: ReplyClock::new(sent, patience) }
    }

    fn deadline(&self) -> Instant {
        self.clock.deadline()
    }

    pub(super) fn is_motion(&self) -> bool {
        matches!(self.purpose, Purpose::Motion(_))
    }

    pub(super) fn is_read(&self) -> bool {
        self.request == Request::Read
    }

    pub(super) fn is_poll(&self) -> bool {
        self.purpose == Purpose::Poll
    }

    pub(super) fn sent(&self) -> Instant {
        self.clock.sent.steady
    }

    /// Marks a motion that a halt has overtaken. A question keeps its purpose, because it moves
    /// nothing.
    pub(super) fn disown(&mut self) {
        if self.is_motion() {
            self.purpose = Purpose::Disowned;
        }
    }

    /// Returns `true` if `acknowledgement` matches the request; acknowledgements never name the
    /// rotator.
    pub(super) fn is_acknowledged_by(&self, acknowledgement: Acknowledgement) -> bool {
        match (&self.request, acknowledgement) {
            (
                Request::Motion(unit::Motion::GoTo { target, .. }),
                Acknowledgement::GoTo { target: acknowledged },
            ) => acknowledged.is_none_or(|whole_degrees| whole_degrees == *target),
            (
                Request::Motion(unit::Motion::Rotate { direction, .. }),
                Acknowledgement::RotateClockwise,
            ) => *direction == Direction::Clockwise,
            (
                Request::Motion(unit::Motion::Rotate { direction, .. }),
                Acknowledgement::RotateCounterClockwise,
            ) => *direction == Direction::CounterClockwise,
            (Request::Configure(_), Acknowledgement::Configure) => true,
            _ => false,
        }
    }
}

impl Genius {
    /// Takes received bytes.
    pub(super) fn take_bytes(&mut self, bytes: &[u8], now: Moment) {
        for piece in bytes.chunks(PIECE) {
            self.decoder.push(piece);
            self.unfinished.extend(piece);
            // Azel takes the replies one by one, because each may change the expected next reply.
            while let Some(received) = self.decoder.next() {
                self.take(received, now);
            }
        }
        self.quiet_at = (!self.unfinished.is_empty()).then(|| now.steady + QUIET);
    }

    /// Gives up an unfinished reply after a silence.
    pub(super) fn end_unfinished(&mut self, now: Moment) {
        if self.quiet_at.take_if(|quiet_at| now.steady >= *quiet_at).is_some() {
            for received in self.decoder.idle() {
                self.take(received, now);
            }
            self.unfinished.clear();
        }
    }

    fn take(&mut self, received: Received, now: Moment) {
        self.record_received(&received, now);
        match received {
            Received::Reply(Reply::Status(status)) => self.take_answer(status, now),
            Received::Reply(Reply::Acknowledgement {
                request: Acknowledgement::Stop,
                is_accepted,
            }) => {
                self.take_halt_answer(is_accepted, now);
            }
            Received::Reply(Reply::Acknowledgement { request: acknowledgement, is_accepted }) => {
                let is_expected = |sent: &mut Outstanding| sent.is_acknowledged_by(acknowledgement);
                match self.outstanding.take_if(is_expected) {
                    Some(outstanding) => self.take_verdict(&outstanding, is_accepted, now),
                    None => self.state.traffic.unsolicited += 1,
                }
            }
            Received::Noise(bytes) => {
                tracing::debug!(length = bytes.len(), "bytes that are no reply");
                self.take_noise(now);
            }
            Received::LayoutChanged(layout) => {
                self.state.traffic.odd += 1;
                tracing::warn!(?layout, "the status has another form now");
            }
            Received::OtherProtocol => {
                self.state.is_other_device = true;
                tracing::warn!("another protocol answers, or one that asks for a code");
            }
        }
    }

    /// Counts bytes that form no reply.
    pub(super) fn take_noise(&mut self, now: Moment) {
        self.state.traffic.damaged += 1;
        self.state.traffic.last_unreadable = Some(now.steady);
    }

    fn count_reply(&mut self, now: Moment) {
        self.state.traffic.replies += 1;
        self.state.traffic.last_reply = Some(now.steady);
    }

    /// Takes a status. The unit answers each question at most once and in order. A status is
    /// therefore at least as young as the oldest unanswered question.
    fn take_answer(&mut self, status: Status, now: Moment) {
        let read = self.outstanding.take_if(|sent| sent.is_read());
        self.missing.extend(read.as_ref().map(Outstanding::sent));
        let Some(question_time) = self.missing.pop_front() else {
            self.state.traffic.unsolicited += 1;
            return;
        };
        self.count_reply(now);
        let is_behind = self.drain_until.is_some();
        self.drain_until = (!self.missing.is_empty()).then(|| now.steady + DRAIN);
        let sent = read.as_ref().map_or(question_time, Outstanding::sent);
        self.take_status(status, question_time, sent, now);
        let next = sent + self.period(now.steady);
        self.next_poll = self.next_poll.map(|due| due.min(next));
        if self.drain_until.is_some() && !is_behind {
            self.look_soon(now);
        }
        if read.is_some_and(|read| read.purpose == Purpose::WriteSettings) {
            self.change_read(now);
        }
    }

    /// Returns the end of the pause in which Azel asks nothing to recognise a surplus answer. While
    /// the antenna moves and only one answer is missing, Azel continues to ask, and counts each
    /// answer as asked one question earlier.
    pub(super) fn drains_until(&self) -> Option<Instant> {
        self.drain_until.filter(|_| !self.is_watched || self.missing.len() > 1)
    }

    fn take_halt_answer(&mut self, is_accepted: bool, now: Moment) {
        if self.halts.pop_front().is_none() {
            self.state.traffic.unsolicited += 1;
            return;
        }
        self.count_reply(now);
        if !is_accepted {
            self.events.push_back(ControllerEvent::HaltRefused("F".to_owned()));
        }
    }

    fn take_verdict(&mut self, outstanding: &Outstanding, is_accepted: bool, now: Moment) {
        self.count_reply(now);
        self.look_soon(now);
        if outstanding.purpose == Purpose::WriteSettings {
            return self.change_judged(is_accepted, now);
        }
        let Purpose::Motion(origin) = outstanding.purpose else { return };
        if is_accepted {
            if !self.orders.iter().any(|order| order.origin == origin) {
                self.events.push_back(ControllerEvent::Accepted(origin));
            }
            return;
        }
        self.forget_orders(origin);
        if let Request::Motion(request) = outstanding.request {
            let refusal = self.refusal(request);
            self.events.push_back(ControllerEvent::Refused(origin, refusal));
        }
    }

    /// Drops the remaining commands of a motion: half of a motion is useless.
    fn forget_orders(&mut self, origin: MotionRequest) {
        self.orders.retain(|order| order.origin != origin);
    }

    /// Repeats a status question whose answer is missing. Azel never repeats other requests,
    /// because the status shows whether they arrived. Returns the bytes to send immediately.
    pub(super) fn expire(&mut self, now: Moment) -> Option<Vec<u8>> {
        let is_late = self
            .outstanding
            .as_ref()
            .is_some_and(|outstanding| now.steady >= self.deadline(outstanding));
        let late = self.outstanding.take_if(|_| is_late)?;
        self.state.traffic.unanswered += 1;
        self.wire.no_reply(late.clock.waited(now), late.is_read(), now);
        if late.is_read() {
            self.state.traffic.miss_position(now.steady);
            if self.missing.len() < MAX_MISSING {
                self.missing.push_back(late.sent());
            }
        }
        match late.purpose {
            Purpose::Motion(origin) => {
                self.forget_orders(origin);
                self.events.push_back(ControllerEvent::Unanswered(origin));
            }
            Purpose::WriteSettings => self.change_unanswered(now),
            Purpose::Poll | Purpose::Asked | Purpose::Disowned => {}
        }
        self.look_soon(now);
        // Outside the limits, a motion would continue forever once the link is lost.
        let is_blind_rescue = self.is_rescue_armed(now.steady) && self.moving();
        is_blind_rescue.then(|| self.stop_both(now))
    }

    /// Returns the time from which the reply to `sent` counts as missing.
    pub(super) fn deadline(&self, sent: &Outstanding) -> Instant {
        let is_hurried = self.is_watched && sent.is_read();
        if is_hurried { sent.deadline().min(sent.sent() + PROMPT) } else { sent.deadline() }
    }

    pub(super) fn stop_both(&mut self, now: Moment) -> Vec<u8> {
        self.orders.clear();
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
        }
        self.halts.push_back(now.steady + REPLY);
        self.look_soon(now);
        Request::Stop.to_bytes()
    }
}
