//! Panel of a controller: readings beyond the position, and actions that only its make has.
//! The window draws both from these descriptions.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::settings::{Field, Values};
use crate::name::{self, Name};

/// One line that a unit reports about itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Label before the value, different for each line.
    pub label: Cow<'static, str>,
    /// Value as shown, with its unit.
    pub text: String,
    /// Fill of a bar, 0 to 1; `None` for no bar.
    pub share: Option<f64>,
    pub tone: Tone,
}

impl Reading {
    /// Returns a plain line without a bar.
    pub fn new(label: impl Into<Cow<'static, str>>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into(), share: None, tone: Tone::Plain }
    }

    /// Adds a bar with the fill `share`, 0 to 1.
    #[must_use]
    pub fn with_bar(self, share: f64) -> Self {
        Self { share: Some(share.clamp(0.0, 1.0)), ..self }
    }

    #[must_use]
    pub fn in_tone(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }
}

/// Tone of a report or a command in the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tone {
    Plain,
    /// A change of a setting, or a motion.
    Change,
    /// Good news, such as an accepted command.
    Good,
    Caution,
    /// A fault or a refusal.
    Bad,
}

/// A fault or warning that a device can report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// Name as the operator knows it.
    #[serde(deserialize_with = "name::one")]
    pub name: Name,
    /// Meaning of a good result, shown after the name of the check; may be empty.
    #[serde(deserialize_with = "name::one")]
    pub when_good: Name,
    pub state: CheckState,
    /// The unit's own text if it says more than `state`; else empty.
    #[serde(rename = "told")]
    pub unit_text: Cow<'static, str>,
    /// Advice to the operator, as a sentence.
    #[serde(deserialize_with = "name::one")]
    pub advice: Name,
    /// `true` if a fault of this check forbids all motion.
    pub locks_motion: bool,
}

impl Check {
    /// Returns a check that never forbids motion.
    pub const fn new(name: &'static str, state: CheckState, advice: &'static str) -> Self {
        let text = Cow::Borrowed("");
        Self { name, when_good: "", state, unit_text: text, advice, locks_motion: false }
    }

    /// Returns `true` for a fault that forbids all motion.
    pub fn forbids_motion(&self) -> bool {
        self.locks_motion && self.state == CheckState::Fault
    }
}

/// Result of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CheckState {
    /// A check that the unit has not reported.
    Unknown,
    Good,
    /// A warning.
    Caution,
    Fault,
}

/// An action that only this make has.
#[derive(Debug)]
pub struct Action {
    /// Name in commands and logs.
    pub key: &'static str,
    /// Text on the button of the action.
    pub label: &'static str,
    /// Effect, in a sentence or two.
    pub description: &'static str,
    /// Inputs for which the window asks.
    pub fields: &'static [Field],
    /// `true` if the action may move the antenna: it then passes every rule of the gate.
    pub moves: bool,
    /// Confirmation question before an action that the operator cannot undo.
    pub question: Option<&'static str>,
}

/// An action with its inputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Act {
    /// Key of the action.
    #[serde(deserialize_with = "name::one")]
    pub action: Name,
    /// Inputs by the keys of the action's fields.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
}

/// Direction to which an action leads the axes of the mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lead {
    /// No direction: the action turns no axis of the mount.
    Nowhere,
    /// These angles, degrees of the mount; `None` leaves an axis unchanged.
    To([Option<f64>; 2]),
    /// A direction that only the unit knows, for this reason; the operator is responsible for it.
    Unseen(&'static str),
    /// An unknown direction, for this reason; Azel does not send the action.
    Unknown(&'static str),
}
