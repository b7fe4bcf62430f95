//! Files that the operator saves for other programs.

use std::{path::PathBuf, sync::Arc};

use jiff::civil::Date;

use crate::{
    contract::{passes::PassListKey, record::PassQuery},
    export::{EventFormat, ListFormat, RowFormat},
};

/// A saved file, with the objects left out of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFile {
    pub path: PathBuf,
    /// Number of objects that the file format cannot represent.
    pub left_out: usize,
}

/// The format of a file of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementForm {
    Tle,
    OmmJson,
    OmmCsv,
}

/// The format of a recorded pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// The points of the track.
    Csv,
    /// The report of the pass and its events.
    Json,
    /// A page to print.
    Html,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Export {
    /// The elements in use of these objects, by catalog number.
    Elements { numbers: Arc<[u32]>, form: ElementForm },
    /// A list of these passes.
    Passes { keys: Arc<[PassListKey]>, format: EventFormat },
    /// Azimuth, elevation and range through one pass.
    Looks { pass: PassListKey, format: ListFormat },
    /// The plan of all antennas.
    Schedule { format: EventFormat },
    /// The page to print for the next shift.
    HandOverSheet,
    /// The recorded pass that the view shows.
    Report { format: ReportFormat },
    /// The recorded passes that `query` finds, with AOS from the first to the last of these days.
    Days { query: PassQuery, first: Date, last: Date, format: RowFormat },
}
