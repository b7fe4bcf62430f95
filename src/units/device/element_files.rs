//! Element files that a unit takes.

use super::settings::{Key, Values};

/// Element files on all units of one make: the upload over SFTP, and the choice of a satellite from
/// a file.
#[derive(Debug)]
pub struct ElementFiles {
    /// Folder in which the unit looks for the files.
    pub folder: &'static str,
    /// User name set by the maker.
    pub factory_user: &'static str,
    /// SHA-256, in hexadecimal digits, of `user:password` as set by the maker. Anyone with
    /// the unit's document knows the password, so its use is worth a warning.
    pub factory_digest: &'static str,
    /// Check of a file or satellite name, which returns the reason why the unit cannot take it. The
    /// first argument names the field.
    pub check_name: fn(&'static str, &str) -> Result<(), String>,
    /// Key of the connection setting that names the file in use.
    pub setting: &'static str,
    /// Key of the settings group that chooses file and satellite.
    pub group: &'static str,
    /// Function that returns the values of [`Self::group`] for a file and the name of a satellite
    /// in it. Writing them ends the current track.
    pub choose: fn(&str, &str) -> Values,
    /// Value of [`Self::group`] with the catalog number that the unit found.
    pub number: Key<i64>,
    /// Key of the settings group that names the source of the unit's elements.
    pub source_group: &'static str,
    /// Test of the values of that group: `true` if the unit fetches its elements without Azel.
    pub are_fetched_by_unit: fn(&Values) -> bool,
    /// Names of the checks that are bad when the unit does not find the satellite.
    pub checks: &'static [&'static str],
}

impl ElementFiles {
    /// Returns the catalog number that the unit found in its file.
    pub fn found(&self, values: &Values) -> Option<i64> {
        self.number.get(values)
    }
}

/// Compares by address: each make has one static instance.
impl PartialEq for ElementFiles {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}
