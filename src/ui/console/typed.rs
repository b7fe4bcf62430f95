//! What the operator typed to be sent: only questions go out from here.

use crate::protocol::satrak::{Query, Word};

/// Why nothing is sent, as a sentence.
pub(super) type Reason = String;

/// The query in `text`, as `STATUS?` or `STATUS`, in any case. `None` when
/// nothing is typed.
pub(super) fn read(text: &str) -> Option<Result<Query, Reason>> {
    let text = text.trim().to_uppercase();
    if text.is_empty() {
        return None;
    }
    Some(read_word(&text))
}

fn read_word(text: &str) -> Result<Query, Reason> {
    if text.contains(['$', '*']) {
        return Err("Type the word alone: header and checksum are added here.".to_owned());
    }
    let end = text.find(['?', '=', ',', ' ']).unwrap_or(text.len());
    let (name, rest) = text.split_at_checked(end).unwrap_or((text, ""));
    let rest = rest.trim();
    let word = Word::from_name(name).ok_or("Not a word of the Satrak document.")?;
    let query = Query::ALL.into_iter().find(|(_, known)| *known == word).map(|(query, _)| query);
    match (query, rest) {
        (Some(query), "" | "?") => Ok(query),
        (Some(_), rest) if rest.starts_with('?') => {
            Err(format!("{name}? takes no values: it only asks."))
        }
        (None, rest) if rest.starts_with('?') => Err(format!("Nobody can ask for {name}.")),
        _ => Err(refusal(word).to_owned()),
    }
}

/// Why a word that is not asked is not sent from here.
const fn refusal(word: Word) -> &'static str {
    match word {
        Word::Stop => "STOP has its own button and key, which wait for nothing.",
        Word::Move | Word::Step | Word::Goto | Word::Track | Word::TrackAutoEnable => {
            "This moves the antenna: it goes through the checks of the antenna card."
        }
        Word::AngleSettings | Word::LoadImage | Word::Reduction => {
            "This is a service function: it is never sent from here."
        }
        Word::Time
        | Word::StartStopTime
        | Word::Settings
        | Word::RtcReupdate
        | Word::GpsSettings
        | Word::Satellite
        | Word::SatelliteHttp
        | Word::SatelliteFtp => "This changes the unit: settings belong to the Antennas view.",
        Word::Version | Word::Status | Word::ErrStatus | Word::GpsData | Word::Tpos => {
            "This can only be asked, not set."
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Verb;

    #[test]
    fn every_query_is_taken_in_any_case_and_with_or_without_its_sign() {
        for (query, word) in Query::ALL {
            for text in [format!("{word}?"), format!(" {word} "), word.name().to_lowercase()] {
                assert_eq!(read(&text), Some(Ok(query)), "{text}");
            }
        }
        assert_eq!(read("  "), None);
    }

    #[test]
    fn nothing_else_is_taken_and_the_reason_is_said() {
        for (text, reason) in [
            ("MOVE=,1,0", "This moves the antenna"),
            ("track=,0", "This moves the antenna"),
            ("GOTO", "This moves the antenna"),
            ("STOP=", "STOP has its own button"),
            ("SETTINGS=,?,?", "This changes the unit"),
            ("RTC_REUPDATE", "This changes the unit"),
            ("SATELLITE_FTP=,a,b,hunter2", "This changes the unit"),
            ("ANGLE_SETTINGS=,1", "This is a service function"),
            ("LOAD_IMAGE=,x", "This is a service function"),
            ("REDUCTION=,1,1", "This is a service function"),
            ("STATUS=", "This can only be asked"),
            ("STATUS?,1", "STATUS? takes no values"),
            ("STATUS? =", "STATUS? takes no values"),
            ("MOVE?", "Nobody can ask for MOVE."),
            ("HELLO?", "Not a word of the Satrak document."),
            ("?", "Not a word of the Satrak document."),
            ("$STATUS?*2B", "Type the word alone"),
        ] {
            let Some(Err(said)) = read(text) else { panic!("{text} was taken") };
            assert!(said.starts_with(reason), "{text}: {said}");
            assert!(!said.contains("HUNTER2"), "{said}");
        }
    }

    #[test]
    fn no_setting_of_any_word_is_taken() {
        for word in Word::ALL {
            for values in ["", ",", ",0", ",1,0"] {
                let text = format!("{word}{}{values}", Verb::Set.sign());
                assert!(matches!(read(&text), Some(Err(_))), "{text}");
            }
        }
    }
}
