//! Finds the settings on which safety depends among those that could not be read.

use serde::{Deserialize, Serialize};

use super::Note;
use crate::station::AntennaId;

/// Settings of the whole station on which the safety of each antenna depends.
const OF_STATION: [&str; 3] = ["keep_out", "sun_avoidance", "site"];
/// Settings of an antenna on which its safety depends.
const OF_ANTENNA: [&str; 2] = ["limits", "mount"];

/// Parts of them that are only words.
const WORDS: [&str; 2] = [".name", ".reason"];

/// A setting on which safety depends, and which could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unread {
    /// Place in the file, such as `keep_out[0].corners`.
    pub place: String,
    /// The antenna that it concerns; `None` for all.
    pub antenna: Option<AntennaId>,
}

impl Unread {
    /// Returns `true` if the safety of this antenna depends on the setting.
    pub fn concerns(&self, antenna: AntennaId) -> bool {
        self.antenna.is_none_or(|id| id == antenna)
    }
}

pub(super) fn found(notes: &[Note], antennas: &[(String, AntennaId)]) -> Vec<Unread> {
    let unread = |note: &Note| {
        let place = || note.place.clone();
        // Words decide nothing.
        if WORDS.iter().any(|word| note.place.ends_with(word)) {
            return None;
        }
        if OF_STATION.iter().any(|key| is_part_of(&note.place, key)) {
            return Some(Unread { place: place(), antenna: None });
        }
        let (of_antenna, id) = antennas
            .iter()
            .find_map(|(path, id)| Some((note.place.strip_prefix(path.as_str())?, *id)))?;
        let counts = OF_ANTENNA.iter().any(|key| is_part_of(of_antenna, key));
        counts.then(|| Unread { place: place(), antenna: Some(id) })
    };
    notes.iter().filter_map(unread).collect()
}

/// Returns `true` if `place` is the setting `key` or a part of it.
fn is_part_of(place: &str, key: &str) -> bool {
    let rest = place.strip_prefix(key);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}
