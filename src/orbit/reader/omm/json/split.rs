//! Cuts a JSON list into its entries, so that a bad one costs no other.

/// One entry, which need not be sound JSON.
#[derive(Debug, PartialEq)]
pub(super) struct Part<'a> {
    /// The line of the text where it starts, from 1.
    pub(super) line: usize,
    /// From its first to its last character. Starts with `{` when it is an object.
    pub(super) text: &'a str,
}

/// The objects of `text`, and what else stands between the commas.
pub(super) fn parts(text: &str) -> impl Iterator<Item = Part<'_>> {
    let between = |letter: char| letter.is_whitespace() || matches!(letter, ',' | '[' | ']');
    let (mut rest, mut line) = (text, 1);
    std::iter::from_fn(move || {
        let start = rest.find(|letter| !between(letter))?;
        let (skipped, entry) = rest.split_at(start);
        line += newlines(skipped);
        let end = if entry.starts_with('{') {
            object_end(entry)
        } else {
            entry.find(|letter| between(letter) || letter == '{').unwrap_or(entry.len())
        };
        let (entry, after) = entry.split_at(end);
        let part = Part { line, text: entry };
        line += newlines(entry);
        rest = after;
        Some(part)
    })
}

fn newlines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// The length of the object that `text` starts with; all of `text` when the
/// object does not end.
fn object_end(text: &str) -> usize {
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    for (index, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b'{' if !in_string => depth += 1,
            b'}' if !in_string => {
                depth -= 1;
                if depth == 0 {
                    return index + 1;
                }
            }
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_cut_at_their_braces() {
        let text = "[{\"a\":\"}\\\"{\"},\n 5 {\"b\":{\"c\":1}}\n{\"d\":\n";
        let found: Vec<_> = parts(text).map(|part| (part.line, part.text)).collect();
        let expected =
            [(1, "{\"a\":\"}\\\"{\"}"), (2, "5"), (2, "{\"b\":{\"c\":1}}"), (3, "{\"d\":\n")];
        assert_eq!(found, expected);
    }
}
