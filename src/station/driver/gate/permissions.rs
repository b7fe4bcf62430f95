//! The operator's permissions for motions that the rules alone would refuse.

use super::{Bounds, Gate};
use crate::{
    clock::{Instant, Moment},
    contract::driver::Intent,
};

#[derive(Debug, Default)]
pub(super) struct Permissions {
    /// When the permission ends that the antenna may be moved by hand out of a barrier.
    out_end: Option<Instant>,
    /// Bounds while it tracks the Sun: everything but the Sun.
    sunward: Option<Box<Bounds>>,
}

impl Gate {
    /// Permits motions by hand out of a barrier. They end at this time.
    pub(in crate::driver) fn let_out(&mut self, end: Option<Instant>) {
        self.permissions.out_end = end;
    }

    /// Returns `true` if it may be moved by hand out of a barrier.
    pub(in crate::driver) fn lets_out(&self, now: Moment) -> bool {
        self.permissions.out_end.is_some_and(|end| now.steady < end)
    }

    /// Permits or forbids program track to lead to the Sun. Returns the earlier state.
    pub(in crate::driver) fn lift_sun(&mut self, is_lifted: bool) -> bool {
        let sunward = is_lifted.then(|| Box::new(self.bounds.without_the_sun()));
        std::mem::replace(&mut self.permissions.sunward, sunward).is_some()
    }

    /// Returns `true` if program track may lead to the Sun.
    pub(in crate::driver) fn lifts_sun(&self) -> bool {
        self.permissions.sunward.is_some()
    }

    /// The bounds that apply with this intent.
    pub(in crate::driver) fn bounds_in(&self, intent: Intent) -> &Bounds {
        match &self.permissions.sunward {
            // The agreement is for the track alone: a go-to in the meantime keeps clear of the Sun.
            Some(sunward) if intent == Intent::Track => sunward,
            _ => &self.bounds,
        }
    }
}
