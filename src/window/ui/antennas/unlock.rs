//! Service functions, which the operator opens with the station's name for ten minutes while the
//! antenna stands.

use crate::clock::Instant;
use std::time::Duration;

use super::unit::ShownUnit;

/// Time for which the service functions stay open.
const OPEN: Duration = Duration::from_mins(10);

/// The open service functions of one unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unlock {
    instant: Instant,
    /// Start of the link on which the operator opened the service functions.
    link_since: Option<Instant>,
}

impl Unlock {
    pub(super) fn new(unit: &ShownUnit<'_>) -> Self {
        let link_since = unit.antenna.snapshot.state.link_since;
        Self { instant: unit.model.steady, link_since }
    }

    /// Returns `true` if the service functions stay open: within the time, on the same link, while
    /// nothing moves and the operator looks at this antenna.
    pub(super) fn holds(&self, unit: &ShownUnit<'_>) -> bool {
        self.left(unit) > Duration::ZERO
            && unit.stands()
            && unit.antenna.snapshot.state.link_since == self.link_since
            && unit.model.selected_antenna == unit.index
    }

    /// Returns the time until the service functions lock automatically.
    pub(super) fn left(&self, unit: &ShownUnit<'_>) -> Duration {
        OPEN.saturating_sub(unit.model.steady.saturating_duration_since(self.instant))
    }
}

/// Returns the reason why the operator cannot open the service functions now.
pub(super) fn refusal(unit: &ShownUnit<'_>) -> Option<&'static str> {
    if !unit.is_open() {
        Some("There is no link to the unit.")
    } else if !unit.stands() {
        Some("The antenna must be at rest, and tracking must be off.")
    } else {
        None
    }
}
