//! Azel: the console of a satellite ground station.
//!
//! This package holds the shell of the window, [`app`], and the command line, [`cli`]. It
//! re-exports the parts of the packages below, which stand in `src/orbit`, `src/units`,
//! `src/contract`, `src/station` and `src/window`. `docs/architecture.md` holds the picture and the
//! invariants.

pub mod app;
pub mod cli;

pub use azel_contract as contract;
pub use azel_orbit::{self as orbit, astro, name};
pub use azel_station::{driver, engine, job, library, makes, record, rehearsal, sim, transfer};
use azel_units::whole_file;
pub use azel_units::{clock, controller, device, plan, protocol, secret, station};
pub use azel_window::{desktop, export, model, ui};
