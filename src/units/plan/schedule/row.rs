//! Worth of a schedule: one number per class, compared from the first class on.

use std::{
    iter::Sum,
    ops::{Add, AddAssign, Sub},
};

use serde::{Deserialize, Serialize};

use crate::station::{ChooseBy, Priority};

/// Class of a number in the row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// Entries that can no longer change.
    Fixed,
    /// Passes that the operator has set to always.
    Always,
    /// Passes of satellites with this priority.
    Priority(Priority),
    /// All other passes, if the rule ignores priorities.
    All,
    /// Entries of the previous schedule.
    Kept,
}

/// Numbers of the classes, then the counted milliseconds, then the negated slews and times of AOS.
/// The first different number decides which of two rows is greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Row([i64; Self::LEN]);

impl Row {
    pub(super) const ZERO: Self = Self([0; Self::LEN]);
    /// Number of classes; later numbers break ties.
    pub(super) const CLASSES: usize = 8;
    const LEN: usize = Self::CLASSES + 3;
    const COUNTED: usize = Self::CLASSES;
    const SLEW: usize = Self::CLASSES + 1;
    const AOS: usize = Self::CLASSES + 2;

    /// Returns a row with only this number in `class`.
    pub(super) fn new(class: Class, number: i64) -> Self {
        Self::single(class.index(), number)
    }

    /// Returns a row with one number, by the index of its class.
    pub(super) fn single(class: usize, number: i64) -> Self {
        let mut row = Self::ZERO;
        if let Some(cell) = row.0.get_mut(class) {
            *cell = number;
        }
        row
    }

    /// Adds the counted time, which breaks ties between equal worths, milliseconds.
    pub(super) fn counting(self, counted_ms: i64) -> Self {
        self.with_number(Self::COUNTED, counted_ms)
    }

    pub(super) fn slewed(mut self, slew_ms: i64) -> Self {
        self.0[Self::SLEW] -= slew_ms;
        self
    }

    pub(super) fn risen(mut self, aos_ms: i64) -> Self {
        self.0[Self::AOS] -= aos_ms;
        self
    }

    pub(super) fn slew_ms(&self) -> i64 {
        -self.0[Self::SLEW]
    }

    pub(super) fn number(&self, class: usize) -> i64 {
        self.0.get(class).copied().unwrap_or_default()
    }

    /// Returns the numbers of the classes, without the tie-breakers.
    #[cfg(test)]
    pub(super) fn classes(&self) -> &[i64] {
        self.0.split_at(Self::CLASSES).0
    }

    /// Returns the numbers that no slew changes, except for the last one.
    pub(super) fn before_slews(&self) -> &[i64] {
        self.0.split_at(Self::SLEW).0
    }

    /// Returns the index of the first class with a number, or [`Self::CLASSES`].
    pub(super) fn first_class(&self) -> usize {
        let mut classes = self.0.iter().take(Self::CLASSES);
        classes.position(|number| *number != 0).unwrap_or(Self::CLASSES)
    }

    /// Returns the row with another number in the cell of a class.
    pub(super) fn with_number(mut self, cell: usize, number: i64) -> Self {
        if let Some(cell) = self.0.get_mut(cell) {
            *cell = number;
        }
        self
    }
}

impl Class {
    /// Returns the class of a pass that is taken by its worth.
    pub(super) fn by_plan(choose_by: ChooseBy, priority: Priority) -> Self {
        match choose_by {
            ChooseBy::Elevation | ChooseBy::Duration => Self::Priority(priority),
            ChooseBy::MostPasses | ChooseBy::MostMinutes => Self::All,
        }
    }

    /// Returns the classes that the operator sees, in the order of the row.
    pub(super) fn shown(choose_by: ChooseBy) -> Vec<Self> {
        let by_plan = |priority| Self::by_plan(choose_by, priority);
        let mut classes = vec![Self::Always];
        classes.extend(Priority::ALL.into_iter().map(by_plan));
        classes.dedup();
        classes
    }

    pub(super) fn index(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Always => 1,
            // `All` takes the place of the first priority, because no rule uses priorities and
            // `All` together.
            Self::All => 2,
            Self::Priority(priority) => 1 + usize::from(priority.number()),
            Self::Kept => Row::CLASSES - 1,
        }
    }
}

impl AddAssign for Row {
    fn add_assign(&mut self, other: Self) {
        for (cell, other) in self.0.iter_mut().zip(other.0) {
            *cell += other;
        }
    }
}

impl Add for Row {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sub for Row {
    type Output = Self;

    fn sub(mut self, other: Self) -> Self {
        for (cell, other) in self.0.iter_mut().zip(other.0) {
            *cell -= other;
        }
        self
    }
}

impl Sum for Row {
    fn sum<I: Iterator<Item = Self>>(rows: I) -> Self {
        rows.fold(Self::ZERO, Self::add)
    }
}
