//! Words for the way of an antenna to a pass under way, or about to begin.

use crate::{plan::schedule::Joining, ui::format};

/// What an antenna that sets out at once has of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayThere {
    /// `None` if nothing is left of the pass.
    pub joining: Option<Joining>,
    /// Seconds until AOS; negative after it.
    pub until_s: f64,
}

impl WayThere {
    /// The rest of a sentence about the antenna, such as "needs 0:37 to get there, 2:05 left".
    pub fn words(self) -> String {
        let Some(Joining { late_s, left_s }) = self.joining else {
            return "is not there before LOS".to_owned();
        };
        let [needed, left] = [self.until_s.max(0.0) + late_s, left_s].map(format::duration);
        format!("needs {needed} to get there, {left} left")
    }

    /// [`Self::words`] where they have no room.
    pub fn short(self) -> String {
        match self.joining {
            Some(joining) => format!("{} left", format::duration(joining.left_s)),
            None => "not there".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_to_get_there_counts_from_now_before_and_after_aos() {
        let way = |until_s| {
            let joining = Some(Joining { late_s: 37.0, left_s: 125.0 });
            WayThere { joining, until_s }.words()
        };
        assert_eq!(way(-60.0), "needs 0:37 to get there, 2:05 left");
        assert_eq!(way(23.0), "needs 1:00 to get there, 2:05 left");
    }
}
