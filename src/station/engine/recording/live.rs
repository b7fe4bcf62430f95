//! Search for the causes of an error while an antenna tracks a pass.

use jiff::Timestamp;

use crate::{
    job::Job,
    orbit::Propagator,
    plan::{Trackability, pass_report::Explained},
};

/// Other elements of the same satellite, with their epochs.
pub(super) type Others = Vec<(Timestamp, Propagator)>;

/// Repeated search for a cause.
#[derive(Default)]
pub(super) struct Live {
    pub(super) job: Option<Job<(Option<Explained>, Others)>>,
    /// Other elements of the satellite; `None` before the first search, which reads them.
    pub(super) others: Option<Others>,
    pub(super) begun: Option<Timestamp>,
    /// Part of the pass that the mount can track.
    pub(super) trackability: Option<Trackability>,
    pub(super) found: Option<Explained>,
}
