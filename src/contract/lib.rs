//! What a station shows and accepts: snapshots, events, commands and refusals. Everything here can be
//! serialised, and nothing here does any work.
//!
//! A station fills these types, and a window, which may be on another machine, reads them.

pub mod driver;
pub mod older_sets;
pub mod record;
pub mod sources;
pub mod transfer;

use azel_orbit as orbit;
use azel_orbit::{astro, name};
#[cfg(test)]
use azel_units::controller;
use azel_units::{clock, device, plan, station};
