//! Stations that the window opened before, in a small file. The list is a convenience: Azel skips
//! entries that it cannot read.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use serde::Serialize;

use crate::{
    job::{Job, Wake},
    model::KnownStation,
    whole_file,
};

const FILE: &str = "stations.toml";
/// Max number of stations in the list.
const MAX: usize = 8;

/// Max wait for the previous write.
const WAIT: Duration = Duration::from_secs(1);

/// List file with its running write.
#[derive(Default)]
pub(super) struct KnownWork {
    path: Option<PathBuf>,
    job: Option<Job<()>>,
}

impl KnownWork {
    /// Keeps the list in `folder`; returns the stations that the file already holds.
    pub(super) fn new(folder: Option<&Path>) -> (Self, Vec<KnownStation>) {
        let path = folder.map(|folder| folder.join(FILE));
        let stations = path.as_deref().map(read).unwrap_or_default();
        (Self { path, job: None }, stations)
    }

    /// Puts `station` at the head of `stations` and of the file, unless it is there already.
    pub(super) fn put_first(
        &mut self,
        station: KnownStation,
        stations: &mut Vec<KnownStation>,
        wake: &Wake,
    ) {
        if stations.first() == Some(&station) {
            return;
        }
        first(&station, stations);
        self.change(wake, move |stations| first(&station, stations));
    }

    /// Removes the station at `path` from `stations` and from the file.
    pub(super) fn forget(&mut self, path: PathBuf, stations: &mut Vec<KnownStation>, wake: &Wake) {
        stations.retain(|station| station.path != path);
        self.change(wake, move |stations| stations.retain(|station| station.path != path));
    }

    /// Changes the current content of the file, because other windows write it too.
    fn change(
        &mut self,
        wake: &Wake,
        change: impl FnOnce(&mut Vec<KnownStation>) + Send + 'static,
    ) {
        let Some(path) = self.path.clone() else { return };
        let before = self.job.take();
        self.job = Some(Job::start("azel-stations-file", Wake::clone(wake), move |_| {
            if let Some(before) = before {
                before.wait(WAIT);
            }
            let mut stations = read(&path);
            change(&mut stations);
            write(&stations, &path);
        }));
    }
}

fn first(station: &KnownStation, stations: &mut Vec<KnownStation>) {
    stations.retain(|known_station| known_station.path != station.path);
    stations.insert(0, station.clone());
    stations.truncate(MAX);
}

fn read(path: &Path) -> Vec<KnownStation> {
    let Ok(text) = fs::read_to_string(path) else { return Vec::new() };
    let table: toml::Table = toml::from_str(&text).unwrap_or_else(|error| {
        tracing::warn!(%error, path = %path.display(), "not used");
        toml::Table::new()
    });
    let stations = table.get("station").and_then(toml::Value::as_array);
    let station = |value: &toml::Value| value.clone().try_into().ok();
    stations.into_iter().flatten().filter_map(station).take(MAX).collect()
}

fn write(stations: &[KnownStation], path: &Path) {
    #[derive(Serialize)]
    struct File<'a> {
        station: &'a [KnownStation],
    }
    let written = toml::to_string_pretty(&File { station: stations })
        .map_err(std::io::Error::other)
        .and_then(|text| whole_file::replace(path, text.as_bytes()));
    if let Err(error) = written {
        tracing::warn!(%error, path = %path.display(), "the stations are not kept");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATIENCE: Duration = Duration::from_mins(1);

    fn station(name: &str) -> KnownStation {
        KnownStation { name: name.to_owned(), path: format!("/{name}.toml").into() }
    }

    fn names(stations: &[KnownStation]) -> Vec<&str> {
        stations.iter().map(|station| station.name.as_str()).collect()
    }

    #[test]
    fn the_last_used_station_comes_first_and_a_second_window_adds_to_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let wake: Wake = std::sync::Arc::new(|| {});
        let (mut first, mut of_first) = KnownWork::new(Some(folder.path()));
        let (mut second, mut of_second) = KnownWork::new(Some(folder.path()));
        for name in ["Hill", "Mast", "Hill"] {
            first.put_first(station(name), &mut of_first, &wake);
        }
        first.job.take().unwrap().wait(PATIENCE);
        second.put_first(station("Field"), &mut of_second, &wake);
        second.job.take().unwrap().wait(PATIENCE);
        assert_eq!(names(&of_first), ["Hill", "Mast"]);
        assert_eq!(names(&KnownWork::new(Some(folder.path())).1), ["Field", "Hill", "Mast"]);
        first.forget("/Hill.toml".into(), &mut of_first, &wake);
        first.job.take().unwrap().wait(PATIENCE);
        assert_eq!(names(&KnownWork::new(Some(folder.path())).1), ["Field", "Mast"]);
        for number in 0..20 {
            first.put_first(station(&number.to_string()), &mut of_first, &wake);
        }
        assert_eq!((of_first.len(), of_first[0].name.as_str()), (MAX, "19"));
    }

    #[test]
    fn what_is_wrong_in_the_file_costs_only_itself() {
        let folder = tempfile::tempdir().unwrap();
        for (text, left) in [
            ("[[station]]\nname = 'A'\npath = '/a'\n[[station]]\nname = 3\npath = '/b'\n", 1),
            ("station = 3", 0),
            ("[[station", 0),
        ] {
            fs::write(folder.path().join(FILE), text).unwrap();
            assert_eq!(KnownWork::new(Some(folder.path())).1.len(), left, "{text}");
        }
    }
}
