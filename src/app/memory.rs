//! State that the window keeps from one start to the next, in a small file beside the station file.
//! A damaged file costs only its contents. Azel writes the file only after a change by the
//! operator.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use serde::{Serialize, de::DeserializeOwned};

use super::place::Place;
use crate::{
    contract::passes::{ListChoice, SPANS_H, Scope},
    job::{Job, Wake},
    model::{Appearance, DistanceUnit, ThemeName, View},
    ui::{StoredViews, map::MapLayers, pass_list::Arrangement, sky_plot::Layers},
    whole_file,
};

/// Default name of the file.
const FILE: &str = "window.toml";
/// Entries of earlier versions. Azel reads them without a warning, and the next write drops them.
const RETIRED: [&str; 2] = ["columns", "keys"];
/// Entries that are absent while they have no value.
const OPTIONAL: [&str; 5] = ["antenna", "group", "list_width", "strip_hours", "window"];
/// Max wait for the last write at the end of the program.
const FAREWELL: Duration = Duration::from_millis(500);

/// State that the window keeps.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Memory {
    pub(super) appearance: Appearance,
    /// Name of the antenna that the operator selected last.
    pub(super) antenna: Option<String>,
    /// Last shown view.
    pub(super) view: View,
    /// Size and place of the window; `None` until the operator changes them.
    pub(super) place: Option<Place>,
    /// The choice of passes in the list.
    pub(super) list: ListChoice,
    /// The kept state of the views.
    pub(super) views: StoredViews,
}

/// Reads the file at `path`; returns an empty table if the file is missing or unreadable.
fn read(path: &Path) -> toml::Table {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => {
            if error.kind() != io::ErrorKind::NotFound {
                tracing::warn!(%error, path = %path.display(), "not read");
            }
            return toml::Table::new();
        }
    };
    toml::from_str(&text).unwrap_or_else(|error| {
        tracing::warn!(%error, path = %path.display(), "not used");
        toml::Table::new()
    })
}

/// Adds the entries of `old` that this version does not know, such as entries of a later version.
fn keep_unknown(new: &mut toml::Table, old: &toml::Table) {
    for (key, old) in old {
        match (new.get_mut(key), old) {
            (Some(toml::Value::Table(new)), toml::Value::Table(old)) => keep_unknown(new, old),
            (Some(_), _) => {}
            (None, _) if RETIRED.contains(&&**key) || OPTIONAL.contains(&&**key) => {}
            (None, _) => {
                new.insert(key.clone(), old.clone());
            }
        }
    }
}

impl Memory {
    /// Returns the memory in a file. Missing or wrong parts get their defaults.
    fn of_file(table: &toml::Table) -> Self {
        let is_set = |key: &str| flag(table, key).unwrap_or_default();
        let number = |key: &str| {
            let number = table.get(key).and_then(toml::Value::as_integer);
            number.and_then(|number| u32::try_from(number).ok())
        };
        let span = |key: &str| number(key).filter(|hours| SPANS_H.contains(hours));
        let list = ListChoice::default();
        Self {
            appearance: Appearance {
                theme: word(table, "theme"),
                light_by_day: is_set("light_by_day"),
                scale_percent: number("scale_percent")
                    .filter(|percent| Appearance::SCALES_PERCENT.contains(percent))
                    .unwrap_or(Appearance::default().scale_percent),
                local_time: flag(table, "local_time").unwrap_or(Appearance::default().local_time),
                angle_decimals: number("angle_decimals")
                    .filter(|decimals| Appearance::ANGLE_DECIMALS.contains(decimals))
                    .unwrap_or(Appearance::default().angle_decimals),
                distances: word(table, "distances"),
            },
            list: ListChoice {
                scope: word(table, "pass_scope"),
                favourites_h: span("pass_hours").unwrap_or(list.favourites_h),
                all_h: span("pass_hours_of_all").unwrap_or(list.all_h),
            },
            antenna: table.get("antenna").and_then(toml::Value::as_str).map(str::to_owned),
            view: kept_view(word(table, "view")),
            place: table.get("window").and_then(|place| place.clone().try_into().ok()),
            views: StoredViews {
                travel_open: is_set("travel_open"),
                faults_open: is_set("faults_open"),
                strip_hours: number("strip_hours"),
                list_width: number("list_width"),
                passes: arrangement(table.get("passes").and_then(toml::Value::as_table)),
                layers: layers(table.get("layers").and_then(toml::Value::as_table)),
                map_layers: map_layers(table.get("map_layers").and_then(toml::Value::as_table)),
            },
        }
    }

    /// Removes the parts that belong to one station alone.
    fn of_another_station(self) -> Self {
        Self { antenna: None, place: None, view: View::default(), ..self }
    }

    pub(super) fn keep_view(&mut self, view: View) {
        self.view = kept_view(view);
    }

    fn to_toml(&self) -> Result<toml::Table, toml::ser::Error> {
        #[derive(Serialize)]
        struct Lines<'a> {
            theme: ThemeName,
            light_by_day: bool,
            scale_percent: u32,
            local_time: bool,
            angle_decimals: u32,
            distances: DistanceUnit,
            #[serde(skip_serializing_if = "Option::is_none")]
            antenna: Option<&'a str>,
            view: View,
            pass_scope: Scope,
            pass_hours: u32,
            pass_hours_of_all: u32,
            travel_open: bool,
            faults_open: bool,
            #[serde(skip_serializing_if = "Option::is_none")]
            strip_hours: Option<u32>,
            #[serde(skip_serializing_if = "Option::is_none")]
            list_width: Option<u32>,
            passes: &'a Arrangement,
            layers: Layers,
            map_layers: MapLayers,
            #[serde(skip_serializing_if = "Option::is_none")]
            window: Option<Place>,
        }
        toml::Table::try_from(Lines {
            theme: self.appearance.theme,
            light_by_day: self.appearance.light_by_day,
            scale_percent: self.appearance.scale_percent,
            local_time: self.appearance.local_time,
            angle_decimals: self.appearance.angle_decimals,
            distances: self.appearance.distances,
            antenna: self.antenna.as_deref(),
            view: self.view,
            pass_scope: self.list.scope,
            pass_hours: self.list.favourites_h,
            pass_hours_of_all: self.list.all_h,
            travel_open: self.views.travel_open,
            faults_open: self.views.faults_open,
            strip_hours: self.views.strip_hours,
            list_width: self.views.list_width,
            passes: &self.views.passes,
            layers: self.views.layers,
            map_layers: self.views.map_layers,
            window: self.place,
        })
    }
}

/// Returns the view to keep. The set-up view is not kept, because it opens automatically.
fn kept_view(view: View) -> View {
    if view == View::Setup { View::default() } else { view }
}

fn flag(table: &toml::Table, key: &str) -> Option<bool> {
    table.get(key).and_then(toml::Value::as_bool)
}

fn arrangement(table: Option<&toml::Table>) -> Arrangement {
    let Some(table) = table else { return Arrangement::default() };
    let is_set = |key: &str| flag(table, key).unwrap_or_default();
    Arrangement {
        order: word(table, "order"),
        group: table.get("group").and_then(toml::Value::as_str).map(str::to_owned),
        light: word(table, "light"),
        sunlit: is_set("sunlit"),
        trackable: is_set("trackable"),
        to_come: is_set("to_come"),
    }
}

fn layers(table: Option<&toml::Table>) -> Layers {
    let defaults = Layers::default();
    let Some(table) = table else { return defaults };
    let shown = |key: &str, default| flag(table, key).unwrap_or(default);
    Layers {
        others: shown("others", defaults.others),
        names: shown("names", defaults.names),
        sun_and_moon: shown("sun_and_moon", defaults.sun_and_moon),
        keyholes: shown("keyholes", defaults.keyholes),
        mask: shown("mask", defaults.mask),
        keep_outs: shown("keep_outs", defaults.keep_outs),
        antennas: shown("antennas", defaults.antennas),
    }
}

fn map_layers(table: Option<&toml::Table>) -> MapLayers {
    let defaults = MapLayers::default();
    let Some(table) = table else { return defaults };
    let shown = |key: &str, default| flag(table, key).unwrap_or(default);
    MapLayers {
        tracks: shown("tracks", defaults.tracks),
        other_tracks: shown("other_tracks", defaults.other_tracks),
        footprints: shown("footprints", defaults.footprints),
        terminator: shown("terminator", defaults.terminator),
        names: shown("names", defaults.names),
        grid: shown("grid", defaults.grid),
    }
}

/// Reads one of a few words; returns the default if the word is missing or unknown.
fn word<T: Default + DeserializeOwned>(table: &toml::Table, key: &str) -> T {
    table.get(key).and_then(|value| value.clone().try_into().ok()).unwrap_or_default()
}

/// Returns the memory file of the station file `station`: `window.toml` for `station.toml`,
/// `hill.window.toml` for `hill.toml`.
fn memory_path(station: &Path) -> PathBuf {
    match station.file_stem() {
        Some(stem) if stem != "station" => {
            let mut name = stem.to_owned();
            name.push(".");
            name.push(FILE);
            station.with_file_name(name)
        }
        _ => station.with_file_name(FILE),
    }
}

/// Memory with its file and a running write.
pub(super) struct Keeper {
    pub(super) memory: Memory,
    written: Memory,
    /// Content of the file when Azel read it.
    file: Arc<toml::Table>,
    path: Option<PathBuf>,
    job: Option<Job<()>>,
}

impl Keeper {
    /// Loads the memory of a station file; without a station file it keeps nothing. A station
    /// without its own memory file starts from the default file beside it.
    pub(super) fn new(station: Option<&Path>) -> Self {
        let path = station.map(memory_path);
        let default_path = station.map(|station| station.with_file_name(FILE));
        let file = path.as_deref().map(read).unwrap_or_default();
        let memory = match (path.as_deref(), default_path.as_deref()) {
            (Some(path), Some(default_path)) if !path.exists() => {
                Memory::of_file(&read(default_path)).of_another_station()
            }
            _ => Memory::of_file(&file),
        };
        Self { written: memory.clone(), memory, file: Arc::new(file), path, job: None }
    }

    /// Writes changes on a thread, one write at a time.
    pub(super) fn keep(&mut self, wake: &Wake) {
        // The log reports a failed write; the next change retries it.
        let _ = Job::take(&mut self.job);
        let Some(path) = self.path.clone().filter(|_| self.job.is_none()) else { return };
        if self.memory == self.written {
            return;
        }
        // Do not retry a failed write before the next change.
        self.written = self.memory.clone();
        let (memory, file) = (self.memory.clone(), Arc::clone(&self.file));
        self.job = Some(Job::start("azel-window-file", Wake::clone(wake), move |_| {
            write(&memory, &file, &path);
        }));
    }

    /// Writes the last change before the program ends, within a limited time.
    pub(super) fn finish(&mut self, wake: &Wake) {
        for _ in 0..2 {
            if let Some(job) = self.job.take() {
                job.wait(FAREWELL);
            }
            self.keep(wake);
        }
    }
}

fn write(memory: &Memory, file: &toml::Table, path: &Path) {
    let text = memory.to_toml().and_then(|mut table| {
        keep_unknown(&mut table, file);
        toml::to_string(&table)
    });
    let written =
        text.map_err(io::Error::other).and_then(|text| whole_file::replace(path, text.as_bytes()));
    if let Err(error) = written {
        tracing::warn!(%error, path = %path.display(), "the window is not kept");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::pass_list::{Light, Order};

    fn other() -> Memory {
        Memory {
            appearance: Appearance {
                theme: ThemeName::Night,
                light_by_day: true,
                scale_percent: 150,
                local_time: false,
                angle_decimals: 3,
                distances: DistanceUnit::NauticalMiles,
            },
            antenna: Some("Şile \"2\"".to_owned()),
            view: View::Map,
            place: "at = [12, 7]\nsize = [1300, 800]\nis_maximized = true"
                .parse::<toml::Table>()
                .unwrap()
                .try_into()
                .ok(),
            list: ListChoice { scope: Scope::All, favourites_h: 24, all_h: 12 },
            views: StoredViews {
                travel_open: true,
                faults_open: false,
                strip_hours: Some(24),
                list_width: Some(411),
                passes: Arrangement {
                    order: Order::Maximum,
                    group: Some("weather".to_owned()),
                    light: Light::Night,
                    trackable: true,
                    ..Arrangement::default()
                },
                layers: Layers { names: false, mask: false, ..Layers::default() },
                map_layers: MapLayers { other_tracks: true, ..MapLayers::default() },
            },
        }
    }

    fn keeper(folder: &tempfile::TempDir) -> Keeper {
        Keeper::new(Some(&folder.path().join("deep/station.toml")))
    }

    fn silent() -> Wake {
        std::sync::Arc::new(|| {})
    }

    #[test]
    fn what_was_changed_comes_back_and_what_was_not_writes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = keeper(&folder);
        assert_eq!(first.memory, Memory::default());
        first.keep(&silent());
        first.finish(&silent());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        first.memory = other();
        first.keep(&silent());
        first.finish(&silent());
        assert_eq!(keeper(&folder).memory, other());
    }

    #[test]
    fn each_station_has_a_memory_of_its_own_and_begins_as_the_usual_one_looks() {
        let folder = tempfile::tempdir().unwrap();
        let keeper = |name: &str| Keeper::new(Some(&folder.path().join(name)));
        let mut first = keeper("station.toml");
        first.memory = other();
        first.finish(&silent());
        let mut hill = keeper("hill.toml");
        assert_eq!(hill.memory.views, other().views);
        assert_eq!(hill.memory, other().of_another_station());
        hill.memory.appearance.theme = ThemeName::Light;
        hill.finish(&silent());
        assert!(folder.path().join("hill.window.toml").exists());
        assert_eq!(keeper("hill.toml").memory.appearance.theme, ThemeName::Light);
        assert_eq!(keeper("station.toml").memory, other());
    }

    #[test]
    fn of_two_changes_the_later_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = keeper(&folder);
        for theme in [ThemeName::Light, ThemeName::Dark, ThemeName::Night] {
            first.memory.appearance.theme = theme;
            first.keep(&silent());
        }
        first.finish(&silent());
        assert_eq!(keeper(&folder).memory.appearance.theme, ThemeName::Night);
    }

    #[test]
    fn a_wrong_part_costs_only_itself() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("window.toml");
        for (text, memory) in [
            ("theme = 'night'\nstrip_hours = -3\nfaults_open = 'yes'\nnew = 1", {
                let theme = ThemeName::Night;
                let appearance = Appearance { theme, ..Appearance::default() };
                Memory { appearance, ..Memory::default() }
            }),
            ("theme = 'light'\nlight_by_day = 3\nscale_percent = 130\nangle_decimals = 4", {
                let theme = ThemeName::Light;
                let appearance = Appearance { theme, ..Appearance::default() };
                Memory { appearance, ..Memory::default() }
            }),
            ("list_width = -4\n[layers]\nnames = false\nmask = 3\nnew = true", {
                let layers = Layers { names: false, ..Layers::default() };
                Memory {
                    views: StoredViews { layers, ..StoredViews::default() },
                    ..Memory::default()
                }
            }),
            ("[passes]\norder = 'maximum'\nlight = 3\nsunlit = 'yes'\ntrackable = true", {
                let passes = Arrangement {
                    order: Order::Maximum,
                    trackable: true,
                    ..Arrangement::default()
                };
                Memory {
                    views: StoredViews { passes, ..StoredViews::default() },
                    ..Memory::default()
                }
            }),
            ("pass_scope = 'none'\npass_hours = 7\npass_hours_of_all = 24", {
                let list = ListChoice { all_h: 24, ..ListChoice::default() };
                Memory { list, ..Memory::default() }
            }),
            // Entries of earlier versions.
            ("keys = [['operate', 'N', 'J']]\ncolumns = ['age', 'number']", Memory::default()),
            ("view = 'setup'\nwindow = { size = [4, 5], is_maximized = 3 }", Memory::default()),
            ("theme = 7\nantenna = 'Mast'", {
                Memory { antenna: Some("Mast".to_owned()), ..Memory::default() }
            }),
            ("theme = \"", Memory::default()),
        ] {
            fs::write(&path, text).unwrap();
            assert_eq!(Memory::of_file(&read(&path)), memory, "{text}");
        }
        fs::write(&path, [0xFF, 0xFE]).unwrap();
        assert_eq!(Memory::of_file(&read(&path)), Memory::default());
    }

    #[test]
    fn a_write_keeps_entries_of_a_later_version_and_drops_those_of_earlier_ones() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("window.toml");
        let text = "antenna = 'Mast'\nlater = 1\nkeys = [['operate', 'N', 'J']]\ncolumns = ['age']\n\
                    strip_hours = 24\n[layers]\nclouds = true\nnames = true\n";
        fs::write(&path, text).unwrap();
        let mut keeper = Keeper::new(Some(&folder.path().join("station.toml")));
        keeper.memory.antenna = None;
        keeper.memory.views.strip_hours = None;
        keeper.memory.views.layers.names = false;
        keeper.finish(&silent());
        let file = read(&path);
        assert_eq!(file.get("later"), Some(&toml::Value::Integer(1)));
        let layers = file.get("layers").and_then(toml::Value::as_table).unwrap();
        let flags = ["clouds", "names"].map(|key| layers.get(key).and_then(toml::Value::as_bool));
        assert_eq!(flags, [Some(true), Some(false)]);
        for removed in ["keys", "columns", "antenna", "strip_hours"] {
            assert_eq!(file.get(removed), None, "{removed}");
        }
    }

    #[test]
    fn a_place_that_cannot_be_written_harms_nothing() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("deep"), "a file").unwrap();
        let mut keeper = keeper(&folder);
        keeper.memory = other();
        keeper.keep(&silent());
        keeper.finish(&silent());
        assert_eq!(fs::read_to_string(folder.path().join("deep")).unwrap(), "a file");
    }
}
