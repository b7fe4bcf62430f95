//! Forms of one unit: edits, pending changes and results.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::atomic::{AtomicU64, Ordering},
    time::Duration,
};

use jiff::Timestamp;

use super::{
    draft::{Draft, Sent},
    field_state::{self, FieldState},
    outcome,
    unit::ShownUnit,
    unlock::Unlock,
};
use crate::{
    clock::Instant,
    contract::driver::Command,
    device::settings::{Access, Change, Group, Guard, Hindrance, Values},
    model::UiCommand,
    ui::{copies::CopiedValues, format, source_test::SourceTestState},
};

/// Max time until the session shows a change that it received.
const HEARD: Duration = Duration::from_secs(3);

/// Form of one unit. The type has no `Debug`, because an edit may be a password.
#[derive(Default)]
pub(super) struct Form {
    drafts: BTreeMap<&'static str, Draft>,
    /// Groups requested so far, with the start of the link that the requests used.
    requested: (Option<Instant>, BTreeSet<&'static str>),
    pub(super) unlock: Option<Unlock>,
    pub(super) report: Report,
    /// Source of elements on display; `None` for the source in use.
    pub(super) tab: Option<&'static str>,
    /// Time of the request for automatic tracking.
    pub(super) auto_asked: Option<Timestamp>,
    /// Flag: show the password while the operator types it.
    pub(super) is_revealed: bool,
    pub(super) source_test: SourceTestState,
}

/// Results of the last Apply.
#[derive(Default)]
pub(super) struct Report {
    /// Number of verified settings, and time of the last verification.
    verified: Option<(usize, Timestamp)>,
    /// Groups with values that the unit never reports, with the time of the unit's answer.
    copied: Vec<(&'static str, Timestamp)>,
    failures: Vec<String>,
}

impl Report {
    /// Returns all sentences, successes first; `true` marks a success.
    pub(super) fn lines(&self, now: Timestamp) -> Vec<(bool, String)> {
        let verified = self.verified.iter().map(|(count, time)| {
            let plural = if *count == 1 { "" } else { "s" };
            let time_text = format::moment(*time, now);
            (true, format!("{count} setting{plural} read back and verified {time_text}"))
        });
        let copied = self.copied.iter().map(|(title, time)| {
            let time_text = format::moment(*time, now);
            (true, format!("{title}: accepted by the unit and read back {time_text}"))
        });
        let failures = self.failures.iter().map(|words| (false, words.clone()));
        verified.chain(copied).chain(failures).collect()
    }
}

/// Numbers of fields by state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Count {
    /// Fields whose value is not on the unit.
    pub(super) edited: usize,
    /// Edited fields whose values Apply would send.
    pub(super) ready: usize,
    pub(super) to_confirm: usize,
    pub(super) locked: usize,
    pub(super) invalid: usize,
    /// Fields that wait because Azel cannot send another field of their change.
    pub(super) held_back: usize,
    pub(super) rejected: usize,
    pub(super) sending: usize,
}

impl Form {
    pub(super) fn draft(&mut self, group: &'static str) -> &mut Draft {
        self.drafts.entry(group).or_default()
    }

    /// Counts the fields of these groups by state.
    pub(super) fn count(&self, unit: &ShownUnit<'_>, groups: &[&str]) -> Count {
        let mut count = Count::default();
        for (key, draft) in self.drafts.iter().filter(|(key, _)| groups.contains(key)) {
            let Some(group) = unit.description(key) else { continue };
            for field in group.fields {
                let (state, value) = field_state::new(unit, group, field, draft);
                let add = |end: &mut usize, is_so: bool| *end += usize::from(is_so);
                add(&mut count.edited, state.is_edit());
                add(&mut count.ready, value.is_some());
                add(&mut count.to_confirm, state == FieldState::ConfirmFirst);
                add(&mut count.locked, state == FieldState::NeedsService);
                add(&mut count.invalid, matches!(state, FieldState::Invalid(_)));
                add(&mut count.held_back, matches!(state, FieldState::HeldBackBy(_)));
                add(&mut count.rejected, state == FieldState::Rejected);
                add(&mut count.sending, state == FieldState::Sending);
            }
        }
        count
    }

    /// Counts the fields of the whole unit by state.
    pub(super) fn count_all(&self, unit: &ShownUnit<'_>) -> Count {
        let groups: Vec<&str> = unit.antenna.groups().iter().map(|group| group.key).collect();
        self.count(unit, &groups)
    }

    /// Returns the reason why the ready values must wait, if one of them decides where the antenna
    /// points.
    pub(super) fn hindrance(&self, unit: &ShownUnit<'_>) -> Option<Hindrance> {
        let ready = |key: &str, draft: &Draft| {
            let Some(group) = unit.description(key) else { return false };
            let moving = group.fields.iter().filter(|field| field.moves);
            moving.into_iter().any(|field| field_state::new(unit, group, field, draft).1.is_some())
        };
        let hindrance = unit.hindrance().filter(|_| unit.is_open())?;
        self.drafts.iter().any(|(key, draft)| ready(key, draft)).then_some(hindrance)
    }

    /// Requests every group not yet read on this link, once each. A replay requests nothing.
    pub(super) fn ask_unread(&mut self, unit: &ShownUnit<'_>, commands: &mut Vec<UiCommand>) {
        let link = unit.antenna.snapshot.state.link_since;
        if !unit.is_open() || link.is_none() || unit.model.replay.is_some() {
            return;
        }
        if self.requested.0 != link {
            self.requested = (link, BTreeSet::new());
        }
        for group in unit.antenna.groups() {
            if !unit.is_fresh(group.key) && self.requested.1.insert(group.key) {
                commands.push(UiCommand::antenna(unit.antenna.id(), Command::ReadGroup(group.key)));
            }
        }
    }

    /// Sends the ready values to the unit, one change for each group.
    pub(super) fn apply(&mut self, unit: &ShownUnit<'_>, commands: &mut Vec<UiCommand>) {
        self.begin_report();
        let all: Vec<(&'static Group, Values)> = unit
            .antenna
            .groups()
            .iter()
            .filter_map(|group| {
                let draft = self.drafts.get(group.key).filter(|draft| draft.sent().is_none())?;
                let ready = |field| Some((field_state::new(unit, group, field, draft).1?, field));
                let values = group.fields.iter().filter_map(ready);
                let values: Values = values.map(|(value, field)| (field.key, value)).collect();
                (!values.is_empty()).then_some((*group, values))
            })
            .collect();
        for (group, values) in all {
            self.send(unit, group, values, commands);
        }
    }

    /// Takes over copied values as if the operator had typed them.
    pub(super) fn take_over(&mut self, unit: &ShownUnit<'_>, entries: Vec<CopiedValues>) {
        for CopiedValues { group: key, field: field_key, value } in entries {
            let group = unit.description(key);
            let Some(field) = group.and_then(|group| group.field(field_key)) else { continue };
            self.draft(key).type_in(field, field.kind.text(&value), unit.values(key));
        }
    }

    /// Clears the report of earlier changes.
    pub(super) fn begin_report(&mut self) {
        self.report = Report::default();
    }

    /// Sends `values` to the unit as one change of `group`.
    pub(super) fn send(
        &mut self,
        unit: &ShownUnit<'_>,
        group: &'static Group,
        values: Values,
        commands: &mut Vec<UiCommand>,
    ) {
        static TICKETS: AtomicU64 = AtomicU64::new(1);
        let is_service = group.guard(&values) == Guard::Service;
        let ticket = TICKETS.fetch_add(1, Ordering::Relaxed);
        let draft = self.draft(group.key);
        let expected = draft.expected().cloned().or_else(|| unit.values(group.key).cloned());
        draft.begin(Sent { ticket, instant: unit.model.steady, values: values.clone() });
        let is_unlocked = is_service && unit.is_unlocked;
        let change = Change { ticket, group: group.key, values, expected, is_unlocked };
        commands.push(UiCommand::antenna(unit.antenna.id(), Command::WriteSettings(change)));
    }

    /// Takes the results of the sent changes.
    pub(super) fn take_outcomes(&mut self, unit: &ShownUnit<'_>) {
        for (key, draft) in &mut self.drafts {
            let (Some(sent), Some(group)) = (draft.sent(), unit.description(key)) else { continue };
            let state = unit.group(key);
            let written = state.and_then(|state| state.written.clone()).filter(|written| {
                written.change.ticket == sent.ticket && written.change.values == sent.values
            });
            let current = unit.values(key);
            if let Some(written) = written {
                let count = sent.values.len();
                match &written.result {
                    Ok(()) => self.report.verify(group, &sent.values, count, written.time),
                    Err(error) => {
                        let words =
                            outcome::sentence(group, &written, error, draft.expected(), current);
                        self.report.failures.push(words);
                    }
                }
                draft.end(&written, group.fields, current);
                continue;
            }
            let is_under_way = state.is_some_and(|state| state.step.is_some());
            if !is_under_way && unit.model.steady.saturating_duration_since(sent.instant) > HEARD {
                draft.give_up();
                let words = format!("{}: no answer came back. Read again.", group.title);
                self.report.failures.push(words);
            }
        }
    }

    /// Drops all edits and the report.
    pub(super) fn revert(&mut self) {
        self.drafts.values_mut().for_each(Draft::revert);
        self.begin_report();
    }
}

impl Report {
    fn verify(&mut self, group: &Group, values: &Values, count: usize, time: Timestamp) {
        let reported =
            |key: &&&str| group.field(key).is_some_and(|field| field.access == Access::Edit);
        if values.keys().any(|key| reported(&key)) {
            let before = self.verified.as_ref().map_or(0, |(count, _)| *count);
            self.verified = Some((before + count, time));
        } else {
            self.copied.push((group.title, time));
        }
    }
}
