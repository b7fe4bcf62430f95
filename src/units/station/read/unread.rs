//! Selection of the unreadable settings on which safety depends.

use serde::{Deserialize, Serialize};

use super::{Note, NoteReason};
use crate::station::AntennaId;

/// Settings of the whole station on which the safety of each antenna depends.
const STATION_KEYS: [&str; 3] = ["keep_out", "sun_avoidance", "site"];
/// Settings of an antenna on which its safety depends. Half the beam width is a part of the margin
/// of each keep-out, and the pointing model determines the direction of the beam.
const ANTENNA_KEYS: [&str; 4] = ["limits", "mount", "beam_width_deg", "pointing_model"];

/// Fields of these settings that do not affect safety: texts, and an unknown antenna of a keep-out,
/// which then applies to all.
const HARMLESS: [&str; 3] = [".name", ".reason", ".antenna"];

/// An unreadable setting on which safety depends.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unread {
    /// Place in the file, such as `keep_out[0].corners`.
    pub place: String,
    /// The affected antenna; `None` for all.
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
        let is_unknown = note.reason == NoteReason::Unknown;
        let is_meant = |place: &str, keys: &[&str]| {
            keys.iter().any(|key| is_part_of(place, key) || is_unknown && is_mistyped(place, key))
        };
        if is_meant(&note.place, &STATION_KEYS) {
            return Some(Unread { place: place(), antenna: None });
        }
        let (relative_place, id) = antennas
            .iter()
            .find_map(|(path, id)| Some((note.place.strip_prefix(path.as_str())?, *id)))?;
        is_meant(relative_place, &ANTENNA_KEYS)
            .then(|| Unread { place: place(), antenna: Some(id) })
    };
    notes.iter().filter_map(unread).collect()
}

/// Returns `true` if `place` is the setting `key` or a part of it.
fn is_part_of(place: &str, key: &str) -> bool {
    let rest = place.strip_prefix(key);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Returns `true` if `written` differs from `key` only by one or two missing, additional, changed
/// or swapped letters, or by case and separators.
fn is_mistyped(written: &str, key: &str) -> bool {
    let letters = |text: &str| -> Vec<char> {
        text.chars()
            .filter(|letter| letter.is_alphanumeric())
            .flat_map(char::to_lowercase)
            .collect()
    };
    let (written, key) = (letters(written), letters(key));
    // With two changes, one short word would match almost any other.
    let max = if key.len() > 6 { 2 } else { 1 };
    differs_within(&written, &key, max)
}

/// Returns `true` if at most `max` changes of a letter turn `written` into `key`.
fn differs_within(written: &[char], key: &[char], max: usize) -> bool {
    match (written, key) {
        ([a, written @ ..], [b, key @ ..]) if a == b => differs_within(written, key, max),
        ([], []) => true,
        _ if max == 0 => false,
        _ => {
            let max = max - 1;
            let (short_written, short_key) = (written.get(1..), key.get(1..));
            let is_swapped = || match (written, key) {
                ([a, b, written @ ..], [c, d, key @ ..]) => {
                    (a, b) == (d, c) && differs_within(written, key, max)
                }
                _ => false,
            };
            short_written.is_some_and(|written| differs_within(written, key, max))
                || short_key.is_some_and(|key| differs_within(written, key, max))
                || short_written
                    .zip(short_key)
                    .is_some_and(|(written, key)| differs_within(written, key, max))
                || is_swapped()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unread_pointing_model_concerns_its_antenna() {
        let id = AntennaId::FIRST;
        let antennas = [("antenna[0].".to_owned(), id)];
        let invalid = NoteReason::Invalid("must be a number".to_owned());
        for (place, reason) in [
            ("antenna[0].pointing_model", invalid.clone()),
            ("antenna[0].pointing_model.sag_deg", invalid),
            ("antenna[0].pointing_model.tilt_deg", NoteReason::Unknown),
            ("antenna[0].pointing_modell", NoteReason::Unknown),
        ] {
            let note = Note { place: place.to_owned(), line: None, reason };
            let unread = Unread { place: place.to_owned(), antenna: Some(id) };
            assert_eq!(safety_entries(&[note], &antennas), [unread]);
        }
    }

    #[test]
    fn a_name_with_a_typing_error_is_known_and_other_names_are_not() {
        for (written, key) in [
            ("keep_outs", "keep_out"),
            ("keepout", "keep_out"),
            ("kepe_out", "keep_out"),
            ("KeepOut", "keep_out"),
            ("sun_avoidence", "sun_avoidance"),
            ("sites", "site"),
            ("limit", "limits"),
            ("mont", "mount"),
        ] {
            assert!(is_mistyped(written, key), "{written}");
        }
        let others = ["name", "rule", "offsets", "notes", "size_of_dish", "list", "group", "time"];
        for other in others {
            for key in STATION_KEYS.into_iter().chain(ANTENNA_KEYS) {
                assert!(!is_mistyped(other, key), "{other} {key}");
            }
        }
    }
}
