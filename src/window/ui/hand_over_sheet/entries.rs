//! Table of the schedule's entries, in the order of execution.

mod row;

use maud::{Markup, html};
use row::Row;

use super::HandOverSheet;
use crate::ui::page::{SECTION_HEAD_MM, plot, section};

/// Heights of the line with a day and of a row, millimetres; equal to the values in the style
/// sheet.
const DAY_MM: f64 = 3.5;
const ROW_MM: f64 = 6.0;
/// Height of the line that counts the entries without room, millimetres.
const MORE_MM: f64 = 3.2;
const COLUMNS: usize = 3;

/// Returns `true` if a row has its day above it: at the top of a column, and at a change of the
/// day.
fn begins_day(rows: &[Row], index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|before| rows.get(before));
    before.map(|before| &before.day) != rows.get(index).map(|row| &row.day)
}

/// Returns the height of a column with these rows, millimetres.
fn column_mm(rows: &[Row]) -> f64 {
    let days = (0..rows.len()).filter(|index| begins_day(rows, *index)).count();
    // The heads of the column take the room of a row.
    ROW_MM * (rows.len() + 1) as f64 + DAY_MM * days as f64
}

/// Returns the number of rows that fit in a column.
fn fitting(rows: &[Row], room_mm: f64) -> usize {
    let fits = |count: &usize| column_mm(rows.get(..*count).unwrap_or_default()) <= room_mm;
    (1..=rows.len()).take_while(fits).count()
}

pub(super) struct Table {
    /// Rows in the order of execution.
    rows: Vec<Row>,
}

/// Rows of each column, and the number of rows that do not fit.
pub(super) struct LaidOut<'a> {
    passes: usize,
    columns: Vec<&'a [Row]>,
    more: usize,
}

impl Table {
    pub(super) fn new(sheet: &HandOverSheet<'_>) -> Self {
        let entries = sheet.entries().into_iter();
        let mut rows: Vec<Row> = entries.map(|entry| Row::new(sheet, entry)).collect();
        rows.sort_by_key(|row| row.sets_out);
        Self { rows }
    }

    /// Lays all rows out in one wide column if they fit. Otherwise fills narrow columns, with two
    /// lines a row, as far as there is room.
    pub(super) fn lay_out(&self, room_mm: f64) -> LaidOut<'_> {
        let passes = self.rows.len();
        let room_mm = room_mm - SECTION_HEAD_MM;
        if column_mm(&self.rows) <= room_mm {
            return LaidOut { passes, columns: vec![&self.rows], more: 0 };
        }
        let even: Vec<&[Row]> = self.rows.chunks(passes.div_ceil(COLUMNS).max(1)).collect();
        if even.iter().all(|rows| column_mm(rows) <= room_mm) {
            return LaidOut { passes, columns: even, more: 0 };
        }
        let mut left = &self.rows[..];
        let mut columns = Vec::new();
        for _ in 0..COLUMNS {
            let (column, rest) = left.split_at(fitting(left, room_mm - MORE_MM));
            columns.push(column);
            left = rest;
        }
        LaidOut { passes, columns, more: left.len() }
    }
}

impl LaidOut<'_> {
    pub(super) fn height_mm(&self) -> f64 {
        let highest = self.columns.iter().map(|rows| column_mm(rows)).fold(0.0, f64::max);
        let more_mm = if self.more > 0 { MORE_MM } else { 0.0 };
        SECTION_HEAD_MM + highest + more_mm
    }

    pub(super) fn html(&self) -> Markup {
        let is_dense = self.columns.len() > 1;
        let remark = format!(
            "Sky: north up, rings 0°, 30°, 60°, dot at AOS, thick where taken. Prio A: always. \
             Bold: spare below 1:00{}",
            if is_dense { ". *: shortened" } else { "" }
        );
        let name = match self.passes {
            0 => "No passes".to_owned(),
            1 => "1 pass".to_owned(),
            passes => format!("{passes} passes"),
        };
        let content = html! {
            div.columns.dense[is_dense].wide[!is_dense] {
                @for rows in self.columns.iter().filter(|rows| !rows.is_empty()) {
                    ol {
                        (heads(is_dense))
                        @for (index, row) in rows.iter().enumerate() {
                            @if begins_day(rows, index) { li.day { (row.day) } }
                            (pass(row, is_dense))
                        }
                    }
                }
            }
            @if self.more > 0 { p.more { "and " (self.more) " more in the list" } }
        };
        section("passes", &name, &remark, &content)
    }
}

fn heads(is_dense: bool) -> Markup {
    html! {
        li.pass.heads {
            span.sky {}
            div.line {
                span.name { "Satellite" }
                span.priority { @if is_dense { "P" } @else { "Prio" } }
                span.aos { "AOS" }
                span.los { "LOS" }
            }
            div.line {
                span.sets-out { "Sets out" }
                span.antenna { "Antenna" }
                span.max { "Max, az" }
                span.counts.number { @if is_dense { "Beam" } @else { "In beam" } }
                span.spare.number { "Spare" }
                span.shortened { "Shortened" }
            }
        }
    }
}

fn pass(row: &Row, is_dense: bool) -> Markup {
    let is_marked = is_dense && !row.shortened.is_empty();
    html! {
        li.pass {
            (plot::thumbnail(&row.whole, &row.part))
            div.line {
                span.name { (row.name) }
                span.priority { (row.priority) }
                span.aos { (row.aos) }
                span.los { (row.los) }
            }
            div.line {
                span.sets-out { (crate::ui::format::second_of_day(row.sets_out)) }
                span.antenna { (row.antenna) }
                span.max { (row.max) }
                span.counts.number { (row.counts) @if is_marked { "*" } }
                span.spare.number.bold[row.is_spare_short] { (row.spare) }
                span.shortened { (row.shortened) }
            }
        }
    }
}
