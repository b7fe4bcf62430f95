//! Azel: the console of a satellite ground station.
//!
//! This package holds the window and the command line. From the bottom: [`desktop`], [`model`], [`ui`], [`app`], [`cli`];
//! a lower folder never names a higher one. The packages below stand in `src/orbit`, `src/units` and
//! `src/station`, and their parts can be named from here too. `docs/architecture.md` holds the
//! picture and the invariants.

pub mod app;
pub mod cli;
pub mod desktop;
pub mod export;
pub mod model;
pub mod ui;

pub use azel_contract as contract;
pub use azel_orbit::{self as orbit, astro, name};
pub use azel_station::{driver, engine, job, library, makes, record, rehearsal, sim, transfer};
use azel_units::whole_file;
pub use azel_units::{clock, controller, device, plan, protocol, secret, station};
