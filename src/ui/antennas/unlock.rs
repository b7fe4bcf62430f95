//! The service functions: opened by the name of the station, for ten minutes,
//! while the antenna stands.

use crate::clock::Instant;
use std::time::Duration;

use super::unit::Unit;

/// For so long they stay open.
const OPEN: Duration = Duration::from_mins(10);

/// The service functions of one unit are open.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unlock {
    at: Instant,
    /// The link on which they were opened.
    link_since: Option<Instant>,
}

impl Unlock {
    pub(super) fn new(unit: &Unit<'_>) -> Self {
        let link_since = unit.antenna.snapshot.state.link_since;
        Self { at: unit.model.steady, link_since }
    }

    /// They stay open: for the time, on the same link, while nothing moves and
    /// the operator looks at this antenna.
    pub(super) fn holds(&self, unit: &Unit<'_>) -> bool {
        self.left(unit) > Duration::ZERO
            && unit.stands()
            && unit.antenna.snapshot.state.link_since == self.link_since
            && unit.model.selected_antenna == unit.index
    }

    /// Until they lock by themselves.
    pub(super) fn left(&self, unit: &Unit<'_>) -> Duration {
        OPEN.saturating_sub(unit.model.steady.saturating_duration_since(self.at))
    }
}

/// Why they cannot be opened now.
pub(super) fn refusal(unit: &Unit<'_>) -> Option<&'static str> {
    if !unit.is_open() {
        Some("There is no link to the unit.")
    } else if !unit.stands() {
        Some("The antenna has to stand, and tracking has to be off.")
    } else {
        None
    }
}
