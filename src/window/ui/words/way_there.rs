//! Words for the slew of an antenna to a current pass, or to one about to begin.

use crate::{plan::schedule::Joining, ui::format};

/// Returns the time that an antenna needs if it starts now, including its set-up.
pub fn needs(joining: Joining) -> String {
    format!("needs {} to get there", format::duration(joining.needs_s))
}

/// Remaining part of a pass for an antenna that starts now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayThere {
    /// Slew to the pass; `None` if no part of the pass remains.
    pub joining: Option<Joining>,
}

impl WayThere {
    /// Returns the rest of a sentence about the antenna, such as "needs 0:37 to get there, leaving
    /// 2:05 to track".
    pub fn words(self) -> String {
        let Some(joining) = self.joining else {
            return "is not there before LOS".to_owned();
        };
        format!("{}, leaving {} to track", needs(joining), format::duration(joining.left_s))
    }

    /// Returns a shorter form of [`Self::words`].
    pub fn short(self) -> String {
        match self.joining {
            Some(joining) => format!("{} trackable", format::duration(joining.left_s)),
            None => "not there".to_owned(),
        }
    }
}
