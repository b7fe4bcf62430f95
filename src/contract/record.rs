//! Reports, passes and fits of a record, and the state of the record.

mod pass;
mod past;
mod peaks;
mod pointing;
mod status;

pub use pass::{AboutTrack, PlannedPart, RecordedReport, TrackedBy};
pub use past::{
    ExplainedPasses, ListedKind, OpenedPass, PassPage, PassQuery, PassTimes, RecordedPass, Row,
};
pub use peaks::{Peak, PeakBody, PeakChange, Peaks};
pub use pointing::{FittedNoise, FittedTerm, PointingFit, PointingFitted};
pub use status::{Failing, Status};
