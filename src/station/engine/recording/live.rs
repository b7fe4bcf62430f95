//! The search for the causes of an error while an antenna tracks a pass.

use jiff::Timestamp;

use crate::{
    job::Job,
    orbit::Propagator,
    plan::{Trackability, pass_report::Explained},
};

/// Other elements of the satellite, with their epochs.
pub(super) type Others = Vec<(Timestamp, Propagator)>;

/// The search for a cause, again and again.
#[derive(Default)]
pub(super) struct Live {
    pub(super) job: Option<Job<(Option<Explained>, Others)>>,
    /// `None` before the first look, which reads them.
    pub(super) others: Option<Others>,
    pub(super) begun: Option<Timestamp>,
    /// The part of the pass that the mount can track.
    pub(super) trackability: Option<Trackability>,
    pub(super) found: Option<Explained>,
}
