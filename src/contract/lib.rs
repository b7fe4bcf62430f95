//! The contract between a station and its clients: snapshots, events, commands and refusals. A
//! station fills these types, and a window, possibly on another machine, reads them.
//!
//! All types are serialisable and do no work. Clients fetch the contents of two types apart from a
//! snapshot: the lines of a link ([`driver::WireLog`]), and the passes of a list
//! ([`passes::PassList`]). A pass computes its outline at first use.

pub mod alarms;
pub mod antenna;
pub mod automatic;
pub mod claim;
pub mod closing;
mod command;
pub mod control;
pub mod copies;
pub mod driver;
mod event;
pub mod hooks;
pub mod host_keys;
pub mod link_tests;
pub mod older_sets;
pub mod passes;
pub mod record;
pub mod recorded;
pub mod rehearsal;
pub mod reminders;
pub mod schedule;
mod snapshot;
pub mod source_tests;
pub mod sources;
pub mod transfer;
pub mod uploads;
pub mod written;

use azel_orbit as orbit;
use azel_orbit::{astro, name};
#[cfg(test)]
use azel_units::demo;
use azel_units::{clock, controller, device, plan, secret, station};
pub use command::{Attention, Command};
pub use event::{CommandOrigin, Event};
pub use snapshot::{CatalogState, Snapshot};
