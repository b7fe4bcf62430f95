//! Record of a station: measurements, lines on the links, commands and decisions, in one SQLite
//! file. `docs/record.md` describes its schema.
//!
//! Invariant: nobody waits for the record. Sessions keep their last lines and positions in their
//! own logs, the station queues its entries, and one thread writes both. The record itself counts
//! and marks the items that could not be kept.

mod along;
mod causes;
mod entry;
mod file;
mod film;
mod intake;
mod keeping;
mod missed;
mod pass;
mod past;
mod peaks;
mod pointing;
mod read;
mod recorder;
mod tables;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
#[cfg(test)]
mod tests;
mod writer;

pub use along::{Neighbour, neighbour, times_between, times_of_pass};
pub use causes::explain_passes;
pub use entry::{Entry, Kind};
pub use film::{Film, FilmError, Parts, Picture, Shown};
pub use intake::RecordedSession;
pub use missed::{MissedEntry, missed};
pub use pass::PassNote;
pub use past::{open_pass, passes, passes_within};
pub use peaks::read_peaks;
pub use pointing::{CannotFitPointing, fit_pointing};
pub use read::{Query, Record, RowKind};
pub use recorder::Recorder;

/// Reason why a record cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    #[error("the disk is full")]
    DiskFull,
    /// A newer program wrote the record.
    #[error(
        "the record was written by a newer Azel (schema {0}; this one reads {known}): update Azel, or \
         move the file away",
        known = file::VERSION
    )]
    Newer(i64),
    /// The file is damaged or not a record.
    #[error("the file is not a record of Azel, or it is damaged")]
    NoRecord,
    #[error("{0}")]
    Database(rusqlite::Error),
    #[error("a report cannot be written as JSON: {0}")]
    Report(#[from] serde_json::Error),
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

impl From<rusqlite::Error> for RecordError {
    fn from(error: rusqlite::Error) -> Self {
        use rusqlite::ErrorCode;
        match error.sqlite_error_code() {
            Some(ErrorCode::DiskFull) => Self::DiskFull,
            Some(ErrorCode::NotADatabase | ErrorCode::DatabaseCorrupt) => Self::NoRecord,
            _ => Self::Database(error),
        }
    }
}
