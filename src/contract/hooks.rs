//! Calls of hooks and their results.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    passes::PassListKey,
    station::{AntennaId, HookEvent},
};

/// Max time by which a pass of the station begins before that of an antenna, seconds.
const MAX_EARLIER_S: i64 = 1200;

/// Call of a hook, for the record and for the views.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HookRun {
    /// Number of the call in this run of the station.
    pub number: u64,
    /// Name of the hook.
    pub hook: String,
    pub event: HookEvent,
    /// Time of the event.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Time of the call.
    pub started: Timestamp,
    pub antenna: Option<AntennaId>,
    /// Pass of the event; `None` for an alarm.
    pub pass: Option<PassListKey>,
    /// Short name of the satellite.
    pub satellite: Option<String>,
    /// The operator asked for the call in Preferences.
    pub is_trial: bool,
    pub state: HookState,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HookState {
    Running,
    Ended(HookOutcome),
    NotRun(NotRun),
}

/// End of a call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HookOutcome {
    pub duration_s: f64,
    pub result: HookResult,
    /// First 4 kB of the output of the program, or of the reply of the server.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub output: String,
    /// There was more output than `output` has.
    #[serde(default)]
    pub is_cut: bool,
}

/// Result of a call.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HookResult {
    /// Exit code of the program.
    Exited(i32),
    /// A signal ended the program.
    Killed,
    /// Azel ended the call after its timeout.
    TimedOut,
    /// Reason why the program cannot start.
    CannotStart(String),
    /// Status of the reply of the server.
    Answered(u16),
    /// Reason why the server did not answer.
    NoAnswer(String),
    /// The call failed inside Azel.
    BrokeOff,
}

impl HookResult {
    /// Returns `true` if the call did its work: exit code 0, or a status of the 200s.
    pub fn is_success(&self) -> bool {
        match self {
            Self::Exited(code) => *code == 0,
            Self::Answered(status) => (200..300).contains(status),
            Self::Killed
            | Self::TimedOut
            | Self::CannotStart(_)
            | Self::NoAnswer(_)
            | Self::BrokeOff => false,
        }
    }
}

/// Reason why Azel did not call a hook.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NotRun {
    /// The hook still has its max number of calls under way.
    Busy,
    /// The clock jumped over the time of the call, or the computer slept.
    TooLate,
}

impl HookRun {
    /// Returns `true` if the call failed or did not happen.
    pub fn is_failure(&self) -> bool {
        match &self.state {
            HookState::Running => false,
            HookState::Ended(outcome) => !outcome.result.is_success(),
            HookState::NotRun(_) => true,
        }
    }

    /// Returns `true` if the call belongs to the pass of an antenna that is up from `start` to
    /// `end`. An antenna's own minimum elevation may shorten the pass of the station.
    pub fn belongs_to(
        &self,
        antenna: AntennaId,
        satellite: u32,
        start: Timestamp,
        end: Timestamp,
    ) -> bool {
        let is_pass = self.pass.is_some_and(|(number, aos)| {
            let earlier_s = start.as_second() - aos.as_second();
            number == satellite && aos < end && earlier_s <= MAX_EARLIER_S
        });
        self.antenna == Some(antenna) && is_pass
    }
}
