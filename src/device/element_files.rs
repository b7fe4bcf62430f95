//! How a unit is given files of elements.

use super::settings::{Key, Values};

/// How every unit of a make takes files of elements over SFTP, and is told which
/// satellite of which file to use.
#[derive(Debug)]
pub struct ElementFiles {
    /// Where it looks for them.
    pub folder: &'static str,
    /// The user that it has from its maker.
    pub factory_user: &'static str,
    /// SHA-256 in hexadecimal digits of the password that it has from its maker, after the
    /// user and a colon. Whoever has its document knows it, so its use is worth a warning.
    pub factory_digest: &'static str,
    /// Why the unit cannot be told a name of a file or of a satellite. The first argument
    /// says which of both it is.
    pub check_name: fn(&'static str, &str) -> Result<(), String>,
    /// Key of the setting of its connection that names the file it uses.
    pub setting: &'static str,
    /// Key of the group of settings that chooses file and satellite.
    pub group: &'static str,
    /// The values of that group for a file and the name of a satellite in it; the present
    /// track ends.
    pub choose: fn(&str, &str) -> Values,
    /// The value of that group that holds the catalog number of what it found.
    pub number: Key<i64>,
    /// Names of the checks that are bad where it does not find the satellite.
    pub checks: &'static [&'static str],
}

impl ElementFiles {
    /// The catalog number of what it found in its file.
    pub fn found(&self, values: &Values) -> Option<i64> {
        self.number.of(values)
    }
}

/// There is one of each make.
impl PartialEq for ElementFiles {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}
