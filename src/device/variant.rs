//! What a unit can do and remembers, as the settings of its connection make it.

use super::{Capabilities, panel::Action, settings::Group};

/// What a unit can do and remembers. A make has another one where the settings of the
/// connection change that, such as a rotator that turns no elevation.
#[derive(Debug)]
pub struct Variant {
    /// What it can do.
    pub capabilities: Capabilities,
    /// What it remembers and can be told.
    pub groups: &'static [&'static Group],
    /// What only it can do.
    pub actions: &'static [Action],
}

impl Variant {
    /// The action with this key.
    pub fn action(&self, key: &str) -> Option<&'static Action> {
        self.actions.iter().find(|action| action.key == key)
    }
}
