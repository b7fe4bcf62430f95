//! The selection of lines, by mouse and keys.

use std::collections::{BTreeSet, VecDeque};

/// The selected lines, by position.
#[derive(Debug, Default)]
pub(super) struct Selection {
    chosen: BTreeSet<u64>,
    /// Start of a range.
    anchor: Option<u64>,
    /// The last chosen line.
    cursor: Option<u64>,
}

/// Mode of a selection step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// Selects only this line.
    Alone,
    /// Selects the range from the anchor to this line.
    Range,
    /// Adds or removes this line.
    Toggle,
}

impl Selection {
    /// The last chosen line.
    pub(super) fn cursor(&self) -> Option<u64> {
        self.cursor
    }

    pub(super) fn holds(&self, position: u64) -> bool {
        self.chosen.contains(&position)
    }

    /// The selected lines in `shown`.
    pub(super) fn among<'a>(&'a self, shown: &'a VecDeque<u64>) -> impl Iterator<Item = u64> + 'a {
        let is_shown = |position: &&u64| shown.binary_search(position).is_ok();
        self.chosen.iter().filter(is_shown).copied()
    }

    /// Chooses a line of `shown`.
    pub(super) fn choose(&mut self, position: u64, way: Way, shown: &VecDeque<u64>) {
        self.cursor = Some(position);
        let anchor = self.anchor.filter(|anchor| shown.binary_search(anchor).is_ok());
        match (way, anchor) {
            (Way::Range, Some(anchor)) => {
                let range = anchor.min(position)..=anchor.max(position);
                let start = shown.partition_point(|shown| shown < range.start());
                let within = shown.iter().skip(start).take_while(|shown| range.contains(shown));
                self.chosen = within.copied().collect();
            }
            (Way::Toggle, _) => {
                self.anchor = Some(position);
                if !self.chosen.remove(&position) {
                    self.chosen.insert(position);
                }
            }
            (Way::Alone, _) | (Way::Range, None) => {
                self.anchor = Some(position);
                self.chosen = BTreeSet::from([position]);
            }
        }
    }

    /// Moves `down` lines from the last chosen one, or to the newest line if there is none.
    /// Returns the index of the new line in `shown`.
    pub(super) fn go(&mut self, down: isize, way: Way, shown: &VecDeque<u64>) -> Option<usize> {
        let last = shown.len().checked_sub(1)?;
        let place = match self.cursor {
            None => last,
            Some(cursor) => {
                let at = shown.partition_point(|position| *position < cursor);
                at.saturating_add_signed(down).min(last)
            }
        };
        self.choose(*shown.get(place)?, way, shown);
        Some(place)
    }

    /// Chooses all lines of `shown`.
    pub(super) fn choose_all(&mut self, shown: &VecDeque<u64>) {
        self.chosen = shown.iter().copied().collect();
        self.anchor = shown.front().copied();
        self.cursor = shown.back().copied();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown() -> VecDeque<u64> {
        [2, 5, 6, 9, 11].into()
    }

    fn chosen(selection: &Selection) -> Vec<u64> {
        selection.among(&shown()).collect()
    }

    #[test]
    fn shift_selects_what_is_shown_between() {
        let mut selection = Selection::default();
        selection.choose(9, Way::Range, &shown());
        assert_eq!(chosen(&selection), [9], "without a first one it is alone");
        selection.choose(5, Way::Range, &shown());
        assert_eq!(chosen(&selection), [5, 6, 9]);
        selection.choose(11, Way::Range, &shown());
        assert_eq!(chosen(&selection), [9, 11]);
        selection.choose(2, Way::Alone, &shown());
        assert_eq!(chosen(&selection), [2]);
        selection.choose(6, Way::Toggle, &shown());
        selection.choose(2, Way::Toggle, &shown());
        assert_eq!(chosen(&selection), [6]);
    }

    #[test]
    fn keys_go_over_the_shown_lines_and_stay_among_them() {
        let mut selection = Selection::default();
        assert_eq!(selection.go(-1, Way::Alone, &shown()), Some(4));
        assert_eq!(selection.go(-2, Way::Alone, &shown()), Some(2));
        assert_eq!(selection.go(1, Way::Range, &shown()), Some(3));
        assert_eq!(chosen(&selection), [6, 9]);
        assert_eq!(selection.go(isize::MIN, Way::Range, &shown()), Some(0));
        assert_eq!(chosen(&selection), [2, 5, 6]);
        assert_eq!(selection.go(isize::MAX, Way::Alone, &shown()), Some(4));
        assert_eq!(selection.go(1, Way::Alone, &VecDeque::new()), None);
    }

    #[test]
    fn what_is_filtered_out_is_not_copied() {
        let mut selection = Selection::default();
        selection.choose_all(&shown());
        let fewer = VecDeque::from([5, 7]);
        assert_eq!(selection.among(&fewer).collect::<Vec<_>>(), [5]);
    }
}
