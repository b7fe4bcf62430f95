//! Finds the settings on which safety depends among those that could not be read.

use serde::{Deserialize, Serialize};

use super::{Note, NoteReason};
use crate::station::AntennaId;

/// Settings of the whole station on which the safety of each antenna depends.
const STATION_KEYS: [&str; 3] = ["keep_out", "sun_avoidance", "site"];
/// Settings of an antenna on which its safety depends.
const ANTENNA_KEYS: [&str; 2] = ["limits", "mount"];

/// Fields of these settings that do not affect safety: texts, and an unknown antenna of a keep-out,
/// which then holds for all.
const HARMLESS: [&str; 3] = [".name", ".reason", ".antenna"];

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

pub(super) fn safety_entries(notes: &[Note], antennas: &[(String, AntennaId)]) -> Vec<Unread> {
    let unread = |note: &Note| {
        let place = || note.place.clone();
        if HARMLESS.iter().any(|field| note.place.ends_with(field)) {
            return None;
        }
        let is_unknown_of_site =
            note.reason == NoteReason::Unknown && is_part_of(&note.place, "site");
        if is_unknown_of_site {
            return None;
        }
        if STATION_KEYS.iter().any(|key| is_part_of(&note.place, key)) {
            return Some(Unread { place: place(), antenna: None });
        }
        let (relative_place, id) = antennas
            .iter()
            .find_map(|(path, id)| Some((note.place.strip_prefix(path.as_str())?, *id)))?;
        let counts = ANTENNA_KEYS.iter().any(|key| is_part_of(relative_place, key));
        counts.then(|| Unread { place: place(), antenna: Some(id) })
    };
    notes.iter().filter_map(unread).collect()
}

/// Returns `true` if `place` is the setting `key` or a part of it.
fn is_part_of(place: &str, key: &str) -> bool {
    let rest = place.strip_prefix(key);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}
