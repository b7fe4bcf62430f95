//! Panel of a controller: readings beyond the position, and actions that only its make has.
//! The window draws both from these descriptions.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::settings::{Field, Values};
use crate::name::{self, Name};

/// One line that a unit reports about itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Text before the value. Each line needs a label of its own.
    pub label: Cow<'static, str>,
    /// Value as shown, with its unit.
    pub text: String,
    /// Fill of a bar, 0 to 1; `None` for no bar.
    pub share: Option<f64>,
    pub tone: Tone,
}

impl Reading {
    /// A plain line without a bar.
    pub fn new(label: impl Into<Cow<'static, str>>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into(), share: None, tone: Tone::Plain }
    }

    /// Adds a bar that is full by `share`, 0 to 1.
    #[must_use]
    pub fn with_bar(self, share: f64) -> Self {
        Self { share: Some(share.clamp(0.0, 1.0)), ..self }
    }

    #[must_use]
    pub fn in_tone(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }
}

/// Tone in which a report or a command is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tone {
    Plain,
    /// A setting is to change, or something is to move.
    Change,
    /// Good news, such as an accepted command.
    Good,
    Caution,
    /// Wrong, or refused.
    Bad,
}

/// A fault or warning that a device can report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// Name as the operator knows it.
    #[serde(deserialize_with = "name::one")]
    pub name: Name,
    /// Shown after the name of a check that is good: what that means; may be empty.
    #[serde(deserialize_with = "name::one")]
    pub when_good: Name,
    pub state: CheckState,
    /// The unit's own words where they say more than `state`; else empty.
    #[serde(rename = "told")]
    pub unit_text: Cow<'static, str>,
    /// Advice to the operator, as a sentence.
    #[serde(deserialize_with = "name::one")]
    pub advice: Name,
    /// A fault here forbids all motion.
    pub locks_motion: bool,
}

impl Check {
    /// A check that never forbids motion.
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
    /// Not reported.
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
    /// Text on its button.
    pub label: &'static str,
    /// Effect, in a sentence or two.
    pub description: &'static str,
    /// Inputs that the window asks for.
    pub fields: &'static [Field],
    /// The action may move the antenna, so it passes every rule of the gate.
    pub moves: bool,
    /// Confirmation question, for an action that cannot be undone.
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

/// Where an action leads the axes of the mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lead {
    /// The mount's axes stay: nothing turns, or something else does.
    Nowhere,
    /// To these angles, degrees as the mount counts; `None` leaves an axis as it is.
    To([Option<f64>; 2]),
    /// Only the unit knows where, for this reason; the operator answers for it.
    Unseen(&'static str),
    /// Nobody knows where, for this reason; the action is not sent.
    Unknown(&'static str),
}
