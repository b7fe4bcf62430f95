//! The makes of controllers that there are: the lists to which another is
//! added. The demo station is made of them.

mod demo;

pub use demo::DemoAddresses;

use crate::{
    controller::{rc2000c, rotator_genius, satrak},
    sim,
    station::ControllerSpec,
};

/// All that there are, as the reader of the station file wants them.
pub static SPECS: &[&ControllerSpec] = &[&satrak::SPEC, &rotator_genius::SPEC, &rc2000c::SPEC];

/// How each is simulated on the command line.
pub static SIMULATORS: &[sim::Command] =
    &[sim::satrak::COMMAND, sim::rotator_genius::COMMAND, sim::rc2000c::COMMAND];

#[cfg(test)]
mod tests;
