//! The settings file on disk: read whole, replaced whole.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::Serialize;

use super::{Note, Station, from_toml};
use crate::whole_file;

/// The version that this program writes. A file of a later one is left alone.
const VERSION: i64 = 1;

/// What was found at the place of the settings.
#[derive(Debug)]
pub struct Loaded {
    /// The station.
    pub station: Station,
    /// What was not taken over as it stands in the file.
    pub notes: Vec<Note>,
}

/// Why settings that exist were not read. They stay as they are on disk.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// There are no settings yet.
    #[error("there are no settings yet")]
    Missing,
    /// The operating system refused.
    #[error("the settings cannot be read: {source}: {}", path.display())]
    Read {
        /// Why.
        source: io::Error,
        /// Where.
        path: PathBuf,
    },
    /// Not TOML.
    #[error("the settings are not valid TOML: {source}: {}", path.display())]
    Syntax {
        /// Where in the text.
        source: Box<toml::de::Error>,
        /// Where.
        path: PathBuf,
    },
    /// A later program wrote them.
    #[error("the settings have version {found}, this program knows {VERSION}: {}", path.display())]
    Newer {
        /// Their version.
        found: i64,
        /// Where.
        path: PathBuf,
    },
}

/// Why settings were not written. The old ones are still there.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The station cannot be put into TOML.
    #[error("the settings cannot be put into TOML: {0}")]
    Form(#[from] toml::ser::Error),
    /// The operating system refused.
    #[error("the settings were not saved, the old ones stay: {source}: {}", path.display())]
    Write {
        /// Why.
        source: io::Error,
        /// Where.
        path: PathBuf,
    },
}

/// Where the settings of this user live; `None` on a machine without a home.
pub fn settings_path() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "azel")
        .map(|dirs| dirs.config_dir().join("station.toml"))
}

/// Reads the station at `path`.
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    let text = fs::read_to_string(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => LoadError::Missing,
        _ => LoadError::Read { source, path: path.to_owned() },
    })?;
    let table: toml::Table = toml::from_str(&text)
        .map_err(|source| LoadError::Syntax { source: source.into(), path: path.to_owned() })?;
    let version = table.get("version").and_then(toml::Value::as_integer).unwrap_or(VERSION);
    if version > VERSION {
        return Err(LoadError::Newer { found: version, path: path.to_owned() });
    }
    let (station, notes) = from_toml(table);
    Ok(Loaded { station, notes })
}

/// Puts the station at `path`; a failure at any moment leaves the old settings
/// whole. What stood there before is kept beside it with the ending `.old`,
/// because reading forgives more than it can carry over.
pub fn save(station: &Station, path: &Path) -> Result<(), SaveError> {
    #[derive(Serialize)]
    struct Versioned<'a> {
        version: i64,
        #[serde(flatten)]
        station: &'a Station,
    }
    let text = toml::to_string_pretty(&Versioned { version: VERSION, station })?;
    whole_file::replace_and_keep_old(path, text.as_bytes())
        .map_err(|source| SaveError::Write { source, path: path.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::{super::NoteReason, *};
    use crate::{astro::HorizonMask, station::Antenna};

    fn written(text: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        fs::write(&path, text).unwrap();
        (folder, path)
    }

    #[test]
    fn a_station_comes_back_as_it_was_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/station.toml");
        let mut station = Station::demo("192.168.10.21:4001");
        station.name = "Şile \"1\"".to_owned();
        station.antennas.push(Antenna::satrak("Second", "host.example:5"));
        station.horizon_mask = HorizonMask::parse("350 2.5\n10, -0.1\n123.25 12").ok();
        save(&station, &path).unwrap();
        let loaded = load(&path).unwrap();
        assert_eq!(loaded.notes, []);
        assert_eq!(loaded.station, station);
        save(&Station::default(), &path).unwrap();
        assert_eq!(load(&path.with_extension("toml.old")).unwrap().station, station);
    }

    #[test]
    fn a_bad_field_costs_only_itself() {
        let (_folder, path) = written(
            "name = 'Here'\nelevation_floor_deg = 'ten'\nelevtion = 3\n\
             horizon_mask = '''\n0 5\n90 x'''\n\
             [site]\nlatitude_deg = 95.0\nlongitude_deg = 1.0\naltitude_m = 0.0\n\
             [[antenna]]\nname = 'A'\nbeam_width_deg = -1\n\
             [antenna.connection]\ncontroller = 'satrak'\naddress = 'h:4001'\n\
             [[antenna]]\nname = 'B'\n[antenna.connection]\ncontroller = 'satrak'\naddress = 'h'\n",
        );
        let Loaded { station, notes } = load(&path).unwrap();
        assert_eq!(station.name, "Here");
        assert_eq!(station.antennas.len(), 1);
        assert_eq!(station.antennas[0].name, "A");
        let places: Vec<&str> = notes.iter().map(|note| note.place.as_str()).collect();
        assert_eq!(
            places,
            [
                "site",
                "horizon_mask",
                "elevation_floor_deg",
                "antenna[0].beam_width_deg",
                "antenna[1].connection.address",
                "elevtion"
            ]
        );
        let NoteReason::Invalid(why) = &notes[1].reason else { panic!("{:?}", notes[1]) };
        assert_eq!(why, "line 2 does not hold an azimuth and an elevation");
        assert_eq!(notes[5].reason, NoteReason::Unknown);
    }

    #[test]
    fn a_second_antenna_of_the_same_name_gets_a_name_of_its_own() {
        let one = "[[antenna]]\nname = 'Mast'\n[antenna.connection]\n\
                   controller = 'satrak'\naddress = 'h:4001'\n";
        let (_folder, path) = written(&format!("{one}{}{one}", one.replace("'Mast'", "' MAST 2'")));
        let Loaded { station, notes } = load(&path).unwrap();
        let names: Vec<&str> = station.antennas.iter().map(|antenna| &*antenna.name).collect();
        assert_eq!(names, ["Mast", " MAST 2", "Mast 3"]);
        assert_eq!(notes.len(), 1);
        assert_eq!(notes[0].place, "antenna[2].name");
        let NoteReason::Invalid(why) = &notes[0].reason else { panic!("{:?}", notes[0]) };
        assert_eq!(why, "another antenna has it too, this one is called Mast 3");
    }

    #[test]
    fn what_cannot_be_read_is_left_alone() {
        let (_folder, path) = written("name = \"open");
        assert!(matches!(load(&path), Err(LoadError::Syntax { .. })));
        assert_eq!(fs::read_to_string(&path).unwrap(), "name = \"open");
        let (_folder, path) = written("version = 99");
        assert!(matches!(load(&path), Err(LoadError::Newer { found: 99, .. })));
        assert!(matches!(load(Path::new("/nowhere/at/all.toml")), Err(LoadError::Missing)));
    }

    #[test]
    fn a_failed_save_keeps_the_old_file() {
        let (folder, path) = written("name = 'Old'");
        // A folder of that name cannot be replaced by a file.
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("inside")).unwrap();
        assert!(matches!(save(&Station::default(), &taken), Err(SaveError::Write { .. })));
        assert_eq!(load(&path).unwrap().station.name, "Old");
    }
}
