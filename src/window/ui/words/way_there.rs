//! Words for the way of an antenna to a pass under way, or about to begin.

use crate::{plan::schedule::Joining, ui::format};

/// The time that an antenna which sets out at once needs, its set-up included.
pub fn needs(joining: Joining) -> String {
    format!("needs {} to get there", format::duration(joining.needs_s))
}

/// Part of a pass that is left for an antenna which sets out at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayThere {
    /// `None` if nothing is left of the pass.
    pub joining: Option<Joining>,
}

impl WayThere {
    /// The rest of a sentence about the antenna, such as "needs 0:37 to get there, leaving 2:05 to
    /// track".
    pub fn words(self) -> String {
        let Some(joining) = self.joining else {
            return "is not there before LOS".to_owned();
        };
        format!("{}, leaving {} to track", needs(joining), format::duration(joining.left_s))
    }

    /// [`Self::words`] where they have no room.
    pub fn short(self) -> String {
        match self.joining {
            Some(joining) => format!("{} trackable", format::duration(joining.left_s)),
            None => "not there".to_owned(),
        }
    }
}
