//! How old the elements of the satellites on the sheet are.

use std::collections::BTreeSet;

use super::HandOverSheet;
use crate::{
    astro::time::DAY_S,
    ui::{
        format,
        sheet::{
            CAPTION, LEFT, RIGHT, SECTION_HEAD, SMALL, section,
            svg::{Anchor, Svg},
        },
        words::OLD_ELEMENTS_S,
    },
};

const COLUMNS: usize = 4;
const ROW: f64 = 9.0;
const MOST_ROWS: usize = 5;

/// The ages, the oldest first.
pub(super) struct List {
    said: String,
    ages: Vec<Age>,
}

struct Age {
    name: String,
    seconds: f64,
    is_old: bool,
}

impl List {
    pub(super) fn of(sheet: &HandOverSheet<'_>) -> Self {
        let taken = sheet.entries().into_iter().map(|entry| entry.pass.satellite);
        let left_out = sheet.left_out().into_iter().map(|left| left.pass.satellite);
        let numbers: BTreeSet<u32> = taken.chain(left_out).collect();
        let own_s = sheet.station.scheduling.max_element_age_d.map(|days| days * DAY_S);
        let most_s = own_s.map_or(OLD_ELEMENTS_S, |own_s| own_s.min(OLD_ELEMENTS_S));
        let known = numbers.iter().filter_map(|number| sheet.satellites.get(number));
        let mut ages: Vec<Age> = known
            .map(|(elements, _)| {
                let seconds = elements.age_s(sheet.from);
                Age { name: elements.label(), seconds, is_old: seconds.abs() > most_s }
            })
            .collect();
        ages.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then_with(|| a.name.cmp(&b.name)));
        let old = ages.iter().filter(|age| age.is_old).count();
        let said = format!(
            "At {}Z, oldest first. {old} of {} older than {} (bold, \u{d7})",
            format::minute_of_day(sheet.from),
            ages.len(),
            format::age(most_s),
        );
        Self { said, ages }
    }

    fn rows(&self) -> usize {
        self.ages.len().div_ceil(COLUMNS).min(MOST_ROWS)
    }

    pub(super) fn height(&self) -> f64 {
        SECTION_HEAD + ROW * self.rows() as f64
    }

    /// Returns where the list ends.
    pub(super) fn draw(&self, svg: &mut Svg, y: f64) -> f64 {
        let top = section(svg, y, "Ages of elements", &self.said);
        let column = (RIGHT - LEFT) / COLUMNS as f64;
        let places = self.rows() * COLUMNS;
        let is_cut = self.ages.len() > places;
        let shown = if is_cut { places - 1 } else { self.ages.len() };
        let at = |place: usize| {
            let rows = self.rows().max(1);
            [LEFT + column * (place / rows) as f64, top + ROW * (place % rows) as f64 + 6.5]
        };
        for (age, place) in self.ages.iter().take(shown).zip(0..) {
            let [x, y] = at(place);
            let face = if age.is_old { SMALL.bold() } else { SMALL };
            let mark = if age.is_old { " \u{d7}" } else { "" };
            svg.name([x, y], column - 60.0, face, &age.name);
            let words = format!("{}{mark}", age_in_words(age.seconds));
            svg.text([x + column - 12.0, y], 46.0, face.anchored(Anchor::End), &words);
        }
        if is_cut {
            let words = format!("and {} more, all younger", self.ages.len() - shown);
            svg.text(at(shown), column, CAPTION, &words);
        }
        y + self.height()
    }
}

/// Elements may be of a time to come.
fn age_in_words(seconds: f64) -> String {
    if seconds < 0.0 {
        return format!("in {}", format::age(-seconds));
    }
    format::age(seconds)
}
