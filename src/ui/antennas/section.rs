//! The parts of the settings of a unit, in the order in which the list shows
//! them. A Satrak has cards of its own; elsewhere each group is one.

use crate::controller::{
    Make,
    satrak::{self, GROUPS},
    settings::Group,
};

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
    /// A group of another make.
    Plain {
        /// Its key.
        keys: &'static [&'static str],
        title: &'static str,
        is_service: bool,
    },
}

impl Section {
    /// Those of a Satrak.
    pub(super) const ALL: [Self; 7] = [
        Self::General,
        Self::Gps,
        Self::Window,
        Self::Satellite,
        Self::Clock,
        Self::Checks,
        Self::Service,
    ];

    /// Those of a unit of this make.
    pub(super) fn of(make: &Make) -> Vec<Self> {
        if make.key == satrak::MAKE.key {
            return Self::ALL.to_vec();
        }
        let plain = |group: &&'static Group| Self::Plain {
            keys: std::slice::from_ref(&group.key),
            title: group.title,
            is_service: group.is_service,
        };
        make.groups.iter().map(plain).collect()
    }

    /// It opens only with the service functions.
    pub(super) fn is_service(self) -> bool {
        matches!(self, Self::Service | Self::Plain { is_service: true, .. })
    }

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::General => "General",
            Self::Gps => "GPS",
            Self::Window => "Tracking window",
            Self::Satellite => "Satellite and TLE",
            Self::Clock => "Clock",
            Self::Checks => "Versions and faults",
            Self::Service => "Service",
            Self::Plain { title, .. } => title,
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
            Self::Plain { keys, .. } => keys,
        }
    }
}

/// The description of the group of a Satrak with this key.
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

    #[test]
    fn another_make_has_a_section_for_each_of_its_groups() {
        for make in crate::makes::makes().filter(|make| make.key != satrak::MAKE.key) {
            let sections = Section::of(make);
            assert_eq!(sections.len(), make.groups.len());
            for (section, group) in sections.iter().zip(make.groups) {
                assert_eq!(
                    (section.groups(), section.title()),
                    ([group.key].as_slice(), group.title)
                );
            }
        }
    }
}
