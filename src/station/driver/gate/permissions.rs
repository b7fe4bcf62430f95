//! Operator permissions for motions that the rules alone would refuse.

use super::{Bounds, Gate};
use crate::{
    clock::{Instant, Moment},
    contract::driver::Intent,
};

#[derive(Debug, Default)]
pub(super) struct Permissions {
    /// End of the permission to move the antenna manually out of a barrier.
    out_end: Option<Instant>,
    /// Bounds during a track of the Sun: everything but the Sun.
    sunward: Option<Box<Bounds>>,
}

impl Gate {
    /// Permits manual motions out of a barrier until `end`.
    pub(in crate::driver) fn permit_exit(&mut self, end: Option<Instant>) {
        self.permissions.out_end = end;
    }

    /// Returns `true` if the operator may move the antenna manually out of a barrier.
    pub(in crate::driver) fn permits_exit(&self, now: Moment) -> bool {
        self.permissions.out_end.is_some_and(|end| now.steady < end)
    }

    /// Permits or forbids program track towards the Sun. Returns the previous state.
    pub(in crate::driver) fn lift_sun(&mut self, is_lifted: bool) -> bool {
        let sunward = is_lifted.then(|| Box::new(self.bounds.without_the_sun()));
        std::mem::replace(&mut self.permissions.sunward, sunward).is_some()
    }

    /// Returns `true` if program track may lead to the Sun.
    pub(in crate::driver) fn lifts_sun(&self) -> bool {
        self.permissions.sunward.is_some()
    }

    /// Returns the bounds that apply to this intent.
    pub(in crate::driver) fn bounds_in(&self, intent: Intent) -> &Bounds {
        match &self.permissions.sunward {
            // The permission applies only to the track: a go-to must still avoid the Sun.
            Some(sunward) if intent == Intent::Track => sunward,
            _ => &self.bounds,
        }
    }
}
