//! Upload of a file of elements to a unit, with proof of the result and without ever
//! losing the old file.

mod error;
mod put;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use tokio_util::sync::CancellationToken;

pub use error::{FolderState, Progress, UploadError, UploadReason, UploadStep};

use super::{FileHash, FileName, FileObject, KeptFiles, Origin, Peer, SftpFolder, TleFile};
use crate::{astro::time, clock::Clock};
use put::Put;

#[derive(Debug, Clone)]
pub struct Upload {
    /// Unit that has the folder; kept files are listed under it.
    pub unit: Peer,
    /// Name of the file on the unit.
    pub file: FileName,
    /// New content. To roll back, use the result of [`KeptFiles::read`].
    pub elements: TleFile,
}

/// Proof that a file is on a unit: it was read back in its place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Uploaded {
    pub unit: Peer,
    /// Name of the file on the unit.
    pub file: FileName,
    pub bytes: u64,
    pub sha256: FileHash,
    /// Time of reading back.
    pub at: Timestamp,
    /// Objects in the order of the file.
    pub objects: Vec<FileObject>,
}

impl Uploaded {
    /// Age of the oldest elements in the file at `now`, seconds.
    pub fn oldest_age_s(&self, now: Timestamp) -> Option<f64> {
        let oldest = self.objects.iter().map(|object| object.epoch).min()?;
        Some(time::seconds_between(oldest, now))
    }
}

/// Carries out `upload` in `folder`. Afterwards `kept` has both the old and the new file.
/// `tell` is called with the progress. A cancel is obeyed until the new file takes its
/// place.
pub async fn upload(
    folder: &mut SftpFolder,
    upload: Upload,
    kept: &KeptFiles,
    clock: &Clock,
    tell: &mut dyn FnMut(Progress),
    cancel: &CancellationToken,
) -> Result<Uploaded, UploadError> {
    let Upload { unit, file, elements } = upload;
    let (name, address) = (file.as_str(), unit.to_string());
    let put = Put { folder, file: name, new: elements.bytes(), tell, cancel };
    put.run(&mut |old| kept.keep(&address, name, old, clock.utc(), Origin::Found)).await?;
    let at = clock.utc();
    // The unit has the file either way; only a later roll-back to it is lost.
    if let Err(error) = kept.keep(&address, name, elements.bytes(), at, Origin::Uploaded) {
        tracing::warn!(%error, file = name, "the uploaded file was not kept on this computer");
    }
    let sha256 = elements.hash();
    tracing::info!(unit = address, file = name, %sha256, "elements uploaded and verified");
    Ok(Uploaded {
        bytes: elements.bytes().len() as u64,
        sha256,
        at,
        objects: elements.objects().to_vec(),
        unit,
        file,
    })
}
