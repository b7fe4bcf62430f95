//! The folder of files on a unit, as far as an upload needs it.

use std::time::Duration;

/// What a file in a folder holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) bytes: Vec<u8>,
    /// Who may read and write it, where the host tells.
    pub(super) mode: Option<u32>,
}

/// Told how many bytes of a file are done.
pub(super) type Tell<'a> = &'a mut dyn FnMut(u64);

/// A folder on another computer. Every call ends within its time limit.
pub(super) trait Folder {
    /// The file `name`, if there is one.
    async fn read(&mut self, name: &str, tell: Tell<'_>) -> Result<Option<Found>, FolderError>;

    /// Writes the file `name`, which must not exist, down to the disk. Gives
    /// it `mode` when that is known.
    async fn write_new(
        &mut self,
        name: &str,
        bytes: &[u8],
        mode: Option<u32>,
        tell: Tell<'_>,
    ) -> Result<(), FolderError>;

    /// Removes the file `name`; that there is none is no error.
    async fn remove(&mut self, name: &str) -> Result<(), FolderError>;

    /// Gives the file `from` the name `to`, which must be free.
    async fn rename(&mut self, from: &str, to: &str) -> Result<(), FolderError>;

    /// Whether [`Self::replace`] works here.
    fn can_replace(&self) -> bool;

    /// Puts the file `from` in the place of `to` in one step.
    async fn replace(&mut self, from: &str, to: &str) -> Result<(), FolderError>;
}

/// Why a folder on another computer did not do what it was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FolderError {
    /// The user may not do this there.
    #[error(
        "the user has no right to do this in the folder; log in as another user, or let the unit's keeper allow it"
    )]
    Denied,
    /// The folder, or a file in it that has to be there, is not.
    #[error("the folder or file is not there; check the path of the folder")]
    Missing,
    /// The disk there cannot take the file.
    #[error("its disk has {free_bytes} bytes left; remove files there that are not needed")]
    DiskFull {
        /// What the host says is left.
        free_bytes: u64,
    },
    /// Larger than this program takes.
    #[error("the file is larger than {0} bytes; this is not a file of elements")]
    TooLarge(u64),
    /// It said no in its own words.
    #[error("it refused ({0}); check folder, rights and free space there")]
    Refused(String),
    /// The time limit, which stands here, is over.
    #[error("no answer within {} s; check the link and try again", .0.as_secs_f64())]
    TimedOut(Duration),
    /// The connection is gone.
    #[error("the connection was lost; check the link and try again")]
    Lost,
}

impl FolderError {
    /// Whether nothing more can be asked on this connection.
    pub(super) fn ends_connection(&self) -> bool {
        matches!(self, Self::TimedOut(_) | Self::Lost)
    }
}
