//! All elements the operator has, the newest of every object.

use std::collections::BTreeMap;

use jiff::Timestamp;

use super::{Elements, ReadReport, Refusal};

/// Elements by catalogue number, each with the name of its source.
#[derive(Debug, Clone, Default)]
pub struct Catalog {
    entries: BTreeMap<u32, Entry>,
}

#[derive(Debug, Clone)]
struct Entry {
    elements: Elements,
    source: String,
}

/// What a merge changed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MergeSummary {
    /// Objects the catalog did not have.
    pub added: usize,
    /// Objects that got a newer epoch.
    pub updated: usize,
    /// Sets with an older or the same epoch, which were left out.
    pub not_newer: usize,
    /// Objects that could not be read.
    pub refused: Vec<Refusal>,
}

impl Catalog {
    /// Takes over what was read from `source`. The newest epoch of an object
    /// wins, whatever the order of merging.
    pub fn merge(&mut self, report: ReadReport, source: &str) -> MergeSummary {
        let mut summary = MergeSummary { refused: report.refused, ..MergeSummary::default() };
        for elements in report.elements {
            match self.entries.get(&elements.catalog_number()) {
                Some(known) if known.elements.epoch() >= elements.epoch() => {
                    summary.not_newer += 1;
                    continue;
                }
                Some(_) => summary.updated += 1,
                None => summary.added += 1,
            }
            let entry = Entry { source: source.to_owned(), elements };
            self.entries.insert(entry.elements.catalog_number(), entry);
        }
        summary
    }

    /// The elements of an object.
    pub fn get(&self, catalog_number: u32) -> Option<&Elements> {
        self.entries.get(&catalog_number).map(|entry| &entry.elements)
    }

    /// Where the elements of an object came from.
    pub fn source(&self, catalog_number: u32) -> Option<&str> {
        self.entries.get(&catalog_number).map(|entry| entry.source.as_str())
    }

    /// At most `limit` objects whose number starts with `text` or whose name
    /// holds it in any case, by name, then by number. An empty text finds all.
    pub fn search(&self, text: &str, limit: usize) -> Vec<&Elements> {
        let text = text.trim().to_lowercase();
        let mut found: Vec<(String, &Elements)> = self
            .iter()
            .map(|elements| (elements.name().to_lowercase(), elements))
            .filter(|(name, elements)| {
                name.contains(&text) || elements.catalog_number().to_string().starts_with(&text)
            })
            .collect();
        found.sort_by(|(a, first), (b, second)| {
            a.cmp(b).then(first.catalog_number().cmp(&second.catalog_number()))
        });
        found.into_iter().take(limit).map(|(_, elements)| elements).collect()
    }

    /// All elements by catalogue number.
    pub fn iter(&self) -> impl Iterator<Item = &Elements> {
        self.entries.values().map(|entry| &entry.elements)
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The newest epoch of all.
    pub fn newest_epoch(&self) -> Option<Timestamp> {
        self.iter().map(Elements::epoch).max()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::read_elements;

    /// An OMM list of objects given as number, name and day of August 2026.
    fn report(objects: &[(u32, &str, u32)]) -> ReadReport {
        let messages: Vec<_> = objects
            .iter()
            .map(|(number, name, day)| {
                serde_json::json!({
                    "OBJECT_NAME": name, "NORAD_CAT_ID": number,
                    "EPOCH": format!("2026-08-{day:02}T00:00:00"), "MEAN_MOTION": 15.0,
                    "ECCENTRICITY": 0.001, "INCLINATION": 51.6, "RA_OF_ASC_NODE": 0,
                    "ARG_OF_PERICENTER": 0, "MEAN_ANOMALY": 0, "BSTAR": 0
                })
            })
            .collect();
        read_elements(&serde_json::json!(messages).to_string())
    }

    #[test]
    fn the_newest_epoch_wins_whatever_the_order() {
        let mut catalog = Catalog::default();
        let first = catalog.merge(report(&[(5, "OLD", 10), (6, "B", 12)]), "first");
        assert_eq!((first.added, first.updated, first.not_newer), (2, 0, 0));
        let second = catalog.merge(report(&[(5, "NEW", 11), (6, "STALE", 11)]), "second");
        assert_eq!((second.added, second.updated, second.not_newer), (0, 1, 1));
        assert_eq!((catalog.get(5).unwrap().name(), catalog.source(5)), ("NEW", Some("second")));
        assert_eq!((catalog.get(6).unwrap().name(), catalog.source(6)), ("B", Some("first")));
        assert_eq!(catalog.newest_epoch(), Some("2026-08-12T00:00:00Z".parse().unwrap()));
        assert_eq!(catalog.len(), 2);
    }

    #[test]
    fn a_merge_hands_on_what_was_refused() {
        let mut catalog = Catalog::default();
        let summary = catalog.merge(read_elements("[{}]"), "broken");
        assert_eq!((summary.refused.len(), catalog.is_empty()), (1, true));
    }

    #[test]
    fn search_finds_numbers_by_their_start_and_names_by_any_part() {
        let mut catalog = Catalog::default();
        let objects =
            [(25_544, "ISS", 1), (255, "Noaa 19", 1), (7, "METEOR 25", 1), (8, "Iss 2", 1)];
        catalog.merge(report(&objects), "test");
        let numbers = |text, limit| -> Vec<u32> {
            catalog.search(text, limit).into_iter().map(Elements::catalog_number).collect()
        };
        assert_eq!(numbers(" iss", 9), [25_544, 8]);
        assert_eq!(numbers("25", 9), [25_544, 7, 255]);
        assert_eq!(numbers("25", 1), [25_544]);
        assert_eq!(numbers("", 9).len(), 4);
        assert!(numbers("no such", 9).is_empty());
    }
}
