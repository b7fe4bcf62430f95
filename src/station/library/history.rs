//! Older sets of elements of each object, in one compressed file of the library.
//!
//! Each line has the catalog number, the epoch in microseconds, and the set with its source's name
//! as JSON. An unreadable line does not affect the other lines.

use std::{
    collections::BTreeMap,
    fs, io,
    io::{Read as _, Write as _},
    path::{Path, PathBuf},
};

use flate2::{Compression, read::GzDecoder, write::GzEncoder};

use crate::{contract::older_sets::OlderSet, whole_file};

/// Name of the file in the folder of the library.
const NAME: &str = "older-sets.gz";
/// Number of stored sets of each object, besides the one in use.
const MAX_SETS: usize = 4;
/// Max unpacked size, bytes. Azel never writes a larger file.
const MAX_UNPACKED: u64 = 1 << 28;

/// Older sets on disk.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
}

/// Lines of one object with their epochs, the newest first.
type Lines = Vec<(i64, String)>;

impl History {
    /// Creates the history of the library in `folder`, which may not exist yet.
    pub fn new(folder: &Path) -> Self {
        Self { path: folder.join(NAME) }
    }

    /// Returns the older sets of an object, the newest first.
    pub fn sets_of(&self, catalog_number: u32) -> Vec<OlderSet> {
        let text = self.text();
        let lines = text.lines().filter_map(parts);
        let own = lines.filter(|(number, ..)| *number == catalog_number);
        let mut sets: Vec<OlderSet> =
            own.filter_map(|(_, _, set)| serde_json::from_str(set).ok()).collect();
        sets.sort_by_key(|set| std::cmp::Reverse(set.elements.epoch()));
        sets
    }

    /// Adds sets, and keeps the newest four of each object.
    pub fn add(&self, sets: &[OlderSet]) -> io::Result<()> {
        if sets.is_empty() {
            return Ok(());
        }
        let mut stored: BTreeMap<u32, Lines> = BTreeMap::new();
        for (number, epoch, set) in self.text().lines().filter_map(parts) {
            stored.entry(number).or_default().push((epoch, set.to_owned()));
        }
        let mut is_changed = false;
        for set in sets {
            let lines = stored.entry(set.elements.catalog_number()).or_default();
            let epoch = set.elements.epoch().as_microsecond();
            let is_too_old =
                lines.len() >= MAX_SETS && lines.iter().all(|(other, _)| *other > epoch);
            if is_too_old || lines.iter().any(|(other, _)| *other == epoch) {
                continue;
            }
            lines.push((epoch, serde_json::to_string(set)?));
            lines.sort_by_key(|(epoch, _)| std::cmp::Reverse(*epoch));
            lines.truncate(MAX_SETS);
            is_changed = true;
        }
        if is_changed { self.save(&stored) } else { Ok(()) }
    }

    fn save(&self, stored: &BTreeMap<u32, Lines>) -> io::Result<()> {
        let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
        for (number, lines) in stored {
            for (epoch, set) in lines {
                writeln!(packed, "{number} {epoch} {set}")?;
            }
        }
        whole_file::replace_and_keep_old(&self.path, &packed.finish()?)
    }

    /// Returns the text of the file. If the file is damaged, returns the previous file, or else the
    /// readable start of the damaged one.
    fn text(&self) -> String {
        let read = read(&self.path);
        match read {
            Ok(text) => text,
            Err(Damage { error, start }) => {
                if error.kind() != io::ErrorKind::NotFound {
                    let path = self.path.display();
                    tracing::warn!(%error, %path, "the older sets are damaged");
                }
                read_old(&self.path).unwrap_or(start)
            }
        }
    }
}

/// Reason why a file could not be read to its end.
struct Damage {
    error: io::Error,
    /// Text that was read before the error.
    start: String,
}

fn read(path: &Path) -> Result<String, Damage> {
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(|error| Damage { error, start: String::new() })?;
    let unpacked = GzDecoder::new(file).take(MAX_UNPACKED).read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).into_owned();
    match unpacked {
        Ok(_) => Ok(text),
        Err(error) => Err(Damage { error, start: text }),
    }
}

fn read_old(path: &Path) -> Option<String> {
    read(&whole_file::old(path)).ok()
}

fn parts(line: &str) -> Option<(u32, i64, &str)> {
    let (number, rest) = line.split_once(' ')?;
    let (epoch, set) = rest.split_once(' ')?;
    Some((number.parse().ok()?, epoch.parse().ok()?, set))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{bundled, read_elements, write_omm_json};

    const ISS: u32 = 25_544;

    /// Returns the ISS with an epoch on `day` August 2026.
    fn set(day: u32, source: &str) -> OlderSet {
        let bundled = bundled().unwrap();
        let mut text = Vec::new();
        write_omm_json([bundled.get(ISS).unwrap()], &mut text).unwrap();
        let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
        list[0]["EPOCH"] = format!("2026-08-{day:02}T10:00:00.000000").into();
        let elements = read_elements(&list.to_string()).elements.remove(0);
        OlderSet { elements, source: source.to_owned() }
    }

    fn days(history: &History) -> Vec<i8> {
        let day = |set: &OlderSet| set.elements.epoch().to_zoned(jiff::tz::TimeZone::UTC).day();
        history.sets_of(ISS).iter().map(day).collect()
    }

    #[test]
    fn the_newest_sets_of_an_object_are_kept_once() {
        let folder = tempfile::tempdir().unwrap();
        let history = History::new(&folder.path().join("deep"));
        assert_eq!(history.sets_of(ISS), []);
        history.add(&[set(3, "weather"), set(1, "own"), set(3, "other")]).unwrap();
        assert_eq!(history.sets_of(ISS), [set(3, "weather"), set(1, "own")]);
        assert_eq!(history.sets_of(43_013), []);
        history.add(&[set(2, "own"), set(4, "own"), set(5, "own"), set(1, "own")]).unwrap();
        assert_eq!(days(&history), [5, 4, 3, 2]);
        let written = fs::metadata(folder.path().join("deep").join(NAME)).unwrap();
        history.add(&[set(1, "own"), set(5, "own")]).unwrap();
        let again = fs::metadata(folder.path().join("deep").join(NAME)).unwrap();
        assert_eq!(written.modified().unwrap(), again.modified().unwrap(), "nothing was new");
    }

    #[test]
    fn a_damaged_file_gives_way_to_the_one_before_it_and_a_bad_line_costs_itself() {
        let folder = tempfile::tempdir().unwrap();
        let history = History::new(folder.path());
        history.add(&[set(1, "own")]).unwrap();
        history.add(&[set(2, "own")]).unwrap();
        let path = folder.path().join(NAME);
        fs::write(&path, "no gzip").unwrap();
        assert_eq!(days(&history), [1]);
        history.add(&[set(3, "own")]).unwrap();
        assert_eq!(days(&history), [3, 1]);

        let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
        let good = serde_json::to_string(&set(7, "own")).unwrap();
        writeln!(packed, "x\n{ISS} 5 {{}}\n{ISS}\n{ISS} 7 {good}").unwrap();
        fs::write(&path, packed.finish().unwrap()).unwrap();
        assert_eq!(days(&history), [7]);
    }
}
