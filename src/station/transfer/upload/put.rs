//! Steps of an upload, for any folder.

use std::future::Future;

use tokio_util::sync::CancellationToken;

use super::{FolderState, UploadError, UploadReason};
use crate::{
    contract::transfer::{FileHash, Progress, UploadStep},
    transfer::{
        KeptError,
        folder::{Folder, FolderFile},
    },
};

/// Returns the name of the file during the upload. It does not end in `.txt` or `.tle`, so that a
/// unit does not take the file for elements.
pub(super) fn new_name(file: &str) -> String {
    format!("{file}.azel-new")
}

/// Returns the name of the old file during a replacement in two steps.
pub(super) fn old_name(file: &str) -> String {
    format!("{file}.azel-old")
}

/// Upload of one file to a folder.
pub(super) struct Put<'a, F> {
    pub(super) folder: &'a mut F,
    pub(super) file: &'a str,
    pub(super) new: &'a [u8],
    pub(super) tell: &'a mut dyn FnMut(Progress),
    pub(super) cancel: &'a CancellationToken,
}

impl<F: Folder> Put<'_, F> {
    /// Puts the file in its place and proves it. Calls `keep_old` with the old file before any
    /// write; if it fails, nothing is written.
    pub(super) async fn run(
        mut self,
        keep_old: &mut dyn FnMut(&[u8]) -> Result<(), KeptError>,
    ) -> Result<(), UploadError> {
        let old = self.read_old().await.map_err(as_before(UploadStep::ReadOld))?;
        self.advance(UploadStep::KeepOld);
        if let Some(old) = &old {
            keep_old(&old.bytes).map_err(|error| as_before(UploadStep::KeepOld)(error.into()))?;
        }
        self.write(old.as_ref().and_then(|old| old.mode)).await?;
        self.advance(UploadStep::Replace);
        let (file, new_name, old_name) = (self.file, new_name(self.file), old_name(self.file));
        if self.folder.can_replace() {
            self.swap_at_once(&new_name).await?;
        } else {
            self.swap(old.is_some(), &new_name, &old_name).await?;
        }
        self.prove().await?;
        // An earlier interrupted upload may also have left this file.
        if let Err(error) = self.folder.remove(&old_name).await {
            tracing::warn!(%error, file, "the file before the last was left on the unit");
        }
        Ok(())
    }

    /// Reads the current file, after repairing an interrupted upload.
    async fn read_old(&mut self) -> Result<Option<FolderFile>, UploadReason> {
        if let Some(old) = self.read(UploadStep::ReadOld, self.file).await? {
            return Ok(Some(old));
        }
        let old_path = old_name(self.file);
        let old = self.read(UploadStep::ReadOld, &old_path).await?;
        if old.is_some() {
            self.folder.rename(&old_path, self.file).await?;
            tracing::info!(file = self.file, "an interrupted upload was repaired on the unit");
        }
        Ok(old)
    }

    /// Writes the file beside the old one and compares its content.
    async fn write(&mut self, mode: Option<u32>) -> Result<(), UploadError> {
        let name = new_name(self.file);
        if let Err(reason) = self.send(&name, mode).await {
            return Err(self.withdraw(UploadStep::Write, reason).await);
        }
        match self.read(UploadStep::Compare, &name).await {
            Ok(found) if self.is_new(found.as_ref()) => Ok(()),
            Ok(_) => Err(self.withdraw(UploadStep::Compare, UploadReason::Differs).await),
            Err(reason) => Err(self.withdraw(UploadStep::Compare, reason).await),
        }
    }

    async fn send(&mut self, name: &str, mode: Option<u32>) -> Result<(), UploadReason> {
        self.advance(UploadStep::Write);
        let mut tell = teller(self.tell, UploadStep::Write, self.new.len());
        let writing = async {
            self.folder.remove(name).await?;
            self.folder.write_new(name, self.new, mode, &mut tell).await
        };
        unless_cancelled(self.cancel, writing).await
    }

    /// Replaces the file in one step on the unit: a complete file exists at every moment.
    async fn swap_at_once(&mut self, new_name: &str) -> Result<(), UploadError> {
        match self.folder.replace(new_name, self.file).await {
            Ok(()) => Ok(()),
            Err(error) if error.ends_connection() => Err(UploadError {
                step: UploadStep::Replace,
                reason: error.into(),
                state: FolderState::OldOrNew,
            }),
            Err(error) => Err(self.withdraw(UploadStep::Replace, error.into()).await),
        }
    }

    /// Replaces the file in two steps on the unit; the old file has another name in between.
    async fn swap(
        &mut self,
        has_old: bool,
        new_name: &str,
        old_name: &str,
    ) -> Result<(), UploadError> {
        let step = UploadStep::Replace;
        let state = FolderState::OldAside { name: old_name.to_owned() };
        if has_old {
            // A file with the old name is older than the current file.
            let moving = async {
                self.folder.remove(old_name).await?;
                self.folder.rename(self.file, old_name).await
            };
            match moving.await {
                Ok(()) => {}
                Err(error) if error.ends_connection() => {
                    return Err(UploadError { step, reason: error.into(), state });
                }
                Err(error) => return Err(self.withdraw(step, error.into()).await),
            }
        }
        let Err(error) = self.folder.rename(new_name, self.file).await else { return Ok(()) };
        let is_lost = error.ends_connection();
        if has_old {
            if is_lost || self.folder.rename(old_name, self.file).await.is_err() {
                return Err(UploadError { step, reason: error.into(), state });
            }
        } else if is_lost {
            return Err(UploadError { step, reason: error.into(), state: FolderState::OldOrNew });
        }
        Err(self.withdraw(step, error.into()).await)
    }

    /// Proves the new file. This step cannot be cancelled: the file is already in its place.
    async fn prove(&mut self) -> Result<(), UploadError> {
        let step = UploadStep::Prove;
        self.advance(step);
        let found = {
            let mut tell = teller(self.tell, step, self.new.len());
            self.folder.read(self.file, &mut tell).await
        };
        let reason = match found {
            Ok(found) if self.is_new(found.as_ref()) => return Ok(()),
            Ok(_) => UploadReason::Differs,
            Err(error) => error.into(),
        };
        Err(UploadError { step, reason, state: FolderState::NewUnproved })
    }

    /// Removes the partial new file after a failure.
    async fn withdraw(&mut self, step: UploadStep, reason: UploadReason) -> UploadError {
        let name = new_name(self.file);
        let is_lost = matches!(&reason, UploadReason::Folder(error) if error.ends_connection());
        let state = if !is_lost && self.folder.remove(&name).await.is_ok() {
            FolderState::AsBefore
        } else {
            FolderState::Leftover { name }
        };
        UploadError { step, reason, state }
    }

    async fn read(
        &mut self,
        step: UploadStep,
        name: &str,
    ) -> Result<Option<FolderFile>, UploadReason> {
        self.advance(step);
        let mut tell = teller(self.tell, step, self.new.len());
        unless_cancelled(self.cancel, self.folder.read(name, &mut tell)).await
    }

    fn advance(&mut self, step: UploadStep) {
        teller(self.tell, step, self.new.len())(0);
    }

    fn is_new(&self, found: Option<&FolderFile>) -> bool {
        found.is_some_and(|found| FileHash::new(&found.bytes) == FileHash::new(self.new))
    }
}

fn teller(tell: &mut dyn FnMut(Progress), step: UploadStep, file_bytes: usize) -> impl FnMut(u64) {
    let file_bytes = file_bytes as u64;
    move |done_bytes| tell(Progress { step, done_bytes, file_bytes })
}

fn as_before(step: UploadStep) -> impl Fn(UploadReason) -> UploadError {
    move |reason| UploadError { step, reason, state: FolderState::AsBefore }
}

async fn unless_cancelled<T, E: Into<UploadReason>>(
    cancel: &CancellationToken,
    work: impl Future<Output = Result<T, E>>,
) -> Result<T, UploadReason> {
    tokio::select! {
        biased;
        () = cancel.cancelled() => Err(UploadReason::Cancelled),
        done = work => done.map_err(Into::into),
    }
}

#[cfg(test)]
mod tests;
