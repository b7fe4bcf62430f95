//! Folder of files on a unit, with the operations of an upload.

use std::time::Duration;

/// Content and rights of a file in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FolderFile {
    pub(super) bytes: Vec<u8>,
    /// Access rights, if the host reports them.
    pub(super) mode: Option<u32>,
}

/// Callback with the number of finished bytes of a file.
pub(super) type Tell<'a> = &'a mut dyn FnMut(u64);

/// Folder on another computer. Every call ends within its timeout.
pub(super) trait Folder {
    /// Reads the file `name`; `None` if there is none.
    async fn read(&mut self, name: &str, tell: Tell<'_>)
    -> Result<Option<FolderFile>, FolderError>;

    /// Writes the file `name`, which must not exist, and syncs it to the disk. Sets its mode to
    /// `mode` if given.
    async fn write_new(
        &mut self,
        name: &str,
        bytes: &[u8],
        mode: Option<u32>,
        tell: Tell<'_>,
    ) -> Result<(), FolderError>;

    /// Removes the file `name`; succeeds if there is none.
    async fn remove(&mut self, name: &str) -> Result<(), FolderError>;

    /// Renames the file `source` to `destination`, which must be free.
    async fn rename(&mut self, source: &str, destination: &str) -> Result<(), FolderError>;

    /// Returns `true` if [`Self::replace`] works in this folder.
    fn can_replace(&self) -> bool;

    /// Replaces the file `destination` by `source` in one step.
    async fn replace(&mut self, source: &str, destination: &str) -> Result<(), FolderError>;
}

/// Reason why an operation in a folder failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FolderError {
    /// The user may not do the operation.
    #[error(
        "the user may not do this in the folder; log in as another user, or ask the person who \
         maintains the unit for permission"
    )]
    Denied,
    /// The folder or a required file in it is missing.
    #[error("the folder or file is not there; check the path of the folder")]
    Missing,
    /// The disk is full.
    #[error("its disk has {free_bytes} bytes left; remove files there that are not needed")]
    DiskFull {
        /// Free bytes according to the host.
        free_bytes: u64,
    },
    /// The file exceeds Azel's size limit, bytes.
    #[error("the file is larger than {0} bytes; this is not a file of elements")]
    TooLarge(u64),
    /// The host refused, with its reason.
    #[error("it refused ({0}); check the folder, its permissions and the free space there")]
    Refused(String),
    /// The operation exceeded this timeout.
    #[error("no answer within {} s; check the link and try again", .0.as_secs_f64())]
    TimedOut(Duration),
    /// The connection was lost.
    #[error("the connection was lost; check the link and try again")]
    Lost,
}

impl FolderError {
    /// Returns `true` if the connection can no longer be used.
    pub(super) fn ends_connection(&self) -> bool {
        matches!(self, Self::TimedOut(_) | Self::Lost)
    }
}
