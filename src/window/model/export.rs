//! Files that the operator saves for other programs.

use std::{path::PathBuf, sync::Arc};

use jiff::civil::Date;

use crate::{
    contract::{passes::PassListKey, record::PassQuery},
    export::{EventFormat, ListFormat, RowFormat},
};

/// A file that was saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFile {
    pub path: PathBuf,
    /// Objects that its form cannot carry.
    pub left_out: usize,
}

/// The form of a file of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementForm {
    Tle,
    OmmJson,
    OmmCsv,
}

/// The form of a recorded pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// The points of its track.
    Csv,
    /// Its report and what happened in it.
    Json,
    /// A page to print.
    Html,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Export {
    /// The elements in use of these objects, by catalog number.
    Elements { numbers: Arc<[u32]>, form: ElementForm },
    /// These passes.
    Passes { keys: Arc<[PassListKey]>, format: EventFormat },
    /// Azimuth, elevation and range through one pass.
    Looks { pass: PassListKey, format: ListFormat },
    /// The plan of all antennas.
    Schedule { format: EventFormat },
    /// The page to print for the next shift.
    HandOverSheet,
    /// The pass of the record that is shown.
    Report { format: ReportFormat },
    /// The passes of the record that `query` finds, whose AOS is from the first of these days to the
    /// last.
    Days { query: PassQuery, first: Date, last: Date, format: RowFormat },
}
