//! Rules of names. No variable, parameter, field, constant, function or type has a preposition, a
//! pronoun or a bare participle as its name, and limits are `min` and `max`.
//!
//! The test reads tokens, because a use of a name has the same form as its declaration. A forbidden
//! word that stands alone is a name. After `.` or `'`, or beside `::`, the word is a member, a
//! label or part of a path, which the test judges at its definition.

use std::{
    collections::HashMap,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

/// Folder whose names the test checks.
const FOLDER: &str = "src";

/// Words that must not be a name, in upper or lower case.
const NO_NAMES: &str = "
    about against amid among anew around aside at away
    behind beneath beside besides between beyond both but by during each either ever except
    from he her him his how inside into it its itself like meanwhile neither of off
    onto over since so such than that the their them themselves then there these they this
    those though through throughout till to together toward towards under until upon
    what whatever whence whether which who whoever whom whose why with within without
    you your
    asked given gone got held kept known meant said seen sought taken told wanted
";

/// Words that must not be part of a name: `min`, `max` and `default` are the standard ones.
const NO_WORDS: [&str; 4] = ["least", "most", "fewest", "usual"];

/// Accepted terms that contain such a word.
const TERMS: [&str; 1] = ["least_squares"];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Token<'a> {
    Word(&'a str),
    Mark(char),
}

/// Returns the tokens of a Rust file with their lines, without comments and literals.
fn tokens(text: &str) -> Vec<(Token<'_>, usize)> {
    let bytes = text.as_bytes();
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_' || *byte >= 0x80;
    let word_end = |start: usize| {
        bytes[start..].iter().position(|byte| !is_word(byte)).map_or(bytes.len(), |len| start + len)
    };
    let (mut tokens, mut index, mut line, mut counted) = (Vec::new(), 0, 1, 0);
    while index < bytes.len() {
        let first = bytes[index];
        if first == b' ' {
            index += 1;
            continue;
        }
        line += text[counted..index].matches('\n').count();
        counted = index;
        let rest = &text[index..];
        let length = match first {
            b'/' if rest.starts_with("//") => Some(rest.find('\n').unwrap_or(rest.len())),
            b'/' if rest.starts_with("/*") => Some(block_comment(rest)),
            b'"' | b'\'' | b'b' | b'c' | b'r' => literal(rest),
            _ => None,
        };
        index = if let Some(length) = length {
            index + length
        } else if first == b'\'' {
            // Skip the word of a lifetime or a label.
            word_end(index + 1)
        } else if is_word(&first) {
            let end = word_end(index);
            // `r#type` is the name `type`.
            if &text[index..end] != "r" || bytes.get(end) != Some(&b'#') {
                tokens.push((Token::Word(&text[index..end]), line));
            }
            end
        } else {
            if !first.is_ascii_whitespace() {
                tokens.push((Token::Mark(char::from(first)), line));
            }
            index + 1
        };
    }
    tokens
}

/// Returns the length of the block comment at the start of `text`, with the comments inside it.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut index) = (0_usize, 0);
    while index < text.len() {
        let pair = text.as_bytes().get(index..index + 2).unwrap_or_default();
        match pair {
            b"/*" => depth += 1,
            b"*/" if depth == 1 => return index + 2,
            b"*/" => depth -= 1,
            _ => {
                index += 1;
                continue;
            }
        }
        index += 2;
    }
    text.len()
}

/// Returns the length of the string or character at the start of `text`, with its prefix.
fn literal(text: &str) -> Option<usize> {
    let prefix = ["br", "cr", "r", "b", "c", ""].into_iter().find(|prefix| {
        let rest = text.strip_prefix(prefix).unwrap_or("x");
        let is_raw = prefix.ends_with('r') && rest.trim_start_matches('#').starts_with('"');
        is_raw || !prefix.ends_with('r') && rest.starts_with(['"', '\''])
    })?;
    let body = &text[prefix.len()..];
    if prefix.ends_with('r') {
        let end = format!("\"{}", "#".repeat(body.find('"')?));
        return Some(prefix.len() + end.len() + body[end.len()..].find(&end)? + end.len());
    }
    let quote = body.chars().next()?;
    let mut letters = body.char_indices().skip(1);
    let first = letters.next()?;
    let is_character = first.1 == '\\' || letters.clone().next()?.1 == '\'';
    if quote == '\'' && !is_character {
        return None;
    }
    let mut letters = body.char_indices().skip(1);
    while let Some((index, letter)) = letters.next() {
        match letter {
            '\\' => drop(letters.next()),
            letter if letter == quote => return Some(prefix.len() + index + 1),
            _ => {}
        }
    }
    None
}

/// Returns the tokens without those of attributes, whose words belong to macros.
fn without_attributes<'a>(tokens: &[(Token<'a>, usize)]) -> Vec<(Token<'a>, usize)> {
    use Token::{Mark, Word};
    let (mut kept, mut depth) = (Vec::new(), 0_usize);
    for (index, (token, line)) in tokens.iter().enumerate() {
        let next = tokens.get(index + 1).map(|(token, _)| *token);
        match token {
            Mark('#') if depth == 0 && [Mark('['), Mark('!')].map(Some).contains(&next) => {
                depth = 1;
            }
            Mark('[') if depth > 0 => depth += 1,
            Mark(']') if depth == 2 => depth = 0,
            Mark(']') if depth > 2 => depth -= 1,
            // Keep `test`, because it marks the name of a test.
            Word("test") => {}
            _ if depth > 0 => continue,
            _ => {}
        }
        kept.push((*token, *line));
    }
    kept
}

/// Returns the words of a name in snake or camel case, in small letters.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let is_constant = !name.chars().any(char::is_lowercase);
    for letter in name.chars() {
        if letter == '_' || letter.is_uppercase() && !is_constant {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| letter != '_') {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Verdicts on names by their words, stored because names repeat.
#[derive(Default)]
struct Judge<'a>(HashMap<&'a str, Verdict>);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Allowed,
    /// Name that is forbidden as a whole.
    NoName,
    /// Name with a forbidden word.
    NoWord,
}

impl<'a> Judge<'a> {
    fn judge(&mut self, name: &'a str) -> Verdict {
        *self.0.entry(name).or_insert_with(|| {
            let lower = name.to_lowercase();
            if NO_NAMES.split_whitespace().any(|word| word == lower) {
                Verdict::NoName
            } else if !TERMS.contains(&name)
                && words(name).iter().any(|word| NO_WORDS.contains(&word.as_str()))
            {
                Verdict::NoWord
            } else {
                Verdict::Allowed
            }
        })
    }
}

/// Returns the forbidden names of a file, with their lines.
fn findings<'a>(text: &'a str, judge: &mut Judge<'a>) -> Vec<Finding<'a>> {
    use Token::{Mark, Word};
    let tokens = without_attributes(&tokens(text));
    let mut findings = Vec::new();
    let mut is_import = false;
    for (index, (token, line)) in tokens.iter().enumerate() {
        let name = match *token {
            Mark(';') => {
                is_import = false;
                continue;
            }
            // `use<…>` lists the generic parameters that a return type captures, and imports
            // nothing.
            Word("use") if tokens.get(index + 1).map(|(next, _)| *next) != Some(Mark('<')) => {
                is_import = true;
                continue;
            }
            Word(name) if !is_import => name,
            Word(_) | Mark(_) => continue,
        };
        let verdict = judge.judge(name);
        if verdict == Verdict::Allowed {
            continue;
        }
        let token_at = |offset: isize| {
            let index = index.checked_add_signed(offset)?;
            tokens.get(index).map(|(token, _)| *token)
        };
        let pair = |first, second| [token_at(first), token_at(second)];
        let previous = token_at(-1);
        let is_range = pair(-1, -2) == [Some(Mark('.')); 2];
        let is_member = previous == Some(Mark('.')) && !is_range;
        let is_in_path = pair(-1, -2) == [Some(Mark(':')); 2] || pair(1, 2) == [Some(Mark(':')); 2];
        let is_function = previous == Some(Word("fn"));
        // A conversion has the name `from`, which the trait of the standard library gives.
        if is_in_path || is_member || is_function && name == "from" {
            continue;
        }
        let is_upper_camel = name.starts_with(char::is_uppercase)
            && (name.contains(char::is_lowercase) || name.len() == 1);
        let defines_type = ["struct", "enum", "type", "trait", "union"]
            .iter()
            .any(|word| previous == Some(Word(word)));
        // Code reads a variant behind the name of its type: `Switch::Off`.
        if is_upper_camel && !defines_type {
            continue;
        }
        // The name of a test is a sentence.
        let is_test = is_function && (2..6).any(|offset| token_at(-offset) == Some(Word("test")));
        if is_test && verdict == Verdict::NoWord {
            continue;
        }
        findings.push(Finding { name, line: *line });
    }
    findings
}

/// Forbidden name at one place of a file.
struct Finding<'a> {
    name: &'a str,
    line: usize,
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_name_is_a_preposition_a_pronoun_or_a_participle() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    rust_files(&top.join(FOLDER), &mut files);
    assert!(files.len() > 300, "{}", files.len());
    let texts: Vec<(String, String)> = files
        .iter()
        .map(|file| {
            let path = file.strip_prefix(top).unwrap().display().to_string().replace('\\', "/");
            (path, fs::read_to_string(file).unwrap())
        })
        .collect();
    let mut list = String::new();
    let mut judge = Judge::default();
    for (path, text) in &texts {
        for finding in findings(text, &mut judge) {
            writeln!(list, "{path}:{}: {}", finding.line, finding.name).unwrap();
        }
    }
    assert!(list.is_empty(), "{} forbidden names:\n{list}", list.lines().count());
}

#[test]
fn names_are_found_where_they_are_bound() {
    let names = |text: &str| -> String {
        let found = findings(text, &mut Judge::default())
            .into_iter()
            .map(|finding| finding.name.to_owned());
        found.collect::<Vec<_>>().join(" ")
    };
    assert_eq!(names("fn at(of: &str) { let it = 1; }"), "at of it");
    assert_eq!(
        names("struct Held { by: u8 } enum Why { Off } const AT: u8 = 0;"),
        "Held by Why AT"
    );
    assert_eq!(names("x.map(|it| it.with(1)); for to in 0..until {}"), "it it to until");
    assert_eq!(names("fn max_of(at_least: u8, least_squares: u8) {}"), "at_least");
    assert_eq!(names("fn from(time: u8) { Self::of(time); a.by; 'at: loop {} }"), "");
    assert_eq!(names("#[serde(with = \"of\")] struct A; // of it\n/* by /* at */ */ \"to\""), "");
    assert_eq!(names("r#\"by \" at\"# '\\'' 'x' b'\\\\' \"\\\" of\" of"), "of");
    assert_eq!(names("#[test]\nfn at_most_one() {} fn usual_one() {}"), "usual_one");
}
