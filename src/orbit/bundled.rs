//! The elements bundled with the program.

use std::{
    io::{BufRead as _, BufReader},
    sync::Arc,
};

use jiff::Timestamp;

use super::{Catalog, Refusal, read_elements};

/// Name of the source of the bundled elements.
pub const BUNDLED_SOURCE: &str = "bundled, 2026-08-11";

/// Newest epoch of the bundled elements.
pub const BUNDLED_NEWEST: Timestamp = Timestamp::constant(1_786_596_111, 0);

/// Compressed TLE text; see `assets/elements/README.md`.
const COMPRESSED: &[u8] = include_bytes!("../../assets/elements/active_2026-08-11.tle.gz");

/// Number of sets that are read at a time. It bounds the memory that reading takes beside the
/// catalog.
const SETS: usize = 512;
/// Number of lines of a set with its name.
const SET_LINES: usize = 3;

/// Reason why the bundled elements cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BundledError {
    #[error("the bundled elements do not unpack: {0}")]
    Unpack(#[from] std::io::Error),
    #[error("{} of the bundled elements cannot be read", .0.len())]
    Refused(Vec<Refusal>),
}

/// Returns the catalog of all satellites that were active on 2026-08-11.
pub fn bundled() -> Result<Catalog, BundledError> {
    read_into(Catalog::default())
}

/// Returns the same catalog. It shares the memory of sets that are also in `previous`.
pub fn bundled_sharing(previous: &Arc<Catalog>) -> Result<Catalog, BundledError> {
    let mut catalog = Catalog::default();
    catalog.share_with(previous);
    read_into(catalog)
}

fn read_into(mut catalog: Catalog) -> Result<Catalog, BundledError> {
    let mut lines = BufReader::new(flate2::read::GzDecoder::new(COMPRESSED)).lines();
    let (mut refused, mut text) = (Vec::new(), String::new());
    loop {
        text.clear();
        for line in lines.by_ref().take(SETS * SET_LINES) {
            text.push_str(&line?);
            text.push('\n');
        }
        if text.is_empty() {
            break;
        }
        refused.extend(catalog.merge(read_elements(&text), BUNDLED_SOURCE).refused);
    }
    if refused.is_empty() { Ok(catalog) } else { Err(BundledError::Refused(refused)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bundled_object_is_there() {
        let catalog = bundled().unwrap();
        assert_eq!(catalog.len(), 16_089);
        assert_eq!(catalog.get(25_544).unwrap().name(), "ISS (ZARYA)");
        let newest = catalog.newest_epoch().unwrap();
        assert_eq!(newest.as_second(), BUNDLED_NEWEST.as_second());
    }

    #[test]
    fn a_second_catalog_shares_every_set() {
        let first = Arc::new(bundled().unwrap());
        let second = bundled_sharing(&first).unwrap();
        assert_eq!(first.len(), second.len());
        assert!(first.iter().zip(second.iter()).all(|(a, b)| std::ptr::eq(a, b)));
    }
}
