//! Copies of the settings of units as files: saved, listed and read on a thread
//! of their own.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::antenna::AntennaModel;
use crate::{
    device::settings::{Change, CopyHead, Group, Held, SettingsCopy},
    job::{BrokeOff, Job, Wake},
    whole_file,
};

/// A copy larger than this is none.
const MAX_BYTES: u64 = 1 << 20;

/// The copies of the settings of units.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Copies {
    /// What came of the last saving.
    pub saved: Option<Saving>,
    /// The copy that is compared with an antenna; `None` while none is.
    pub open: Option<OpenCopy>,
}

/// What came of a saving.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Saving {
    /// Name of the antenna.
    pub antenna: String,
    /// When it ended.
    pub at: Timestamp,
    /// Where the copy is; or what went wrong, in words.
    pub result: Result<PathBuf, String>,
}

/// A comparison on its way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenCopy {
    /// Name of the antenna.
    pub antenna: String,
    /// The copies of this antenna, the newest first.
    pub listed: Vec<PathBuf>,
    /// The copy that was read, with its path; or what went wrong, in words.
    pub read: Option<(PathBuf, Result<SettingsCopy, String>)>,
}

/// What is to be done on the thread.
pub(super) enum Task {
    Save { antenna: String, text: String, path: PathBuf },
    List { antenna: String },
    Read { path: PathBuf, controller: &'static str, groups: &'static [&'static Group] },
}

/// What came of it.
pub(super) enum Outcome {
    Saved { antenna: String, result: Result<PathBuf, String> },
    Listed(Vec<PathBuf>),
    Read(PathBuf, Result<SettingsCopy, String>),
}

/// A change of a service setting waits for the copy of what was there before.
#[derive(Debug)]
pub(super) struct Waiting {
    pub(super) antenna: String,
    pub(super) changes: Vec<Change>,
}

/// The work that is under way, and what waits for it.
#[derive(Default)]
pub(super) struct CopyWork {
    folder: Option<PathBuf>,
    job: Option<Job<Outcome>>,
    /// What comes of the job if it breaks off.
    if_broken: Option<Outcome>,
    queue: Vec<Task>,
    pub(super) waiting: Option<Waiting>,
}

impl CopyWork {
    /// The copies stand beside the station file.
    pub(super) fn beside(station: Option<&Path>) -> Self {
        let folder = station.map(|station| station.with_file_name("settings-copies"));
        Self { folder, ..Self::default() }
    }

    /// Begins to save what is known of `antenna`, or says why not.
    pub(super) fn save(&mut self, antenna: &AntennaModel, now: Timestamp) -> Result<(), String> {
        let folder = self.folder.as_ref().ok_or("this user has no folder for settings")?;
        let name = &antenna.config.name;
        let head = CopyHead {
            antenna: name.clone(),
            address: antenna.config.connection.address.clone(),
            controller: antenna.spec().key.to_owned(),
            saved_at: now,
        };
        let held: &Held = &antenna.snapshot.state.held;
        if held.values().all(|state| state.held.is_none()) {
            return Err(format!("nothing was read from {name} yet"));
        }
        let text = SettingsCopy::text(&head, antenna.groups(), held);
        let stamp = now.strftime("%Y%m%dT%H%M%SZ");
        let path = folder.join(format!("{}-{stamp}.toml", slug(name)));
        self.queue.push(Task::Save { antenna: name.clone(), text, path });
        Ok(())
    }

    /// Asks for the names of the copies of an antenna.
    pub(super) fn list(&mut self, antenna: &str) {
        self.queue.push(Task::List { antenna: antenna.to_owned() });
    }

    /// Reads a copy for `antenna`.
    pub(super) fn read(&mut self, path: PathBuf, antenna: &AntennaModel) {
        let (controller, groups) = (antenna.spec().key, antenna.groups());
        self.queue.push(Task::Read { path, controller, groups });
    }

    /// The result that has come in, and the next piece of work begun.
    pub(super) fn turn(&mut self, wake: &Wake) -> Option<Outcome> {
        if let Some(end) = Job::take(&mut self.job) {
            // The next piece begins with the next turn, which the wake brings.
            wake();
            return end.ok().or(self.if_broken.take());
        }
        if self.job.is_none() && !self.queue.is_empty() {
            let task = self.queue.remove(0);
            let folder = self.folder.clone();
            let of =
                if let Task::Save { antenna, .. } = &task { Some(antenna.clone()) } else { None };
            self.if_broken = Some(broken(&task));
            let work = move |_: &(dyn Fn() -> bool + Sync)| carry_out(task, folder.as_deref());
            match Job::start("azel-copies", Wake::clone(wake), work) {
                Ok(job) => self.job = Some(job),
                Err(error) => {
                    let why = format!("no thread for the copies of settings: {error}");
                    tracing::error!("{why}");
                    // What waits for a copy must hear that there is none.
                    return of.map(|antenna| Outcome::Saved { antenna, result: Err(why) });
                }
            }
        }
        None
    }
}

/// What comes of a piece of work that broke off: what waits for it must hear.
fn broken(task: &Task) -> Outcome {
    let why = BrokeOff.to_string();
    match task {
        Task::Save { antenna, .. } => Outcome::Saved { antenna: antenna.clone(), result: Err(why) },
        Task::List { .. } => Outcome::Listed(Vec::new()),
        Task::Read { path, .. } => Outcome::Read(path.clone(), Err(why)),
    }
}

fn carry_out(task: Task, folder: Option<&Path>) -> Outcome {
    match task {
        Task::Save { antenna, text, path } => {
            let result = match whole_file::replace(&path, text.as_bytes()) {
                Ok(()) => Ok(path),
                Err(error) => {
                    Err(format!("the settings were not saved as {}: {error}", path.display()))
                }
            };
            Outcome::Saved { antenna, result }
        }
        Task::List { antenna } => {
            Outcome::Listed(folder.map(|folder| list(folder, &antenna)).unwrap_or_default())
        }
        Task::Read { path, controller, groups } => {
            let copy = text(&path).map_err(|error| error.to_string()).and_then(|text| {
                SettingsCopy::read(&text, controller, groups).map_err(|error| error.to_string())
            });
            let copy = copy.map_err(|why| format!("{} cannot be used: {why}", path.display()));
            Outcome::Read(path, copy)
        }
    }
}

fn text(path: &Path) -> io::Result<String> {
    if fs::metadata(path)?.len() > MAX_BYTES {
        return Err(io::Error::other("it is too large for a copy of settings"));
    }
    fs::read_to_string(path)
}

/// The newest first: the time is in the name.
fn list(folder: &Path, antenna: &str) -> Vec<PathBuf> {
    let start = format!("{}-", slug(antenna));
    let is_copy = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.strip_prefix(&start).is_some_and(|rest| rest.len() == "20260812T111530Z.toml".len())
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).filter(is_copy).collect();
    paths.sort();
    paths.reverse();
    paths
}

/// A name that every file system takes.
fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_listed_by_antenna_the_newest_first() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "Dish-1-20260812T111530Z.toml",
            "Dish-1-20260813T111530Z.toml",
            "Dish-1-2-20260813T111530Z.toml",
            "Dish-20260813T111530Z.toml",
            "Dish-1-notes.toml",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let names: Vec<_> = list(folder.path(), "Dish 1")
            .into_iter()
            .map(|path| path.file_name().unwrap().to_str().unwrap().to_owned())
            .collect();
        assert_eq!(names, ["Dish-1-20260813T111530Z.toml", "Dish-1-20260812T111530Z.toml"]);
        assert_eq!(list(&folder.path().join("nowhere"), "Dish 1"), Vec::<PathBuf>::new());
    }

    #[test]
    fn a_file_that_is_no_copy_says_so_with_its_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.toml");
        fs::write(&path, "a = 1").unwrap();
        let task = Task::Read { path: path.clone(), controller: "satrak", groups: &[] };
        let Outcome::Read(_, Err(why)) = carry_out(task, None) else { panic!("it is none") };
        assert!(why.contains("x.toml") && why.contains("version"), "{why}");
    }
}
