//! Files of elements between this computer, units and servers: uploads by SFTP with proof
//! of the result, and test fetches of the sources that a unit uses.
//!
//! The cryptography here is slow on purpose, so these functions never run on the thread of
//! the sessions: see [`Transfer`].

mod background;
mod connect_error;
mod fetch;
mod folder;
mod hash;
mod host_key;
mod kept;
mod keyring;
mod limits;
mod login;
mod old_algorithms;
mod sftp;
mod ssh;
mod tle_file;

mod upload;

pub use background::{BrokenOff, Transfer};
pub use connect_error::{ConnectError, ConnectStep, KeyFileProblem, Peer};
pub use fetch::{
    ElementSource, FetchError, Fetched, FileProtocol, Seen, Trust, UnitView, fetch,
    what_a_unit_sees,
};
pub use folder::FolderError;
pub use hash::{FileHash, NoHash};
pub use host_key::{KeyVerdict, KnownHosts, KnownHostsError, OfferedKey};
pub use kept::{KeptError, KeptFile, KeptFiles, Origin};
pub use keyring::{Account, Keyring, KeyringError, MemoryKeyring, SystemKeyring, TimedKeyring};
pub use limits::{Interruption, Limits};
pub use login::{Login, Proof, is_factory_password};
pub use old_algorithms::{AlgorithmPart, OldAlgorithm};
pub use secrecy::SecretString;
pub use sftp::SftpFolder;
pub use ssh::{check_host_key, open_sftp};
pub use tle_file::{FileName, FileNameError, FileObject, TleFile, TleFileError};
pub use tokio_util::sync::CancellationToken;

pub use upload::{
    FolderState, Progress, Upload, UploadError, UploadReason, UploadStep, Uploaded, upload,
};
