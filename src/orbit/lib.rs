//! Elements, propagation, look angles and passes. All functions are pure, and take the time as an
//! argument.

pub mod astro;
mod bundled;
mod catalog;
mod elements;
mod ground;
mod look;
pub mod name;
mod passes;
mod propagator;
mod reader;
mod shadow;
mod simd;
mod sources;
mod writer;

pub use bundled::{BUNDLED_NEWEST, BUNDLED_SOURCE, BundledError, bundled, bundled_sharing};
pub use catalog::{Catalog, MAX_EPOCH_AHEAD, MergeSummary, SOURCE_LAG, SourceOrders};
pub use elements::{EPOCH_YEARS, Elements, ElementsError, Heights};
pub use ground::{SubPoint, TrackPoint};
pub use look::{Distance, Local, LookAngles, OverGround};
pub use passes::{
    FoundPasses, Pass, PassPoint, PassSearch, clear_stretches, found_passes, passes,
    passes_and_effort, passes_of_all,
};
pub use propagator::{PropagationError, Propagator, State};
pub use reader::{
    MAX_ELEMENT_BYTES, Note, NoteKind, Nothing, ReadReport, Refusal, RefusalReason, decoded,
    read_element_bytes, read_elements,
};
pub use shadow::{is_lit, is_sunlit};
pub use sources::{
    FETCH_PAUSE, FetchProblem, FileReport, RefreshHours, RequestLimit, Source, SourcePlace,
    SourceReport, may_fetch, not_before,
};
pub use writer::{
    TleRefusal, TleRefusalReason, tle_lines, write_omm_csv, write_omm_json, write_tle,
};
