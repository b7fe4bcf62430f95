//! Files that the operator opens, on a thread. The operator chooses them in the desktop's dialog,
//! or types a path if there is no dialog.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use super::App;
use crate::{
    desktop::{
        file_dialog::{self, NoDialog},
        folder,
    },
    job::Job,
    model::{
        NextStation,
        intake::Offer,
        typed_path::{OpenedFile, PathPurpose, PathRequest},
    },
};

/// Outcome of a request to open a file.
#[derive(Debug, PartialEq, Eq)]
enum Outcome {
    /// Files to open; empty after Cancel.
    Chosen(OpenedFile, Vec<PathBuf>),
    /// Request for a typed path.
    AsksForPath(PathRequest),
}

/// Dialog that asks for files to open, starting in a folder; returns none after Cancel.
type OpenDialog = fn(OpenedFile, Option<&Path>) -> Result<Vec<PathBuf>, NoDialog>;

/// Job that opens one file at a time.
pub(super) struct OpenWork {
    job: Option<Job<Outcome>>,
    pub(super) dialog: OpenDialog,
}

impl Default for OpenWork {
    fn default() -> Self {
        Self { job: None, dialog }
    }
}

fn dialog(file: OpenedFile, folder: Option<&Path>) -> Result<Vec<PathBuf>, NoDialog> {
    match file {
        OpenedFile::Station => {
            file_dialog::file_to_open("Station file", folder).map(|path| path.into_iter().collect())
        }
        OpenedFile::Elements => file_dialog::files_to_open("Files of elements"),
    }
}

impl App {
    /// Shows the dialog, or asks for a typed path.
    pub(super) fn choose_file(&mut self, file: OpenedFile) {
        let (dialog, folder) = (self.open_work.dialog, self.stations_folder.clone());
        self.begin_to_open(move || choose(file, folder.as_deref(), dialog, folder::documents));
    }

    /// Opens the file at a typed path, or asks for the path again.
    pub(super) fn open_file(&mut self, file: OpenedFile, path: PathBuf) {
        self.begin_to_open(move || take_typed(file, path));
    }

    fn begin_to_open(&mut self, work: impl FnOnce() -> Outcome + Send + 'static) {
        if self.open_work.job.is_some() {
            let reason = "Another file is being opened; its dialog may be behind this window.";
            return self.views.not_opened(reason);
        }
        self.open_work.job = Some(Job::start("azel-open", Arc::clone(&self.wake), move |_| work()));
    }

    /// Takes the chosen files, or the request for a typed path.
    pub(super) fn take_opened_file(&mut self) {
        let Some(end) = Job::take(&mut self.open_work.job) else { return };
        match end {
            Ok(Outcome::Chosen(OpenedFile::Station, files)) => {
                if let Some(path) = files.into_iter().next() {
                    self.choose_station(NextStation::File(path));
                }
            }
            Ok(Outcome::Chosen(OpenedFile::Elements, files)) => {
                if !files.is_empty() {
                    self.offer_elements(files.into_iter().map(Offer::File).collect(), true);
                }
            }
            Ok(Outcome::AsksForPath(request)) => self.views.ask_for_path(request),
            Err(broke_off) => self.views.not_opened(&format!("Not opened: {broke_off}.")),
        }
    }
}

/// Asks for files with the dialog. Without a dialog, asks for a path in the folder of stations or
/// of documents.
fn choose(
    file: OpenedFile,
    stations: Option<&Path>,
    dialog: OpenDialog,
    documents: impl FnOnce() -> Option<PathBuf>,
) -> Outcome {
    match dialog(file, stations) {
        Ok(files) => Outcome::Chosen(file, files),
        Err(no_dialog) => {
            let folder = match file {
                OpenedFile::Station => stations.map(Path::to_owned),
                OpenedFile::Elements => documents(),
            };
            // End the folder with a separator: the operator types the file name behind it.
            ask_for_path(file, folder.unwrap_or_default().join(""), no_dialog.to_string())
        }
    }
}

fn take_typed(file: OpenedFile, path: PathBuf) -> Outcome {
    let reason = match unusable(&path) {
        Some(reason) => reason,
        None if !path.exists() => "there is no such file",
        None => return Outcome::Chosen(file, vec![path]),
    };
    ask_for_path(file, path, reason.to_owned())
}

fn ask_for_path(file: OpenedFile, path: PathBuf, reason: String) -> Outcome {
    Outcome::AsksForPath(PathRequest { purpose: PathPurpose::Open(file), path, reason })
}

/// Returns the reason why a typed path cannot name a file.
pub(super) fn unusable(path: &Path) -> Option<&'static str> {
    if !path.is_absolute() {
        Some("type the whole path, from the root or the drive on")
    } else if path.is_dir() {
        Some("this is a folder: add the name of the file")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [OpenedFile; 2] = [OpenedFile::Station, OpenedFile::Elements];

    fn request(outcome: Outcome) -> PathRequest {
        let Outcome::AsksForPath(request) = outcome else { panic!("{outcome:?}") };
        request
    }

    #[test]
    fn without_a_dialog_a_path_in_the_right_folder_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let [stations, documents] = ["stations", "documents"].map(|name| folder.path().join(name));
        for (file, expected) in FILES.into_iter().zip([&stations, &documents]) {
            let no_dialog = |_: OpenedFile, _: Option<&Path>| Err(NoDialog);
            let request =
                request(choose(file, Some(&stations), no_dialog, || Some(documents.clone())));
            assert_eq!((request.purpose, &request.path), (PathPurpose::Open(file), expected));
            assert!(request.path.display().to_string().ends_with(std::path::MAIN_SEPARATOR));
            assert!(request.reason.contains("no file dialogs"), "{}", request.reason);
            let cancelled = |_: OpenedFile, _: Option<&Path>| Ok(Vec::new());
            let outcome = choose(file, None, cancelled, || None);
            assert_eq!(outcome, Outcome::Chosen(file, Vec::new()));
        }
    }

    #[test]
    fn a_typed_path_is_opened_or_asked_for_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("own.toml");
        for file in FILES {
            let missing = request(take_typed(file, path.clone()));
            assert_eq!((missing.path, &*missing.reason), (path.clone(), "there is no such file"));
            let relative = request(take_typed(file, "own.toml".into()));
            assert!(relative.reason.contains("whole path"), "{}", relative.reason);
            let is_folder = request(take_typed(file, folder.path().to_owned()));
            assert!(is_folder.reason.contains("folder"), "{}", is_folder.reason);
        }
        std::fs::write(&path, "").unwrap();
        for file in FILES {
            let outcome = take_typed(file, path.clone());
            assert_eq!(outcome, Outcome::Chosen(file, vec![path.clone()]));
        }
    }
}
