//! Older sets that the operator uses in place of the newest ones, in a small file of the library.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{contract::older_sets::OlderSet, orbit::Catalog, whole_file};

/// Name of the file in the folder of the library.
const NAME: &str = "older-sets-in-use.json";

/// Older set that the operator uses for one object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Exception {
    set: OlderSet,
    /// Epoch of the newest set at the operator's choice; a newer set ends the exception.
    newest: Timestamp,
}

impl Exception {
    fn number(&self) -> u32 {
        self.set.elements.catalog_number()
    }

    /// Returns `true` if `catalog` has a newer set than at the operator's choice. A set with an
    /// epoch too far in the future counts as older than any current set.
    fn is_over(&self, catalog: &Catalog) -> bool {
        catalog
            .get(self.number())
            .is_some_and(|elements| catalog.is_better(elements.epoch(), self.newest))
    }
}

/// Older sets in use, at most one of each object.
#[derive(Debug)]
pub struct Exceptions {
    path: PathBuf,
    list: Vec<Exception>,
}

impl Exceptions {
    /// Reads the file in the library folder, which may be missing. An unreadable file counts as
    /// empty: Azel then uses the newest sets.
    pub fn load(folder: &Path) -> Self {
        let path = folder.join(NAME);
        let list = match read(&path) {
            Ok(list) => list,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => {
                let path = path.display();
                tracing::warn!(%error, %path, "the older sets in use are damaged");
                Vec::new()
            }
        };
        Self { path, list }
    }

    /// Uses `set` until a set newer than `newest` arrives.
    pub fn begin(&mut self, set: OlderSet, newest: Timestamp) -> io::Result<()> {
        let new = Exception { set, newest };
        self.list.retain(|exception| exception.number() != new.number());
        self.list.push(new);
        self.save()
    }

    /// Returns to the newest set of an object.
    pub fn end(&mut self, catalog_number: u32) -> io::Result<()> {
        self.retain(|exception| exception.number() != catalog_number)
    }

    /// Forgets the exceptions that newer sets in `catalog` have ended.
    pub fn forget_ended(&mut self, catalog: &Catalog) -> io::Result<()> {
        self.retain(|exception| !exception.is_over(catalog))
    }

    /// Returns `true` if the operator uses an older set for this object.
    pub fn has(&self, catalog_number: u32) -> bool {
        self.list.iter().any(|exception| exception.number() == catalog_number)
    }

    /// Replaces the newest sets in `catalog` by the older sets in use.
    pub fn apply(&self, catalog: &mut Catalog) {
        for exception in &self.list {
            if !exception.is_over(catalog) {
                let set = &exception.set;
                catalog.use_in_place(set.elements.clone(), &set.source);
            }
        }
    }

    fn retain(&mut self, stays: impl Fn(&Exception) -> bool) -> io::Result<()> {
        let before = self.list.len();
        self.list.retain(stays);
        if self.list.len() == before { Ok(()) } else { self.save() }
    }

    fn save(&self) -> io::Result<()> {
        whole_file::replace(&self.path, &serde_json::to_vec_pretty(&self.list)?)
    }
}

fn read(path: &Path) -> io::Result<Vec<Exception>> {
    Ok(serde_json::from_slice(&fs::read(path)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{read_elements, write_omm_json};

    const ISS: u32 = 25_544;

    /// Returns the ISS with an epoch on `day` August 2026.
    fn set(day: u32) -> OlderSet {
        let bundled = crate::orbit::bundled().unwrap();
        let mut text = Vec::new();
        write_omm_json([bundled.get(ISS).unwrap()], &mut text).unwrap();
        let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
        list[0]["EPOCH"] = format!("2026-08-{day:02}T10:00:00.000000").into();
        let elements = read_elements(&list.to_string()).elements.remove(0);
        OlderSet { elements, source: "own".to_owned() }
    }

    fn catalog(day: u32) -> Catalog {
        let mut catalog = Catalog::default();
        let mut text = Vec::new();
        write_omm_json([&set(day).elements], &mut text).unwrap();
        catalog.merge(crate::orbit::read_element_bytes(&text), "newest");
        catalog
    }

    fn in_use(folder: &Path, day: u32) -> Timestamp {
        let mut catalog = catalog(day);
        let mut exceptions = Exceptions::load(folder);
        exceptions.apply(&mut catalog);
        exceptions.forget_ended(&self::catalog(day)).unwrap();
        catalog.get(ISS).unwrap().epoch()
    }

    #[test]
    fn an_older_set_is_used_until_a_newer_one_comes_or_it_is_ended() {
        let folder = tempfile::tempdir().unwrap();
        let folder = &folder.path().join("deep");
        let epoch = |day| set(day).elements.epoch();
        Exceptions::load(folder).begin(set(3), epoch(7)).unwrap();
        assert_eq!(in_use(folder, 7), epoch(3));
        assert_eq!(in_use(folder, 7), epoch(3), "at every start");
        assert_eq!(in_use(folder, 8), epoch(8));
        assert_eq!(in_use(folder, 7), epoch(7), "it came to its end");
        let mut exceptions = Exceptions::load(folder);
        exceptions.begin(set(3), epoch(7)).unwrap();
        exceptions.begin(set(4), epoch(7)).unwrap();
        assert_eq!(in_use(folder, 7), epoch(4));
        Exceptions::load(folder).end(ISS).unwrap();
        assert_eq!(in_use(folder, 7), epoch(7));
    }

    #[test]
    fn a_newest_epoch_far_ahead_keeps_no_older_set_in_use() {
        let folder = tempfile::tempdir().unwrap();
        let epoch = |day| set(day).elements.epoch();
        Exceptions::load(folder.path()).begin(set(3), epoch(30)).unwrap();
        let mut catalog = Catalog::default();
        catalog.set_time(epoch(8));
        let mut text = Vec::new();
        write_omm_json([&set(7).elements], &mut text).unwrap();
        catalog.merge(crate::orbit::read_element_bytes(&text), "newest");
        Exceptions::load(folder.path()).apply(&mut catalog);
        assert_eq!(catalog.get(ISS).unwrap().epoch(), epoch(7));
    }

    #[test]
    fn a_damaged_file_leaves_the_newest_sets_in_use() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(NAME), "[{").unwrap();
        assert_eq!(in_use(folder.path(), 7), set(7).elements.epoch());
    }
}
