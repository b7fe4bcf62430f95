//! Snapshots, events and commands of the session of one antenna.

mod command;
mod command_row;
mod intent;
pub mod lessons;
mod link_test;
mod position_age;
mod preview;
mod refusal;
mod safety;
mod snapshot;
mod time_sync;
mod unit;
mod wire_log;

pub use command::{Command, OffsetChange, SESSION_TICKETS, is_ticket_of_session};
pub use command_row::{Effect, LockedOut, Offline, Row, TakesControl};
pub use intent::Intent;
pub use lessons::AxisLessons;
pub use link_test::{LinkFault, LinkFinding};
pub use position_age::position_for;
pub use preview::{Preview, Way};
pub use refusal::Refusal;
pub use safety::{Evidence, Mover, OffTargetCause, Response, Safety, Unlike};
pub use snapshot::{
    Breach, Event, Found, LeftMoving, LeftOffsets, LinkLoss, LinkState, OnBoardView, Snapshot,
    StopState, StoppingWay, TrackProblem, TrackView, UnitOffsetsView,
};
pub use time_sync::TimeSync;
pub use unit::Unit;
pub use wire_log::{IsAwaited, MAX_LINES, Recorded, WireLog};
