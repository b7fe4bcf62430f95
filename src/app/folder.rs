//! Folders that the desktop's file manager opens, on a thread.

use std::{path::PathBuf, sync::Arc};

use super::App;
use crate::{
    desktop::folder::{self, NotOpened},
    job::Job,
};

/// Job that opens one folder at a time.
#[derive(Default)]
pub(super) struct FolderWork {
    job: Option<Job<Result<(), NotOpened>>>,
}

impl App {
    pub(super) fn open_folder(&mut self, path: PathBuf) {
        let work = move |_: &(dyn Fn() -> bool + Sync)| folder::open(&path);
        self.folder_work.job = Some(Job::start("azel-folder", Arc::clone(&self.wake), work));
    }

    /// Takes the result of the folder thread.
    pub(super) fn take_folder(&mut self) {
        match Job::take(&mut self.folder_work.job) {
            None | Some(Ok(Ok(()))) => {}
            Some(Ok(Err(not_opened))) => self.views.folder_not_opened(&not_opened.to_string()),
            Some(Err(broke_off)) => self.views.folder_not_opened(&broke_off.to_string()),
        }
    }
}
