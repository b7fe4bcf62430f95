//! The window of a station: its views, and the model that they draw. The window depends on the
//! contract of a station, but not on the station itself.
//!
//! Layers from the bottom: [`desktop`], [`export`], [`model`], [`ui`]; a lower folder never names a
//! higher one.

pub mod desktop;
pub mod export;
pub mod model;
pub mod ui;

use azel_contract as contract;
use azel_orbit::{self as orbit, astro};
#[cfg(test)]
use azel_station::{engine, makes, transfer};
use azel_units::{clock, controller, device, plan, secret, station};
