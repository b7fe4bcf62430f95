//! Files of elements on units and servers.

mod hash;
mod kept_file;
mod old_algorithms;
mod server;
mod tle_file;
mod unit_view;
mod upload;

pub use hash::{FileHash, NoHash};
pub use kept_file::{KeptFile, Origin};
pub use old_algorithms::{AlgorithmPart, OldAlgorithm};
pub use server::{FileProtocol, Peer};
pub use tle_file::{FileName, FileNameError, FileObject, TleFile, TleFileError};
pub use unit_view::{SatelliteMatch, UnitView};
pub use upload::{Progress, UploadStep, Uploaded};
