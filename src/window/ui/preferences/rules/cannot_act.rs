//! Reasons why a rule cannot act; some of them keep it from being saved.

use super::draft::{Of, RuleDraft, RulesDraft};
use crate::{
    station::{AntennaId, HoursOfDay},
    ui::preferences::satellites::draft::SatellitesDraft,
};

/// Antennas and satellites that the rules name, as edited.
pub(in crate::ui::preferences) struct Around<'a> {
    /// The antennas that stay.
    pub(in crate::ui::preferences) antennas: Vec<(AntennaId, String)>,
    /// Catalog numbers.
    pub(in crate::ui::preferences) favourites: Vec<u32>,
    pub(in crate::ui::preferences) satellites: &'a SatellitesDraft,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CannotAct {
    NoAntenna,
    NoSatellite,
    NoGroup,
    /// A field of the hours cannot be used.
    Hours,
    /// The group has no satellites.
    EmptyGroup(usize),
    /// Only favourites are planned.
    NoFavourite,
    /// An earlier rule, with this number, always decides.
    Behind(usize),
}

impl Around<'_> {
    pub(super) fn antenna(&self, id: AntennaId) -> Option<&str> {
        let known = self.antennas.iter().find(|(known, _)| *known == id);
        known.map(|(_, name)| name.as_str())
    }

    /// Name of a group that stays.
    pub(super) fn group(&self, index: usize) -> Option<String> {
        let mut kept = self.satellites.kept();
        kept.find(|(known, _)| *known == index).map(|(_, group)| group.title())
    }

    /// The satellites of a rule; `None` for all.
    fn members(&self, of: Of) -> Option<Vec<u32>> {
        match of {
            Of::All => None,
            Of::Satellite(number) => Some(number.into_iter().collect()),
            Of::Group(group) => {
                let members = group.and_then(|group| self.satellites.members(group));
                Some(members.unwrap_or_default().to_vec())
            }
        }
    }
}

impl CannotAct {
    /// Returns `true` if Azel could not read the rule back from the station file.
    pub(super) fn is_wrong(&self) -> bool {
        matches!(self, Self::NoAntenna | Self::NoSatellite | Self::NoGroup | Self::Hours)
    }

    /// Begins in the middle of a sentence.
    pub(super) fn words(self, around: &Around<'_>) -> String {
        match self {
            Self::NoAntenna => "its antenna is removed".to_owned(),
            Self::NoSatellite => "it names no satellite".to_owned(),
            Self::NoGroup => "it names a group that does not exist".to_owned(),
            Self::Hours => "its hours are not valid".to_owned(),
            Self::EmptyGroup(group) => {
                let name = around.group(group).unwrap_or_default();
                format!("the group {name} has no satellites")
            }
            Self::NoFavourite => {
                "it names no favourite, and only favourites are planned".to_owned()
            }
            Self::Behind(number) => format!("rule {number} decides before it"),
        }
    }
}

impl RulesDraft {
    /// Why a rule cannot act, once it is on.
    pub(super) fn cannot_act(&self, index: usize, around: &Around<'_>) -> Option<CannotAct> {
        let rule = self.all().get(index)?;
        wrong(rule, around).or_else(|| self.in_vain(index, rule, around))
    }

    /// Numbers of the rules that are on and cannot act although they can be saved, and why.
    pub(in crate::ui::preferences) fn idle(&self, around: &Around<'_>) -> Vec<(usize, String)> {
        let on = self.all().iter().enumerate().filter(|(_, rule)| rule.is_on);
        let of = |index: usize| {
            let number = self.number(index)?;
            let why = self.cannot_act(index, around).filter(|why| !why.is_wrong())?;
            Some((number, why.words(around)))
        };
        on.filter_map(|(index, _)| of(index)).collect()
    }

    fn in_vain(&self, index: usize, rule: &RuleDraft, around: &Around<'_>) -> Option<CannotAct> {
        let members = around.members(rule.of);
        match (rule.of, &members) {
            (Of::Group(Some(group)), Some(members)) if members.is_empty() => {
                return Some(CannotAct::EmptyGroup(group));
            }
            (_, Some(members)) if !members.iter().any(|of| around.favourites.contains(of)) => {
                return Some(CannotAct::NoFavourite);
            }
            _ => {}
        }
        let mut earlier = self.all().iter().enumerate().take(index);
        let hides = |other: &RuleDraft| {
            let acts = other.is_on && !other.is_removed && wrong(other, around).is_none();
            acts && covers(other, rule, around)
        };
        let (by, _) = earlier.find(|(_, other)| hides(other))?;
        self.number(by).map(CannotAct::Behind)
    }
}

/// Why a rule could not be read back from the station file.
pub(super) fn wrong(rule: &RuleDraft, around: &Around<'_>) -> Option<CannotAct> {
    if rule.antenna.is_some_and(|id| around.antenna(id).is_none()) {
        return Some(CannotAct::NoAntenna);
    }
    match rule.of {
        Of::Satellite(None) => return Some(CannotAct::NoSatellite),
        Of::Group(group) if group.and_then(|group| around.group(group)).is_none() => {
            return Some(CannotAct::NoGroup);
        }
        Of::All | Of::Satellite(_) | Of::Group(_) => {}
    }
    let is_wrong = rule.typed.read().1.iter().any(|standing| standing.problem.is_some());
    is_wrong.then_some(CannotAct::Hours)
}

/// Returns `true` if `first` applies wherever `second` does.
fn covers(first: &RuleDraft, second: &RuleDraft, around: &Around<'_>) -> bool {
    let [one, other] = [first, second].map(|rule| rule.typed.read().0);
    let has_satellites = match (around.members(first.of), around.members(second.of)) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some(first), Some(second)) => second.iter().all(|number| first.contains(number)),
    };
    let has_hours = match (one.hours(), other.hours()) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some(first), Some(second)) => is_within(second, first),
    };
    has_satellites
        && has_hours
        && first.antenna.is_none_or(|id| second.antenna == Some(id))
        && one.sun.is_none_or(|sun| other.sun == Some(sun))
}

/// Returns `true` if `inner` lies entirely within the hours of `outer`.
fn is_within(inner: HoursOfDay, outer: HoursOfDay) -> bool {
    const DAY_MIN: i32 = 24 * 60;
    let minute = |time: jiff::civil::Time| i32::from(time.hour()) * 60 + i32::from(time.minute());
    let after = |from, to| (minute(to) - minute(from)).rem_euclid(DAY_MIN);
    after(outer.start, inner.start) + after(inner.start, inner.end) <= after(outer.start, outer.end)
}
