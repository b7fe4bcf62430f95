//! Draft of the groups and of the priorities and limits of the favourites.

use std::borrow::Cow;

use super::followed::{self, Followed};
use crate::{
    station::{
        Antenna, AntennaId, Favourite, Favourites, PassLimits, Priority, SatelliteGroup, Station,
    },
    ui::preferences::{
        connection_fields::not_empty,
        draft::Draft,
        fields::{Description, Placed, Standing, Typed, placed},
        search::{self, Spot},
        section::{DraftSection, Finding},
    },
};

/// Title of the section of a group.
pub(super) const GROUP: &str = "Group";
const PRIORITIES: [Option<Priority>; 6] = {
    let [first, second, third, fourth, fifth] = Priority::ALL;
    [None, Some(first), Some(second), Some(third), Some(fourth), Some(fifth)]
};

#[derive(PartialEq)]
pub(in crate::ui::preferences) struct SatellitesDraft {
    pub(super) followed: Typed<Followed>,
    /// Own settings of each favourite. A field of the station lists the favourites. The settings of
    /// a removed favourite wait for its return.
    own: Favourites,
    groups: Vec<GroupDraft>,
}

/// A group. A removed group keeps its place among the groups.
#[derive(PartialEq)]
pub(in crate::ui::preferences) struct GroupDraft {
    was: Option<SatelliteGroup>,
    pub(super) named: Typed<Named>,
    pub(super) satellites: Vec<u32>,
    pub(super) limits: PassLimits,
    pub(in crate::ui::preferences) is_removed: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    name: String,
    priority: Option<Priority>,
}

/// Settings that a satellite gets from its groups.
pub(super) struct OfGroups {
    /// Priority, and the name of the group that sets it.
    pub(super) priority: Option<(Priority, String)>,
    pub(super) limits: PassLimits,
}

impl GroupDraft {
    fn new(group: &SatelliteGroup) -> Self {
        let named = Named { name: group.name.clone(), priority: group.priority };
        Self {
            was: Some(group.clone()),
            named: Typed::new(named, fields()),
            satellites: group.satellites.clone(),
            limits: group.limits.clone(),
            is_removed: false,
        }
    }

    fn added(name: String) -> Self {
        Self {
            was: None,
            named: Typed::new(Named { name, priority: None }, fields()),
            satellites: Vec::new(),
            limits: PassLimits::default(),
            is_removed: false,
        }
    }

    /// Returns the entered name, or the previous name if the field is empty.
    pub(in crate::ui::preferences) fn title(&self) -> String {
        let typed = self.named.name().trim();
        if typed.is_empty() { self.named.before().name.clone() } else { typed.to_owned() }
    }

    pub(super) fn priority(&self) -> Option<Priority> {
        self.named.read().0.priority
    }

    pub(super) fn has_other_satellites(&self) -> bool {
        let was = self.was.as_ref().map(|was| was.satellites.as_slice()).unwrap_or_default();
        was != self.satellites
    }

    #[cfg(test)]
    pub(in crate::ui::preferences) fn rename(&mut self, name: &str) {
        self.named.type_in("Name", name.to_owned());
    }

    fn edits(&self) -> usize {
        let Some(was) = &self.was else { return usize::from(!self.is_removed) };
        if self.is_removed {
            return 1;
        }
        self.named.edited()
            + usize::from(self.has_other_satellites())
            + usize::from(was.limits != self.limits)
    }
}

fn fields() -> Vec<Placed<Named>> {
    let fields = [
        Description::text("Name", not_empty, |named: &mut Named| Some(&mut named.name)),
        Description::choice(
            "Priority",
            &[(0, "Default"), (1, "1"), (2, "2"), (3, "3"), (4, "4"), (5, "5")],
            &PRIORITIES,
            |named: &mut Named| &mut named.priority,
        )
        .described("For those of its satellites that have none of their own."),
    ];
    placed(GROUP, fields)
}

impl SatellitesDraft {
    pub(in crate::ui::preferences) fn new(station: &Station) -> Self {
        Self {
            followed: Typed::new(Followed::new(station), followed::fields()),
            own: station.favourites.clone(),
            groups: station.groups.iter().map(GroupDraft::new).collect(),
        }
    }

    /// Returns the entered catalog numbers of the favourites.
    pub(in crate::ui::preferences) fn favourites(&self) -> Vec<u32> {
        self.followed.read().0.favourites.numbers()
    }

    /// Returns the own settings of a favourite.
    pub(super) fn own(&self, number: u32) -> Favourite {
        self.own.get(number).cloned().unwrap_or_else(|| Favourite::new(number))
    }

    pub(super) fn put(&mut self, favourite: Favourite) {
        self.own.put(favourite);
    }

    pub(in crate::ui::preferences) fn groups(&self) -> &[GroupDraft] {
        &self.groups
    }

    pub(in crate::ui::preferences) fn group_mut(
        &mut self,
        index: usize,
    ) -> Option<&mut GroupDraft> {
        self.groups.get_mut(index)
    }

    /// Returns the groups that stay, with their indices.
    pub(in crate::ui::preferences) fn remaining(
        &self,
    ) -> impl Iterator<Item = (usize, &GroupDraft)> {
        self.groups.iter().enumerate().filter(|(_, group)| !group.is_removed)
    }

    /// Returns the satellites of a group that stays.
    pub(in crate::ui::preferences) fn members(&self, group: usize) -> Option<&[u32]> {
        let group = self.groups.get(group).filter(|group| !group.is_removed)?;
        Some(&group.satellites)
    }

    /// Adds a group without satellites and returns its index.
    pub(super) fn add_group(&mut self) -> usize {
        let names: Vec<&str> = self.names().collect();
        let name = Antenna::free_name("Group", &names);
        self.groups.push(GroupDraft::added(name));
        self.groups.len() - 1
    }

    /// Returns the settings that a satellite gets from its groups.
    pub(super) fn of_groups(&self, number: u32) -> OfGroups {
        let mut found = OfGroups { priority: None, limits: PassLimits::default() };
        for (_, group) in self.remaining().filter(|(_, group)| group.satellites.contains(&number)) {
            let priority = || group.priority().map(|priority| (priority, group.title()));
            found.priority = found.priority.or_else(priority);
            found.limits = found.limits.or(&group.limits);
        }
        found
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.groups.iter().map(|group| group.named.name())
    }

    /// Returns the state of each field of a group. Its name must differ from the names of the other
    /// groups.
    pub(super) fn standings(&self, index: usize) -> Vec<Standing> {
        let Some(group) = self.groups.get(index) else { return Vec::new() };
        let others = self.remaining().filter(|(other, _)| *other != index);
        let names: Vec<&str> = self.names().collect();
        let reason = "must differ from those of the other groups";
        group.named.standings_among(others.map(|(_, other)| other.named.name()), &names, reason)
    }

    /// Returns the groups with invalid names.
    fn groups_findings(&self) -> impl Iterator<Item = Finding> {
        self.remaining().filter_map(|(index, group)| {
            let problem =
                self.standings(index).into_iter().find_map(|standing| standing.problem)?;
            Some(Finding { label: format!("Name of the group {}", group.title()), problem })
        })
    }
}

impl DraftSection for SatellitesDraft {
    /// Counts each changed priority and each changed row of limits as one edit.
    fn edits(&self, before: &Draft) -> usize {
        let of_favourite = |own: &Favourite| {
            let was = before.satellites.own(own.satellite);
            usize::from(was.priority != own.priority) + usize::from(was.limits != own.limits)
        };
        self.followed.edited()
            + self.own.iter().map(of_favourite).sum::<usize>()
            + self.groups.iter().map(GroupDraft::edits).sum::<usize>()
    }

    fn findings(&self, _: &Draft) -> Vec<Finding> {
        let mut all = self.followed.findings_in(&self.followed.read().1);
        all.extend(self.groups_findings());
        all
    }

    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        let mut all = self.followed.used_labels();
        all.extend(search::on_page(&super::LABELS));
        all.extend(self.remaining().map(|(_, group)| (group.title().into(), Spot::Page)));
        all
    }

    fn write(&mut self, label: &str, text: String) {
        self.followed.type_in(label, text);
    }

    /// Writes the settings into the station. Removes antennas from limits if the station no longer
    /// has them.
    fn put_into(&self, _: &Draft, station: &mut Station) -> Option<()> {
        if self.groups_findings().next().is_some() {
            return None;
        }
        let ids: Vec<AntennaId> = station.antennas.iter().map(|antenna| antenna.id).collect();
        let with_antennas = |limits: &PassLimits| PassLimits {
            antennas: limits
                .antennas
                .as_ref()
                .map(|named| named.iter().copied().filter(|id| ids.contains(id)).collect()),
            ..limits.clone()
        };
        let Followed { favourites, frequencies } = self.followed.valid()?;
        (station.favourites, station.frequencies) = (favourites, frequencies);
        for number in station.favourites.numbers() {
            let own = self.own(number);
            station.favourites.put(Favourite { limits: with_antennas(&own.limits), ..own });
        }
        let group = |(_, group): (usize, &GroupDraft)| {
            let Named { name, priority } = group.named.read().0;
            let satellites = group.satellites.clone();
            SatelliteGroup { name, satellites, priority, limits: with_antennas(&group.limits) }
        };
        station.groups = self.remaining().map(group).collect();
        Some(())
    }
}
