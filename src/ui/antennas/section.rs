//! The parts of the settings of a Satrak, in the order in which the list shows
//! them.

use crate::controller::{satrak::GROUPS, settings::Group};

/// One card of the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Section {
    General,
    Gps,
    Window,
    Satellite,
    Clock,
    Checks,
    Service,
}

impl Section {
    pub(super) const ALL: [Self; 7] = [
        Self::General,
        Self::Gps,
        Self::Window,
        Self::Satellite,
        Self::Clock,
        Self::Checks,
        Self::Service,
    ];

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::General => "General",
            Self::Gps => "GPS",
            Self::Window => "Tracking window",
            Self::Satellite => "Satellite and TLE",
            Self::Clock => "Clock",
            Self::Checks => "Versions and faults",
            Self::Service => "Service",
        }
    }

    /// The keys of its groups.
    pub(super) fn groups(self) -> &'static [&'static str] {
        match self {
            Self::General => &["general"],
            Self::Gps => &["gps", "receiver"],
            Self::Window => &["window"],
            Self::Satellite => &["file", "web", "ftp"],
            Self::Clock => &["clock"],
            Self::Checks => &["versions", "position"],
            Self::Service => &["angles", "reduction", "image"],
        }
    }
}

/// The description of the group with this key.
pub(super) fn group(key: &str) -> Option<&'static Group> {
    GROUPS.iter().copied().find(|group| group.key == key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_group_of_a_unit_stands_in_one_section() {
        let shown: Vec<_> = Section::ALL.iter().flat_map(|section| section.groups()).collect();
        let known: Vec<_> = GROUPS.iter().map(|group| &group.key).collect();
        assert_eq!(shown, known);
    }
}
