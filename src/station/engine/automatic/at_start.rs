//! State that the previous run left in a file beside the station file. It decides whether automatic
//! operation may be on from the start.

use std::{collections::BTreeMap, fs, io, path::Path};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    contract::{
        passes::PassListKey,
        transfer::{FileHash, FileObject},
    },
    engine::uploads::UploadTarget,
    station::AntennaId,
};

/// Extension that replaces the one of the station file.
pub(super) const EXTENSION: &str = "automatic.toml";

/// End of the last run, and the antennas whose automatic operation was switched off.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::engine) struct LastRun {
    /// `true` if the run ended in order: it did not crash, and no antenna was left moving.
    pub(in crate::engine) is_orderly: bool,
    /// Antennas whose automatic operation was ended and not switched on again.
    pub(in crate::engine) switched_off: Vec<AntennaId>,
    /// Antennas whose automatic operation is on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    switched_on: Vec<AntennaId>,
    /// Fingerprint of the station.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) station: Option<FileHash>,
    /// Last proved pass of each antenna: the unit may still be tracking it.
    #[serde(rename = "held")]
    helds: Vec<HeldPass>,
    /// Last verified upload to each antenna's unit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unit_elements: Vec<UnitElements>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct HeldPass {
    antenna: AntennaId,
    satellite: u32,
    aos: Timestamp,
}

/// Last verified upload to a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::engine) struct UnitElements {
    antenna: AntennaId,
    /// Address of the unit. The entry does not apply to a unit at another address.
    address: String,
    pub(in crate::engine) target: UploadTarget,
    /// Catalog numbers with the epochs of their elements.
    pub(in crate::engine) epochs: Vec<(u32, Timestamp)>,
}

impl LastRun {
    /// Reads the file at `path`. Without a readable file, the end of the last run counts as
    /// unknown.
    pub(super) fn load(path: &Path) -> Self {
        let read = fs::read_to_string(path).map(|text| toml::from_str(&text));
        match read {
            Ok(Ok(last)) => last,
            Ok(Err(error)) => {
                tracing::warn!(%error, "the end of the last run cannot be read");
                Self::default()
            }
            Err(error) => {
                if error.kind() != io::ErrorKind::NotFound {
                    tracing::warn!(%error, "the end of the last run cannot be read");
                }
                Self::default()
            }
        }
    }

    /// Returns the content of the file.
    pub(super) fn text(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// Returns the state to write at the start of this run. It remains on disk if the run crashes.
    pub(super) fn next_run(self) -> Self {
        let mut next = Self { is_orderly: false, ..self };
        next.forget_switched_on();
        next
    }

    /// Returns the last proved pass of this antenna's unit.
    pub(super) fn held_by(&self, antenna: AntennaId) -> Option<PassListKey> {
        let held_pass = self.helds.iter().find(|held_pass| held_pass.antenna == antenna)?;
        Some((held_pass.satellite, held_pass.aos))
    }

    pub(super) fn holds(&mut self, antenna: AntennaId, (satellite, aos): PassListKey) {
        self.helds.retain(|held_pass| held_pass.antenna != antenna);
        self.helds.push(HeldPass { antenna, satellite, aos });
    }

    /// Returns the last verified upload to the unit of this antenna at this address.
    pub(super) fn unit_elements(&self, antenna: AntennaId, address: &str) -> Option<&UnitElements> {
        let is_it = |entry: &&UnitElements| entry.antenna == antenna && entry.address == address;
        self.unit_elements.iter().find(is_it)
    }

    /// Records a verified upload. After a roll-back, the newer of both epochs counts for each
    /// satellite: the rule waits for elements newer than the ones that the operator took back.
    pub(super) fn note_upload(
        &mut self,
        (antenna, address): (AntennaId, &str),
        target: UploadTarget,
        objects: &[FileObject],
        is_roll_back: bool,
    ) {
        let mut epochs: BTreeMap<u32, Timestamp> =
            objects.iter().map(|object| (object.catalog_number, object.epoch)).collect();
        if is_roll_back && let Some(unit_elements) = self.unit_elements(antenna, address) {
            for (number, epoch) in &unit_elements.epochs {
                let newest = epochs.entry(*number).or_insert(*epoch);
                *newest = (*newest).max(*epoch);
            }
        }
        self.unit_elements.retain(|unit_elements| unit_elements.antenna != antenna);
        self.unit_elements.push(UnitElements {
            antenna,
            address: address.to_owned(),
            target,
            epochs: epochs.into_iter().collect(),
        });
    }

    /// Records that automatic operation of this antenna is on or off.
    pub(super) fn note_switch(&mut self, antenna: AntennaId, is_on: bool) {
        for list in [&mut self.switched_on, &mut self.switched_off] {
            list.retain(|antenna_id| *antenna_id != antenna);
        }
        if is_on { &mut self.switched_on } else { &mut self.switched_off }.push(antenna);
    }

    pub(super) fn is_switched_on(&self, antenna: AntennaId) -> bool {
        self.switched_on.contains(&antenna)
    }

    /// Removes the state that lets the next start resume.
    pub(super) fn forget_switched_on(&mut self) {
        (self.switched_on, self.station) = (Vec::new(), None);
    }

    /// Returns `true` if the run crashed while automatic operation of this antenna was on.
    pub(super) fn was_on_at_crash(&self, antenna: AntennaId) -> bool {
        !self.is_orderly && self.switched_on.contains(&antenna)
    }

    pub(super) fn allows(&self, antenna: AntennaId) -> bool {
        self.is_orderly && !self.switched_off.contains(&antenna)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_orderly_end_allows_it_and_not_where_it_was_switched_off() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.automatic.toml");
        assert!(!LastRun::load(&path).allows(AntennaId(1)), "nothing is known of a first start");
        let mut last =
            LastRun { is_orderly: true, switched_off: vec![AntennaId(2)], ..LastRun::default() };
        last.holds(AntennaId(1), (7, Timestamp::UNIX_EPOCH));
        fs::write(&path, last.text().unwrap()).unwrap();
        let read = LastRun::load(&path);
        assert_eq!(read, last);
        assert!(read.allows(AntennaId(1)) && !read.allows(AntennaId(2)));
        fs::write(&path, "is_orderly = 7").unwrap();
        assert!(!LastRun::load(&path).allows(AntennaId(1)));
    }

    /// The text has the form that version f93e9bd5 wrote.
    #[test]
    fn a_file_of_an_earlier_version_means_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.automatic.toml");
        let text = "is_orderly = true\nswitched_off = [2]\n\n[[held]]\nantenna = 1\n\
                    satellite = 25544\naos = \"2026-08-12T01:02:03Z\"\n";
        fs::write(&path, text).unwrap();
        let last = LastRun::load(&path);
        assert!(last.allows(AntennaId(1)) && !last.allows(AntennaId(2)));
        let aos = "2026-08-12T01:02:03Z".parse().unwrap();
        assert_eq!(last.held_by(AntennaId(1)), Some((25_544, aos)));
        assert_eq!(last.text().unwrap(), text, "it is written the same");
    }
}
