//! State of a unit's answers. Clients show a link only by this judgement.

use std::time::Duration;

use super::AntennaModel;
use crate::{
    clock::Instant,
    device::MotionRequest,
    driver::{LinkState, Refusal, Snapshot, position_for},
};

/// Max time without a reply that counts as a hiccup of the link.
const HICCUP: Duration = Duration::from_secs(3);

/// State of a unit's answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answers {
    /// No link is wanted.
    Off,
    /// The link is being opened for the first time.
    Connecting,
    InTime,
    /// Late replies, or a missing reply: the last report is this old.
    Late(Duration),
    /// The link is open, but no reply has come for this long, which exceeds a hiccup.
    Silent(Duration),
    /// The link is lost, with the time without a reply.
    Lost(Duration),
}

/// Reason to offer no motion, because of the age of the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoMotion {
    /// No position was read on the current link.
    Unread,
    /// Replies are late.
    Late,
    /// No reply comes.
    Silent,
}

impl Answers {
    /// Returns `true` if the last report still describes the unit, as far as Azel knows.
    pub fn is_current(self) -> bool {
        match self {
            Self::InTime => true,
            Self::Late(_) => self.overdue().is_none(),
            Self::Off | Self::Connecting | Self::Silent(_) | Self::Lost(_) => false,
        }
    }

    /// Returns the age of the last report, if it exceeds a hiccup of the link.
    pub fn overdue(self) -> Option<Duration> {
        match self {
            Self::Off | Self::Connecting | Self::InTime => None,
            Self::Late(age) => (age >= HICCUP).then_some(age),
            Self::Silent(age) | Self::Lost(age) => Some(age),
        }
    }
}

impl AntennaModel {
    /// Returns the state of the unit's answers at `now`.
    pub fn answers(&self, now: Instant) -> Answers {
        let Snapshot { link, state, .. } = &*self.snapshot;
        let age = |start: Instant| now.saturating_duration_since(start);
        let as_of = match *link {
            LinkState::Off => return Answers::Off,
            LinkState::Connecting { .. } => return Answers::Connecting,
            LinkState::Lost { start, .. } => return Answers::Lost(age(start)),
            LinkState::Up { .. } if self.is_live() => return Answers::InTime,
            // The last report came over an earlier link, so the age of this link counts.
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

    /// Returns the reason, concerning the age of the position, why no control offers `motion` now.
    /// A position that the gate refuses is always a reason. Replies that are late by more than a
    /// hiccup are a reason even while the gate would still accept their position.
    pub fn no_motion(&self, motion: &MotionRequest, now: Instant) -> Option<NoMotion> {
        let refusal = position_for(motion, &self.snapshot.state, now).err();
        let is_unread = refusal == Some(Refusal::PositionUnknown);
        match self.answers(now) {
            // The link itself is the reason, so the age of the position adds none.
            Answers::Off | Answers::Connecting | Answers::Lost(_) => None,
            Answers::Silent(_) => Some(NoMotion::Silent),
            // A session asks for a newer position before a jog, so only a missing position is a
            // reason.
            Answers::InTime => is_unread.then_some(NoMotion::Unread),
            Answers::Late(_) if is_unread => Some(NoMotion::Unread),
            Answers::Late(age) => (refusal.is_some() || age >= HICCUP).then_some(NoMotion::Late),
        }
    }

    /// Returns `true` if no reply has come for longer than a hiccup of the link.
    pub fn is_silent(&self, now: Instant) -> bool {
        match self.answers(now) {
            Answers::InTime | Answers::Late(_) => false,
            Answers::Off | Answers::Connecting | Answers::Silent(_) | Answers::Lost(_) => true,
        }
    }
}
