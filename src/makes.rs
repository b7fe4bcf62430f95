//! The makes of controllers that there are: the one list to which another is
//! added. The demo station is made of them.

mod demo;

pub use demo::DemoAddresses;

use crate::{
    controller::{Make, rc2000c, rotator_genius, satrak},
    sim,
    station::Kind,
};

/// A make of controller and its simulator.
#[derive(Debug)]
pub struct Listed {
    /// What it says of itself; all that drives and shows it follows from there.
    pub kind: &'static Kind,
    /// How it is simulated on the command line.
    pub simulator: sim::Command,
}

/// All that there are.
pub static ALL: &[Listed] = &[
    Listed { kind: &satrak::KIND, simulator: sim::satrak::COMMAND },
    Listed { kind: &rotator_genius::KIND, simulator: sim::rotator_genius::COMMAND },
    Listed { kind: &rc2000c::KIND, simulator: sim::rc2000c::COMMAND },
];

/// The kinds of all of them, as the reader of the station file wants them.
pub fn kinds() -> Vec<&'static Kind> {
    ALL.iter().map(|listed| listed.kind).collect()
}

/// All that the rest of the program may take them for.
pub fn makes() -> impl Iterator<Item = &'static Make> {
    ALL.iter().flat_map(|listed| listed.kind.makes).copied()
}

#[cfg(test)]
mod tests;
