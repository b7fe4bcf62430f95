//! The satellites that the operator has marked, with their priorities and limits.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::{PassLimits, is_default};

/// The favourites in the operator's order, each satellite once.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Favourites(Vec<Favourite>);

/// A satellite that the operator has marked.
///
/// In the station file, it is a catalog number, or a table if it has other values.
#[derive(Debug, Clone, PartialEq)]
pub struct Favourite {
    /// Catalog number.
    pub satellite: u32,
    /// Own priority; `None` for the priority of its group, or else the default.
    pub priority: Option<Priority>,
    /// Own limits. The groups of the satellite provide the missing limits.
    pub limits: PassLimits,
    /// Names of the preferred sources of elements, the best first. If empty, Azel uses the newest
    /// elements of all sources.
    pub sources: Vec<String>,
}

/// Importance of a favourite, from 1, the most important, to 5.
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
    /// Returns the middle priority, which leaves room before and after it.
    fn default() -> Self {
        Self(3)
    }
}

impl TryFrom<i64> for Priority {
    type Error = NoPriority;

    fn try_from(number: i64) -> Result<Self, NoPriority> {
        let found = Self::ALL.into_iter().find(|priority| i64::from(priority.0) == number);
        found.ok_or(NoPriority)
    }
}

impl From<Priority> for i64 {
    fn from(priority: Priority) -> Self {
        i64::from(priority.0)
    }
}

impl Favourite {
    /// Returns a favourite without its own priority or limits.
    pub fn new(satellite: u32) -> Self {
        Self { satellite, priority: None, limits: PassLimits::default(), sources: Vec::new() }
    }
}

impl Favourites {
    pub fn contains(&self, satellite: u32) -> bool {
        self.get(satellite).is_some()
    }

    pub fn get(&self, satellite: u32) -> Option<&Favourite> {
        self.0.iter().find(|favourite| favourite.satellite == satellite)
    }

    pub fn iter(&self) -> impl Iterator<Item = &Favourite> {
        self.0.iter()
    }

    /// Returns the catalog numbers.
    pub fn numbers(&self) -> Vec<u32> {
        self.iter().map(|favourite| favourite.satellite).collect()
    }

    /// Marks a satellite, or replaces its entry.
    pub fn put(&mut self, favourite: Favourite) {
        match self.0.iter_mut().find(|entry| entry.satellite == favourite.satellite) {
            Some(existing) => *existing = favourite,
            None => self.0.push(favourite),
        }
    }

    /// Marks a satellite and sets its priority.
    pub fn set_priority(&mut self, satellite: u32, priority: Priority) {
        let previous = self.get(satellite).cloned();
        let favourite = previous.unwrap_or_else(|| Favourite::new(satellite));
        self.put(Favourite { priority: Some(priority), ..favourite });
    }

    /// Marks a satellite and sets its limits.
    pub fn set_limits(&mut self, satellite: u32, limits: PassLimits) {
        let previous = self.get(satellite).cloned();
        let favourite = previous.unwrap_or_else(|| Favourite::new(satellite));
        self.put(Favourite { limits, ..favourite });
    }

    /// Sets the order of sources of a satellite. Marks the satellite if the order names any source.
    pub fn set_sources(&mut self, satellite: u32, sources: Vec<String>) {
        let previous = self.get(satellite).cloned();
        if previous.is_some() || !sources.is_empty() {
            let favourite = previous.unwrap_or_else(|| Favourite::new(satellite));
            self.put(Favourite { sources, ..favourite });
        }
    }

    /// Returns the order of sources of each satellite that has one, by catalog number.
    pub fn source_orders(&self) -> BTreeMap<u32, Vec<String>> {
        let ordered = self.iter().filter(|favourite| !favourite.sources.is_empty());
        ordered.map(|favourite| (favourite.satellite, favourite.sources.clone())).collect()
    }

    /// Marks or unmarks a satellite.
    pub fn mark(&mut self, satellite: u32, is_favourite: bool) {
        if !is_favourite {
            self.0.retain(|favourite| favourite.satellite != satellite);
        } else if !self.contains(satellite) {
            self.put(Favourite::new(satellite));
        }
    }

    /// Returns these satellites in this order; existing favourites keep their entries.
    #[must_use]
    pub fn with_numbers(&self, numbers: &[u32]) -> Self {
        let mut list = Self::default();
        for number in numbers {
            let previous = self.get(*number).cloned();
            list.put(previous.unwrap_or_else(|| Favourite::new(*number)));
        }
        list
    }
}

/// Marks the satellites without their own priorities or limits.
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
        #[derive(Serialize)]
        struct Table<'a> {
            satellite: u32,
            #[serde(skip_serializing_if = "Option::is_none")]
            priority: Option<Priority>,
            #[serde(skip_serializing_if = "<[_]>::is_empty")]
            sources: &'a [String],
            #[serde(flatten)]
            limits: &'a PassLimits,
        }
        let Self { satellite, priority, limits, sources } = self;
        if priority.is_none() && is_default(limits) && sources.is_empty() {
            return satellite.serialize(out);
        }
        Table { satellite: *satellite, priority: *priority, sources, limits }.serialize(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_satellite_is_a_favourite_once_and_keeps_what_is_known_of_it() {
        let first = Priority::try_from(1).unwrap();
        let mut list = Favourites::from([7, 5, 7]);
        assert_eq!(list.numbers(), [7, 5]);
        list.set_priority(5, first);
        list.mark(5, true);
        let priority = |list: &Favourites, number| list.get(number).unwrap().priority;
        assert_eq!((priority(&list, 5), priority(&list, 7)), (Some(first), None));
        list = list.with_numbers(&[9, 5]);
        assert_eq!((list.numbers(), priority(&list, 5)), (vec![9, 5], Some(first)));
        list.mark(5, false);
        assert!(!list.contains(5) && list.contains(9));
        assert!(Priority::try_from(0).is_err() && Priority::try_from(6).is_err());
    }
}
