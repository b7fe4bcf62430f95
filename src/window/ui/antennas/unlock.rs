//! Service functions: opened with the name of the station, for ten minutes, while the
//! antenna stands.

use crate::clock::Instant;
use std::time::Duration;

use super::unit::ShownUnit;

/// Time for which they stay open.
const OPEN: Duration = Duration::from_mins(10);

/// The open service functions of one unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unlock {
    instant: Instant,
    /// Link on which they were opened.
    link_since: Option<Instant>,
}

impl Unlock {
    pub(super) fn new(unit: &ShownUnit<'_>) -> Self {
        let link_since = unit.antenna.snapshot.state.link_since;
        Self { instant: unit.model.steady, link_since }
    }

    /// Returns `true` if they stay open: within the time, on the same link, while nothing moves and
    /// the operator looks at this antenna.
    pub(super) fn holds(&self, unit: &ShownUnit<'_>) -> bool {
        self.left(unit) > Duration::ZERO
            && unit.stands()
            && unit.antenna.snapshot.state.link_since == self.link_since
            && unit.model.selected_antenna == unit.index
    }

    /// Time until they lock by themselves.
    pub(super) fn left(&self, unit: &ShownUnit<'_>) -> Duration {
        OPEN.saturating_sub(unit.model.steady.saturating_duration_since(self.instant))
    }
}

/// Reason why they cannot be opened now.
pub(super) fn refusal(unit: &ShownUnit<'_>) -> Option<&'static str> {
    if !unit.is_open() {
        Some("There is no link to the unit.")
    } else if !unit.stands() {
        Some("The antenna must be at rest, and tracking must be off.")
    } else {
        None
    }
}
