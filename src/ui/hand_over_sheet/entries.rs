//! The table of what the antennas take, in the order of execution.

mod cells;
mod row;

use row::Row;

use super::HandOverSheet;
use crate::ui::sheet::{
    LEFT, RIGHT, SECTION_HEAD, section,
    svg::{Face, Svg},
};

/// Height of the line with a day.
const DAY: f64 = 10.0;
/// Space between two columns.
const BETWEEN: f64 = 11.0;
/// Height of the line that counts what does not fit.
const FOOT: f64 = 9.0;

/// How the rows stand on the page.
#[derive(Debug, Clone, Copy)]
struct Density {
    layout: Layout,
    row: f64,
}

#[derive(Debug, Clone, Copy)]
enum Layout {
    /// One line a row.
    Wide,
    /// Two columns, two lines a row.
    Two,
    /// Three columns, two lines a row; that an entry is shortened is only marked.
    Three,
}

/// The roomiest first.
const DENSITIES: [Density; 5] = [
    Density { layout: Layout::Wide, row: 24.0 },
    Density { layout: Layout::Two, row: 24.0 },
    Density { layout: Layout::Two, row: 17.5 },
    Density { layout: Layout::Three, row: 17.5 },
    Density { layout: Layout::Three, row: 15.5 },
];

impl Layout {
    fn columns(self) -> usize {
        match self {
            Self::Wide => 1,
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// Height of the names of the columns.
    fn head(self) -> f64 {
        match self {
            Self::Wide => 9.0,
            Self::Two | Self::Three => 17.0,
        }
    }
}

impl Density {
    /// Height of a column with these rows.
    fn height(self, rows: &[Row]) -> f64 {
        let days = (0..rows.len()).filter(|index| begins_day(rows, *index)).count();
        self.layout.head() + DAY * days as f64 + self.row * rows.len() as f64
    }

    /// Number of rows that fit in a column.
    fn fitting(self, rows: &[Row], room: f64) -> usize {
        let fits = |count: &usize| self.height(rows.get(..*count).unwrap_or_default()) <= room;
        (1..=rows.len()).take_while(fits).count()
    }
}

/// Returns `true` if a row has its day above it: at the top of a column, and where the day changes.
fn begins_day(rows: &[Row], index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|before| rows.get(before));
    before.map(|before| &before.day) != rows.get(index).map(|row| &row.day)
}

pub(super) struct Table {
    /// In the order of execution.
    rows: Vec<Row>,
}

/// The rows of each column, and how many do not fit.
struct Laid<'a> {
    density: Density,
    columns: Vec<&'a [Row]>,
    more: usize,
}

impl Table {
    pub(super) fn of(sheet: &HandOverSheet<'_>) -> Self {
        let entries = sheet.entries().into_iter();
        let mut rows: Vec<Row> = entries.map(|entry| Row::of(sheet, entry)).collect();
        rows.sort_by_key(|row| row.sets_out);
        Self { rows }
    }

    /// Returns where the table ends.
    pub(super) fn draw(&self, svg: &mut Svg, y: f64, room: f64) -> f64 {
        let top = y + SECTION_HEAD;
        let laid = self.laid(room - SECTION_HEAD);
        let layout = laid.density.layout;
        let mut said = "Sky: north up, rings 0°, 30°, 60°, dot at AOS, thick where taken. \
                        Prio A: always. Bold: spare below 1:00"
            .to_owned();
        if matches!(layout, Layout::Three) {
            said += ". *: shortened";
        }
        section(svg, y, &counted(self.rows.len()), &said);
        let width = (RIGHT - LEFT + BETWEEN) / layout.columns() as f64;
        let mut bottom = top;
        for (rows, column) in laid.columns.iter().zip(0..) {
            let at = [LEFT + width * f64::from(column), top];
            let end = laid.density.draw_column(svg, at, width - BETWEEN, rows);
            bottom = bottom.max(end);
        }
        if laid.more > 0 {
            let words = format!("and {} more in the list", laid.more);
            svg.text([LEFT, bottom + 7.0], RIGHT - LEFT, Face::of(7.0).bold(), &words);
            bottom += FOOT;
        }
        bottom
    }

    /// The roomiest way in which all fit; else as many as fit in the densest.
    fn laid(&self, room: f64) -> Laid<'_> {
        for density in DENSITIES {
            let in_one = self.rows.len().div_ceil(density.layout.columns()).max(1);
            let columns: Vec<&[Row]> = self.rows.chunks(in_one).collect();
            if columns.iter().all(|rows| density.height(rows) <= room) {
                return Laid { density, columns, more: 0 };
            }
        }
        let [.., density] = DENSITIES;
        let mut left = &self.rows[..];
        let mut columns = Vec::new();
        for _ in 0..density.layout.columns() {
            let (column, rest) = left.split_at(density.fitting(left, room - FOOT));
            columns.push(column);
            left = rest;
        }
        Laid { density, columns, more: left.len() }
    }
}

fn counted(passes: usize) -> String {
    match passes {
        0 => "No passes".to_owned(),
        1 => "1 pass".to_owned(),
        passes => format!("{passes} passes"),
    }
}
