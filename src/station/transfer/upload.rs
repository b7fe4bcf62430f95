//! Upload of an element file to a unit, with proof of the result and without loss of the old file.

mod error;
mod put;

use tokio_util::sync::CancellationToken;

use super::{KeptFiles, SftpFolder};
use crate::{
    clock::Clock,
    contract::transfer::{FileName, Origin, Peer, Progress, TleFile, Uploaded},
};
pub use error::{FolderState, UploadError, UploadReason};
use put::Put;

#[derive(Debug, Clone)]
pub struct Upload {
    /// Unit with the folder; kept files are listed under this unit.
    pub unit: Peer,
    /// Name of the file on the unit.
    pub file: FileName,
    /// New content. For a roll-back, the result of [`KeptFiles::read`].
    pub elements: TleFile,
}

/// Carries out `upload` in `folder`, and stores the old and the new file in `kept_files`. Calls
/// `tell` with the progress. A cancel works until the new file takes its place.
pub async fn upload(
    folder: &mut SftpFolder,
    upload: Upload,
    kept_files: &KeptFiles,
    clock: &Clock,
    tell: &mut dyn FnMut(Progress),
    cancel: &CancellationToken,
) -> Result<Uploaded, UploadError> {
    let Upload { unit, file, elements } = upload;
    let (name, address) = (file.as_str(), unit.to_string());
    let put = Put { folder, file: name, new: elements.bytes(), tell, cancel };
    put.run(&mut |old| kept_files.keep(&address, name, old, clock.utc(), Origin::Found)).await?;
    let time = clock.utc();
    // The unit already has the file; a failure only prevents a later roll-back to it.
    if let Err(error) = kept_files.keep(&address, name, elements.bytes(), time, Origin::Uploaded) {
        tracing::warn!(%error, file = name, "the uploaded file was not kept on this computer");
    }
    let sha256 = elements.hash();
    tracing::info!(unit = address, file = name, %sha256, "elements uploaded and verified");
    Ok(Uploaded {
        bytes: elements.bytes().len() as u64,
        sha256,
        time,
        objects: elements.objects().to_vec(),
        unit,
        file,
    })
}
