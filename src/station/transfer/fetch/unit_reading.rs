//! Contents of an element file as a unit will read them.

use crate::{
    contract::transfer::{FileHash, FileObject, SatelliteMatch, UnitView},
    orbit::{Elements, read_element_bytes},
};

/// Number of columns of a TLE line before its checksum.
const TLE_COLUMNS: usize = 68;
/// Max number of suggestions for a name that was not found.
const MAX_SIMILAR: usize = 5;

/// Reads `bytes` like a unit that follows `satellite`.
pub fn what_a_unit_sees(bytes: &[u8], satellite: &str) -> UnitView {
    let read = read_element_bytes(bytes);
    let named = |elements: &&Elements| elements.name() == satellite;
    let object = |elements: &Elements| FileObject {
        name: elements.name().to_owned(),
        catalog_number: elements.catalog_number(),
        epoch: elements.epoch(),
    };
    let mut found: Vec<_> = read.elements.iter().filter(named).map(object).collect();
    let satellite = match found.pop() {
        None => SatelliteMatch::Missing { similar: similar(&read.elements, satellite) },
        Some(only) if found.is_empty() => SatelliteMatch::Found(only),
        Some(last) => {
            found.push(last);
            SatelliteMatch::Several(found)
        }
    };
    UnitView {
        bytes: bytes.len() as u64,
        sha256: FileHash::new(bytes),
        objects: read.elements.len(),
        refused: read.refused,
        refused_unlisted: read.refused_unlisted,
        is_tle: is_tle(bytes),
        satellite,
    }
}

/// Returns names that differ only in case or blanks, or that contain the expected name or are
/// contained in it.
fn similar(elements: &[Elements], expected: &str) -> Vec<String> {
    let plain = |name: &str| {
        let letters = name.chars().filter(|letter| letter.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect::<String>()
    };
    let expected = plain(expected);
    let is_similar = |name: &&str| {
        let name = plain(name);
        !expected.is_empty()
            && !name.is_empty()
            && (name.contains(&expected) || expected.contains(&name))
    };
    let names = elements.iter().map(Elements::name).filter(is_similar);
    names.take(MAX_SIMILAR).map(str::to_owned).collect()
}

/// Returns `true` if two consecutive lines have the form of a TLE.
fn is_tle(bytes: &[u8]) -> bool {
    let is_line = |line: &[u8], start: &[u8]| line.starts_with(start) && line.len() >= TLE_COLUMNS;
    let mut first = false;
    bytes.split(|byte| *byte == b'\n').any(|line| {
        let is_set = first && is_line(line, b"2 ");
        first = is_line(line, b"1 ");
        is_set
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Element sets of Spacetrack Report 3, with its original numbers.
    const SETS: &str = "\
TEST 1\r
1 88888U          80275.98708465  .00073094  13844-3  66816-4 0    87\r
2 88888  72.8435 115.9689 0086731  52.6988 110.5714 16.05824518  1058\r
TEST 1B\r
1 88888U          80275.98708465  .00073094  13844-3  66816-4 0    88\r
2 88888  72.8435 115.9689 0086731  52.6988 110.5714 16.05824518  1058\r
";

    #[test]
    fn a_satellite_is_found_by_its_very_name() {
        let view = what_a_unit_sees(SETS.as_bytes(), "TEST 1");
        let SatelliteMatch::Found(object) = &view.satellite else { panic!("{view:?}") };
        assert_eq!(object.catalog_number, 88_888);
        assert_eq!(view.epoch().unwrap().to_string()[..10], *"1980-10-01");
        assert!(view.is_tle);
        // The second set has a wrong checksum.
        assert_eq!((view.objects, view.refused.len()), (1, 1));
        assert_eq!(view.sha256, FileHash::new(SETS.as_bytes()));
    }

    #[test]
    fn a_satellite_that_is_missing_is_told_with_the_names_it_may_have() {
        for expected in ["test 1", "TEST-1", "TEST"] {
            let view = what_a_unit_sees(SETS.as_bytes(), expected);
            let similar = vec!["TEST 1".to_owned()];
            assert_eq!(view.satellite, SatelliteMatch::Missing { similar }, "{expected}");
            assert_eq!(view.epoch(), None);
        }
        let none = SatelliteMatch::Missing { similar: Vec::new() };
        assert_eq!(what_a_unit_sees(SETS.as_bytes(), "NOAA 15").satellite, none);
        assert_eq!(what_a_unit_sees(SETS.as_bytes(), "").satellite, none);
        let page = what_a_unit_sees(b"<html>gone</html>", "TEST 1");
        assert_eq!((page.is_tle, page.objects, page.satellite), (false, 0, none));
    }

    #[test]
    fn one_name_for_several_objects_is_told() {
        let set = SETS.lines().take(3).collect::<Vec<_>>().join("\n");
        let view = what_a_unit_sees(format!("{set}\n{set}\n").as_bytes(), "TEST 1");
        assert!(matches!(&view.satellite, SatelliteMatch::Several(objects) if objects.len() == 2));
    }

    #[test]
    fn another_form_than_tle_is_told() {
        let json = br#"[{"OBJECT_NAME":"A","EPOCH":"2026-08-11T12:00:00","MEAN_MOTION":15.5,
            "ECCENTRICITY":0.0004,"INCLINATION":51.6,"RA_OF_ASC_NODE":100,"ARG_OF_PERICENTER":10,
            "MEAN_ANOMALY":20,"NORAD_CAT_ID":7,"BSTAR":0,"MEAN_MOTION_DOT":0,"MEAN_MOTION_DDOT":0}]"#;
        let view = what_a_unit_sees(json, "A");
        assert!(matches!(view.satellite, SatelliteMatch::Found(_)), "{view:?}");
        assert!(!view.is_tle);
    }
}
