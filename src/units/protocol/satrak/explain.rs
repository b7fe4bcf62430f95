//! Values of a frame, each with its number, name and unit from the document.

mod names;

use super::{Frame, HIDDEN, Verb, Word};
use names::{Named, NamedFields};

/// One value of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Value {
    /// Position in the frame, counted from 1 as in the document.
    pub number: usize,
    pub name: &'static str,
    /// Text in the frame, without surrounding blanks.
    pub raw: String,
    /// Unit of measure; empty if the value is not a number.
    pub unit: &'static str,
    /// Meaning of a code; empty for a number or a text.
    pub stands_for: &'static str,
}

/// Explains a frame that was sent to a unit.
pub fn explain_request(frame: &Frame) -> Vec<Value> {
    match frame.command() {
        // The explanation hides all values: a comma in the password would spread it over several
        // values.
        Some((Word::SatelliteFtp, Verb::Set)) => vec![hidden()],
        Some((word, Verb::Set)) => explain(frame, names::of_setting(word)),
        _ => explain(frame, NamedFields::NONE),
    }
}

/// Explains a frame that came from a unit.
pub fn explain_reply(frame: &Frame) -> Vec<Value> {
    let is_error = frame.fields().first().is_some_and(|field| field == "ERR");
    match frame.command() {
        // The document does not state the form of a failed query, so ERR may follow any sign.
        _ if is_error => explain(frame, names::REFUSAL),
        Some((_, Verb::Set)) => explain(frame, names::ANSWER),
        Some((Word::SatelliteFtp, Verb::Query)) => vec![hidden()],
        Some((word, Verb::Query)) => explain(frame, names::of_reply(word)),
        None => explain(frame, NamedFields::NONE),
    }
}

/// Returns the name of fault `number` in the answer to `ERRSTATUS?`, counted from 1.
pub(super) fn fault_name(number: usize) -> &'static str {
    let named = names::of_reply(Word::ErrStatus).named;
    number
        .checked_sub(1)
        .and_then(|index| named.get(index))
        .map_or(names::UNKNOWN, |named| named.name)
}

/// Returns the placeholder for all values of a frame that contains a password.
fn hidden() -> Value {
    let raw = HIDDEN.to_owned();
    Value { number: 1, name: "values with a password", raw, unit: "", stands_for: "" }
}

fn explain(frame: &Frame, names: NamedFields) -> Vec<Value> {
    let raw = raw_values(frame, names);
    let named = names.named.iter().map(Some).chain(std::iter::repeat(None));
    raw.into_iter()
        .zip(named)
        .enumerate()
        .map(|(index, (raw, named))| {
            let unknown = Named::new(names::UNKNOWN);
            let named = named.unwrap_or(&unknown);
            let code = named.codes.iter().find(|(code, _)| *code == raw);
            Value {
                number: index + 1,
                name: named.name,
                // `NONE` and `?` may replace an angle; a unit after them would be wrong.
                unit: if code.is_some() { "" } else { named.unit },
                stands_for: code.map_or("", |(_, word)| word),
                raw,
            }
        })
        .collect()
}

/// Returns the texts of the values; a value that may contain commas stays in one piece.
fn raw_values(frame: &Frame, names: NamedFields) -> Vec<String> {
    let fields = frame.fields();
    let whole = names.text_at.and_then(|before| {
        let after = names.named.len().checked_sub(before + 1)?;
        let text = frame.joined(before, after)?;
        let (front, back) = (fields.get(..before)?, fields.get(fields.len() - after..)?);
        Some(front.iter().cloned().chain([text]).chain(back.iter().cloned()).collect())
    });
    whole.unwrap_or_else(|| fields.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reply(payload: &str) -> Vec<String> {
        let values = explain_reply(&Frame::from_payload(payload));
        values
            .into_iter()
            .map(|Value { number, name, raw, unit, stands_for }| {
                format!("{number} {name}: {raw}{unit}{stands_for}")
            })
            .collect()
    }

    #[test]
    fn values_have_number_name_and_unit() {
        let status = reply("STATUS?,0,299.49,34.35,1,0,0,0,0,3,0,12,-1,0,80.0,35.0,1,7");
        assert_eq!(status.len(), 17);
        assert_eq!(status[0], "1 fault or warning: 0none");
        assert_eq!(status[1], "2 azimuth: 299.49°");
        assert_eq!(status[3], "4 limit X+: 1set");
        assert_eq!(status[8], "9 tracking state: 3before the start");
        assert_eq!(status[10], "11 GPS lock delay: 12 s");
        assert_eq!(status[11], "12 motion of X: -1toward smaller angles");
        assert_eq!(status[16], "17 not in the document: 7");
    }

    #[test]
    fn the_threshold_is_the_twelfth_in_the_answer_and_the_eleventh_in_the_setting() {
        let answer = reply("SETTINGS?,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,1,2.0");
        assert_eq!(answer[10], "11 source of the elements: 1web");
        assert_eq!(answer[11], "12 elevation threshold: 2.0°");
        let setting = Frame::from_payload("SETTINGS=,?,?,?,?,?,?,5.0,?,?,?,2.0");
        let values = explain_request(&setting);
        assert_eq!((values[10].name, values[10].unit), ("elevation threshold", "°"));
        assert_eq!((values[0].raw.as_str(), values[0].stands_for), ("?", "stays as it is"));
    }

    #[test]
    fn a_text_with_commas_is_one_value() {
        let satellite = reply("SATELLITE?,amateur.txt,AO-7, OSCAR 7,1,7530,78.4");
        assert_eq!(satellite[1], "2 satellite: AO-7, OSCAR 7");
        assert_eq!(satellite[4], "5 maximum elevation: 78.4°");
        assert_eq!(reply("SATELLITE_HTTP?,https://x/a,b,3,1")[0], "1 address: https://x/a,b");
        assert_eq!(reply("LOAD_IMAGE?,a,b"), ["1 state: a,b"]);
    }

    #[test]
    fn answers_to_settings_and_refusals_are_told_apart() {
        assert_eq!(reply("MOVE=,OK"), ["1 answer: OKaccepted"]);
        assert_eq!(reply("STATUS?,ERR,7"), ["1 answer: ERRrefused", "2 code: 7"]);
        assert_eq!(reply("HELLO,1"), ["1 not in the document: 1"]);
        assert_eq!(reply("STATUS?"), [""; 0]);
    }

    #[test]
    fn values_with_a_password_are_not_explained() {
        let values = "h,u,hunter2,22,f,s,1,1";
        let words = ["1 values with a password: (hidden)"];
        assert_eq!(reply(&format!("SATELLITE_FTP?,{values}")), words);
        let setting = Frame::from_payload(&format!("SATELLITE_FTP=,{values}"));
        assert!(!format!("{:?}", explain_request(&setting)).contains("hunter2"));
    }

    #[test]
    fn each_fault_has_its_name() {
        let names: std::collections::BTreeSet<_> = (1..=12).map(fault_name).collect();
        assert_eq!(names.len(), 12);
        assert_eq!(fault_name(13), names::UNKNOWN);
    }
}
