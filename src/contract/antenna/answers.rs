//! How a unit answers: the one judgement behind all that a client shows of a link.

use std::time::Duration;

use super::AntennaModel;
use crate::{
    clock::Instant,
    device::MotionRequest,
    driver::{LinkState, Refusal, Snapshot, position_for},
};

/// Longest time without a reply that is a hiccup of the link.
const HICCUP: Duration = Duration::from_secs(3);

/// How a unit answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answers {
    /// Nobody wants a link.
    Off,
    /// The link is opened for the first time.
    Connecting,
    InTime,
    /// Replies come, but late, or one is missing: the last report is this old.
    Late(Duration),
    /// The link is open. The time without a reply is longer than a hiccup.
    Silent(Duration),
    /// The link is gone, with the time without a reply.
    Lost(Duration),
}

/// Why no motion is offered, by the age of the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoMotion {
    /// It was not read on this link.
    Unread,
    /// Replies are late.
    Late,
    /// No reply comes.
    Silent,
}

impl Answers {
    /// Returns `true` if the last report is true now, as far as anybody knows.
    pub fn is_current(self) -> bool {
        match self {
            Self::InTime => true,
            Self::Late(_) => self.overdue().is_none(),
            Self::Off | Self::Connecting | Self::Silent(_) | Self::Lost(_) => false,
        }
    }

    /// Age of the last report, if it is older than a hiccup of the link explains.
    pub fn overdue(self) -> Option<Duration> {
        match self {
            Self::Off | Self::Connecting | Self::InTime => None,
            Self::Late(age) => (age >= HICCUP).then_some(age),
            Self::Silent(age) | Self::Lost(age) => Some(age),
        }
    }
}

impl AntennaModel {
    /// Returns how the unit answers.
    pub fn answers(&self, now: Instant) -> Answers {
        let Snapshot { link, state, .. } = &*self.snapshot;
        let age = |start: Instant| now.saturating_duration_since(start);
        let as_of = match *link {
            LinkState::Off => return Answers::Off,
            LinkState::Connecting { .. } => return Answers::Connecting,
            LinkState::Lost { start, .. } => return Answers::Lost(age(start)),
            LinkState::Up { .. } if self.is_live() => return Answers::InTime,
            // The last report came over an earlier link.
            LinkState::Up { start } => start,
            LinkState::Stale { as_of } => as_of,
        };
        let silent = age(state.traffic.last_reply.unwrap_or(as_of));
        if silent >= HICCUP {
            return Answers::Silent(silent);
        }
        let request_time = state.measured_on_link().map_or(as_of, |measured| measured.requested);
        Answers::Late(age(request_time.min(as_of)))
    }

    /// Returns the reason why no control offers `motion` now, as far as the age of the
    /// position decides it. A position that the gate refuses is always a reason. So are replies that
    /// are late by more than a hiccup, even while the gate would still pass their position.
    pub fn no_motion(&self, motion: &MotionRequest, now: Instant) -> Option<NoMotion> {
        let refusal = position_for(motion, &self.snapshot.state, now).err();
        let is_unread = refusal == Some(Refusal::PositionUnknown);
        match self.answers(now) {
            // The link is the reason.
            Answers::Off | Answers::Connecting | Answers::Lost(_) => None,
            Answers::Silent(_) => Some(NoMotion::Silent),
            // A session asks for a younger position before a jog.
            Answers::InTime => is_unread.then_some(NoMotion::Unread),
            Answers::Late(_) if is_unread => Some(NoMotion::Unread),
            Answers::Late(age) => (refusal.is_some() || age >= HICCUP).then_some(NoMotion::Late),
        }
    }

    /// Returns `true` if no reply has come for longer than a hiccup of the link lasts.
    pub fn is_silent(&self, now: Instant) -> bool {
        match self.answers(now) {
            Answers::InTime | Answers::Late(_) => false,
            Answers::Off | Answers::Connecting | Answers::Silent(_) | Answers::Lost(_) => true,
        }
    }
}
