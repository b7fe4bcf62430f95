//! Where the cells of a row stand, in one line or in two.

use super::{DAY, Density, Layout, begins_day, row::Row};
use crate::ui::{
    format,
    sheet::{
        CAPTION, SMALL, sky,
        svg::{Anchor, Face, Svg, wrapped},
    },
};

/// Space between the edge of a row and the circle of its sky.
const AROUND: f64 = 1.0;
/// Width of the name of a column of numbers.
const HEAD: f64 = 30.0;
/// Between two lines of one cell.
const LINE: f64 = 7.4;

/// A cell: its left edge from the left of the row, its line, and its width.
#[derive(Debug, Clone, Copy)]
struct Cell {
    x: f64,
    line: usize,
    width: f64,
    is_number: bool,
}

impl Cell {
    const fn text(x: f64, line: usize, width: f64) -> Self {
        Self { x, line, width, is_number: false }
    }

    /// A number, which stands at the right edge.
    const fn number(x: f64, line: usize, width: f64) -> Self {
        Self { x, line, width, is_number: true }
    }

    /// The cell with this width to its right edge.
    fn reaching(self, width: f64) -> Self {
        Self { x: self.x + self.width - width, width, ..self }
    }

    fn draw(self, svg: &mut Svg, [left, base]: [f64; 2], face: Face, words: &str) {
        if self.is_number {
            let right = face.anchored(Anchor::End);
            svg.text([left + self.x + self.width, base], self.width, right, words);
        } else {
            svg.text([left + self.x, base], self.width, face, words);
        }
    }
}

/// The cells of a row.
struct Cells {
    sets_out: Cell,
    aos: Cell,
    max: Cell,
    los: Cell,
    name: Cell,
    priority: Cell,
    antenna: Cell,
    counts: Cell,
    spare: Cell,
    /// With the most lines that it takes; `None` where there is only room for a mark.
    shortened: Option<(Cell, usize)>,
}

const WIDE: Cells = Cells {
    sets_out: Cell::text(30.0, 0, 40.0),
    aos: Cell::text(74.0, 0, 40.0),
    max: Cell::text(118.0, 0, 54.0),
    los: Cell::text(176.0, 0, 40.0),
    name: Cell::text(220.0, 0, 98.0),
    priority: Cell::text(322.0, 0, 16.0),
    antenna: Cell::text(342.0, 0, 60.0),
    counts: Cell::number(404.0, 0, 28.0),
    spare: Cell::number(433.0, 0, 37.0),
    shortened: Some((Cell::text(476.0, 0, 63.0), 2)),
};

const TWO: Cells = Cells {
    sets_out: Cell::text(28.0, 1, 36.0),
    aos: Cell::text(127.0, 0, 40.0),
    max: Cell::text(169.0, 0, 50.0),
    los: Cell::text(222.0, 0, 42.0),
    name: Cell::text(28.0, 0, 96.0),
    priority: Cell::text(127.0, 1, 16.0),
    antenna: Cell::text(67.0, 1, 56.0),
    counts: Cell::number(142.0, 1, 26.0),
    spare: Cell::number(170.0, 1, 32.0),
    shortened: Some((Cell::text(208.0, 1, 56.0), 1)),
};

const THREE: Cells = Cells {
    sets_out: Cell::text(20.0, 1, 32.0),
    aos: Cell::text(103.0, 0, 34.0),
    max: Cell::text(88.0, 1, 31.0),
    los: Cell::text(139.0, 0, 34.0),
    name: Cell::text(20.0, 0, 72.0),
    priority: Cell::text(93.0, 0, 8.0),
    antenna: Cell::text(53.0, 1, 34.0),
    counts: Cell::number(117.0, 1, 24.0),
    spare: Cell::number(141.0, 1, 31.0),
    shortened: None,
};

impl Density {
    fn cells(self) -> &'static Cells {
        match self.layout {
            Layout::Wide => &WIDE,
            Layout::Two => &TWO,
            Layout::Three => &THREE,
        }
    }

    /// Returns where the column ends.
    pub(super) fn draw_column(
        self,
        svg: &mut Svg,
        [left, top]: [f64; 2],
        width: f64,
        rows: &[Row],
    ) -> f64 {
        if rows.is_empty() {
            return top;
        }
        self.draw_heads(svg, [left, top]);
        let mut y = top + self.layout.head();
        for (row, index) in rows.iter().zip(0..) {
            if begins_day(rows, index) {
                svg.text([left, y + 7.0], width, SMALL.bold(), &row.day);
                y += DAY;
                svg.line([left, y - 0.2], [left + width, y - 0.2], 0.15);
            }
            self.draw(svg, [left, y], row);
            y += self.row;
            svg.line([left, y - 0.2], [left + width, y - 0.2], 0.15);
        }
        y
    }

    fn draw_heads(self, svg: &mut Svg, [x, y]: [f64; 2]) {
        let cells = self.cells();
        let priority = if matches!(self.layout, Layout::Three) { "P" } else { "Prio" };
        let heads = [
            (cells.sets_out, "Sets out"),
            (cells.aos, "AOS"),
            (cells.max, "Max, az"),
            (cells.los, "LOS"),
            (cells.name, "Satellite"),
            (cells.priority, priority),
            (cells.antenna, "Antenna"),
            (cells.counts, "In beam"),
            (cells.spare, "Spare"),
        ];
        let shortened = cells.shortened.map(|(cell, _)| (cell, "Shortened"));
        for (cell, word) in heads.into_iter().chain(shortened) {
            // A name may be wider than its numbers, which begin where nothing else is.
            let cell = if cell.is_number { cell.reaching(HEAD) } else { cell };
            cell.draw(svg, [x, y + 6.0 + 8.0 * cell.line as f64], CAPTION, word);
        }
    }

    fn draw(self, svg: &mut Svg, [x, y]: [f64; 2], row: &Row) {
        let (radius, middle) = (self.row / 2.0 - AROUND, y + self.row / 2.0);
        sky::draw(svg, [x + radius + AROUND, middle], radius, &row.track);
        let (first, second, lines) = match self.layout {
            Layout::Wide => (Face::of(7.5), Face::of(7.5), [middle + 2.7, middle + 2.7]),
            Layout::Two | Layout::Three => (Face::of(7.0), SMALL, [middle - 1.2, middle + 6.2]),
        };
        let cells = self.cells();
        let mut put = |cell: Cell, words: &str| {
            let (base, face) = if cell.line == 0 { (lines[0], first) } else { (lines[1], second) };
            cell.draw(svg, [x, base], face, words);
        };
        put(cells.sets_out, &format::second_of_day(row.sets_out));
        put(cells.aos, &row.aos);
        put(cells.los, &row.los);
        put(cells.priority, &row.priority);
        put(cells.antenna, &row.antenna);
        put(cells.max, &row.max);
        let is_marked = cells.shortened.is_none() && !row.shortened.is_empty();
        let mark = if is_marked { "*" } else { "" };
        put(cells.counts, &format!("{}{mark}", row.counts));
        let name_size = if matches!(self.layout, Layout::Three) { SMALL } else { first };
        let Cell { x: name_x, width, .. } = cells.name;
        svg.name([x + name_x, lines[0]], width, name_size.bold(), &row.name);
        let spare = if row.is_spare_short { second.bold() } else { second };
        cells.spare.draw(svg, [x, lines[1]], spare, &row.spare);
        if let Some((cell, most)) = cells.shortened {
            let parts = wrapped(&row.shortened, cell.width, SMALL, most);
            let first = lines[1] - LINE / 2.0 * parts.len().saturating_sub(1) as f64;
            for (words, line) in parts.iter().zip(0..) {
                cell.draw(svg, [x, first + LINE * f64::from(line)], SMALL, words);
            }
        }
    }
}
