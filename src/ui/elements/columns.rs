//! The columns of the table of the catalog.

use egui::Rect;
use jiff::Timestamp;

use super::{PADDING, words};
use crate::{
    model::{Model, catalog_table::Column, globe::NextPass},
    orbit::{Catalog, Elements},
    ui::format,
};

/// Minimum width of a table with all columns.
const ALL_FROM: f32 = 900.0;

/// A column with its left end, or its right end for numbers, in a table of the width that the
/// layout is made for.
type Placed = (Column, f32);

const ALL: (&[Placed], f32) = (
    &[
        (Column::Star, 40.0),
        (Column::Name, 70.0),
        (Column::Number, 350.0),
        (Column::Period, 420.0),
        (Column::Inclination, 484.0),
        (Column::Heights, 590.0),
        (Column::Age, 686.0),
        (Column::From, 704.0),
        (Column::NextPass, 920.0),
        (Column::MaxElevation, 1008.0),
    ],
    1024.0,
);
const FEWER: (&[Placed], f32) = (
    &[
        (Column::Star, 40.0),
        (Column::Name, 70.0),
        (Column::Number, 330.0),
        (Column::Age, 430.0),
        (Column::From, 450.0),
        (Column::NextPass, 680.0),
        (Column::MaxElevation, 768.0),
    ],
    784.0,
);

/// Width of the bar of a maximum elevation, for 90 degrees.
pub(super) const BAR: f32 = 40.0;
/// Room for the number behind the bar.
pub(super) const BAR_NUMBER: f32 = 34.0;
/// Gap between the time of the next pass and the bar.
const BAR_GAP: f32 = 12.0;

/// Returns `true` if the column is aligned to the left.
pub(super) fn is_left(column: Column) -> bool {
    matches!(column, Column::Star | Column::Name | Column::From)
}

/// The shown columns with their places in `row`. They spread with the table; names get the
/// room that is left.
pub(super) fn places(row: Rect) -> impl Iterator<Item = (Column, Rect)> {
    let (columns, laid_out) = if row.width() < ALL_FROM { FEWER } else { ALL };
    let scale = row.width() / laid_out;
    let last = columns.last().map_or(row.right(), |(_, end)| row.left() + end * scale);
    let end_of = move |column: Column, end: f32| match column {
        // The bar keeps its width in a narrow table.
        Column::NextPass => (row.left() + end * scale).min(last - BAR - BAR_NUMBER - BAR_GAP),
        _ => row.left() + end * scale,
    };
    columns.iter().enumerate().map(move |(index, (column, end))| {
        let x = match column {
            Column::Star => row.left() + end,
            Column::Name => row.left() + PADDING + 54.0,
            column => end_of(*column, *end),
        };
        let neighbour = |by: usize| columns.get(by).map(|(column, end)| end_of(*column, *end));
        let place = match column {
            Column::Star => row.with_min_x(x).with_max_x(x + 20.0),
            Column::Name => {
                let to = neighbour(index + 1).unwrap_or(row.right()) - 84.0;
                row.with_min_x(x).with_max_x(to)
            }
            Column::From => {
                let to = neighbour(index + 1).unwrap_or(row.right()) - 92.0;
                row.with_min_x(x).with_max_x(to)
            }
            Column::MaxElevation => row.with_min_x(x - BAR - BAR_NUMBER).with_max_x(x),
            _ => row.with_min_x(x - 96.0).with_max_x(x),
        };
        (*column, place)
    })
}

pub(super) fn head(column: Column) -> &'static str {
    match column {
        Column::Star => "",
        Column::Name => "Name",
        Column::Number => "Number",
        Column::Period => "Period min",
        Column::Inclination => "Incl. °",
        Column::Heights => "Apo × per km",
        Column::Age => "Epoch age",
        Column::From => "From",
        Column::NextPass => "Next pass",
        Column::MaxElevation => "Max el",
    }
}

/// The column for screen readers.
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

/// The next pass of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Next {
    /// Not searched for yet.
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

/// A row with what its cells say.
pub(super) struct Row<'a> {
    pub(super) elements: &'a Elements,
    pub(super) from: &'a str,
    /// An older set is in use by choice of the operator.
    pub(super) is_older_set: bool,
    pub(super) next: Next,
    pub(super) now: Timestamp,
}

impl<'a> Row<'a> {
    pub(super) fn new(elements: &'a Elements, catalog: &'a Catalog, model: &Model) -> Self {
        let number = elements.catalog_number();
        let next = model.catalog_table.next.as_ref();
        Self {
            elements,
            from: catalog.source_of(number).unwrap_or_default(),
            is_older_set: catalog.set_aside(number).is_some(),
            next: next.map_or(Next::Unknown, |next| {
                next.get(number, model.now).map_or(Next::Never, Next::At)
            }),
            now: model.now,
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
            Column::Heights => words::heights(elements.heights()),
            Column::Age => words::age(elements.age_s(self.now)),
            Column::From => self.from.to_owned(),
            Column::NextPass => words::next_pass(self.next, self.now),
            Column::MaxElevation => self
                .next
                .pass()
                .map_or_else(String::new, |next| format::degrees(next.max_elevation.degrees(), 0)),
        }
    }

    /// The row for screen readers.
    pub(super) fn spoken(&self, priority: Option<u8>) -> String {
        let cell = |column| self.cell(column);
        let star = priority.map(|of| format!(", favourite of priority {of}")).unwrap_or_default();
        let choice = if self.is_older_set { ", an older set by choice" } else { "" };
        format!(
            "{}, {}, elements {} old, from {}{choice}, next pass {}{star}",
            cell(Column::Name),
            self.elements.catalog_number(),
            cell(Column::Age),
            self.from,
            cell(Column::NextPass),
        )
    }

    /// The columns that a narrow table leaves out.
    pub(super) fn tip(&self) -> String {
        let cell = |column| self.cell(column);
        let designator = self.elements.international_designator().unwrap_or("no designator");
        format!(
            "{}\n{}, {designator}\nPeriod {} min, inclination {}°\nApogee × perigee {} km",
            cell(Column::Name),
            self.elements.catalog_number(),
            cell(Column::Period),
            cell(Column::Inclination),
            cell(Column::Heights),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{pos2, vec2};

    #[test]
    fn the_bar_of_the_elevation_leaves_the_time_of_the_pass_free() {
        for width in (600..2600_u16).step_by(20) {
            let row = Rect::from_min_size(pos2(48.0, 0.0), vec2(f32::from(width), 25.0));
            let place_of = |wanted| places(row).find(|(column, _)| *column == wanted).unwrap().1;
            let (time, bar) = (place_of(Column::NextPass), place_of(Column::MaxElevation));
            assert!(time.right() + 8.0 <= bar.left(), "{width}: {time:?} {bar:?}");
            let from = place_of(Column::From);
            assert!(from.width() > 40.0 && from.right() < time.right() - 60.0, "{width}: {from:?}");
        }
    }
}
