//! Satellites chosen for a unit, checked before Azel sends anything.

use jiff::Timestamp;

use crate::{
    device::ElementFiles,
    orbit::Catalog,
    transfer::{TleFile, TleFileError},
};

/// Chosen satellites, and the file made of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// Objects in the order of the choice.
    pub objects: Vec<ChosenObject>,
    /// File with all satellites, or the reason why there is no file.
    pub file: Result<TleFile, TleFileError>,
}

/// One chosen satellite.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenObject {
    pub catalog_number: u32,
    /// Name in the catalog; empty without a name.
    pub name: String,
    /// Epoch of the elements; `None` without elements.
    pub epoch: Option<Timestamp>,
    /// Reason why the satellite cannot go to a unit; `None` if it can.
    pub problem: Option<TleFileError>,
}

impl Chosen {
    /// Creates the choice of the objects with these catalog numbers from `catalog`, for a unit with
    /// these element files. An object without elements is listed, but is not in the file.
    pub fn new(catalog: &Catalog, numbers: &[u32], takes: &ElementFiles) -> Self {
        let objects = numbers.iter().map(|number| match catalog.get(*number) {
            None => ChosenObject {
                catalog_number: *number,
                name: String::new(),
                epoch: None,
                problem: None,
            },
            Some(elements) => ChosenObject {
                catalog_number: *number,
                name: elements.name().to_owned(),
                epoch: Some(elements.epoch()),
                problem: TleFile::new([elements], takes).err(),
            },
        });
        Self {
            objects: objects.collect(),
            file: TleFile::new(numbers.iter().filter_map(|number| catalog.get(*number)), takes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        controller::satrak::ELEMENT_FILES,
        orbit::{bundled, read_elements},
    };

    const ISS: u32 = 25_544;

    #[test]
    fn what_can_be_carried_makes_a_file() {
        let chosen = Chosen::new(&bundled().unwrap(), &[ISS, 43_013], &ELEMENT_FILES);
        assert!(chosen.objects.iter().all(|one| one.problem.is_none() && one.epoch.is_some()));
        assert_eq!(chosen.file.unwrap().objects().len(), 2);
    }

    #[test]
    fn what_cannot_be_carried_says_so_at_its_own_line() {
        let mut catalog = bundled().unwrap();
        let text = "[{\"OBJECT_NAME\":\"NEW ONE\",\"NORAD_CAT_ID\":340000,\
                    \"EPOCH\":\"2026-08-14T00:00:00\",\"MEAN_MOTION\":14.19,\"ECCENTRICITY\":0.0001,\
                    \"INCLINATION\":98.7,\"RA_OF_ASC_NODE\":0,\"ARG_OF_PERICENTER\":0,\
                    \"MEAN_ANOMALY\":0,\"BSTAR\":0}]";
        catalog.merge(read_elements(text), "own");
        let chosen = Chosen::new(&catalog, &[ISS, 340_000, 999_999_998], &ELEMENT_FILES);
        let is_fine: Vec<_> = chosen.objects.iter().map(|one| one.problem.is_none()).collect();
        assert_eq!(is_fine, [true, false, true]);
        assert_eq!(chosen.objects[2].epoch, None);
        assert!(matches!(chosen.file, Err(TleFileError::Refused(refused)) if refused.len() == 1));
    }
}
