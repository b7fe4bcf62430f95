//! Writer of elements as text: TLE, OMM in JSON, OMM in CSV.
//!
//! The OMM forms keep every number to its last bit and the epoch to the microsecond. A TLE keeps
//! the digits that fit into its columns.

mod omm;
mod tle;

pub use self::{
    omm::{write_omm_csv, write_omm_json},
    tle::{TleRefusal, TleRefusalReason, tle_lines, write_tle},
};
