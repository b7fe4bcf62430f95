//! Lists of all makes, to which a new one is added. The demo station, with one unit of each,
//! is written out in `src/units/demo.rs`.

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

/// Units of all makes in memory, by the key of the make.
static UNITS: &[(&str, units::Make)] = &[
    (satrak::SPEC.key, units::satrak),
    (rotator_genius::SPEC.key, units::genius),
    (rc2000c::SPEC.key, units::rc2000c),
];

/// A simulated unit for `antenna`, set up like the antenna; `None` for a make without a simulator.
/// Where the antenna leaves open which file of elements its unit uses, it is told.
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
