//! What the unit was seen doing, for comparison with its next report.

use super::{
    effect::Effects,
    monitor::Watch as Monitor,
    on_board::Watch,
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
    /// Watch over a track that nobody asked for from here.
    pub(super) unasked: Option<Watch>,
    rest: Rest,
    /// When the last position that was compared at rest came in.
    looked: Option<Instant>,
}

impl Observed {
    /// Takes a position once. Returns the axis that turns although the flags say that it stands, and
    /// by how many degrees.
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
