//! Copies of unit settings as files: a separate thread saves, lists and reads them.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;

use crate::{
    contract::antenna::AntennaModel,
    device::settings::{Change, CopyHead, Group, GroupStates, SettingsCopy},
    job::{BrokeOff, Job, Wake},
    whole_file,
};

/// Max size of a copy, bytes.
const MAX_BYTES: u64 = 1 << 20;

/// Job for the thread.
pub(super) enum Task {
    Save { antenna: String, text: String, path: PathBuf },
    List { antenna: String },
    Read { path: PathBuf, controller: &'static str, groups: &'static [&'static Group] },
}

/// Outcome of a job.
pub(super) enum Outcome {
    Saved { antenna: String, result: Result<PathBuf, String> },
    Listed(Vec<PathBuf>),
    Read(PathBuf, Result<SettingsCopy, String>),
}

/// Pending changes of service settings, until a copy of the previous values is saved.
#[derive(Debug)]
pub(super) struct Waiting {
    pub(super) antenna: String,
    pub(super) changes: Vec<Change>,
}

/// Current job and pending jobs.
#[derive(Default)]
pub(super) struct CopyWork {
    folder: Option<PathBuf>,
    job: Option<Job<Outcome>>,
    /// Outcome to report if the job breaks off, so that pending changes do not wait for a missing
    /// copy.
    if_broken: Option<Outcome>,
    queue: Vec<Task>,
    pub(super) waiting: Option<Waiting>,
}

impl CopyWork {
    /// Creates the work; copies go to a folder beside the station file.
    pub(super) fn new(station: Option<&Path>) -> Self {
        let folder = station.map(|station| station.with_file_name("settings-copies"));
        Self { folder, ..Self::default() }
    }

    /// Queues a save of the settings read from `antenna`, or returns the reason why it cannot.
    pub(super) fn save(&mut self, antenna: &AntennaModel, now: Timestamp) -> Result<(), String> {
        let folder = self.folder.as_ref().ok_or("this user has no folder for settings")?;
        let name = &antenna.config.name;
        let head = CopyHead {
            antenna: name.clone(),
            address: antenna.config.connection.address.clone(),
            controller: antenna.spec().key.to_owned(),
            saved_at: now,
        };
        let current: &GroupStates = &antenna.snapshot.state.groups;
        if current.values().all(|state| state.last_read.is_none()) {
            return Err(format!("nothing was read from {name} yet"));
        }
        let text = SettingsCopy::text(&head, antenna.groups(), current);
        let stamp = now.strftime("%Y%m%dT%H%M%SZ");
        let path = folder.join(format!("{}-{stamp}.toml", slug(name)));
        self.queue.push(Task::Save { antenna: name.clone(), text, path });
        Ok(())
    }

    /// Queues a search for the copies of an antenna.
    pub(super) fn list(&mut self, antenna: &str) {
        self.queue.push(Task::List { antenna: antenna.to_owned() });
    }

    /// Queues the reading of a copy for `antenna`.
    pub(super) fn read(&mut self, path: PathBuf, antenna: &AntennaModel) {
        let (controller, groups) = (antenna.spec().key, antenna.groups());
        self.queue.push(Task::Read { path, controller, groups });
    }

    /// Returns the outcome of a finished job, or starts the next one.
    pub(super) fn turn(&mut self, wake: &Wake) -> Option<Outcome> {
        if let Some(end) = Job::take(&mut self.job) {
            // The next job starts in the next turn, which this wake causes.
            wake();
            return end.ok().or(self.if_broken.take());
        }
        if self.job.is_none() && !self.queue.is_empty() {
            let task = self.queue.remove(0);
            let folder = self.folder.clone();
            self.if_broken = Some(broken(&task));
            let work = move |_: &(dyn Fn() -> bool + Sync)| carry_out(task, folder.as_deref());
            self.job = Some(Job::start("azel-copies", Wake::clone(wake), work));
        }
        None
    }
}

/// Returns the outcome of a job that breaks off.
fn broken(task: &Task) -> Outcome {
    let reason = BrokeOff.to_string();
    match task {
        Task::Save { antenna, .. } => {
            Outcome::Saved { antenna: antenna.clone(), result: Err(reason) }
        }
        Task::List { .. } => Outcome::Listed(Vec::new()),
        Task::Read { path, .. } => Outcome::Read(path.clone(), Err(reason)),
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
            let copy =
                copy.map_err(|reason| format!("{} cannot be used: {reason}", path.display()));
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

/// Returns the copies of an antenna, newest first; file names contain the time.
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

/// Returns a file name that every file system accepts.
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
        let Outcome::Read(_, Err(reason)) = carry_out(task, None) else { panic!("it is none") };
        assert!(reason.contains("x.toml") && reason.contains("version"), "{reason}");
    }
}
