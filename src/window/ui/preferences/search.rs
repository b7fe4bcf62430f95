//! The search for a setting in all pages.

use std::borrow::Cow;

use super::{appearance, draft::Draft, horizon::Chosen, page::Page, section::DraftSection};

/// Most results that are listed.
const MAX_RESULTS: usize = 12;

/// Text of the search, until a result is chosen.
#[derive(Default)]
pub(super) struct Search {
    pub(super) text: String,
    /// The result that Enter chooses.
    pub(super) chosen: usize,
    pub(super) wants_focus: bool,
}

/// A place that a search leads to.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Spot {
    /// The field with the label of the result.
    Field,
    /// An item of the page of the horizon.
    Horizon(Chosen),
    /// The page as it is.
    Page,
}

/// Labels of settings that are no fields, which lead to their page.
pub(super) fn on_page(labels: &[&'static str]) -> Vec<(Cow<'static, str>, Spot)> {
    labels.iter().map(|label| (Cow::Borrowed(*label), Spot::Page)).collect()
}

/// A setting that was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    pub(super) page: Page,
    pub(super) label: Cow<'static, str>,
    pub(super) spot: Spot,
}

/// The settings whose label, or page, has every word of `text`; those by their label first.
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

/// All settings, in the order of the pages.
fn all(draft: &Draft) -> Vec<Found> {
    let of_page = |page: Page| {
        let labels = draft.section(page).map_or_else(appearance::labels, DraftSection::labels);
        labels.into_iter().map(move |(label, spot)| Found { page, label, spot })
    };
    Page::all(draft).into_iter().flat_map(of_page).collect()
}
