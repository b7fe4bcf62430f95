//! Sections of the draft of a station. Each page edits one section.

use std::borrow::Cow;

use super::{draft::Draft, fields::Problem, search::Spot};
use crate::station::Station;

/// A section of the draft that a page edits.
pub(super) trait DraftSection {
    /// Returns the number of unsaved edits; `before` is the draft of the saved station.
    fn edits(&self, before: &Draft) -> usize;

    /// Returns the invalid fields. `draft` contains this section.
    fn findings(&self, draft: &Draft) -> Vec<Finding>;

    /// Returns the labels that a search finds, and the place that each leads to.
    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)>;

    /// Types `text` into the field with this label.
    fn write(&mut self, _label: &str, _text: String) {}

    /// Writes the section into `station`, which already has the previous pages, if all fields are
    /// valid. `draft` contains this section.
    fn put_into(&self, draft: &Draft, station: &mut Station) -> Option<()>;
}

/// An invalid field and the reason.
pub(super) struct Finding {
    pub(super) label: String,
    pub(super) problem: Problem,
}

impl Finding {
    pub(super) fn sentence(&self) -> String {
        format!("{} {}.", self.label, self.problem.reason)
    }
}
