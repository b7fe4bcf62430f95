//! Antenna controllers without sockets: their protocols, capabilities and settings, the station
//! file, and the plan that assigns passes to antennas.
//!
//! From the bottom: [`clock`], [`secret`], [`whole_file`], [`protocol`], [`device`], [`station`],
//! [`controller`], [`demo`], [`plan`]; a lower one never names a higher one.

pub mod clock;
pub mod controller;
pub mod demo;
pub mod device;
pub mod plan;
pub mod protocol;
pub mod secret;
pub mod station;
pub mod whole_file;

use azel_orbit::{self as orbit, astro, name};
