//! Lists of all makes, to which a new one is added. The demo station, with one unit of each,
//! is written out in `demo.rs`.

mod demo;

pub use demo::DemoAddresses;

use crate::{
    controller::{rc2000c, rotator_genius, satrak},
    sim,
    station::ControllerSpec,
};

/// Descriptions of all makes, for the reader of the station file.
pub static SPECS: &[&ControllerSpec] = &[&satrak::SPEC, &rotator_genius::SPEC, &rc2000c::SPEC];

/// Simulators of all makes, as commands.
pub static SIMULATORS: &[sim::Command] =
    &[sim::satrak::COMMAND, sim::rotator_genius::COMMAND, sim::rc2000c::COMMAND];

#[cfg(test)]
mod tests;
