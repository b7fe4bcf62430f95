//! File of elements for a unit, checked before it is sent.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    device::ElementFiles,
    orbit::{Elements, TleRefusal, read_element_bytes, write_tle},
    transfer::FileHash,
};

/// An object of a file on a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileObject {
    /// Name in the file, by which the unit looks for it.
    pub name: String,
    pub catalog_number: u32,
    /// Epoch of the elements, as precise as the columns of a TLE.
    pub epoch: Timestamp,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TleFile {
    bytes: Vec<u8>,
    objects: Vec<FileObject>,
}

/// Reason why no file was made. In this case Azel sends nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TleFileError {
    /// No object was chosen.
    #[error("no satellite was chosen; choose one at least")]
    Empty,
    /// Some objects cannot be written as TLE; all of them are listed.
    #[error("{}; leave them out", listed(.0))]
    Refused(Vec<TleRefusal>),
    /// The object has no name, but the unit finds objects only by name.
    #[error("object {catalog_number} has no name, and the unit looks for names; leave it out")]
    Nameless { catalog_number: u32 },
    /// Two objects have the same name; the unit would find only the first.
    #[error("two objects have the name {name}, and the unit looks for names; leave one out")]
    NameTwice {
        /// Name in the file.
        name: String,
    },
    /// The unit's protocol cannot carry the name.
    #[error("the unit cannot be told to look for {name}: the {problem}; leave it out")]
    Name {
        /// Name in the file.
        name: String,
        /// Reason in words.
        problem: String,
    },
}

fn listed(refused: &[TleRefusal]) -> String {
    let one =
        |refusal: &TleRefusal| format!("object {}: {}", refusal.catalog_number, refusal.reason);
    refused.iter().map(one).collect::<Vec<_>>().join("; ")
}

impl TleFile {
    /// Creates a file of the `chosen` objects for a unit with these element files. The file
    /// contains all chosen objects, or there is no file.
    ///
    /// # Errors
    /// Returns an error if nothing is chosen, an object does not fit into a TLE, or a name is
    /// missing, repeated or unacceptable to the unit.
    pub fn new<'a>(
        chosen: impl IntoIterator<Item = &'a Elements>,
        takes: &ElementFiles,
    ) -> Result<Self, TleFileError> {
        let mut bytes = Vec::new();
        // Writing to memory cannot fail.
        let refused = write_tle(chosen, &mut bytes).unwrap_or_default();
        if !refused.is_empty() {
            return Err(TleFileError::Refused(refused));
        }
        let file = Self::from_bytes(bytes);
        if file.objects.is_empty() {
            return Err(TleFileError::Empty);
        }
        let mut names = std::collections::BTreeSet::new();
        for FileObject { name, catalog_number, .. } in &file.objects {
            if name.is_empty() {
                return Err(TleFileError::Nameless { catalog_number: *catalog_number });
            }
            if !names.insert(name) {
                return Err(TleFileError::NameTwice { name: name.clone() });
            }
            (takes.check_name)("name", name)
                .map_err(|problem| TleFileError::Name { name: name.clone(), problem })?;
        }
        Ok(file)
    }

    /// Creates a file from an earlier state of a unit, to be put back, with any content.
    pub fn from_bytes(bytes: Vec<u8>) -> Self {
        let object = |elements: &Elements| FileObject {
            name: elements.name().to_owned(),
            catalog_number: elements.catalog_number(),
            epoch: elements.epoch(),
        };
        let objects = read_element_bytes(&bytes).elements.iter().map(object).collect();
        Self { bytes, objects }
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the objects in the order of the file.
    pub fn objects(&self) -> &[FileObject] {
        &self.objects
    }

    pub fn hash(&self) -> FileHash {
        FileHash::new(&self.bytes)
    }
}

/// Name of a file in the folder of a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileName(String);

/// Reason why a name cannot be the name of a file on a unit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FileNameError {
    /// The unit's protocol cannot carry the name; reason in words.
    #[error("the {0}; choose another one")]
    Value(String),
    /// The name leads to another folder or is hidden.
    #[error(
        "the file name starts with a dot or holds a slash; choose a plain one such as weather.txt"
    )]
    Path,
}

impl FileName {
    /// Checks `name` as entered, for a unit with these element files.
    pub fn new(name: &str, takes: &ElementFiles) -> Result<Self, FileNameError> {
        (takes.check_name)("file name", name).map_err(FileNameError::Value)?;
        if name.starts_with('.') || name.contains(['/', '\\']) {
            return Err(FileNameError::Path);
        }
        Ok(Self(name.to_owned()))
    }

    pub fn as_str(&self) -> &str {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        controller::satrak::ELEMENT_FILES,
        orbit::{TleRefusalReason, bundled, read_elements},
    };

    fn omm(name: &str, number: u32) -> String {
        format!(
            r#"{{"OBJECT_NAME":"{name}","OBJECT_ID":"1998-067A","EPOCH":"2026-08-11T12:00:00.000000",
            "MEAN_MOTION":15.5,"ECCENTRICITY":0.0004,"INCLINATION":51.6,"RA_OF_ASC_NODE":100.0,
            "ARG_OF_PERICENTER":10.0,"MEAN_ANOMALY":20.0,"EPHEMERIS_TYPE":0,
            "CLASSIFICATION_TYPE":"U","NORAD_CAT_ID":{number},"ELEMENT_SET_NO":999,"REV_AT_EPOCH":1,
            "BSTAR":0.0001,"MEAN_MOTION_DOT":0.0001,"MEAN_MOTION_DDOT":0}}"#
        )
    }

    fn file(objects: &[(&str, u32)]) -> Result<TleFile, TleFileError> {
        let objects: Vec<_> = objects.iter().map(|(name, number)| omm(name, *number)).collect();
        let read = read_elements(&format!("[{}]", objects.join(",")));
        assert_eq!(read.elements.len(), objects.len(), "{:?}", read.refused);
        TleFile::new(&read.elements, &ELEMENT_FILES)
    }

    #[test]
    fn a_file_holds_what_was_chosen_under_names_the_unit_can_be_told() {
        let file = file(&[("ISS (ZARYA)", 25_544), ("NOAA 15 [B]", 125_338)]).unwrap();
        let text = std::str::from_utf8(file.bytes()).unwrap();
        assert_eq!(text.lines().count(), 6, "{text}");
        let objects: Vec<_> =
            file.objects().iter().map(|one| (one.name.as_str(), one.catalog_number)).collect();
        assert_eq!(objects, [("ISS (ZARYA)", 25_544), ("NOAA 15 [B]", 125_338)]);
        assert_eq!(file.objects()[0].epoch, "2026-08-11T12:00:00Z".parse().unwrap());
        assert_eq!(file.hash(), FileHash::new(text.as_bytes()));
    }

    #[test]
    fn what_cannot_be_carried_is_refused_with_all_reasons() {
        let error = file(&[("A", 340_000), ("B", 5), ("C", 400_000)]).unwrap_err();
        let TleFileError::Refused(refused) = &error else { panic!("{error}") };
        assert_eq!(refused.len(), 2);
        assert_eq!(refused[0].reason, TleRefusalReason::CatalogNumber);
        assert!(error.to_string().contains("object 400000: a TLE carries"), "{error}");
        assert_eq!(file(&[]), Err(TleFileError::Empty));
        assert_eq!(file(&[("", 7)]), Err(TleFileError::Nameless { catalog_number: 7 }));
        let twice = TleFileError::NameTwice { name: "A".to_owned() };
        assert_eq!(file(&[("A", 7), ("A", 8)]), Err(twice));
        let comma = file(&[("AO-7, OSCAR 7", 7530)]).unwrap_err();
        assert!(matches!(comma, TleFileError::Name { .. }), "{comma}");
    }

    #[test]
    fn most_of_the_bundled_objects_can_be_sent_one_by_one() {
        let catalog = bundled().unwrap();
        let elements: Vec<_> = catalog.iter().take(500).collect();
        assert_eq!(elements.len(), 500);
        for one in elements {
            let file = TleFile::new([one], &ELEMENT_FILES).unwrap();
            assert_eq!(file.objects()[0].catalog_number, one.catalog_number());
        }
    }

    #[test]
    fn names_of_files_stay_in_their_folder() {
        for name in ["weather.txt", "IRIDIUM 70 [+].tle"] {
            assert_eq!(FileName::new(name, &ELEMENT_FILES).unwrap().as_str(), name);
        }
        for name in ["", ".", "..", ".hidden", "a/b", "a\\b", "a,b", "şile.txt", " a"] {
            assert!(FileName::new(name, &ELEMENT_FILES).is_err(), "{name}");
        }
    }
}
