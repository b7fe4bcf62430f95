//! Ages of the elements of the satellites on the sheet.

use std::collections::BTreeSet;

use maud::{Markup, html};

use super::HandOverSheet;
use crate::{
    astro::time::DAY_S,
    ui::{
        format,
        page::{SECTION_HEAD_MM, printable, section},
        words::OLD_ELEMENTS_S,
    },
};

const COLUMNS: usize = 4;
/// Height of a row, millimetres; equals the value in the style sheet.
const ROW_MM: f64 = 3.2;
const MAX_ROWS: usize = 5;

/// List of the ages, the oldest first.
pub(super) struct List {
    remark: String,
    ages: Vec<Age>,
}

struct Age {
    name: String,
    seconds: f64,
    is_old: bool,
}

impl List {
    pub(super) fn new(sheet: &HandOverSheet<'_>) -> Self {
        let listed_numbers = sheet.entries().into_iter().map(|entry| entry.pass.satellite);
        let left_out = sheet.left_out().into_iter().map(|left| left.pass.satellite);
        let numbers: BTreeSet<u32> = listed_numbers.chain(left_out).collect();
        let own_s = sheet.station.scheduling.max_element_age_d.map(|days| days * DAY_S);
        let max_s = own_s.map_or(OLD_ELEMENTS_S, |own_s| own_s.min(OLD_ELEMENTS_S));
        let satellites = numbers.iter().filter_map(|number| sheet.satellites.get(number));
        let mut ages: Vec<Age> = satellites
            .map(|(elements, _)| {
                let seconds = elements.age_s(sheet.start);
                Age { name: printable(&elements.label()), seconds, is_old: seconds.abs() > max_s }
            })
            .collect();
        ages.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then_with(|| a.name.cmp(&b.name)));
        let old = ages.iter().filter(|age| age.is_old).count();
        let remark = format!(
            "At {}Z, oldest first. {old} of {} older than {} (bold, \u{d7})",
            format::minute_of_day(sheet.start),
            ages.len(),
            format::age(max_s),
        );
        Self { remark, ages }
    }

    fn rows(&self) -> usize {
        self.ages.len().div_ceil(COLUMNS).min(MAX_ROWS)
    }

    pub(super) fn height_mm(&self) -> f64 {
        SECTION_HEAD_MM + ROW_MM * self.rows() as f64
    }

    pub(super) fn html(&self) -> Markup {
        let places = self.rows() * COLUMNS;
        let is_cut = self.ages.len() > places;
        let shown = if is_cut { places - 1 } else { self.ages.len() };
        let rows = format!("grid-template-rows: repeat({}, {ROW_MM}mm)", self.rows().max(1));
        let content = html! {
            ul style=(rows) {
                @for age in self.ages.iter().take(shown) {
                    li.bold[age.is_old] {
                        span { (age.name) }
                        span { (age_in_words(age.seconds)) @if age.is_old { " \u{d7}" } }
                    }
                }
                @if is_cut {
                    li.quiet { "and " (self.ages.len() - shown) " more, all younger" }
                }
            }
        };
        section("ages", "Ages of elements", &self.remark, &content)
    }
}

/// Formats an age, or the time until an epoch in the future.
fn age_in_words(seconds: f64) -> String {
    if seconds < 0.0 {
        return format!("in {}", format::age(-seconds));
    }
    format::age(seconds)
}
