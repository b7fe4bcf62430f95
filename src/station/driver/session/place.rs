//! Barrier around an antenna.

use crate::{
    clock::Instant, contract::driver::Breach, device::Measured, name::Name, plan::Barrier,
};

/// Barrier that certainly or possibly contains the antenna at its last position.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Place {
    looked: Option<Instant>,
    barrier: Option<Barrier>,
    /// Axis without an angle; if set, the antenna is only possibly inside.
    unknown_axis: Option<usize>,
}

impl Place {
    /// Returns `true` once for each position.
    pub(super) fn is_new(&mut self, look: &Measured) -> bool {
        self.looked.replace(look.received) != Some(look.received)
    }

    pub(super) fn set(&mut self, barrier: Option<Barrier>, unknown_axis: Option<usize>) {
        (self.barrier, self.unknown_axis) = (barrier, unknown_axis);
    }

    /// Returns the breach for the snapshot. `axes`: names of the axes.
    pub(super) fn view(&self, axes: &[Name], may_leave: bool) -> Option<Breach> {
        let barrier = self.barrier.clone()?;
        let unknown_axis = self.unknown_axis.and_then(|axis| axes.get(axis)).copied();
        Some(Breach { barrier, unknown_axis, may_leave })
    }
}
