//! The search for a setting in all pages.

use std::borrow::Cow;

use super::{
    appearance, draft::Draft, fields::Typed, horizon::Chosen, page::Page, rules, satellites,
};

/// Most results that are listed.
const MOST: usize = 12;

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
    by_label.truncate(MOST);
    by_label
}

/// All settings, in the order of the pages.
fn all(draft: &Draft) -> Vec<Found> {
    let mut all = Vec::new();
    for page in Page::all(draft) {
        let field = |label| Found { page, label, spot: Spot::Field };
        let on_page = |label| Found { page, label, spot: Spot::Page };
        match page {
            Page::Site | Page::Satellites => {
                let fields = draft.ground.fields.iter();
                let of_page = fields.filter(|of| Page::of_section(of.section) == page);
                all.extend(of_page.map(|of| field(of.description.label.clone())));
                if page == Page::Satellites {
                    all.extend(satellites::LABELS.map(|label| on_page(label.into())));
                    let groups = draft.satellites.kept();
                    all.extend(groups.map(|(_, group)| on_page(group.title().into())));
                }
            }
            Page::Rules => all.extend(rules::LABELS.map(|label| on_page(label.into()))),
            Page::Horizon => {
                let spots = draft.skies.spots().into_iter();
                all.extend(spots.map(|(label, chosen)| Found {
                    page,
                    label: label.into(),
                    spot: Spot::Horizon(chosen),
                }));
            }
            Page::Antenna(id) => {
                let antenna = draft.index(id).and_then(|index| draft.antennas.get(index));
                let labels = antenna.map(Typed::labels).unwrap_or_default();
                all.extend(labels.into_iter().map(field));
            }
            Page::Notices => all.extend(draft.notices.labels().into_iter().map(field)),
            Page::Appearance => {
                all.extend(appearance::LABELS.map(|label| on_page(label.into())));
            }
        }
    }
    all
}
