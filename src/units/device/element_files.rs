//! Element files that a unit takes.

use super::settings::{Key, Values};

/// How all units of a make take element files over SFTP, and how Azel has them use a satellite of a
/// file.
#[derive(Debug)]
pub struct ElementFiles {
    /// Folder in which the unit looks for the files.
    pub folder: &'static str,
    /// User name set by the maker.
    pub factory_user: &'static str,
    /// SHA-256, in hexadecimal digits, of `user:password` as set by the maker. Anyone with
    /// the unit's document knows the password, so its use is worth a warning.
    pub factory_digest: &'static str,
    /// Checks a file or satellite name and says why the unit cannot take it. The first
    /// argument says which of the two it is.
    pub check_name: fn(&'static str, &str) -> Result<(), String>,
    /// Key of the connection setting that names the file in use.
    pub setting: &'static str,
    /// Key of the settings group that chooses file and satellite.
    pub group: &'static str,
    /// Values of [`Self::group`] for a file and the name of a satellite in it. Writing them ends
    /// the present track.
    pub choose: fn(&str, &str) -> Values,
    /// Value of [`Self::group`] with the catalog number that the unit found.
    pub number: Key<i64>,
    /// Key of the settings group that tells where the unit's elements come from.
    pub source_group: &'static str,
    /// Returns `true` if the unit fetches its elements by itself, by the values of that group.
    pub are_fetched_by_unit: fn(&Values) -> bool,
    /// Names of the checks that are bad when the unit does not find the satellite.
    pub checks: &'static [&'static str],
}

impl ElementFiles {
    /// The catalog number that the unit found in its file.
    pub fn found(&self, values: &Values) -> Option<i64> {
        self.number.get(values)
    }
}

/// Compares by address: each make has one of these.
impl PartialEq for ElementFiles {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}
