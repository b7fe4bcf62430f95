//! What the rest of the program knows of a make of controller without a link.

use super::{Capabilities, ElementFiles, Explained, WireLine, panel::Action, settings::Group};

/// One make of controller, as the rest of the program knows it without a link.
#[derive(Debug)]
pub struct Make {
    /// As in the station file.
    pub key: &'static str,
    /// As on the box.
    pub name: &'static str,
    /// Why it may have refused or closed the connection, in a sentence.
    pub closed_note: Option<&'static str>,
    /// What it can do.
    pub capabilities: Capabilities,
    /// What it remembers and can be told.
    pub groups: &'static [&'static Group],
    /// What only it can do.
    pub actions: &'static [Action],
    /// How it is given files of elements, where it takes any.
    pub element_files: Option<&'static ElementFiles>,
    /// Takes a line of its link apart, where it can.
    pub explain: Option<fn(&WireLine) -> Explained>,
    /// Why something that was typed, in capitals, is none of
    /// [`AntennaState::questions`](super::AntennaState::questions); a sentence or two.
    /// `None` where there is no more to say than that it is none.
    pub why_no_question: Option<fn(&str) -> String>,
}

impl Make {
    /// The action with this key.
    pub fn action(&self, key: &str) -> Option<&'static Action> {
        self.actions.iter().find(|action| action.key == key)
    }
}
