//! What the driver has seen or done for safety, beyond what was asked of it.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    name::{self, Name},
    plan::Barrier,
};

/// A matter of safety, for the event line and the alarm list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Safety {
    /// The dead-man has stopped the unit, because this program was late.
    DeadManFired,
    /// Azel ended in the middle of a motion by hand, or while a STOP was owed.
    LeftMoving {
        /// When that motion or STOP began.
        since: Timestamp,
        /// STOP was not sent by itself: the operator is to decide.
        asks: bool,
    },
    /// The mark of a motion by hand could not be written to disk, so another start
    /// would not know of it.
    NoMark,
    /// The session broke down and was started again with STOP.
    SessionBroke,
    /// STOP is proved by what the unit says alone: this axis tells no angle.
    StoppedByFlags {
        /// Name of the axis.
        #[serde(deserialize_with = "name::one")]
        axis: Name,
    },
    /// Angles change although the unit says that it stands.
    FlagsContradict {
        /// Name of the axis.
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        /// By how much it has turned, degrees.
        turned_deg: f64,
    },
    /// It does not answer while it moves on this program's word, or before STOP is proved to
    /// have ended that. The snapshot says until when.
    SilentInMotion,
    /// A held jog does not turn the axis.
    JogWithoutEffect,
    /// The clock of this computer was set.
    ClockStepped {
        /// By this much, seconds; positive ahead.
        by_s: f64,
    },
    /// A jog was ended because this computer goes to sleep.
    EndedForSleep,
    /// This computer slept.
    Slept {
        /// For this long.
        lasted: Duration,
    },
    /// A target is not followed further without the operator's word: the antenna was
    /// out of sight.
    AsksToResume {
        /// Name of the target.
        name: String,
        /// For how long.
        lost: Duration,
        /// How its unit differs from what it was before; `None` where that is not why
        /// it asks.
        unlike: Option<Unlike>,
    },
    /// The antenna was about to enter, or is inside, what is forbidden.
    Forbidden {
        /// What it is.
        barrier: Barrier,
        /// Who drove.
        driver: Mover,
        /// What was done about it.
        response: Response,
    },
}

/// In what a unit differs from what it was before it was out of sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unlike {
    /// It gives another name or firmware.
    Identity,
    /// Its own limits are others.
    Limits,
    /// It takes itself to stand elsewhere.
    Place,
    /// It adds something else to its path.
    Offsets,
    /// It does not tell again what it told before.
    Unread,
}

impl Safety {
    /// Where the antenna must not point, where it is about that.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Forbidden { barrier, .. } => Some(barrier),
            _ => None,
        }
    }
}

/// Who moves an antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mover {
    /// This program, by hand or position by position.
    Azel,
    /// The unit's own program.
    Program,
    /// Nobody that is known here: the panel, another client, an overrun.
    Somebody,
}

/// What was done about an antenna that enters what is forbidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Response {
    /// STOP was sent.
    Stopped,
    /// The operator was told; STOP is not wanted there, or would keep it inside.
    Told,
}
