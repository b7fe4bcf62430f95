//! Folder of element files that the unit reads from disk.

use std::{collections::BTreeMap, fs, path::Path};

use crate::{
    orbit::{Elements, read_element_bytes},
    protocol::satrak::Frame,
};

/// Returns `true` if `frame` makes the unit use a file.
pub(super) fn is_about_a_file(frame: &Frame) -> bool {
    frame.line().trim_start_matches('$').starts_with("SATELLITE=")
}

/// Reads the files in `folder` by name. Skips unreadable files.
pub(super) fn read(folder: &Path) -> BTreeMap<String, Vec<Elements>> {
    let Ok(entries) = fs::read_dir(folder) else { return BTreeMap::new() };
    let file = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().ok()?;
        let bytes = fs::read(entry.path()).ok()?;
        Some((name, read_element_bytes(&bytes).elements))
    };
    entries.filter_map(|entry| file(entry.ok()?)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{bundled, write_tle};

    #[test]
    fn files_are_read_as_they_are_now() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read(&folder.path().join("none")).is_empty());
        let catalog = bundled().unwrap();
        for number in [25_544, 43_013] {
            let mut bytes = Vec::new();
            write_tle(catalog.get(number), &mut bytes).unwrap();
            fs::write(folder.path().join("weather.txt"), bytes).unwrap();
            assert_eq!(read(folder.path())["weather.txt"][0].catalog_number(), number);
        }
    }

    #[test]
    fn only_a_new_file_is_worth_a_look() {
        let is = |payload: &str| is_about_a_file(&Frame::from_payload(payload));
        assert!(is("SATELLITE=,iridium.txt,IRIDIUM 70 [+],1,0"));
        assert!(!is("SATELLITE?") && !is("SATELLITE_FTP=,a,b,c,22,d,e,1,1") && !is("STATUS?"));
    }
}
