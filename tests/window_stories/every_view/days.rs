//! Times of another day, which carry their day in every place.

use egui_kittest::kittest::{By, NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::{Findings, painted},
    rig::Window,
};

/// Hours around the present of a scene after [`BACK_S`](super::BACK_S).
const HOURS: [&str; 2] = ["22:", "23:"];
const MONTHS: [&str; 12] =
    ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

/// Returns all words that the operator can see or hear.
pub(crate) fn words(window: &Window) -> Vec<String> {
    let nodes = window.query_all(By::new()).flat_map(|node| {
        let node = node.accesskit_node();
        [node.label(), node.value()]
    });
    nodes.flatten().chain(painted::texts(window)).collect()
}

/// Returns the text before each time of day, such as `11:15:30` or `11:15Z`, in `words`.
fn times(words: &str) -> Vec<(&str, &str)> {
    let is_time = |place: usize| {
        let shape = |form: &str| {
            let found = words.get(place..place + form.len())?;
            let fits = found.chars().zip(form.chars()).all(|(found, form)| match form {
                '0' => found.is_ascii_digit(),
                form => found == form,
            });
            fits.then_some(found)
        };
        shape("00:00:00").or_else(|| shape("00:00Z"))
    };
    let starts = words.char_indices().filter(|(place, _)| {
        !words[..*place].ends_with(|before: char| before.is_ascii_digit() || before == ':')
    });
    starts.filter_map(|(place, _)| Some((&words[..place], is_time(place)?))).collect()
}

/// Returns `true` if the day stands before a time, or before the start of a stretch that ends with
/// this time.
fn has_day(before: &str) -> bool {
    let before = before.trim_end_matches(['T', ' ']);
    let is_date = |last: &str| last.len() == 10 && last.matches('-').count() == 2;
    let is_day = MONTHS.iter().any(|month| before.ends_with(month))
        || before.rsplit(' ').next().is_some_and(is_date);
    let Some(begin) = before.strip_suffix(" to").filter(|_| !is_day) else { return is_day };
    times(begin).last().is_some_and(|(before, _)| has_day(before))
}

/// Returns `true` if the time is a duration, as in `T−12:15:30`, and not a time of day.
fn is_span(before: &str) -> bool {
    before.ends_with(['\u{2212}', '+'])
        || before.ends_with("rises in ")
        || before.ends_with("Z, in ")
}

/// Finds times of another day without their day, in a window whose present is
/// [`BACK_S`](super::BACK_S) earlier. Counts those with a day.
pub(super) fn check(window: &Window, findings: &mut Findings) {
    for words in words(window) {
        for (before, time) in times(&words) {
            if has_day(before) {
                findings.count(1);
            } else if !is_span(before) && !HOURS.contains(&&time[..3]) {
                findings.add(&format!("{time} has no day in {words:?}"));
            }
        }
    }
}

#[test]
fn the_day_of_a_time_is_told_apart_from_its_lack() {
    let bare = |words: &str| times(words).iter().any(|(before, _)| !has_day(before));
    for words in ["AOS 11:15:30Z", "at 11:15Z", "11:15:30 to 11:20:00Z", "Verified 11:15:30Z"] {
        assert!(bare(words), "{words}");
    }
    for words in ["AOS 12 Aug 11:15:30Z", "2026-08-12 11:15:30Z", "12 Aug 11:15:30 to 11:20:00Z"] {
        assert!(!bare(words) && !times(words).is_empty(), "{words}");
    }
}
