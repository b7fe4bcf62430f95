//! The columns of the table of the catalog.

use std::borrow::Cow;

use egui::Rect;
use jiff::Timestamp;

use super::{PADDING, words};
use crate::{
    model::{DistanceUnit, Model, catalog_table::Column, globe::NextPass},
    orbit::{Catalog, Elements},
    ui::format,
};

/// Width of the bar of a max elevation of 90 degrees, points.
pub(super) const BAR: f32 = 40.0;
/// Room for the number behind the bar, points.
const BAR_NUMBER: f32 = 34.0;
/// Free space between two columns, points.
const GAP: f32 = 12.0;
/// Left end of the names, behind the marks and stars, points.
const NAME: f32 = PADDING + 54.0;
/// Width of the stars, points.
const STAR: f32 = 20.0;
/// Min width of the names, points.
const MIN_NAME: f32 = 154.0;

/// The columns behind the names.
const ALL: [Column; 8] = [
    Column::Number,
    Column::Period,
    Column::Inclination,
    Column::Heights,
    Column::Age,
    Column::From,
    Column::NextPass,
    Column::MaxElevation,
];

/// Columns that a narrow table leaves out, the least important first.
const FOLDS: [Column; 8] = [
    Column::Period,
    Column::Inclination,
    Column::Heights,
    Column::From,
    Column::Number,
    Column::MaxElevation,
    Column::Age,
    Column::NextPass,
];

/// Returns the columns for which a table of this width has room.
fn that_fit(width: f32) -> Vec<Column> {
    let mut fit = ALL.to_vec();
    for folded in FOLDS {
        if min_width(&fit) <= width {
            break;
        }
        fit.retain(|column| *column != folded);
    }
    fit
}

/// Returns the min width of a column behind the names, with the gap before it, points.
fn min_width_of(column: Column) -> f32 {
    let width = match column {
        Column::Star | Column::Name => 0.0,
        Column::Number => 64.0,
        Column::Period => 60.0,
        Column::Inclination => 46.0,
        Column::Heights => 98.0,
        Column::Age => 78.0,
        Column::From => 128.0,
        Column::NextPass => 92.0,
        Column::MaxElevation => BAR + BAR_NUMBER,
    };
    width + GAP
}

fn min_width(columns: &[Column]) -> f32 {
    let others: f32 = columns.iter().map(|column| min_width_of(*column)).sum();
    NAME + MIN_NAME + others + PADDING
}

/// Returns the share of the free room that a column gets: texts get more than numbers.
fn weight(column: Column) -> f32 {
    match column {
        Column::Name => 6.0,
        Column::From => 3.0,
        Column::MaxElevation => 0.0,
        _ => 1.0,
    }
}

/// Returns `true` for a column with text aligned to the left.
pub(super) fn is_left(column: Column) -> bool {
    matches!(column, Column::Star | Column::Name | Column::From)
}

/// Returns the shown columns with their places in `row`. The columns share the free room.
pub(super) fn places(row: Rect) -> Vec<(Column, Rect)> {
    let others = that_fit(row.width());
    let free = (row.width() - min_width(&others)).max(0.0);
    let weights: f32 = others.iter().map(|column| weight(*column)).sum();
    let unit = free / (weight(Column::Name) + weights);
    let first = row.left() + NAME;
    let mut end = first + MIN_NAME + unit * weight(Column::Name);
    let star = row.with_min_x(row.left() + PADDING + 24.0);
    let star = star.with_max_x(star.left() + STAR);
    let mut places =
        vec![(Column::Star, star), (Column::Name, row.with_min_x(first).with_max_x(end))];
    for column in others {
        let start = end + GAP;
        end += min_width_of(column) + unit * weight(column);
        places.push((column, row.with_min_x(start).with_max_x(end)));
    }
    places
}

pub(super) fn head(column: Column, unit: DistanceUnit) -> Cow<'static, str> {
    let words = match column {
        Column::Star => "",
        Column::Name => "Name",
        Column::Number => "Number",
        Column::Period => "Period min",
        Column::Inclination => "Incl. °",
        Column::Heights => return format!("Apo × per {}", format::distance_unit(unit)).into(),
        Column::Age => "Epoch age",
        Column::From => "Source",
        Column::NextPass => "Next pass",
        Column::MaxElevation => "Max el",
    };
    words.into()
}

/// Returns the name of the column for screen readers.
pub(super) fn spoken(column: Column) -> &'static str {
    match column {
        Column::Star => "priority",
        Column::Name => "name",
        Column::Number => "number",
        Column::Period => "period",
        Column::Inclination => "inclination",
        Column::Heights => "apogee and perigee",
        Column::Age => "epoch age",
        Column::From => "source",
        Column::NextPass => "next pass",
        Column::MaxElevation => "maximum elevation",
    }
}

/// Next pass of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Next {
    /// Pass that Azel has not searched for yet.
    Unknown,
    Never,
    At(NextPass),
}

impl Next {
    pub(super) fn pass(self) -> Option<NextPass> {
        match self {
            Self::At(pass) => Some(pass),
            Self::Unknown | Self::Never => None,
        }
    }
}

/// Row with the data of its cells.
pub(super) struct Row<'a> {
    pub(super) elements: &'a Elements,
    pub(super) start_text: &'a str,
    /// Flag: the operator chose an older set, which is in use.
    pub(super) is_older_set: bool,
    pub(super) next: Next,
    pub(super) now: Timestamp,
    pub(super) unit: DistanceUnit,
}

impl<'a> Row<'a> {
    pub(super) fn new(elements: &'a Elements, catalog: &'a Catalog, model: &Model) -> Self {
        let number = elements.catalog_number();
        let next = model.catalog_table.next.as_ref();
        Self {
            elements,
            start_text: catalog.source_of(number).unwrap_or_default(),
            is_older_set: catalog.set_aside(number).is_some(),
            next: next.map_or(Next::Unknown, |next| {
                next.get(number, model.now).map_or(Next::Never, Next::At)
            }),
            now: model.now,
            unit: model.appearance.distances,
        }
    }

    pub(super) fn cell(&self, column: Column) -> String {
        let elements = self.elements;
        match column {
            Column::Star => String::new(),
            Column::Name if elements.name().is_empty() => "No name".to_owned(),
            Column::Name => elements.name().to_owned(),
            Column::Number => words::number(elements.catalog_number()),
            Column::Period => format::number(elements.period_s() / 60.0, 1),
            Column::Inclination => format::number(elements.inclination().degrees(), 2),
            Column::Heights => words::heights(elements.heights(), self.unit),
            Column::Age => words::age(elements.age_s(self.now)),
            Column::From => self.start_text.to_owned(),
            Column::NextPass => words::next_pass(self.next, self.now),
            Column::MaxElevation => self
                .next
                .pass()
                .map_or_else(String::new, |next| format::degrees(next.max_elevation.degrees(), 0)),
        }
    }

    /// Returns the row as text for screen readers.
    pub(super) fn spoken(&self, priority: Option<u8>) -> String {
        let cell = |column| self.cell(column);
        let star =
            priority.map(|level| format!(", favourite of priority {level}")).unwrap_or_default();
        let choice = if self.is_older_set { ", an older set by choice" } else { "" };
        let next = match self.next {
            Next::Unknown => "being computed".to_owned(),
            Next::Never | Next::At(_) => cell(Column::NextPass),
        };
        format!(
            "{}, {}, elements {} old, from {}{choice}, next pass {next}{star}",
            cell(Column::Name),
            self.elements.catalog_number(),
            cell(Column::Age),
            self.start_text,
        )
    }

    /// Returns a tooltip with the columns that a narrow table leaves out.
    pub(super) fn tip(&self) -> String {
        let cell = |column| self.cell(column);
        let designator = self.elements.international_designator().unwrap_or("no designator");
        format!(
            "{}\n{}, {designator}\nPeriod {} min, inclination {}°\nApogee × perigee {} {}",
            cell(Column::Name),
            self.elements.catalog_number(),
            cell(Column::Period),
            cell(Column::Inclination),
            cell(Column::Heights),
            format::distance_unit(self.unit),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{pos2, vec2};

    fn row(width: f32) -> Rect {
        Rect::from_min_size(pos2(48.0, 0.0), vec2(width, 25.0))
    }

    fn shown(width: f32) -> Vec<Column> {
        places(row(width)).into_iter().map(|(column, _)| column).collect()
    }

    #[test]
    fn columns_stand_beside_each_other_within_the_row_at_every_width() {
        for width in (680..2600_u16).step_by(20).map(f32::from) {
            let places = places(row(width));
            for pair in places.windows(2) {
                let [(_, left), (column, right)] = pair else { unreachable!() };
                assert!(left.right() < right.left(), "{width} {column:?}: {left:?} {right:?}");
            }
            let (last, place) = places.last().unwrap();
            assert!(place.right() <= row(width).right() - PADDING + 0.1, "{width} {last:?}");
        }
    }

    #[test]
    fn a_narrow_table_leaves_the_least_important_columns_out() {
        assert_eq!(shown(1024.0).len(), 10);
        let narrow = shown(684.0);
        for column in [Column::Number, Column::Age, Column::NextPass, Column::MaxElevation] {
            assert!(narrow.contains(&column), "{narrow:?}");
        }
        assert!(!narrow.contains(&Column::Period) && !narrow.contains(&Column::From));
    }
}
