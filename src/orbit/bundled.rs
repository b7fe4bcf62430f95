//! The elements bundled with the program.

use std::io::Read;

use jiff::Timestamp;

use super::{Catalog, Refusal, read_elements};

/// Name of the source of the bundled elements.
pub const BUNDLED_SOURCE: &str = "bundled, 2026-08-11";

/// The newest epoch of the bundled elements.
pub const BUNDLED_NEWEST: Timestamp = Timestamp::constant(1_786_596_111, 0);

/// Compressed TLE text, see `assets/elements/README.md`.
const COMPRESSED: &[u8] = include_bytes!("../../assets/elements/active_2026-08-11.tle.gz");

/// The reason why the bundled elements cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BundledError {
    #[error("the bundled elements do not unpack: {0}")]
    Unpack(#[from] std::io::Error),
    #[error("{} of the bundled elements cannot be read", .0.len())]
    Refused(Vec<Refusal>),
}

/// The catalog of all satellites that were active on 2026-08-11.
pub fn bundled() -> Result<Catalog, BundledError> {
    let mut text = String::new();
    flate2::read::GzDecoder::new(COMPRESSED).read_to_string(&mut text)?;
    let report = read_elements(&text);
    // Frees two and a half megabytes before the merge.
    drop(text);
    let mut catalog = Catalog::default();
    let summary = catalog.merge(report, BUNDLED_SOURCE);
    if summary.refused.is_empty() {
        Ok(catalog)
    } else {
        Err(BundledError::Refused(summary.refused))
    }
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
}
