//! Station: the sessions with its units, the engine that decides, the record, transfers of
//! elements, simulators in place of units, and rehearsals of a plan.
//!
//! Modules from the bottom: [`promises`], [`job`], [`library`], [`transfer`], [`driver`],
//! [`record`], [`sim`], [`makes`], [`engine`], [`rehearsal`]. A lower module never names a higher
//! one.

pub mod driver;
pub mod engine;
pub mod job;
pub mod library;
pub mod makes;
pub mod promises;
pub mod record;
pub mod rehearsal;
pub mod sim;
pub mod transfer;

use azel_contract as contract;
use azel_orbit::{self as orbit, astro, name};
use azel_units::{clock, controller, device, plan, protocol, secret, station, whole_file};
