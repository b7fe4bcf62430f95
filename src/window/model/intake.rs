//! Files and texts that the operator drags over the window, drops, pastes or chooses. Azel shows
//! their contents before it takes anything.

use std::{path::PathBuf, sync::Arc};

use crate::orbit::{Catalog, Nothing, Refusal, read_element_bytes};

/// Max number of refused records that are listed one by one.
const LISTED: usize = 3;

/// A file or a text that may hold elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Offer {
    File(PathBuf),
    Text(Arc<str>),
}

/// Offers and the elements found in them.
#[derive(Debug, Clone, PartialEq)]
pub struct Intake {
    pub offers: Vec<Offer>,
    /// `true` once the operator has dropped the files; the operator can choose nothing earlier.
    pub is_dropped: bool,
    /// Results in the order of the offers; `None` until Azel has read all of them.
    pub judged: Option<Vec<Judged>>,
}

/// Contents of an offer, compared with the elements in use.
#[derive(Debug, Clone, PartialEq)]
pub enum Judged {
    /// Error message of the operating system, which refused to read the file.
    Unreadable(String),
    Nothing(Nothing),
    Elements(Counts),
}

/// Numbers of objects in an offer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts {
    /// Objects that are not in the catalog.
    pub new: usize,
    /// Objects whose set is newer than the set in use.
    pub newer: usize,
    pub same: usize,
    pub older: usize,
    /// The first few refused records.
    pub refused: Vec<Refusal>,
    pub all_refused: usize,
}

impl Counts {
    /// Returns the number of objects that could be read.
    pub fn objects(&self) -> usize {
        self.new + self.newer + self.same + self.older
    }
}

impl Offer {
    /// Returns the name for display.
    pub fn name(&self) -> String {
        match self {
            Self::File(path) => path.file_name().map_or_else(
                || path.display().to_string(),
                |name| name.to_string_lossy().into_owned(),
            ),
            Self::Text(_) => "pasted text".to_owned(),
        }
    }
}

impl Judged {
    /// Compares the elements in `bytes` with the elements in use.
    pub fn new(bytes: &[u8], in_use: Option<&Catalog>) -> Self {
        let report = read_element_bytes(bytes);
        if let Some(nothing) = report.nothing {
            return Self::Nothing(nothing);
        }
        let mut counts = Counts {
            all_refused: report.refused.len() + report.refused_unlisted,
            refused: report.refused.into_iter().take(LISTED).collect(),
            ..Counts::default()
        };
        for elements in &report.elements {
            let known_elements = in_use.and_then(|catalog| catalog.get(elements.catalog_number()));
            let count = match known_elements
                .map(|known_elements| elements.epoch().cmp(&known_elements.epoch()))
            {
                None => &mut counts.new,
                Some(std::cmp::Ordering::Greater) => &mut counts.newer,
                Some(std::cmp::Ordering::Equal) => &mut counts.same,
                Some(std::cmp::Ordering::Less) => &mut counts.older,
            };
            *count += 1;
        }
        Self::Elements(counts)
    }

    /// Returns `true` if the offer has objects to take.
    pub fn is_usable(&self) -> bool {
        matches!(self, Self::Elements(counts) if counts.objects() > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::{bundled, write_omm_json};

    #[test]
    fn what_a_text_holds_is_counted_against_the_elements_in_use() {
        let catalog = bundled().unwrap();
        let mut text = Vec::new();
        let four = [25_544, 43_013, 57_166, 59_051].map(|number| catalog.get(number).unwrap());
        write_omm_json(four, &mut text).unwrap();
        let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
        list[0]["EPOCH"] = "2026-08-20T00:00:00".into();
        list[1]["EPOCH"] = "2026-08-01T00:00:00".into();
        list[2]["NORAD_CAT_ID"] = 999_999.into();
        list.as_array_mut().unwrap().push(serde_json::json!({ "OBJECT_NAME": "M" }));
        let Judged::Elements(counts) = Judged::new(list.to_string().as_bytes(), Some(&catalog))
        else {
            panic!("there are elements")
        };
        assert_eq!((counts.new, counts.newer, counts.same, counts.older), (1, 1, 1, 1));
        assert_eq!((counts.objects(), counts.all_refused), (4, 1));
        assert_eq!(counts.refused[0].object.as_deref(), Some("M"));
        let page = Judged::new(b"<!DOCTYPE html>", Some(&catalog));
        assert_eq!(page, Judged::Nothing(Nothing::WebPage));
        assert!(!page.is_usable());
    }
}
