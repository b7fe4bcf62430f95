//! Events that the driver noticed, and actions that it took, for safety without a request.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    name::{self, Name},
    plan::{Barrier, on_board::Ranked, pass_report::Explained},
};

/// Why an antenna is off its satellite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum OffTargetCause {
    /// Something that the unit reports of itself makes an error as large.
    Reported(Ranked),
    /// The positions of the pass so far show it.
    Measured(Explained),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Safety {
    /// The dead-man has stopped the unit, because this program was late.
    DeadManFired,
    /// Azel ended in the middle of a motion by hand, or while a STOP was owed.
    LeftMoving {
        /// `None` if the record of it cannot be read.
        #[serde(rename = "since")]
        start: Option<Timestamp>,
        /// STOP was not sent automatically: the operator must decide.
        asks: bool,
    },
    /// The record of a motion by hand could not be written to disk, so another start would not
    /// know of it.
    NoMark,
    /// The session broke down and was restarted with STOP.
    SessionBroke,
    /// STOP is proved only by the unit's flags: this axis has no angle.
    StoppedByFlags {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
    },
    /// Angles change although the unit says that it stands.
    FlagsContradict {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        turned_deg: f64,
    },
    /// Somebody else has moved an axis, by the unit's panel, by another program or by hand. A motion
    /// of this program ends.
    ForeignHands {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        evidence: Evidence,
    },
    /// It does not answer while it moves on this program's word, or before STOP is proved to
    /// have ended that. The snapshot says until when.
    SilentInMotion,
    /// A motion that the unit accepted does not turn this axis (`None`: either axis), or the sensor
    /// does not show it. Azel has sent STOP.
    NoEffect {
        #[serde(deserialize_with = "name::option")]
        axis: Option<Name>,
    },
    /// The antenna stayed off its target for too long. Azel has sent STOP.
    OffTarget {
        off_deg: f64,
        /// Older records do not hold it.
        #[serde(default)]
        cause: Option<Box<OffTargetCause>>,
    },
    /// The clock of this computer was set.
    ClockStepped {
        /// By this much, seconds; positive ahead.
        by_s: f64,
        /// The new time. Older records do not hold it.
        #[serde(default)]
        time: Option<Timestamp>,
    },
    /// A jog was ended because this computer goes to sleep.
    EndedForSleep,
    Slept {
        lasted: Duration,
    },
    /// The antenna was out of reach: a target is not tracked on without the operator's
    /// consent.
    AsksToResume {
        name: String,
        lost: Duration,
        /// How its unit differs from before; `None` where that is not the reason to ask.
        unlike: Option<Unlike>,
    },
    /// After an outage the unit is not as it was before, or does not say so.
    UnitDiffers {
        unlike: Unlike,
    },
    /// The antenna was about to enter a barrier, or is inside one.
    Forbidden {
        barrier: Barrier,
        driver: Mover,
        response: Response,
    },
}

/// How a unit differs from what it was before it was out of reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unlike {
    /// Another name or firmware.
    Identity,
    /// Other limits of its own.
    Limits,
    /// Another location.
    Place,
    /// Other offsets.
    Offsets,
    /// It does not point where it was left.
    Position,
    /// It has not reported again what it reported before.
    Unread,
}

impl Safety {
    /// The barrier that it is about, if any.
    pub fn barrier(&self) -> Option<&Barrier> {
        match self {
            Self::Forbidden { barrier, .. } => Some(barrier),
            _ => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mover {
    /// This program, by hand or by positions.
    Azel,
    /// The unit's own program.
    Program,
    /// Nobody known here: the panel, another client, an overrun.
    Somebody,
}

/// Response to an antenna that enters a barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Response {
    Stopped,
    /// The operator was told; STOP is not wanted there, or would keep the antenna inside.
    Reported,
}

/// Evidence that somebody else moves an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Evidence {
    /// The axis is outside the interval that Azel's commands can reach.
    Outside {
        /// Distance from that interval, degrees, positive clockwise or up.
        off_deg: f64,
    },
    /// The unit reports a jog that Azel did not send.
    Jogged,
    /// The unit reports that the axis turns without a command.
    Runaway,
}
