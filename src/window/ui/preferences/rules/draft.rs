//! Draft of the automation rules.

use std::borrow::Cow;

use super::cannot_act::{self, RuleContext};
use crate::{
    station::{AntennaId, AutomationRule, HoursOfDay, RuleAction, RuleSubject, Station, SunIs},
    ui::preferences::{
        draft::Draft,
        fields::{Description, Placed, Problem, Typed, placed},
        search::{self, Spot},
        section::{DraftSection, Finding},
    },
};

/// Titles of the sections of a rule.
pub(super) const WHEN: &str = "When";
pub(super) const ACTION_LABEL: &str = "Then";

/// The rules in their order. Rules that saving removes keep their place until then.
#[derive(PartialEq)]
pub(in crate::ui::preferences) struct RulesDraft(Vec<RuleDraft>);

#[derive(Clone, PartialEq)]
pub(super) struct Conditions {
    pub(super) sun: Option<SunIs>,
    pub(super) is_by_hours: bool,
    /// Hours of the rule, kept while the rule applies at all hours.
    pub(super) hours: HoursOfDay,
    pub(super) action: RuleAction,
}

/// The satellites of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DraftSubject {
    All,
    /// A satellite; `None` until the operator chooses one.
    Satellite(Option<u32>),
    /// Index of the draft of a group. The rule follows the name of the group.
    Group(Option<usize>),
}

#[derive(PartialEq)]
pub(super) struct RuleDraft {
    /// Index among the saved rules.
    was: Option<usize>,
    pub(super) is_on: bool,
    pub(super) antenna: Option<AntennaId>,
    pub(super) subject: DraftSubject,
    pub(super) typed: Typed<Conditions>,
    pub(super) is_removed: bool,
}

impl Conditions {
    pub(super) fn hours(&self) -> Option<HoursOfDay> {
        self.is_by_hours.then_some(self.hours)
    }
}

impl RuleDraft {
    fn new(rule: &AutomationRule, was: Option<usize>, station: &Station) -> Self {
        let group = |name: &String| station.groups.iter().position(|members| members.name == *name);
        let conditions = Conditions {
            sun: rule.sun,
            is_by_hours: rule.hours.is_some(),
            hours: rule.hours.unwrap_or(HoursOfDay::NIGHT),
            action: rule.action,
        };
        Self {
            was,
            is_on: rule.is_on,
            antenna: rule.antenna,
            subject: match &rule.subject {
                None => DraftSubject::All,
                Some(RuleSubject::Satellite(number)) => DraftSubject::Satellite(Some(*number)),
                Some(RuleSubject::Group(name)) => DraftSubject::Group(group(name)),
            },
            typed: Typed::new(conditions, fields()),
            is_removed: false,
        }
    }

    /// Returns the saved rule.
    pub(super) fn was_in<'a>(&self, before: &'a RulesDraft) -> Option<&'a Self> {
        self.was.and_then(|was| before.0.get(was))
    }

    fn edits(&self, before: &RulesDraft) -> usize {
        let Some(was) = self.was_in(before) else {
            return usize::from(!self.is_removed);
        };
        if self.is_removed {
            return 1;
        }
        self.typed.edited()
            + usize::from(was.is_on != self.is_on)
            + usize::from(was.antenna != self.antenna)
            + usize::from(was.subject != self.subject)
    }

    /// Returns the rule as entered, or `None` if the station file could not contain it.
    fn read(&self, context: &RuleContext<'_>) -> Option<AutomationRule> {
        let rule_subject = match self.subject {
            DraftSubject::All => None,
            DraftSubject::Satellite(number) => Some(RuleSubject::Satellite(number?)),
            DraftSubject::Group(group) => Some(RuleSubject::Group(context.group(group?)?)),
        };
        let conditions = self.typed.read().0;
        Some(AutomationRule {
            is_on: self.is_on,
            antenna: self.antenna,
            subject: rule_subject,
            sun: conditions.sun,
            hours: conditions.hours(),
            action: conditions.action,
        })
    }
}

impl RulesDraft {
    pub(in crate::ui::preferences) fn new(station: &Station) -> Self {
        let rules = station.rules.iter().enumerate();
        Self(rules.map(|(index, rule)| RuleDraft::new(rule, Some(index), station)).collect())
    }

    pub(super) fn all(&self) -> &[RuleDraft] {
        &self.0
    }

    pub(super) fn get_mut(&mut self, index: usize) -> Option<&mut RuleDraft> {
        self.0.get_mut(index)
    }

    /// Appends a disabled rule that excludes all passes, and returns its index.
    pub(in crate::ui::preferences) fn add(&mut self) -> usize {
        let conditions = Conditions {
            sun: None,
            is_by_hours: false,
            hours: HoursOfDay::NIGHT,
            action: RuleAction::Leave,
        };
        self.0.push(RuleDraft {
            was: None,
            is_on: false,
            antenna: None,
            subject: DraftSubject::All,
            typed: Typed::new(conditions, fields()),
            is_removed: false,
        });
        self.0.len() - 1
    }

    /// Inserts a disabled copy of a rule after it, and returns the index of the copy.
    pub(super) fn duplicate(&mut self, index: usize) -> Option<usize> {
        let rule = self.0.get(index)?;
        let copy = RuleDraft {
            was: None,
            is_on: false,
            antenna: rule.antenna,
            subject: rule.subject,
            typed: Typed::new(rule.typed.read().0, fields()),
            is_removed: false,
        };
        self.0.insert(index + 1, copy);
        Some(index + 1)
    }

    /// Moves a rule to another index.
    pub(super) fn reorder(&mut self, start: usize, end: usize) {
        if start < self.0.len() && end < self.0.len() {
            let rule = self.0.remove(start);
            self.0.insert(end, rule);
        }
    }

    /// Returns the number of a rule among the rules that stay, from 1.
    pub(super) fn number(&self, index: usize) -> Option<usize> {
        let rule = self.0.get(index).filter(|rule| !rule.is_removed);
        let before = self.0.iter().take(index).filter(|rule| !rule.is_removed).count();
        rule.map(|_| before + 1)
    }

    fn is_reordered(&self) -> bool {
        !self.0.iter().filter_map(|rule| rule.was).is_sorted()
    }

    /// Returns the number of edits; a new order counts as one edit.
    pub(super) fn edited(&self, before: &Self) -> usize {
        let edited = self.0.iter().map(|rule| rule.edits(before)).sum::<usize>();
        edited + usize::from(self.is_reordered())
    }

    /// Returns findings for the rules that Azel could not read back from the station file.
    pub(super) fn wrong(&self, context: &RuleContext<'_>) -> Vec<Finding> {
        let frequency = |index: usize| {
            let number = self.number(index)?;
            let reason = cannot_act::wrong(self.0.get(index)?, context)?;
            let problem = Problem::new(format!("cannot be saved: {}", reason.words(context)));
            Some(Finding { label: format!("Rule {number}"), problem })
        };
        (0..self.0.len()).filter_map(frequency).collect()
    }

    /// Returns the rules if all of them are valid.
    pub(super) fn read(&self, context: &RuleContext<'_>) -> Option<Vec<AutomationRule>> {
        if !self.wrong(context).is_empty() {
            return None;
        }
        let remaining = self.0.iter().filter(|rule| !rule.is_removed);
        remaining.map(|rule| rule.read(context)).collect()
    }
}

impl DraftSection for RulesDraft {
    fn edits(&self, before: &Draft) -> usize {
        self.edited(&before.rules)
    }

    fn findings(&self, draft: &Draft) -> Vec<Finding> {
        self.wrong(&draft.around_rules())
    }

    fn labels(&self) -> Vec<(Cow<'static, str>, Spot)> {
        search::on_page(&super::LABELS)
    }

    fn put_into(&self, draft: &Draft, station: &mut Station) -> Option<()> {
        station.rules = self.read(&draft.around_rules())?;
        Some(())
    }
}

fn fields() -> Vec<Placed<Conditions>> {
    const SUN: [Option<SunIs>; 3] = [None, Some(SunIs::Up), Some(SunIs::Down)];
    const THENS: [RuleAction; 3] = [RuleAction::Take, RuleAction::Leave, RuleAction::Park];
    let mut fields = placed(
        WHEN,
        [
            Description::choice(
                "Sun",
                &[(0, "Any"), (1, "Up"), (2, "Down")],
                &SUN,
                |conditions: &mut Conditions| &mut conditions.sun,
            ),
            Description::choice(
                "Hours",
                &[(0, "All"), (1, "Some")],
                &[false, true],
                |conditions: &mut Conditions| &mut conditions.is_by_hours,
            ),
            Description::time("From", |conditions: &mut Conditions| &mut conditions.hours.start)
                .in_unit("UTC")
                .when(|conditions| conditions.is_by_hours),
            Description::time("To", |conditions: &mut Conditions| &mut conditions.hours.end)
                .in_unit("UTC")
                .when(|conditions| conditions.is_by_hours)
                .checked(|conditions| {
                    let HoursOfDay { start, end } = conditions.hours;
                    if start == end { Err("must differ from From") } else { Ok(()) }
                }),
        ],
    );
    fields.extend(placed(
        ACTION_LABEL,
        [Description::choice(
            "Then",
            &[(0, "Take"), (1, "Leave"), (2, "Park")],
            &THENS,
            |conditions: &mut Conditions| &mut conditions.action,
        )],
    ));
    fields
}
