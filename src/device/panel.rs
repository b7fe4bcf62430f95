//! The panel of a controller: what it tells beyond its position, and what only
//! it can do. The window draws both from these descriptions.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::settings::{Field, Values};
use crate::name::{self, Name};

/// One line of what a device tells of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Before the value. Lines with the same label would not be told apart.
    pub label: Cow<'static, str>,
    /// As shown, with its unit.
    pub text: String,
    /// For a bar: how full it is, 0 to 1.
    pub share: Option<f64>,
    /// Whether it is worth a second look.
    pub tone: Tone,
}

impl Reading {
    /// A plain line.
    pub fn new(label: impl Into<Cow<'static, str>>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into(), share: None, tone: Tone::Plain }
    }

    /// With a bar that is full by `share`, 0 to 1.
    #[must_use]
    pub fn with_bar(self, share: f64) -> Self {
        Self { share: Some(share.clamp(0.0, 1.0)), ..self }
    }

    /// In this tone.
    #[must_use]
    pub fn in_tone(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }
}

/// How something that a device tells, or is told, is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tone {
    /// As usual.
    Plain,
    /// Something is to be changed or to move.
    Change,
    /// It was accepted.
    Good,
    /// Unusual.
    Caution,
    /// Wrong, or refused.
    Bad,
}

/// A fault or warning that a device can report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// As the operator knows it.
    #[serde(deserialize_with = "name::one")]
    pub name: Name,
    /// What is good, or not, with it; after the name, may be empty.
    #[serde(deserialize_with = "name::one")]
    pub about: Name,
    /// How it is.
    pub state: CheckState,
    /// How the device puts it where it says more than `state` does; else empty.
    pub told: Cow<'static, str>,
    /// What to do about it, in a sentence.
    #[serde(deserialize_with = "name::one")]
    pub advice: Name,
    /// As long as it is a fault, nothing may be moved.
    pub locks_motion: bool,
}

impl Check {
    /// One that locks no motion.
    pub const fn new(name: &'static str, state: CheckState, advice: &'static str) -> Self {
        let told = Cow::Borrowed("");
        Self { name, about: "", state, told, advice, locks_motion: false }
    }

    /// Whether it is a fault for which nothing may be moved.
    pub fn forbids_motion(&self) -> bool {
        self.locks_motion && self.state == CheckState::Fault
    }
}

/// How a checked thing is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CheckState {
    /// Not told.
    Unknown,
    /// All right.
    Good,
    /// A warning.
    Caution,
    /// A fault.
    Fault,
}

/// What only this make of controller can do.
#[derive(Debug)]
pub struct Action {
    /// Names it in commands and logs.
    pub key: &'static str,
    /// On its key.
    pub label: &'static str,
    /// What it does, in a sentence or two.
    pub about: &'static str,
    /// What it needs to be told; the window asks for it.
    pub fields: &'static [Field],
    /// Metal may move by it: it passes every rule of the gate.
    pub moves: bool,
    /// Asked before it is done, where it cannot be undone.
    pub question: Option<&'static str>,
}

/// An action with what it was told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Act {
    /// Key of the action.
    #[serde(deserialize_with = "name::one")]
    pub action: Name,
    /// By the keys of its fields.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
}

/// Where an action leads the axes of the mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lead {
    /// They stay: nothing turns, or something else does.
    Nowhere,
    /// There, degrees as the mount counts; `None` stays as it is.
    To([Option<f64>; 2]),
    /// Where the unit alone knows, for this reason: the operator answers for it.
    Unseen(&'static str),
    /// Nobody knows where as long as this is so; it is not sent.
    Unknown(&'static str),
}
