//! Sections of the draft of a station, of which each page edits one.

use std::borrow::Cow;

use super::{draft::Draft, fields::Problem, search::Spot};
use crate::station::Station;

/// A part of the draft that a page edits.
pub(super) trait DraftSection {
    /// Number of edits that are not saved; `before` is the draft of the station as saved.
    fn edits(&self, before: &Draft) -> usize;

    /// The fields that cannot be used. `draft` holds this section.
    fn findings(&self, draft: &Draft) -> Vec<Finding>;

    /// Labels that a search finds, and where each leads to.
    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)>;

    /// Types `text` into the field with this label.
    fn write(&mut self, _label: &str, _text: String) {}

    /// Puts the section into `station`, which has those of the pages before, if all of it is right.
    /// `draft` holds this section.
    fn put_into(&self, draft: &Draft, station: &mut Station) -> Option<()>;
}

/// A field that cannot be used, and why.
pub(super) struct Finding {
    pub(super) label: String,
    pub(super) problem: Problem,
}

impl Finding {
    pub(super) fn sentence(&self) -> String {
        format!("{} {}.", self.label, self.problem.reason)
    }
}
