//! Safety events that the driver noticed, and its actions without a request.

use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    name::{self, Name},
    plan::{Barrier, on_board::Ranked, pass_report::Explained},
};

/// Reason why an antenna points off its satellite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum OffTargetCause {
    /// The unit reports a condition that explains an error of this size.
    Reported(Ranked),
    /// The measured positions of the pass so far show the cause.
    Measured(Explained),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Safety {
    /// The dead-man stopped the unit, because this program was late.
    DeadManFired,
    /// Azel ended during a motion by hand, or while it owed a STOP.
    LeftMoving {
        /// Start of the motion; `None` if its record cannot be read.
        #[serde(rename = "since")]
        start: Option<Timestamp>,
        /// Azel did not send STOP automatically: the operator must decide.
        asks: bool,
    },
    /// Azel could not record a motion by hand on disk, so the next start would not know of the
    /// motion.
    NoMark,
    /// The session crashed and was restarted with STOP.
    SessionBroke,
    /// Only the unit's flags prove the standstill, because this axis has no angle.
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
    /// Somebody moved an axis by the unit's panel, by another program or by hand. A motion of this
    /// program ends.
    ForeignHands {
        #[serde(deserialize_with = "name::one")]
        axis: Name,
        evidence: Evidence,
    },
    /// The unit does not answer during a motion that Azel commanded, or before STOP is proved.
    /// `silent` in the snapshot stays true while the silence lasts.
    SilentInMotion,
    /// A motion that the unit accepted does not turn this axis (`None`: either axis), or the sensor
    /// does not show the motion. Azel has sent STOP.
    NoEffect {
        #[serde(deserialize_with = "name::option")]
        axis: Option<Name>,
    },
    /// The antenna stayed off its target for too long. Azel has sent STOP.
    OffTarget {
        off_deg: f64,
        /// Likeliest cause; missing in older records.
        #[serde(default)]
        cause: Option<Box<OffTargetCause>>,
    },
    /// Somebody set the clock of this computer.
    ClockStepped {
        /// Step of the clock, seconds; positive ahead.
        by_s: f64,
        /// New time; missing in older records.
        #[serde(default)]
        time: Option<Timestamp>,
    },
    /// Azel ended a jog because this computer goes to sleep.
    EndedForSleep,
    Slept {
        lasted: Duration,
    },
    /// The antenna was out of reach. Azel does not resume the track without the operator's consent.
    AsksToResume {
        name: String,
        lost: Duration,
        /// Difference of the unit from before; `None` if it is not the reason to ask.
        unlike: Option<Unlike>,
    },
    /// After an outage, the unit differs from before or has not reported its state.
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

/// Difference of a unit from its state before the outage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unlike {
    /// Name or firmware.
    Identity,
    /// Limits of the unit's own.
    Limits,
    Place,
    Offsets,
    /// Position: the antenna does not point where Azel left it.
    Position,
    /// Missing report: the unit has not repeated an earlier report.
    Unread,
}

impl Safety {
    /// Returns the barrier of the event, if any.
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
    /// An unknown party: the panel, another client or an overrun.
    Somebody,
}

/// Response to an antenna that enters a barrier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Response {
    Stopped,
    /// Message to the operator without STOP, because the operator does not want STOP there or STOP
    /// would keep the antenna inside.
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
