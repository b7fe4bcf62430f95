//! Strict parser of `OpenMetrics` text, written from its specification.

use std::collections::{BTreeMap, BTreeSet};

/// Labels of a sample, by name.
pub(super) type Labels = BTreeMap<String, String>;

#[derive(Debug, Default)]
pub(super) struct Family {
    pub(super) kind: String,
    pub(super) unit: String,
    /// Samples by labels.
    pub(super) samples: Vec<(Labels, f64)>,
}

/// Metric families by name.
pub(super) type Families = BTreeMap<String, Family>;

/// Returns the families of a text; panics if the text breaks a rule of the format.
pub(super) fn parse(text: &str) -> Families {
    let body = text.strip_suffix("# EOF\n").expect("the text must end with # EOF");
    let mut families = Families::new();
    let mut current = String::new();
    let mut seen = BTreeSet::new();
    for line in body.split_terminator('\n') {
        if let Some(rest) = line.strip_prefix("# ") {
            let mut words = rest.splitn(3, ' ');
            let [keyword, name, value] = [(); 3].map(|()| words.next().expect(line));
            assert!(is_name(name), "{line}");
            if name != current {
                assert!(!families.contains_key(name), "{name} is interleaved");
                families.insert(name.to_owned(), Family::default());
                name.clone_into(&mut current);
            }
            let family = families.get_mut(name).unwrap();
            assert!(family.samples.is_empty(), "metadata behind samples: {line}");
            match keyword {
                "TYPE" => value.clone_into(&mut family.kind),
                "UNIT" => {
                    assert!(name.ends_with(&format!("_{value}")), "{line}");
                    value.clone_into(&mut family.unit);
                }
                "HELP" => assert!(value.ends_with('.'), "{line}"),
                other => panic!("{other}: {line}"),
            }
            continue;
        }
        let (name, labels, value) = sample(line);
        let family = families.get_mut(&current).expect(line);
        let suffix = match &*family.kind {
            "counter" => "_total",
            "info" => "_info",
            "gauge" => "",
            other => panic!("{other}: {line}"),
        };
        assert_eq!(name, format!("{current}{suffix}"), "{line}");
        assert!(value.is_finite(), "{line}");
        assert!(family.kind != "counter" || value >= 0.0, "{line}");
        assert!(seen.insert((name, labels.clone())), "twice: {line}");
        family.samples.push((labels, value));
    }
    families
}

fn is_name(name: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_lowercase() || letter == '_';
    name.starts_with(is_letter)
        && name.chars().all(|letter| is_letter(letter) || letter.is_ascii_digit())
}

/// Splits the line of a sample into name, labels and value.
fn sample(line: &str) -> (String, Labels, f64) {
    let end = line.find(['{', ' ']).expect(line);
    let (name, rest) = line.split_at(end);
    assert!(is_name(name), "{line}");
    let mut labels = Labels::new();
    let mut rest = rest;
    if let Some(inner) = rest.strip_prefix('{') {
        rest = inner;
        while !rest.starts_with('}') {
            let (key, behind) = rest.split_once("=\"").expect(line);
            assert!(is_name(key), "{line}");
            let (mut value, mut letters) = (String::new(), behind.char_indices());
            let end = loop {
                match letters.next().expect(line) {
                    (end, '"') => break end,
                    (_, '\\') => value.push(match letters.next().expect(line).1 {
                        'n' => '\n',
                        letter @ ('\\' | '"') => letter,
                        other => panic!("escape {other}: {line}"),
                    }),
                    (_, letter) => value.push(letter),
                }
            };
            assert!(labels.insert(key.to_owned(), value).is_none(), "{line}");
            rest = &behind[end + 1..];
            rest = rest.strip_prefix(',').unwrap_or(rest);
        }
        rest = &rest[1..];
    }
    let value = rest.strip_prefix(' ').expect(line).parse().expect(line);
    (name.to_owned(), labels, value)
}
