//! Paths along which a mount can follow a pass, differences between its axis readings and its
//! direction, and lists of passes. Other programs and people read the lists. All functions are
//! pure.

mod az_el;
mod azimuth_wrap;
pub mod bounds;
pub mod detour;
pub mod on_board;
pub mod pass_report;
pub mod pointing;
pub mod program_track;
mod rate_limited;
pub mod schedule;
mod trackability;

pub use bounds::{Barrier, Bounds, BoundsAt, Clearance, Sweep};
pub use on_board::{OnBoardPass, Supervision};
pub use program_track::{ProgramTrack, Target, TrackPhase, TrackStats};
pub use trackability::{Loss, MountLimits, Sample, Trackability, trackability};
