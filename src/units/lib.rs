//! Antenna controllers and all that is decided without a socket: what their bytes mean, what they
//! can do, how a station is set up, and which antenna takes which pass.
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
