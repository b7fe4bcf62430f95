//! Automatic operation, and what came of the passes of a day.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    passes::PassListKey, plan::pass_report::LossCause, station::AntennaId, transfer::OldAlgorithm,
};

/// Automatic operation of one antenna. Only the operator switches it on, and lets it go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    Off(OffBecause),
    On(On),
    /// Somebody moved the antenna: it waits for the operator, whatever the time.
    Suspended {
        #[serde(rename = "by")]
        interruption: Interruption,
        #[serde(rename = "since")]
        start: Timestamp,
    },
}

impl Operation {
    pub fn is_on(&self) -> bool {
        matches!(self, Self::On(_))
    }

    /// The pass that is being taken.
    pub fn taking(&self) -> Option<&Taking> {
        match self {
            Self::On(On { doing: Doing::Takes(taking), .. }) => Some(taking),
            _ => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OffBecause {
    /// Nobody has switched it on since the start.
    NotSwitchedOn,
    /// The operator switched it off.
    Operator,
    Stop,
    /// The monitor or the dead-man has stopped the antenna.
    Safety,
    LockedOut,
    /// The settings of the antenna were changed.
    Changed,
    /// After an outage the unit was not as it had been left.
    NotAsLeft,
    /// Two passes in a row could not be loaded or proved.
    Failures,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interruption {
    /// By a command from this station, such as a jog.
    ByHand,
    /// By the panel of the unit, or by another program.
    Elsewhere,
    /// The unit ended a motion before its end, and Azel had not: by its panel, by another program, or by
    /// a fault of its own.
    EndedByUnit,
    /// The clock of this computer was set, and no time service is known to keep it.
    Clock,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct On {
    pub doing: Doing,
    /// Passes in a row that could not be loaded or proved.
    pub failures: u8,
    /// When the antenna was last moved by automatic operation, or seen to be.
    pub moved_at: Option<Timestamp>,
    /// Since when its unit tracks although nothing is asked of it.
    pub moves_since: Option<Timestamp>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Doing {
    Rests,
    /// The first motion after a rest is announced.
    Announces {
        moves_at: Timestamp,
        pass: PassListKey,
    },
    /// Goes to its park position between two passes.
    Parks,
    Takes(Taking),
}

/// A pass that is being taken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Taking {
    pub pass: PassListKey,
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// When the unit was asked last, and how often since the pass was last proved.
    pub asked_at: Timestamp,
    pub requests: u8,
    pub attempt: Attempt,
    /// When it was proved that the antenna is on its way; for a unit with a program of its own
    /// by reading back.
    pub proved_at: Option<Timestamp>,
    /// Reason why Azel does not track the pass now.
    pub given_up: Option<GivenUp>,
}

/// Progress of the last request for a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attempt {
    /// Nothing has moved or been loaded for it.
    NotBegun,
    Begun,
    /// After it had begun, the unit was found to miss the pass.
    Objected,
}

/// Reason why a unit cannot begin its pass now. Azel judges this when the antenna should set out,
/// because an earlier fault may be cleared by then.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NotReady {
    /// A fault of the unit locks its motion.
    Fault,
    /// An axis has no position.
    NoPosition,
    /// The unit's clock, site or elements would make it miss the pass.
    WouldMiss,
}

/// Reason why Azel does not track a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GivenUp {
    /// The unit or the gate refused it, or it could not be proved.
    Refused,
    /// The antenna stayed off its target.
    OffTarget,
    /// The unit's clock, site or elements would make it miss the rest of the pass.
    WouldMiss,
}

/// A line of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DayLine {
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub antenna: AntennaId,
    #[serde(rename = "what")]
    pub event: DayEvent,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DayEvent {
    SwitchedOn,
    SwitchedOff(OffBecause),
    Suspended(Interruption),
    WentOn,
    Flown(Flown),
    /// The clock of the unit was set between two passes.
    ClockSet {
        /// Seconds by which it was ahead of this computer's, negative if it was behind; `None` if it
        /// was never set.
        was_ahead_s: Option<f64>,
    },
    ClockNotSet {
        #[serde(rename = "why")]
        reason: String,
    },
    /// Newer elements were uploaded to the unit between two passes, and verified.
    ElementsUploaded {
        file: String,
        satellites: usize,
        /// Old algorithms of the SSH connection.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        old_algorithms: Vec<OldAlgorithm>,
    },
    ElementsNotUploaded {
        #[serde(rename = "why")]
        reason: String,
    },
}

/// Outcome of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Flown {
    pub pass: PassListKey,
    /// Short name of the satellite.
    pub name: String,
    /// Seconds that were to be had.
    pub of_s: f64,
    /// Seconds of them within half the beamwidth, as the report of the pass has it.
    pub in_beam_s: f64,
    pub proved_at: Option<Timestamp>,
    /// Why most of the rest was lost; `None` where all of it was tracked.
    pub cause: Option<MissCause>,
}

impl Flown {
    pub fn lost_s(&self) -> f64 {
        (self.of_s - self.in_beam_s).max(0.0)
    }
}

/// Why a pass, or a part of it, was missed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissCause {
    Off(OffBecause),
    Suspended(Interruption),
    /// After an outage nobody answered the question of tracking on.
    NotResumed,
    /// The unit or the gate refused it, or it could not be proved.
    Refused,
    NotReady(NotReady),
    /// The track was ended, because the antenna stayed off its target.
    OffTarget,
    /// As the report of the pass tells it.
    #[serde(untagged)]
    Lost(LossCause),
}
