//! Lists of all makes. A new make must be added here. `src/units/demo.rs` describes the demo
//! station, which has one unit of each make.

mod units;

pub use azel_units::demo::DemoAddresses;
pub use units::Surroundings;

use std::sync::Arc;

use crate::{
    controller::{rc2000c, rotator_genius, satrak},
    sim::{self, InMemory},
    station::Antenna,
};

/// Simulators of all makes, as commands.
pub static SIMULATORS: &[sim::Command] =
    &[sim::satrak::COMMAND, sim::rotator_genius::COMMAND, sim::rc2000c::COMMAND];

/// Constructors of simulated units in memory, by the key of the make.
static UNITS: &[(&str, units::Make)] = &[
    (satrak::SPEC.key, units::satrak),
    (rotator_genius::SPEC.key, units::genius),
    (rc2000c::SPEC.key, units::rc2000c),
];

/// Returns a simulated unit for `antenna`, or `None` for a make without a simulator. Enters the
/// unit's element file in `antenna` if none is set.
pub fn unit_in_memory(
    antenna: &mut Antenna,
    surroundings: &Surroundings<'_>,
) -> Option<Arc<dyn InMemory>> {
    let key = antenna.connection.spec().key;
    UNITS
        .iter()
        .find(|(candidate, _)| *candidate == key)
        .map(|(_, make)| make(antenna, surroundings))
}

#[cfg(test)]
mod tests;
