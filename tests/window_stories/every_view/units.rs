//! Distances in the chosen unit, in every place.

use crate::window_stories::{
    every_view::{Findings, words},
    rig::Window,
};

/// Returns `true` if `symbol` stands in `words` as the unit of a figure or the head of a column.
fn has_unit(words: &str, symbol: &str) -> bool {
    let ends =
        |of: &&str| of.split('/').next().is_some_and(|of| of.trim_matches(['.', ',']) == symbol);
    words.split_whitespace().any(|of| ends(&of))
}

/// Finds kilometres in a window with nautical miles. Counts the nautical miles.
pub(super) fn check(window: &Window, findings: &mut Findings) {
    for words in words(window) {
        findings.count(usize::from(has_unit(&words, "nmi")));
        if has_unit(&words, "km") {
            findings.add(&format!("kilometres in {words:?}"));
        }
    }
}
