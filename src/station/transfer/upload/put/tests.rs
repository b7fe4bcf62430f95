//! Tests with a failure at every possible request, in every way that a link breaks.

use std::{collections::BTreeMap, time::Duration};

use super::*;
use crate::transfer::{FolderError, folder::Tell};

const FILE: &str = "weather.tle";
const OLD: &[u8] = b"the old elements";
const NEW: &[u8] = b"the new elements, which are longer";

/// Failure of a request.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    /// The unit refuses the request and does nothing.
    Refused,
    /// The link is lost before the request arrives.
    LostBefore,
    /// The link is lost after the request was carried out.
    LostAfter,
    /// The operator cancels before the request.
    Cancelled,
}

/// Folder in memory.
#[derive(Default)]
struct Memory {
    files: BTreeMap<String, Vec<u8>>,
    can_replace: bool,
    /// Index of the failing request, counted from now on, and its failure.
    fault: Option<(usize, Fault)>,
    requested: usize,
    cancel: CancellationToken,
    is_gone: bool,
    /// `true` if the disk corrupts written bytes.
    corrupts: bool,
}

impl Memory {
    async fn request<T>(
        &mut self,
        carry_out: impl FnOnce(&mut BTreeMap<String, Vec<u8>>) -> T,
    ) -> Result<T, FolderError> {
        self.requested += 1;
        if self.is_gone {
            return Err(FolderError::Lost);
        }
        match self.fault.filter(|(index, _)| *index == self.requested) {
            None => Ok(carry_out(&mut self.files)),
            Some((_, Fault::Refused)) => Err(FolderError::Denied),
            Some((_, Fault::LostBefore)) => {
                self.is_gone = true;
                Err(FolderError::Lost)
            }
            Some((_, Fault::LostAfter)) => {
                self.is_gone = true;
                carry_out(&mut self.files);
                Err(FolderError::TimedOut(Duration::from_secs(1)))
            }
            Some((_, Fault::Cancelled)) => {
                self.cancel.cancel();
                tokio::task::yield_now().await;
                Ok(carry_out(&mut self.files))
            }
        }
    }

    fn holds(&self, name: &str) -> Option<&[u8]> {
        self.files.get(name).map(Vec::as_slice)
    }
}

impl Folder for Memory {
    async fn read(
        &mut self,
        name: &str,
        tell: Tell<'_>,
    ) -> Result<Option<FolderFile>, FolderError> {
        let bytes = self.request(|files| files.get(name).cloned()).await?;
        tell(bytes.as_ref().map_or(0, Vec::len) as u64);
        Ok(bytes.map(|bytes| FolderFile { bytes, mode: None }))
    }

    async fn write_new(
        &mut self,
        name: &str,
        bytes: &[u8],
        _mode: Option<u32>,
        tell: Tell<'_>,
    ) -> Result<(), FolderError> {
        assert!(!self.files.contains_key(name), "{name} was not removed first");
        // Each half counts as a request, so that one half can be lost.
        let (first, _) = bytes.split_at(bytes.len() / 2);
        self.request(|files| files.insert(name.to_owned(), first.to_vec())).await?;
        tell(first.len() as u64);
        let written = if self.corrupts { bytes.to_ascii_uppercase() } else { bytes.to_vec() };
        self.request(|files| files.insert(name.to_owned(), written)).await?;
        tell(bytes.len() as u64);
        Ok(())
    }

    async fn remove(&mut self, name: &str) -> Result<(), FolderError> {
        self.request(|files| files.remove(name)).await.map(|_| ())
    }

    async fn rename(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
        assert!(!self.files.contains_key(destination), "{destination} is taken");
        self.replace(source, destination).await
    }

    fn can_replace(&self) -> bool {
        self.can_replace
    }

    async fn replace(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
        self.request(|files| {
            let bytes = files.remove(source).unwrap();
            files.insert(destination.to_owned(), bytes);
        })
        .await
    }
}

/// Uploads [`NEW`]. Returns the result and the kept old file.
async fn put(folder: &mut Memory) -> (Result<(), UploadError>, Option<Vec<u8>>) {
    let mut previous = None;
    let cancel = folder.cancel.clone();
    let put = Put { folder, file: FILE, new: NEW, tell: &mut |_| {}, cancel: &cancel };
    let result = put
        .run(&mut |old| {
            previous = Some(old.to_vec());
            Ok(())
        })
        .await;
    (result, previous)
}

fn folder(can_replace: bool, old: Option<&[u8]>) -> Memory {
    let files = old.map(|old| (FILE.to_owned(), old.to_vec())).into_iter().collect();
    Memory { files, can_replace, ..Memory::default() }
}

/// Checks that the state in the error is true.
fn assert_state(folder: &Memory, error: &UploadError, old: Option<&[u8]>) {
    let (in_place, new_file) = (folder.holds(FILE), folder.holds(&new_name(FILE)));
    let old_file = folder.holds(&old_name(FILE));
    match &error.state {
        FolderState::AsBefore => {
            assert_eq!((in_place, new_file), (old, None));
        }
        FolderState::Leftover { .. } => assert_eq!(in_place, old),
        FolderState::OldOrNew => assert!(in_place == old || in_place == Some(NEW)),
        FolderState::OldAside { .. } => assert!(in_place == old || old_file == old),
        FolderState::NewUnproved => assert_eq!(in_place, Some(NEW)),
    }
}

#[tokio::test]
async fn whatever_breaks_the_old_file_is_not_lost_and_the_next_upload_mends_all() {
    let mut broken = 0;
    for can_replace in [true, false] {
        for old in [Some(OLD), None] {
            for fault in [Fault::Refused, Fault::LostBefore, Fault::LostAfter, Fault::Cancelled] {
                for index in 1.. {
                    let mut folder = folder(can_replace, old);
                    folder.fault = Some((index, fault));
                    let (result, previous) = put(&mut folder).await;
                    if folder.requested < index {
                        break;
                    }
                    let case = format!("{can_replace} {fault:?} {index}");
                    match result {
                        // The cancel came too late, or only the last cleanup failed.
                        Ok(()) => assert_eq!(folder.holds(FILE), Some(NEW), "{case}"),
                        Err(error) => {
                            broken += 1;
                            assert_state(&folder, &error, old);
                            assert!(error.step < UploadStep::Write || previous.as_deref() == old);
                            let is_cancel = matches!(error.reason, UploadReason::Cancelled);
                            assert_eq!(is_cancel, fault == Fault::Cancelled, "{case}: {error}");
                            assert!(!is_cancel || error.state == FolderState::AsBefore, "{case}");
                        }
                    }
                    (folder.fault, folder.is_gone) = (None, false);
                    folder.cancel = CancellationToken::new();
                    let before = folder.holds(FILE).or(folder.holds(&old_name(FILE)));
                    let before = before.map(<[u8]>::to_vec);
                    let (result, previous) = put(&mut folder).await;
                    result.unwrap();
                    assert_eq!(previous, before, "{case}");
                    assert_eq!(folder.files.len(), 1, "{case}: something was left behind");
                    assert_eq!(folder.holds(FILE), Some(NEW), "{case}");
                }
            }
        }
    }
    assert!(broken > 80, "{broken} uploads broke");
}

#[tokio::test]
async fn nothing_is_written_when_the_old_file_cannot_be_kept() {
    let mut folder = folder(true, Some(OLD));
    let cancel = CancellationToken::new();
    let put = Put { folder: &mut folder, file: FILE, new: NEW, tell: &mut |_| {}, cancel: &cancel };
    let error = put.run(&mut |_| Err(KeptError::Changed { path: "old".into() })).await.unwrap_err();
    assert!(matches!(error.reason, UploadReason::Keep(_)), "{error}");
    assert_eq!((folder.requested, folder.holds(FILE)), (1, Some(OLD)));
}

#[tokio::test]
async fn what_reads_back_as_something_else_never_takes_the_old_file_s_place() {
    for can_replace in [true, false] {
        let mut folder = Memory { corrupts: true, ..folder(can_replace, Some(OLD)) };
        let (result, _) = put(&mut folder).await;
        let error = result.unwrap_err();
        assert!(matches!(error.reason, UploadReason::Differs), "{error}");
        assert_eq!((error.step, error.state), (UploadStep::Compare, FolderState::AsBefore));
        assert_eq!((folder.holds(FILE), folder.files.len()), (Some(OLD), 1));
    }
}

#[tokio::test]
async fn what_reads_back_as_something_else_in_its_place_is_no_proof() {
    // Another program writes the file at the moment of its replacement.
    struct Crowded(Memory);
    impl Folder for Crowded {
        async fn read(
            &mut self,
            name: &str,
            tell: Tell<'_>,
        ) -> Result<Option<FolderFile>, FolderError> {
            self.0.read(name, tell).await
        }
        async fn write_new(
            &mut self,
            name: &str,
            bytes: &[u8],
            mode: Option<u32>,
            tell: Tell<'_>,
        ) -> Result<(), FolderError> {
            self.0.write_new(name, bytes, mode, tell).await
        }
        async fn remove(&mut self, name: &str) -> Result<(), FolderError> {
            self.0.remove(name).await
        }
        async fn rename(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
            self.0.rename(source, destination).await
        }
        fn can_replace(&self) -> bool {
            true
        }
        async fn replace(&mut self, source: &str, destination: &str) -> Result<(), FolderError> {
            self.0.replace(source, destination).await?;
            self.0.files.insert(destination.to_owned(), b"of another console".to_vec());
            Ok(())
        }
    }
    let mut folder = Crowded(folder(true, Some(OLD)));
    let cancel = CancellationToken::new();
    let put = Put { folder: &mut folder, file: FILE, new: NEW, tell: &mut |_| {}, cancel: &cancel };
    let error = put.run(&mut |_| Ok(())).await.unwrap_err();
    assert!(matches!(error.reason, UploadReason::Differs), "{error}");
    assert_eq!((error.step, error.state), (UploadStep::Prove, FolderState::NewUnproved));
}

#[tokio::test]
async fn progress_goes_through_all_steps_in_order() {
    let mut folder = folder(false, Some(OLD));
    let cancel = CancellationToken::new();
    let mut progresses = Vec::new();
    let mut tell = |progress| progresses.push(progress);
    let put = Put { folder: &mut folder, file: FILE, new: NEW, tell: &mut tell, cancel: &cancel };
    put.run(&mut |_| Ok(())).await.unwrap();
    assert!(progresses.is_sorted_by_key(|progress: &Progress| progress.step), "{progresses:?}");
    let written = progresses.iter().filter(|progress| progress.step == UploadStep::Write);
    let written: Vec<_> = written.map(|progress| progress.done_bytes).collect();
    assert_eq!(written, [0, NEW.len() as u64 / 2, NEW.len() as u64]);
    let mut steps: Vec<_> = progresses.iter().map(|progress| progress.step).collect();
    steps.dedup();
    assert_eq!(steps.len(), 6);
}
