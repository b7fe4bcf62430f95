//! The search for a setting in all pages.

use std::borrow::Cow;

use super::{appearance, draft::Draft, horizon::Chosen, page::Page, section::DraftSection};

/// Max number of listed results.
const MAX_RESULTS: usize = 12;

/// Search text, until the operator chooses a result.
#[derive(Default)]
pub(super) struct Search {
    pub(super) text: String,
    /// Index of the result that Enter chooses.
    pub(super) chosen: usize,
    pub(super) wants_focus: bool,
}

/// The target of a search result.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Spot {
    /// The field with the label of the result.
    Field,
    /// An item of the horizon page.
    Horizon(Chosen),
    /// The page without a particular field.
    Page,
}

/// Returns labels of settings without fields; they lead to their page.
pub(super) fn on_page(labels: &[&'static str]) -> Vec<(Cow<'static, str>, Spot)> {
    labels.iter().map(|label| (Cow::Borrowed(*label), Spot::Page)).collect()
}

/// A setting found by the search.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    pub(super) page: Page,
    pub(super) label: Cow<'static, str>,
    pub(super) spot: Spot,
}

/// Returns the settings whose label or page title contains every word of `text`. Matches in the
/// label come first.
pub(super) fn find(text: &str, draft: &Draft) -> Vec<Found> {
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    if words.is_empty() {
        return Vec::new();
    }
    let has_all = |place: &str| {
        let place = place.to_lowercase();
        words.iter().all(|word| place.contains(word))
    };
    let (mut by_label, by_page): (Vec<Found>, Vec<Found>) = all(draft)
        .into_iter()
        .filter(|found| has_all(&format!("{} {}", found.label, found.page.title(draft))))
        .partition(|found| has_all(&found.label));
    by_label.extend(by_page);
    by_label.truncate(MAX_RESULTS);
    by_label
}

/// Returns all settings in the order of the pages.
fn all(draft: &Draft) -> Vec<Found> {
    let of_page = |page: Page| {
        let labels = draft.section(page).map_or_else(appearance::labels, DraftSection::labels);
        labels.into_iter().map(move |(label, spot)| Found { page, label, spot })
    };
    Page::all(draft).into_iter().flat_map(of_page).collect()
}
