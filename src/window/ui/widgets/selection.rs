//! The selected row and the marked rows of a list, by mouse and keys.

use std::collections::{BTreeSet, VecDeque};

use egui::Modifiers;

use super::list::Step;

/// The keys of a list in the order of its rows.
pub trait Rows<K> {
    /// Returns the key of the row at `index`.
    fn key(&self, index: usize) -> Option<K>;
    /// Returns the place of a key. For a removed row, the error is the place from which the keys
    /// continue.
    fn place(&self, key: K) -> Result<usize, usize>;
    /// Returns the row that the first key press selects.
    fn start(&self) -> usize;
    fn count(&self) -> usize;
}

impl Rows<u32> for [u32] {
    fn key(&self, index: usize) -> Option<u32> {
        self.get(index).copied()
    }

    fn place(&self, key: u32) -> Result<usize, usize> {
        self.iter().position(|row| *row == key).ok_or(0)
    }

    fn start(&self) -> usize {
        0
    }

    fn count(&self) -> usize {
        <[u32]>::len(self)
    }
}

/// Rows in the order of their keys; the last row is the newest.
impl Rows<u64> for VecDeque<u64> {
    fn key(&self, index: usize) -> Option<u64> {
        self.get(index).copied()
    }

    fn place(&self, key: u64) -> Result<usize, usize> {
        self.binary_search(&key)
    }

    fn start(&self) -> usize {
        self.len().saturating_sub(1)
    }

    fn count(&self) -> usize {
        VecDeque::len(self)
    }
}

/// Effect of a click or key on a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// Selection of the row.
    Select,
    /// Selection of the row, and marks for the range from the anchor.
    Range,
    /// Selection of the row, with its mark toggled.
    Toggle,
}

impl From<Modifiers> for Choice {
    /// Returns the effect of a click.
    fn from(modifiers: Modifiers) -> Self {
        match modifiers {
            Modifiers { shift: true, .. } => Self::Range,
            Modifiers { command: true, .. } => Self::Toggle,
            _ => Self::Select,
        }
    }
}

impl From<Step> for Choice {
    fn from(step: Step) -> Self {
        if step.extends { Self::Range } else { Self::Select }
    }
}

/// Selection of rows with check boxes. The marks stay while another row is selected.
pub type BoxSelection<K> = Selection<K, true>;

/// Selection of rows without check boxes. The selected row is marked; only Shift and Ctrl mark
/// others.
pub type RowSelection<K> = Selection<K, false>;

/// The selected row and the marked rows.
#[derive(Debug)]
pub struct Selection<K, const HAS_BOXES: bool> {
    row: Option<K>,
    marked: BTreeSet<K>,
    /// Start of a range.
    anchor: Option<K>,
}

impl<K, const HAS_BOXES: bool> Default for Selection<K, HAS_BOXES> {
    fn default() -> Self {
        Self { row: None, marked: BTreeSet::new(), anchor: None }
    }
}

impl<K: Copy + Ord, const HAS_BOXES: bool> Selection<K, HAS_BOXES> {
    /// Returns the key of the selected row.
    pub fn row(&self) -> Option<K> {
        self.row
    }

    /// Selects a row from outside the list.
    pub fn select(&mut self, key: K) {
        (self.row, self.anchor) = (Some(key), Some(key));
    }

    pub fn is_marked(&self, key: K) -> bool {
        self.marked.contains(&key)
    }

    /// Returns the marked rows in the order of their keys.
    pub fn marked(&self) -> &BTreeSet<K> {
        &self.marked
    }

    /// Returns the marked rows, or the selected row if none is marked.
    pub fn chosen(&self) -> Vec<K> {
        if self.marked.is_empty() {
            return self.row.into_iter().collect();
        }
        self.marked.iter().copied().collect()
    }

    /// Chooses the row `key` of `rows`.
    pub fn choose(&mut self, key: K, choice: Choice, rows: &(impl Rows<K> + ?Sized)) {
        self.row = Some(key);
        let range = match (choice, self.anchor) {
            (Choice::Range, Some(anchor)) => rows.place(anchor).ok().zip(rows.place(key).ok()),
            _ => None,
        };
        if !HAS_BOXES && choice != Choice::Toggle {
            self.marked = BTreeSet::from([key]);
        }
        if let Some((start, end)) = range {
            let marked = (start.min(end)..=start.max(end)).filter_map(|index| rows.key(index));
            self.marked.extend(marked);
            return;
        }
        self.anchor = Some(key);
        let is_unmarked = choice == Choice::Toggle && self.marked.remove(&key);
        if choice != Choice::Select && !is_unmarked {
            self.marked.insert(key);
        }
    }

    /// Takes a step from the selected row. Returns the place of the new row.
    pub fn go(&mut self, step: Step, rows: &(impl Rows<K> + ?Sized)) -> Option<usize> {
        let place = match self.row.map(|row| rows.place(row)) {
            None => rows.start(),
            Some(Ok(start)) => step.target(start, rows.count())?,
            Some(Err(next)) => next.min(rows.count().checked_sub(1)?),
        };
        self.choose(rows.key(place)?, step.into(), rows);
        Some(place)
    }

    /// Marks or unmarks the selected row.
    pub fn toggle(&mut self, rows: &(impl Rows<K> + ?Sized)) {
        if let Some(row) = self.row {
            self.choose(row, Choice::Toggle, rows);
        }
    }

    /// Marks all of `rows`. Without check boxes, also sets the anchor to the first row and selects
    /// the last row.
    pub fn mark_all(&mut self, rows: &(impl Rows<K> + ?Sized)) {
        if !HAS_BOXES {
            self.marked.clear();
        }
        self.marked.extend((0..rows.count()).filter_map(|index| rows.key(index)));
        if !HAS_BOXES {
            self.anchor = rows.key(0);
            self.row = rows.count().checked_sub(1).and_then(|last| rows.key(last));
        }
    }

    pub fn unmark_all(&mut self) {
        self.marked.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [u32; 5] = [20, 5, 60, 9, 11];

    fn step(rows: isize) -> Step {
        Step { rows, extends: false }
    }

    fn extended(rows: isize) -> Step {
        Step { rows, extends: true }
    }

    fn marked<K: Copy + Ord, const BOXES: bool>(selection: &Selection<K, BOXES>) -> Vec<K> {
        selection.marked().iter().copied().collect()
    }

    #[test]
    fn marks_in_boxes_and_the_selected_row_are_independent() {
        let (mut selection, rows) = (BoxSelection::default(), ROWS.as_slice());
        selection.choose(5, Choice::Select, rows);
        assert_eq!((selection.row(), selection.chosen()), (Some(5), vec![5]));
        assert!(selection.marked().is_empty());
        selection.choose(9, Choice::Range, rows);
        assert_eq!((selection.row(), marked(&selection)), (Some(9), vec![5, 9, 60]));
        selection.choose(60, Choice::Toggle, rows);
        assert_eq!(marked(&selection), [5, 9]);
        selection.choose(20, Choice::Select, rows);
        assert_eq!(selection.chosen(), [5, 9]);
        selection.unmark_all();
        assert_eq!(selection.chosen(), [20]);
    }

    #[test]
    fn keys_go_over_the_rows_and_stay_among_them() {
        let (mut selection, rows) = (BoxSelection::default(), ROWS.as_slice());
        assert_eq!(selection.go(step(1), rows), Some(0));
        assert_eq!(selection.go(step(2), rows), Some(2));
        assert_eq!(selection.go(extended(1), rows), Some(3));
        assert_eq!(marked(&selection), [9, 60]);
        assert_eq!(selection.go(step(isize::MAX), rows), Some(4));
        assert_eq!(selection.go(step(isize::MIN), rows), Some(0));
        selection.toggle(rows);
        assert_eq!(marked(&selection), [9, 20, 60]);
        assert_eq!(selection.go(step(1), [].as_slice()), None);
    }

    fn lines() -> VecDeque<u64> {
        [2, 5, 6, 9, 11].into()
    }

    #[test]
    fn shift_selects_the_rows_between_and_a_click_ends_it() {
        let mut selection = RowSelection::default();
        selection.choose(9, Choice::Range, &lines());
        assert_eq!(marked(&selection), [9], "without a first one it is alone");
        selection.choose(5, Choice::Range, &lines());
        assert_eq!(marked(&selection), [5, 6, 9]);
        selection.choose(11, Choice::Range, &lines());
        assert_eq!(marked(&selection), [9, 11]);
        selection.choose(2, Choice::Select, &lines());
        assert_eq!(marked(&selection), [2]);
        selection.choose(6, Choice::Toggle, &lines());
        selection.choose(2, Choice::Toggle, &lines());
        assert_eq!(marked(&selection), [6]);
        selection.mark_all(&lines());
        assert_eq!((selection.row(), marked(&selection).len()), (Some(11), 5));
    }

    #[test]
    fn keys_begin_at_the_newest_line_and_where_a_line_was() {
        let mut selection = RowSelection::default();
        assert_eq!(selection.go(step(-1), &lines()), Some(4));
        assert_eq!(selection.go(step(-2), &lines()), Some(2));
        assert_eq!(selection.go(extended(1), &lines()), Some(3));
        assert_eq!(marked(&selection), [6, 9]);
        assert_eq!(selection.go(extended(isize::MIN), &lines()), Some(0));
        assert_eq!(marked(&selection), [2, 5, 6]);
        let later = VecDeque::from([5, 6, 9]);
        assert_eq!(selection.go(step(1), &later), Some(0));
        assert_eq!(selection.go(step(1), &VecDeque::new()), None);
    }
}
