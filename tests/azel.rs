//! Tests of the library from outside, and of the window without a display. They share one binary
//! because each further binary would link the whole library again.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may end here, and says what it counted"
)]

mod common;
mod declared;
mod documents;
mod drawn_rehearsals;
mod driver_turns;
mod elements_any;
mod elements_forms;
mod elements_library;
mod every_command;
mod fuzz_regressions;
mod genius_session;
mod host_tracking;
mod link_tests;
mod mask_stretches;
mod metrics;
mod network_ports;
mod orbit_reference;
mod pass_brute_force;
mod pass_event_ids;
mod pass_search;
mod plain_names;
mod rc2000c_any;
mod rc2000c_session;
mod rc2000c_simulator;
mod rc2000c_vectors;
mod rehearsal;
mod rehearsed;
mod rotator_genius_any;
mod rotator_genius_vectors;
mod safety_properties;
mod satrak_any;
mod satrak_session;
mod satrak_vectors;
mod sgp4_verification;
mod space_track;
mod three_units;
mod window_stories;
mod written;
