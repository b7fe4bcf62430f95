//! Division of a JSON list into its entries, so that a bad entry does not affect the others.

use std::collections::BTreeMap;

use serde::de::IgnoredAny;
use serde_json::Deserializer;

use crate::reader::omm::Field;

/// One entry, which may not be valid JSON.
#[derive(Debug, PartialEq)]
pub(super) struct Part<'a> {
    /// Line of the text on which the entry starts, from 1.
    pub(super) line: usize,
    /// Text from the first to the last character of the entry. It starts with `{` if the entry is
    /// an object.
    pub(super) text: &'a str,
}

/// Returns the objects of `text`, and any other text between them. Each byte is examined a fixed
/// number of times.
pub(super) fn parts(text: &str) -> impl Iterator<Item = Part<'_>> {
    let is_separator =
        |letter: char| letter.is_whitespace() || matches!(letter, ',' | '[' | ']' | '}');
    let (mut rest, mut line) = (text, 1);
    std::iter::from_fn(move || {
        let start = rest.find(|letter| !is_separator(letter))?;
        let (skipped, entry) = rest.split_at(start);
        line += newlines(skipped);
        let is_object = entry.starts_with('{');
        let end =
            if is_object { object_end(entry) } else { entry.find('{').unwrap_or(entry.len()) };
        let (entry, after) = entry.split_at(end);
        let text = if is_object { entry } else { entry.trim_end_matches(is_separator) };
        let part = Part { line, text };
        line += newlines(entry);
        rest = after;
        Some(part)
    })
}

fn newlines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// Returns the length of the object that `text` starts with.
///
/// An object without its end must not swallow the objects after it. The object therefore also ends
/// at the start of another object. Such a start is a brace that is not the value of a key, or a
/// brace in an apparent string if a key follows. A string ends with its line, because JSON has no
/// line breaks in strings.
fn object_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    let mut before = b':';
    for (index, byte) in bytes.iter().enumerate() {
        match byte {
            b'\n' => (in_string, escaped) = (false, false),
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b'{' if in_string => {
                if let Some([b'"', letter]) = bytes.get(index + 1..index + 3)
                    && letter.is_ascii_alphabetic()
                {
                    return index;
                }
            }
            b'{' if before == b':' => depth += 1,
            b'{' => return sound_end(text).unwrap_or(index),
            b'}' if !in_string => {
                depth -= 1;
                if depth == 0 {
                    return index + 1;
                }
            }
            _ => {}
        }
        if !byte.is_ascii_whitespace() {
            before = *byte;
        }
    }
    text.len()
}

/// Returns the length of the message that `text` starts with, if the message is valid JSON. Such a
/// message may also contain a list of objects. Returns `None` for an object around a list of
/// messages.
#[allow(clippy::zero_sized_map_values, reason = "only the keys are looked at")]
fn sound_end(text: &str) -> Option<usize> {
    let mut objects = Deserializer::from_str(text).into_iter::<BTreeMap<String, IgnoredAny>>();
    let fields = objects.next()?.ok()?;
    let is_message = fields.keys().any(|key| Field::named(key).is_some());
    is_message.then_some(objects.byte_offset())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str) -> Vec<(usize, &str)> {
        parts(text).map(|part| (part.line, part.text)).collect()
    }

    #[test]
    fn entries_are_cut_at_their_braces() {
        let text = "[{\"a\":\"}\\\"{\"},\n 5, 7 {\"b\": {\"c\":1}}\n{\"d\":\n";
        let expected =
            [(1, "{\"a\":\"}\\\"{\"}"), (2, "5, 7"), (2, "{\"b\": {\"c\":1}}"), (3, "{\"d\":\n")];
        assert_eq!(cut(text), expected);
    }

    #[test]
    fn an_entry_without_an_end_swallows_no_other() {
        for (bad, next) in [
            ("{\"a\":1,", " {\"b\":2}"),
            ("{\"a\":\"open}", "\n,{\"b\":2}"),
            ("{\"a\":\"open,\"c\":\"d\"}", ",{\"b\":2}"),
            ("{\"a\":\"open\\", "\n{\"b\":2}"),
            ("{\"data\":", "[{\"b\":2}"),
        ] {
            let text = format!("[{bad}{next}]}}");
            let found = cut(&text);
            assert_eq!(found.last().map(|(_, text)| *text), Some("{\"b\":2}"), "{bad}");
            assert_eq!(found.len(), 2, "{found:?}");
        }
    }
}
