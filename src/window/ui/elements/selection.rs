//! The selected row and the marked objects of the table, by mouse and keys.

use std::collections::BTreeSet;

/// The row that the inspector shows, and the marked objects, independent of each other.
#[derive(Debug, Default)]
pub(super) struct Selection {
    row: Option<u32>,
    marked: BTreeSet<u32>,
    /// Start of a range.
    anchor: Option<u32>,
}

/// Effect of a click or key on a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// Selects it.
    Select,
    /// Selects it and marks the range from the anchor on.
    Range,
    /// Selects it and marks or unmarks it.
    Toggle,
}

impl Selection {
    /// Catalog number of the selected row.
    pub(super) fn row(&self) -> Option<u32> {
        self.row
    }

    /// Selects a row from outside the table.
    pub(super) fn select(&mut self, number: u32) {
        (self.row, self.anchor) = (Some(number), Some(number));
    }

    pub(super) fn is_marked(&self, number: u32) -> bool {
        self.marked.contains(&number)
    }

    /// The marked objects by number.
    pub(super) fn marked(&self) -> &BTreeSet<u32> {
        &self.marked
    }

    /// The marked objects, or the selected row if none is.
    pub(super) fn chosen(&self) -> Vec<u32> {
        if self.marked.is_empty() {
            return self.row.into_iter().collect();
        }
        self.marked.iter().copied().collect()
    }

    pub(super) fn choose(&mut self, number: u32, way: Way, rows: &[u32]) {
        match way {
            Way::Select => self.anchor = Some(number),
            Way::Toggle => {
                self.anchor = Some(number);
                if !self.marked.remove(&number) {
                    self.marked.insert(number);
                }
            }
            Way::Range => {
                let place = |of: u32| rows.iter().position(|row| *row == of);
                let to = place(number);
                let from = self.anchor.and_then(place).or(to);
                if let (Some(from), Some(to)) = (from, to) {
                    let range = from.min(to)..=from.max(to);
                    self.marked.extend(rows.get(range).unwrap_or_default());
                }
            }
        }
        self.row = Some(number);
    }

    /// Moves `down` rows from the selected one, or to the first if none is selected. Returns
    /// the place of the new row.
    pub(super) fn go(&mut self, down: isize, way: Way, rows: &[u32]) -> Option<usize> {
        let last = rows.len().checked_sub(1)?;
        let at = self.row.and_then(|row| rows.iter().position(|known| *known == row));
        let place = at.map_or(0, |at| at.saturating_add_signed(down).min(last));
        self.choose(*rows.get(place)?, way, rows);
        Some(place)
    }

    /// Marks or unmarks the selected row.
    pub(super) fn toggle(&mut self, rows: &[u32]) {
        if let Some(row) = self.row {
            self.choose(row, Way::Toggle, rows);
        }
    }

    pub(super) fn mark_all(&mut self, rows: &[u32]) {
        self.marked.extend(rows);
    }

    pub(super) fn unmark_all(&mut self) {
        self.marked.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [u32; 5] = [20, 5, 60, 9, 11];

    fn marked(selection: &Selection) -> Vec<u32> {
        selection.marked().iter().copied().collect()
    }

    #[test]
    fn marks_and_the_selected_row_are_independent() {
        let mut selection = Selection::default();
        selection.choose(5, Way::Select, &ROWS);
        assert_eq!((selection.row(), selection.chosen()), (Some(5), vec![5]));
        assert!(selection.marked().is_empty());
        selection.choose(9, Way::Range, &ROWS);
        assert_eq!((selection.row(), marked(&selection)), (Some(9), vec![5, 9, 60]));
        selection.choose(60, Way::Toggle, &ROWS);
        assert_eq!(marked(&selection), [5, 9]);
        selection.choose(20, Way::Select, &ROWS);
        assert_eq!(selection.chosen(), [5, 9]);
        selection.unmark_all();
        assert_eq!(selection.chosen(), [20]);
    }

    #[test]
    fn keys_go_over_the_rows_and_stay_among_them() {
        let mut selection = Selection::default();
        assert_eq!(selection.go(1, Way::Select, &ROWS), Some(0));
        assert_eq!(selection.go(2, Way::Select, &ROWS), Some(2));
        assert_eq!(selection.go(1, Way::Range, &ROWS), Some(3));
        assert_eq!(marked(&selection), [9, 60]);
        assert_eq!(selection.go(isize::MAX, Way::Select, &ROWS), Some(4));
        assert_eq!(selection.go(isize::MIN, Way::Select, &ROWS), Some(0));
        selection.toggle(&ROWS);
        assert_eq!(marked(&selection), [9, 20, 60]);
        assert_eq!(selection.go(1, Way::Select, &[]), None);
    }
}
