//! Element files between this computer, units and servers: uploads by SFTP with proof of the
//! result, and test fetches of a unit's sources.
//!
//! The cryptography is deliberately slow, so these functions never run on the thread of the
//! sessions: see [`Transfer`].

mod background;
mod connect_error;
mod fetch;
mod folder;
mod host_key;
mod kept_files;
mod keyring;
mod limits;
mod login;
mod sftp;
mod ssh;
mod upload;

pub use background::{BrokenOff, Transfer};
pub use connect_error::{ConnectError, ConnectStep, KeyFileProblem};
pub use fetch::{ElementSource, FetchError, Fetched, Trust, fetch, what_a_unit_sees};
pub use folder::FolderError;
pub use host_key::{KeyVerdict, KnownHosts, KnownHostsError, OfferedKey};
pub use kept_files::{KeptError, KeptFiles};
pub use keyring::{Account, Keyring, KeyringError, MemoryKeyring, SystemKeyring, TimedKeyring};
pub use limits::{Interruption, Limits};
pub use login::{Login, Proof, is_factory_password};
pub use secrecy::SecretString;
pub use sftp::SftpFolder;
pub use ssh::{check_host_key, open_sftp};
pub use tokio_util::sync::CancellationToken;

pub use upload::{FolderState, Upload, UploadError, UploadReason, upload};
