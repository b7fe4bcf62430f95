//! Azel: the console of a satellite ground station.
//!
//! The folders are layers; a lower one never names a higher one. From the
//! bottom: [`astro`], [`orbit`], [`library`], [`protocol`], [`device`], [`transfer`], [`station`],
//! [`controller`], [`plan`], [`driver`], [`record`], [`sim`], [`makes`], [`engine`], [`rehearsal`], [`model`], [`ui`],
//! [`app`]; [`desktop`], [`secret`] and `whole_file` stand below them all. `docs/architecture.md`
//! holds the picture and the invariants.

pub mod app;
pub mod astro;
pub mod cli;
pub mod clock;
pub mod controller;
pub mod desktop;
pub mod device;
pub mod driver;
pub mod engine;
pub mod job;
pub mod library;
pub mod makes;
pub mod model;
pub mod name;
pub mod orbit;
pub mod plan;
pub mod protocol;
pub mod record;
pub mod rehearsal;
pub mod secret;
pub mod sim;
pub mod station;
pub mod transfer;
pub mod ui;
mod whole_file;
