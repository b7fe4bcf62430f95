//! Meaning of lines on the link, and the questions that the operator can ask by hand.

use std::borrow::Cow;

use crate::{
    device::{
        Direction, Explained, ExplainedValue, Finding, Meaning, Question, WireLine, panel::Tone,
    },
    protocol::satrak::{
        self as unit, Decoder, Frame, Query, Request, Word, explain_reply, explain_request,
    },
};

pub(super) fn questions() -> Vec<Question> {
    let question = |(query, word): (Query, Word)| Question {
        key: format!("{word}?").into(),
        subject: Cow::Owned(
            unit::Meaning::of_request(&Frame::from_payload(&format!("{word}?"))).text,
        ),
        bytes: Request::Query(query).to_bytes().into(),
    };
    Query::ALL.into_iter().map(question).collect()
}

pub(super) fn query(key: &str) -> Option<Query> {
    let word = Word::from_name(key.strip_suffix('?')?)?;
    Query::ALL.into_iter().find(|(_, candidate)| *candidate == word).map(|(query, _)| query)
}

/// Returns the reason why Azel does not send a typed word, in capitals.
pub(super) fn why_no_question(text: &str) -> String {
    if text.contains(['$', '*']) {
        return "Type the word alone: header and checksum are added here.".to_owned();
    }
    let end = text.find(['?', '=', ',', ' ']).unwrap_or(text.len());
    let (name, rest) = text.split_at_checked(end).unwrap_or((text, ""));
    let Some(word) = Word::from_name(name) else {
        return "Not a word of the Satrak document.".to_owned();
    };
    let is_question = rest.trim().starts_with('?');
    match Query::ALL.into_iter().any(|(_, candidate)| candidate == word) {
        true if is_question => format!("{name}? takes no values: it only asks."),
        false if is_question => format!("Nobody can ask for {name}."),
        _ => refusal(word).to_owned(),
    }
}

/// Returns the reason why the operator cannot send a word of the protocol by hand.
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

/// Returns the meaning of a good line with these bytes.
pub fn meaning(direction: Direction, bytes: &[u8]) -> Meaning {
    let outcome = frame(bytes).map(|frame| match direction {
        Direction::Sent => unit::Meaning::of_request(&frame),
        Direction::Received => unit::Meaning::of_reply(&frame),
    });
    let Some(unit::Meaning { tone, text }) = outcome else {
        return Meaning { tone: Tone::Caution, text: "Not in the document".into() };
    };
    let tone = match tone {
        unit::Tone::Plain => Tone::Plain,
        unit::Tone::Change => Tone::Change,
        unit::Tone::Good => Tone::Good,
        unit::Tone::Caution => Tone::Caution,
        unit::Tone::Bad => Tone::Bad,
    };
    Meaning { tone, text: text.into() }
}

/// Returns the explanation of a good line, value by value.
pub(super) fn explain(line: &WireLine) -> Explained {
    let frame = (line.finding == Finding::Good).then(|| frame(&line.bytes)).flatten();
    let Some(frame) = frame else { return Explained::default() };
    let values = match line.direction {
        Direction::Sent => explain_request(&frame),
        Direction::Received => explain_reply(&frame),
    };
    let value = |unit::Value { number, name, raw, unit, stands_for }| ExplainedValue {
        number,
        name,
        raw,
        unit,
        stands_for,
    };
    Explained {
        name: frame.command().map(|(word, _)| word.name()),
        values: values.into_iter().map(value).collect(),
    }
}

fn frame(bytes: &[u8]) -> Option<Frame> {
    let mut decoder = Decoder::new();
    decoder.push(bytes);
    decoder.next()?.ok().or_else(|| {
        // A frame has no checksum once its values were removed.
        let text = std::str::from_utf8(bytes).ok()?.trim_end();
        Some(Frame::from_payload(text.rsplit_once('$')?.1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Verb;

    #[test]
    fn every_query_is_a_question() {
        for (question, (expected, word)) in questions().into_iter().zip(Query::ALL) {
            assert_eq!(query(&question.key), Some(expected));
            assert_eq!(question.key, format!("{word}?"));
        }
        assert_eq!(query("STATUS"), None);
        assert_eq!(query("MOVE?"), None);
    }

    #[test]
    fn whatever_else_is_typed_the_reason_is_said() {
        for (text, reason) in [
            ("MOVE=,1,0", "This moves the antenna"),
            ("TRACK=,0", "This moves the antenna"),
            ("GOTO", "This moves the antenna"),
            ("STOP=", "STOP has its own button"),
            ("SETTINGS=,?,?", "This changes the unit"),
            ("RTC_REUPDATE", "This changes the unit"),
            ("SATELLITE_FTP=,A,B,HUNTER2", "This changes the unit"),
            ("ANGLE_SETTINGS=,1", "This is a service function"),
            ("LOAD_IMAGE=,X", "This is a service function"),
            ("REDUCTION=,1,1", "This is a service function"),
            ("STATUS=", "This can only be asked"),
            ("STATUS?,1", "STATUS? takes no values"),
            ("STATUS? =", "STATUS? takes no values"),
            ("MOVE?", "Nobody can ask for MOVE."),
            ("HELLO?", "Not a word of the Satrak document."),
            ("?", "Not a word of the Satrak document."),
            ("$STATUS?*2B", "Type the word alone"),
        ] {
            assert_eq!(query(text), None, "{text}");
            let refusal = why_no_question(text);
            assert!(refusal.starts_with(reason), "{text}: {refusal}");
            assert!(!refusal.contains("HUNTER2"), "{refusal}");
        }
    }

    #[test]
    fn no_setting_of_any_word_is_a_question() {
        for word in Word::ALL {
            for values in ["", ",", ",0", ",1,0"] {
                let text = format!("{word}{}{values}", Verb::Set.sign());
                assert_eq!(query(&text), None, "{text}");
            }
        }
    }

    #[test]
    fn a_frame_without_its_values_is_still_named() {
        let known_meaning = meaning(Direction::Received, b"$SATELLITE_FTP?(hidden)\r\n");
        assert_eq!(known_meaning.text, "FTP source of the elements, values hidden");
    }
}
