//! Antenna controllers without sockets: their protocols, capabilities and settings, the station
//! file, and the plan that assigns passes to antennas.
//!
//! The order from the bottom is [`clock`], [`secret`], [`whole_file`], [`protocol`], [`device`],
//! [`station`], [`controller`], [`demo`], [`plan`]. A lower module never names a higher module.

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
