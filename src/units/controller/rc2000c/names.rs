//! The list of stored satellites, which Azel reads entry by entry.

use crate::protocol::rc2000c::{NameEntry, NameIndex, SatelliteName};

/// The entries of the list that Azel has read on this link.
#[derive(Debug, Default)]
pub(super) struct SatelliteNames {
    read: Vec<SatelliteName>,
    /// Number of entries, once an entry or a refusal has shown it.
    count: Option<u8>,
}

impl SatelliteNames {
    /// Returns the next entry to ask for; `None` once all entries were read.
    pub(super) fn next(&self) -> Option<NameIndex> {
        if self.is_complete() {
            return None;
        }
        NameIndex::new(u8::try_from(self.read.len() + 1).ok()?).ok()
    }

    /// Takes an entry. If the unit answers with another entry, its list cannot be read and ends.
    pub(super) fn take(&mut self, entry: &NameEntry) {
        if self.next().is_some_and(|next| next.number() == entry.index) {
            self.read.push(entry.name);
            self.count = Some(entry.count);
        } else {
            self.end();
        }
    }

    /// Ends the list here, because the unit says so or does not answer.
    pub(super) fn end(&mut self) {
        self.count = u8::try_from(self.read.len()).ok();
    }

    pub(super) fn is_complete(&self) -> bool {
        self.count.is_some_and(|count| self.read.len() >= usize::from(count))
    }

    pub(super) fn read(&self) -> &[SatelliteName] {
        &self.read
    }

    /// Returns the stored name that the operator means, regardless of case and surrounding blanks.
    pub(super) fn find(&self, typed: &str) -> Option<SatelliteName> {
        let is_meant =
            |name: &&SatelliteName| name.as_str().trim().eq_ignore_ascii_case(typed.trim());
        self.read.iter().find(is_meant).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(index: u8, count: u8, name: &str) -> NameEntry {
        NameEntry { index, count, name: SatelliteName::new(name).unwrap() }
    }

    #[test]
    fn entries_are_asked_for_one_by_one() {
        let mut names = SatelliteNames::default();
        assert_eq!(names.next().map(NameIndex::number), Some(1));
        names.take(&entry(1, 2, "SBS 6"));
        assert!(!names.is_complete());
        names.take(&entry(2, 2, " GALAXY 5"));
        assert!(names.is_complete() && names.next().is_none());
        assert_eq!(names.find("galaxy 5").unwrap().as_str(), " GALAXY 5");
        assert_eq!(names.find("GALAXY"), None);
    }

    #[test]
    fn a_refusal_and_a_wrong_entry_end_the_list_where_it_is() {
        let mut names = SatelliteNames::default();
        names.end();
        assert!(names.is_complete() && names.read().is_empty());
        let mut names = SatelliteNames::default();
        names.take(&entry(1, 3, "SBS 6"));
        names.take(&entry(1, 3, "SBS 6"));
        assert!(names.is_complete() && names.read().len() == 1);
    }
}
