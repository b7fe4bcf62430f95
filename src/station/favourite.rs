//! The satellites that the operator has marked, each with its priority.

use serde::{Serialize, Serializer, ser::SerializeStruct as _};

/// The favourites in the operator's order, each satellite once.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Favourites(Vec<Favourite>);

/// A satellite that the operator has marked.
///
/// In the station file it is a catalog number, or a table where its priority is not the default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Favourite {
    /// Catalog number.
    pub satellite: u32,
    pub priority: Priority,
}

/// Importance of a favourite, from 1, the first, to 5.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, serde::Deserialize,
)]
#[serde(try_from = "i64", into = "i64")]
pub struct Priority(u8);

#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("must be a number from 1 to 5")]
pub struct NoPriority;

impl Priority {
    pub const ALL: [Self; 5] = [Self(1), Self(2), Self(3), Self(4), Self(5)];

    pub fn number(self) -> u8 {
        self.0
    }
}

impl Default for Priority {
    /// The middle: some favourites come before and some after.
    fn default() -> Self {
        Self(3)
    }
}

impl TryFrom<i64> for Priority {
    type Error = NoPriority;

    fn try_from(number: i64) -> Result<Self, NoPriority> {
        let known = Self::ALL.into_iter().find(|known| i64::from(known.0) == number);
        known.ok_or(NoPriority)
    }
}

impl From<Priority> for i64 {
    fn from(priority: Priority) -> Self {
        i64::from(priority.0)
    }
}

impl Favourites {
    pub fn contains(&self, satellite: u32) -> bool {
        self.priority(satellite).is_some()
    }

    /// The priority of a satellite; `None` where it is no favourite.
    pub fn priority(&self, satellite: u32) -> Option<Priority> {
        let found = self.0.iter().find(|favourite| favourite.satellite == satellite);
        found.map(|favourite| favourite.priority)
    }

    pub fn iter(&self) -> impl Iterator<Item = Favourite> {
        self.0.iter().copied()
    }

    /// Catalog numbers.
    pub fn numbers(&self) -> Vec<u32> {
        self.iter().map(|favourite| favourite.satellite).collect()
    }

    /// Marks a satellite, or changes its priority.
    pub fn put(&mut self, satellite: u32, priority: Priority) {
        match self.0.iter_mut().find(|favourite| favourite.satellite == satellite) {
            Some(known) => known.priority = priority,
            None => self.0.push(Favourite { satellite, priority }),
        }
    }

    /// Marks a satellite with the default priority, or unmarks it.
    pub fn mark(&mut self, satellite: u32, is_favourite: bool) {
        if !is_favourite {
            self.0.retain(|favourite| favourite.satellite != satellite);
        } else if !self.contains(satellite) {
            self.put(satellite, Priority::default());
        }
    }

    /// These satellites in this order; those that are favourites keep their priority.
    #[must_use]
    pub fn with_numbers(&self, numbers: &[u32]) -> Self {
        let mut list = Self::default();
        for number in numbers {
            list.put(*number, self.priority(*number).unwrap_or_default());
        }
        list
    }
}

/// Satellites of the default priority.
impl FromIterator<u32> for Favourites {
    fn from_iter<T: IntoIterator<Item = u32>>(numbers: T) -> Self {
        let mut list = Self::default();
        for number in numbers {
            list.mark(number, true);
        }
        list
    }
}

impl<const N: usize> From<[u32; N]> for Favourites {
    fn from(numbers: [u32; N]) -> Self {
        numbers.into_iter().collect()
    }
}

impl Serialize for Favourite {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        if self.priority == Priority::default() {
            return self.satellite.serialize(out);
        }
        let mut table = out.serialize_struct("Favourite", 2)?;
        table.serialize_field("satellite", &self.satellite)?;
        table.serialize_field("priority", &self.priority)?;
        table.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_satellite_is_a_favourite_once_and_keeps_its_priority() {
        let first = Priority::try_from(1).unwrap();
        let mut list = Favourites::from([7, 5, 7]);
        assert_eq!(list.numbers(), [7, 5]);
        list.put(5, first);
        list.mark(5, true);
        assert_eq!((list.priority(5), list.priority(7)), (Some(first), Some(Priority::default())));
        list = list.with_numbers(&[9, 5]);
        assert_eq!((list.numbers(), list.priority(5)), (vec![9, 5], Some(first)));
        list.mark(5, false);
        assert!(!list.contains(5) && list.contains(9));
        assert!(Priority::try_from(0).is_err() && Priority::try_from(6).is_err());
    }
}
