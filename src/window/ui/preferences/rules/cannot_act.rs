//! Reasons why a rule cannot act. Some of them also prevent saving the rule.

use super::draft::{DraftSubject, RuleDraft, RulesDraft};
use crate::{
    station::{AntennaId, HoursOfDay},
    ui::preferences::satellites::draft::SatellitesDraft,
};

/// Edited antennas and satellites that the rules can name.
pub(in crate::ui::preferences) struct RuleContext<'a> {
    /// The antennas that stay.
    pub(in crate::ui::preferences) antennas: Vec<(AntennaId, String)>,
    /// Catalog numbers of the favourites.
    pub(in crate::ui::preferences) favourites: Vec<u32>,
    pub(in crate::ui::preferences) satellites: &'a SatellitesDraft,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CannotAct {
    NoAntenna,
    NoSatellite,
    NoGroup,
    /// An invalid field of the hours.
    Hours,
    /// Index of a group without satellites.
    EmptyGroup(usize),
    /// No favourite among the satellites; the schedule takes only favourites.
    NoFavourite,
    /// Number of an earlier rule that always decides first.
    Behind(usize),
}

impl RuleContext<'_> {
    pub(super) fn antenna(&self, id: AntennaId) -> Option<&str> {
        let other = self.antennas.iter().find(|(antenna_id, _)| *antenna_id == id);
        other.map(|(_, name)| name.as_str())
    }

    /// Returns the name of a group that stays.
    pub(in crate::ui::preferences) fn group(&self, index: usize) -> Option<String> {
        let mut remaining = self.satellites.remaining();
        remaining.find(|(other, _)| *other == index).map(|(_, group)| group.title())
    }

    /// Returns the satellites of a rule; `None` for all satellites.
    fn members(&self, subject: DraftSubject) -> Option<Vec<u32>> {
        match subject {
            DraftSubject::All => None,
            DraftSubject::Satellite(number) => Some(number.into_iter().collect()),
            DraftSubject::Group(group) => {
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

    /// Returns the reason as a clause for the middle of a sentence.
    pub(super) fn words(self, context: &RuleContext<'_>) -> String {
        match self {
            Self::NoAntenna => "its antenna is removed".to_owned(),
            Self::NoSatellite => "it names no satellite".to_owned(),
            Self::NoGroup => "it names a group that does not exist".to_owned(),
            Self::Hours => "its hours are not valid".to_owned(),
            Self::EmptyGroup(group) => {
                let name = context.group(group).unwrap_or_default();
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
    /// Returns the reason why a rule cannot act when enabled.
    pub(super) fn cannot_act(&self, index: usize, context: &RuleContext<'_>) -> Option<CannotAct> {
        let rule = self.all().get(index)?;
        wrong(rule, context).or_else(|| self.in_vain(index, rule, context))
    }

    /// Returns number and reason of each enabled and valid rule that cannot act.
    pub(in crate::ui::preferences) fn idle(
        &self,
        context: &RuleContext<'_>,
    ) -> Vec<(usize, String)> {
        let on = self.all().iter().enumerate().filter(|(_, rule)| rule.is_on);
        let members = |index: usize| {
            let number = self.number(index)?;
            let reason = self.cannot_act(index, context).filter(|reason| !reason.is_wrong())?;
            Some((number, reason.words(context)))
        };
        on.filter_map(|(index, _)| members(index)).collect()
    }

    fn in_vain(
        &self,
        index: usize,
        rule: &RuleDraft,
        context: &RuleContext<'_>,
    ) -> Option<CannotAct> {
        let members = context.members(rule.subject);
        match (rule.subject, &members) {
            (DraftSubject::Group(Some(group)), Some(members)) if members.is_empty() => {
                return Some(CannotAct::EmptyGroup(group));
            }
            (_, Some(members))
                if !members.iter().any(|total| context.favourites.contains(total)) =>
            {
                return Some(CannotAct::NoFavourite);
            }
            _ => {}
        }
        let mut earlier = self.all().iter().enumerate().take(index);
        let hides = |other: &RuleDraft| {
            let acts = other.is_on && !other.is_removed && wrong(other, context).is_none();
            acts && covers(other, rule, context)
        };
        let (earlier_index, _) = earlier.find(|(_, other)| hides(other))?;
        self.number(earlier_index).map(CannotAct::Behind)
    }
}

/// Returns the reason why Azel could not read a rule back from the station file.
pub(super) fn wrong(rule: &RuleDraft, context: &RuleContext<'_>) -> Option<CannotAct> {
    if rule.antenna.is_some_and(|id| context.antenna(id).is_none()) {
        return Some(CannotAct::NoAntenna);
    }
    match rule.subject {
        DraftSubject::Satellite(None) => return Some(CannotAct::NoSatellite),
        DraftSubject::Group(group) if group.and_then(|group| context.group(group)).is_none() => {
            return Some(CannotAct::NoGroup);
        }
        DraftSubject::All | DraftSubject::Satellite(_) | DraftSubject::Group(_) => {}
    }
    let is_wrong = rule.typed.read().1.iter().any(|standing| standing.problem.is_some());
    is_wrong.then_some(CannotAct::Hours)
}

/// Returns `true` if `first` applies wherever `second` applies.
fn covers(first: &RuleDraft, second: &RuleDraft, context: &RuleContext<'_>) -> bool {
    let [one, other] = [first, second].map(|rule| rule.typed.read().0);
    let has_satellites = match (context.members(first.subject), context.members(second.subject)) {
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
    let after = |start, end| (minute(end) - minute(start)).rem_euclid(DAY_MIN);
    after(outer.start, inner.start) + after(inner.start, inner.end) <= after(outer.start, outer.end)
}
