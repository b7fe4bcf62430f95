//! The makes of controllers that there are: the one list to which another is
//! added.

use super::{Capabilities, panel::Action, rc2000c, rotator_genius, satrak, settings::Group};
use crate::station::{Connection, Rotators};

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
}

impl Make {
    /// All that there are.
    pub const ALL: &'static [&'static Self] =
        &[&satrak::MAKE, &rotator_genius::PAIR, &rotator_genius::ALONE, &rc2000c::MAKE];

    /// The make at the other end of `connection`.
    pub fn of(connection: &Connection) -> &'static Self {
        match connection {
            Connection::Satrak { .. } => &satrak::MAKE,
            Connection::Genius { rotators: Rotators::Pair, .. } => &rotator_genius::PAIR,
            Connection::Genius { .. } => &rotator_genius::ALONE,
            Connection::Rc2000c { .. } => &rc2000c::MAKE,
        }
    }

    /// The action with this key.
    pub fn action(&self, key: &str) -> Option<&'static Action> {
        self.actions.iter().find(|action| action.key == key)
    }
}
