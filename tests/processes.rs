//! Tests with real processes, sockets and clocks. They stand apart so that no other test takes the
//! processor from them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may end here, and says what it counted"
)]

mod command_line;
#[cfg(unix)]
mod dead_man;
#[cfg(unix)]
mod link_sockets;
mod live_stations;
mod network_environment;
mod owed_stop;
mod passes_command;
mod plan_command;
mod pointing_command;
#[cfg(target_os = "linux")]
mod real_peers;
#[cfg(target_os = "linux")]
mod real_window;
mod rehearse_command;
#[cfg(unix)]
mod serve;
#[path = "common/units.rs"]
mod units;
#[cfg(unix)]
mod unread_log;
mod web_source;
