//! The operator's permissions for motions that the rules alone would refuse.

use super::{Bounds, Gate};
use crate::{
    clock::{Instant, Moment},
    contract::driver::Intent,
};

#[derive(Debug, Default)]
pub(super) struct Word {
    /// Until then the antenna may be moved by hand out of a barrier.
    out_until: Option<Instant>,
    /// Bounds while it tracks the Sun: everything but the Sun.
    sunward: Option<Box<Bounds>>,
}

impl Gate {
    /// Permits motions by hand out of a barrier until this time.
    pub(in crate::driver) fn let_out(&mut self, until: Option<Instant>) {
        self.word.out_until = until;
    }

    /// Returns `true` if it may be moved by hand out of a barrier.
    pub(in crate::driver) fn lets_out(&self, now: Moment) -> bool {
        self.word.out_until.is_some_and(|until| now.steady < until)
    }

    /// Permits or forbids program track to lead to the Sun. Returns the earlier state.
    pub(in crate::driver) fn lift_sun(&mut self, is_lifted: bool) -> bool {
        let sunward = is_lifted.then(|| Box::new(self.bounds.without_the_sun()));
        std::mem::replace(&mut self.word.sunward, sunward).is_some()
    }

    /// Returns `true` if program track may lead to the Sun.
    pub(in crate::driver) fn lifts_sun(&self) -> bool {
        self.word.sunward.is_some()
    }

    /// The bounds that apply with this intent.
    pub(in crate::driver) fn bounds_in(&self, intent: Intent) -> &Bounds {
        match &self.word.sunward {
            // The agreement is for the track alone: a go-to in the meantime keeps clear of the Sun.
            Some(sunward) if intent == Intent::Track => sunward,
            _ => &self.bounds,
        }
    }
}
