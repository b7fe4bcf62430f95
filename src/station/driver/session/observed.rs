//! Observed behaviour of the unit, for comparison with its next report.

use super::{
    effect::Effects,
    monitor::BoundsMonitor as Monitor,
    on_board::OnBoardWatch,
    overrun::Overrun,
    place::Place,
    standstill::{Figures, Rest},
};
use crate::{clock::Instant, device::Measured};

#[derive(Default)]
pub(super) struct Observed {
    pub(super) monitor: Monitor,
    pub(super) place: Place,
    pub(super) overrun: Overrun,
    pub(super) effects: Effects,
    /// Watch over a track that Azel did not request.
    pub(super) unasked: Option<OnBoardWatch>,
    rest: Rest,
    /// Receive time of the last position compared at rest.
    looked: Option<Instant>,
}

impl Observed {
    /// Takes each position once. Returns the axis that turns although the flags report standstill,
    /// and its angle in degrees.
    pub(super) fn turned_at_rest(
        &mut self,
        look: Measured,
        is_at_rest: bool,
        began: Option<Instant>,
        figures: Figures,
    ) -> Option<(usize, f64)> {
        if self.looked.replace(look.received) == Some(look.received) {
            return None;
        }
        self.rest.take(look, is_at_rest, began, figures)
    }
}
