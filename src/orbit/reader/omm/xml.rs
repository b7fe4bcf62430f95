//! OMM in XML: one message, or an NDM with many messages.

use std::borrow::Cow;

use quick_xml::{Reader, escape::resolve_predefined_entity, events::Event};

use super::{Field, MessageFields, Value};
use crate::reader::{ReadReport, RefusalReason};

/// Max number of bytes examined to find the name of a tag and its prefix.
const MAX_NAME: usize = 40;

/// Returns `true` if `line` opens a message or an NDM, with or without a prefix.
pub(in crate::reader) fn is_first(line: &str) -> bool {
    line.starts_with('<') && [*b"omm", *b"ndm"].iter().any(|tag| is_start(line, 0, *tag))
}

/// Reads all messages of `text`.
///
/// Each message is cut out first and read separately, so that a bad message does not affect the
/// others.
pub(in crate::reader) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    for (line, text) in messages(text) {
        let mut message = MessageFields::default();
        match fill(&mut message, text) {
            Some(()) => message.finish(line, &mut report),
            None => report.refuse(line, message.object().as_deref(), RefusalReason::Xml),
        }
    }
    report
}

/// Returns the messages of `text`, each from its start tag to the next start tag, with the line on
/// which it starts.
fn messages(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut tags = text
        .match_indices('<')
        .map(|(index, _)| index)
        .filter(|position| is_start(text, *position, *b"omm"));
    let mut next = tags.next();
    let (mut line, mut counted) = (1, 0);
    std::iter::from_fn(move || {
        let start = next?;
        next = tags.next();
        line += text.get(counted..start)?.bytes().filter(|byte| *byte == b'\n').count();
        counted = start;
        Some((line, text.get(start..next.unwrap_or(text.len()))?))
    })
}

/// Returns `true` if the tag at `index` is a start tag called `called`, with or without a prefix.
fn is_start(text: &str, index: usize, called: [u8; 3]) -> bool {
    // A tag that never ends must not be searched again for every `<` in it.
    let bytes = text.as_bytes().get(index + 1..).unwrap_or_default();
    let bytes = bytes.get(..MAX_NAME).unwrap_or(bytes);
    let end = bytes
        .iter()
        .position(|byte| matches!(byte, b'>' | b'/' | b'<' | b' ' | b'\t' | b'\r' | b'\n'));
    let Some((name, [b'>' | b' ' | b'\t' | b'\r' | b'\n', ..])) =
        end.and_then(|end| bytes.split_at_checked(end))
    else {
        return false;
    };
    name.rsplit(|byte| *byte == b':').next().is_some_and(|name| name.eq_ignore_ascii_case(&called))
}

/// Reads the fields of one message; `None` if the message is not valid XML to its end.
fn fill<'a>(message: &mut MessageFields<'a>, text: &'a str) -> Option<()> {
    let mut reader = Reader::from_str(text);
    reader.config_mut().allow_dangling_amp = true;
    let mut field = None;
    let mut value = Cow::Borrowed("");
    loop {
        match reader.read_event().ok()? {
            Event::Start(tag) => {
                field = str::from_utf8(tag.local_name().into_inner()).ok().and_then(Field::named);
                value = Cow::Borrowed("");
            }
            // Most fields are one piece of text, which needs no copy.
            Event::Text(text) if value.is_empty() => value = text.decode().ok()?,
            Event::Text(text) => value.to_mut().push_str(&text.decode().ok()?),
            Event::CData(text) => value.to_mut().push_str(&text.decode().ok()?),
            Event::GeneralRef(entity) => match entity.resolve_char_ref().ok()? {
                Some(letter) => value.to_mut().push(letter),
                None => value.to_mut().push_str(resolve_predefined_entity(&entity.decode().ok()?)?),
            },
            Event::End(tag) => {
                if let Some(field) = field.take() {
                    message.set(field, Value::Text(std::mem::take(&mut value)));
                }
                if tag.local_name().into_inner().eq_ignore_ascii_case(b"omm") {
                    return Some(());
                }
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elements, reader::Refusal};

    /// Returns a message with the name and number of the object, and `more` in its data.
    fn message(name: &str, number: u32, more: &str) -> String {
        format!(
            "<omm id=\"CCSDS_OMM_VERS\" version=\"2.0\">\n<header><CREATION_DATE/>\
             <ORIGINATOR>18 SPCS</ORIGINATOR></header><body><segment><metadata>\n\
             <OBJECT_NAME>{name}</OBJECT_NAME><OBJECT_ID>1998-067A</OBJECT_ID>\
             <CENTER_NAME>EARTH</CENTER_NAME><REF_FRAME>TEME</REF_FRAME>\
             <TIME_SYSTEM>UTC</TIME_SYSTEM><MEAN_ELEMENT_THEORY>SGP4</MEAN_ELEMENT_THEORY>\n\
             </metadata><data><meanElements><EPOCH>2026-08-11T01:21:00.123456</EPOCH>\
             <MEAN_MOTION units=\"rev/day\">15.49560532</MEAN_MOTION>\
             <ECCENTRICITY>.0001771</ECCENTRICITY><INCLINATION>51.6435</INCLINATION>\
             <RA_OF_ASC_NODE>225.4004</RA_OF_ASC_NODE>\
             <ARG_OF_PERICENTER>44.9625</ARG_OF_PERICENTER>\
             <MEAN_ANOMALY> 5.1087 </MEAN_ANOMALY></meanElements>\n\
             <tleParameters><NORAD_CAT_ID>{number}</NORAD_CAT_ID>\
             <BSTAR>.49645E-3</BSTAR><MEAN_MOTION_DDOT/>{more}</tleParameters></data>\
             </segment></body></omm>\n"
        )
    }

    fn numbers(report: &ReadReport) -> Vec<u32> {
        report.elements.iter().map(Elements::catalog_number).collect()
    }

    #[test]
    fn one_message_and_an_ndm_of_many_are_read() {
        let one = message("R&#38;D &amp; &lt;1&gt;", 100_123, "");
        let report = read(&one);
        assert_eq!(report.refused, []);
        assert_eq!(report.elements[0].name(), "R&D & <1>");
        let prefixed =
            message("B", 7, "").replace("<omm", "<ndm:omm").replace("</omm", "</ndm:omm");
        let text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<ndm xmlns:ndm=\"urn:x\">\
             <!-- remark -->{one}{prefixed}</ndm>\n"
        );
        let report = read(&text);
        assert_eq!((numbers(&report), report.refused), (vec![100_123, 7], vec![]));
    }

    #[test]
    fn a_bad_message_costs_no_other() {
        let bad = [
            message("CROSSED", 1, "<a></b>"),
            message("OPEN", 2, "<USER_DEFINED parameter=\"x>"),
            message("TORN", 3, "").split_once("<MEAN_ANOMALY>").unwrap().0.to_owned(),
            message("ENTITY", 4, "&no-such;"),
        ];
        let good = message("GOOD", 9, "");
        let text = format!("<ndm>\n{}\n{good}", bad.join(&format!("\n{good}")));
        let report = read(&text);
        assert_eq!(numbers(&report), [9; 4]);
        let named: Vec<_> =
            report.refused.iter().map(|refused| refused.object.as_deref().unwrap()).collect();
        assert_eq!(named, ["CROSSED", "OPEN", "TORN", "ENTITY"]);
        let expected =
            Refusal { line: 2, object: Some("CROSSED".to_owned()), reason: RefusalReason::Xml };
        assert_eq!(report.refused[0], expected);
        let lines = good.lines().count();
        assert_eq!(report.refused[1].line, 2 + 2 * lines + 1);
    }
}
