//! Automatic operation, and the outcomes of the passes of a day.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    passes::PassListKey, plan::pass_report::LossCause, station::AntennaId, transfer::OldAlgorithm,
};

/// Automatic operation of one antenna. Only the operator switches it on or resumes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    Off(OffBecause),
    On(On),
    /// Somebody moved the antenna. Automatic operation waits for the operator, without a time
    /// limit.
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

    /// Returns the pass that automatic operation is taking.
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
    /// Nobody has switched automatic operation on since the start.
    NotSwitchedOn,
    /// The operator switched automatic operation off.
    Operator,
    Stop,
    /// The monitor or the dead-man stopped the antenna.
    Safety,
    LockedOut,
    /// The operator changed the settings of the antenna.
    Changed,
    /// After an outage, the unit differed from its state before the outage.
    NotAsLeft,
    /// Azel could not load or prove two passes in a row.
    Failures,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interruption {
    /// Command from this station, such as a jog.
    ByHand,
    /// Panel of the unit, or another program.
    Elsewhere,
    /// The unit ended a motion before its end, without a command from Azel: by its panel, another
    /// program, or its own fault.
    EndedByUnit,
    /// Somebody set the clock of this computer, and no time service is known to keep it.
    Clock,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct On {
    pub doing: Doing,
    /// Number of passes in a row that Azel could not load or prove.
    pub failures: u8,
    /// Time at which automatic operation last moved the antenna, or last saw it move.
    pub moved_at: Option<Timestamp>,
    /// Time since which the unit has been tracking without a request; `None` otherwise.
    pub moves_since: Option<Timestamp>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Doing {
    Rests,
    /// Announcement of the first motion after a rest.
    Announces {
        moves_at: Timestamp,
        pass: PassListKey,
    },
    /// Motion to the park position between two passes.
    Parks,
    Takes(Taking),
}

/// A pass that automatic operation is taking.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Taking {
    pub pass: PassListKey,
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// Time of the last request to the unit.
    pub asked_at: Timestamp,
    pub requests: u8,
    pub attempt: Attempt,
    /// Time at which Azel proved that the antenna is on its way. For a unit with its own program,
    /// the proof is a read-back.
    pub proved_at: Option<Timestamp>,
    /// Reason why Azel does not track the pass now; `None` while Azel tracks it.
    pub given_up: Option<GivenUp>,
}

/// Progress of the last request for a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attempt {
    /// Nothing was moved or loaded for the pass.
    NotBegun,
    Begun,
    /// After the start, Azel found that the unit would miss the pass.
    Objected,
}

/// Reason why a unit cannot begin its pass now. Azel judges the unit when the antenna should set
/// out, because an earlier fault may be cleared by then.
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
    /// The unit or the gate refused the pass, or Azel could not prove that the antenna is on its
    /// way.
    Refused,
    /// The antenna stayed off its target.
    OffTarget,
    /// The unit's clock, site or elements would make it miss the rest of the pass.
    WouldMiss,
}

/// A line in the list of the day.
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
    /// Azel set the clock of the unit between two passes.
    ClockSet {
        /// Seconds by which the unit's clock was ahead of the computer's, negative if behind;
        /// `None` if the unit's clock was never set.
        was_ahead_s: Option<f64>,
    },
    ClockNotSet {
        #[serde(rename = "why")]
        reason: String,
    },
    /// Azel uploaded newer elements to the unit between two passes, and verified them.
    ElementsUploaded {
        file: String,
        satellites: usize,
        /// Old algorithms that the SSH connection used.
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
    /// Seconds of the pass that were to be tracked.
    pub of_s: f64,
    /// Seconds of `of_s` with the satellite within half the beamwidth, from the report of the pass.
    pub in_beam_s: f64,
    pub proved_at: Option<Timestamp>,
    /// Main cause of the lost seconds; `None` if the whole pass was tracked.
    pub cause: Option<MissCause>,
}

impl Flown {
    pub fn lost_s(&self) -> f64 {
        (self.of_s - self.in_beam_s).max(0.0)
    }
}

/// Cause of a missed pass, or of a missed part of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissCause {
    Off(OffBecause),
    Suspended(Interruption),
    /// After an outage, nobody answered the question whether to resume tracking.
    NotResumed,
    /// The unit or the gate refused the pass, or Azel could not prove that the antenna is on its
    /// way.
    Refused,
    NotReady(NotReady),
    /// Azel ended the track because the antenna stayed off its target.
    OffTarget,
    /// Cause from the report of the pass.
    #[serde(untagged)]
    Lost(LossCause),
}
