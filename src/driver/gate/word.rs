//! What the operator's word lets through that the rules alone would refuse.

use super::{Bounds, Gate};
use crate::{clock::Instant, clock::Moment, driver::Intent};

/// What the operator has answered for.
#[derive(Debug, Default)]
pub(super) struct Word {
    /// Until then it may be moved by hand out of where it must not point.
    out_until: Option<Instant>,
    /// What it keeps within while it follows the Sun: everything but the Sun.
    sunward: Option<Box<Bounds>>,
}

impl Gate {
    /// The antenna may be moved by hand out of where it must not point, until then.
    pub(in crate::driver) fn let_out(&mut self, until: Option<Instant>) {
        self.word.out_until = until;
    }

    /// Whether it may be moved by hand out of where it must not point.
    pub(in crate::driver) fn lets_out(&self, now: Moment) -> bool {
        self.word.out_until.is_some_and(|until| now.steady < until)
    }

    /// What is followed may, or may not, lead to the Sun. Returns what held before.
    pub(in crate::driver) fn lift_sun(&mut self, is_lifted: bool) -> bool {
        let sunward = is_lifted.then(|| Box::new(self.bounds.without_the_sun()));
        std::mem::replace(&mut self.word.sunward, sunward).is_some()
    }

    /// Whether what is followed may lead to the Sun.
    pub(in crate::driver) fn lifts_sun(&self) -> bool {
        self.word.sunward.is_some()
    }

    /// What holds while the operator wants this.
    pub(in crate::driver) fn bounds_in(&self, intent: Intent) -> &Bounds {
        match &self.word.sunward {
            Some(sunward) if intent == Intent::Track => sunward,
            _ => &self.bounds,
        }
    }
}
