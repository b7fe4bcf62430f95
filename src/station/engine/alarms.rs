//! Alarms: events and states that the operator must not miss.

mod kind;
mod order;
#[cfg(test)]
mod tests;

use std::{sync::Arc, time::Duration};

use jiff::{Timestamp, tz::TimeZone};
use serde::{Deserialize, Serialize};

use self::kind::{explains, replaces, same_matter};
pub use self::{
    kind::{AlarmKind, Priority, Work, alarm_of, is_over},
    order::Placed,
};
use crate::{astro::time::seconds_between, station::AntennaId};

/// Maximum number of rows. Beyond it the oldest go: first those that are over and seen, then
/// seen ones.
const MAX: usize = 200;
/// Within this time after it came, an alarm is recorded, seconds.
const RECORDED_S: f64 = 5.0;

/// State of an alarm in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmState {
    /// Its reason stands, and it was not acknowledged.
    New,
    /// Its reason is over, and it was not acknowledged.
    NewAndOver { since: Timestamp },
    /// Its reason stands; it was acknowledged.
    Seen,
    /// Its reason is over, and it was acknowledged.
    Over { since: Timestamp },
    /// It is quiet until then, whether its reason stands or comes again.
    Shelved { until: Timestamp },
}

/// How long an alarm is shelved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ShelveTime {
    TenMinutes,
    OneHour,
    EightHours,
}

impl ShelveTime {
    pub const ALL: [Self; 3] = [Self::TenMinutes, Self::OneHour, Self::EightHours];

    pub fn duration(self) -> Duration {
        let minutes = match self {
            Self::TenMinutes => 10,
            Self::OneHour => 60,
            Self::EightHours => 480,
        };
        Duration::from_secs(60 * minutes)
    }
}

/// One row of the alarm list: one matter of one antenna, however often it came today.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// Unique in this station. A matter that comes again has a new one, so that nobody
    /// acknowledges what he has not seen.
    pub id: u64,
    /// The id with which the matter came first: that of its row, however often it comes again.
    pub row: u64,
    /// `None` where it concerns no single antenna.
    pub antenna: Option<AntennaId>,
    pub kind: AlarmKind,
    /// When it came first.
    pub raised: Timestamp,
    /// When it came last; the same as `raised` where it came once.
    pub last: Timestamp,
    /// How often it came.
    pub count: u32,
    /// The operator has acknowledged the alarm.
    pub seen: bool,
    /// When its reason was over; `None` while it stands.
    pub over_since: Option<Timestamp>,
    /// Quiet until then.
    pub shelved_until: Option<Timestamp>,
}

impl Alarm {
    pub fn priority(&self) -> Priority {
        self.kind.priority()
    }

    /// Returns `true` once the reason of the alarm is over.
    pub fn is_over(&self) -> bool {
        self.over_since.is_some()
    }

    pub fn state(&self) -> AlarmState {
        match (self.shelved_until, self.over_since, self.seen) {
            (Some(until), ..) => AlarmState::Shelved { until },
            (None, None, false) => AlarmState::New,
            (None, Some(since), false) => AlarmState::NewAndOver { since },
            (None, None, true) => AlarmState::Seen,
            (None, Some(since), true) => AlarmState::Over { since },
        }
    }

    fn is_done(&self) -> bool {
        matches!(self.state(), AlarmState::Over { .. })
    }

    fn acknowledge(&mut self, now: Timestamp) {
        self.seen = true;
        if self.kind.is_momentary() {
            self.over_since.get_or_insert(now);
        }
    }
}

/// A recorded change of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AlarmChange {
    Came,
    Acknowledged,
    Shelved,
    Over,
}

impl AlarmChange {
    /// The change that was recorded at `at`, after the one before of the same id. `None` for one that
    /// nobody looks for, as the end of a shelf.
    pub fn new(alarm: &Alarm, before: Option<&Alarm>, at: Timestamp) -> Option<Self> {
        let is_new = before.is_none() && seconds_between(alarm.last, at) < RECORDED_S;
        let is_set = |part: fn(&Alarm) -> bool| part(alarm) && !before.is_some_and(part);
        if is_new {
            Some(Self::Came)
        } else if is_set(|it| it.shelved_until.is_some()) {
            Some(Self::Shelved)
        } else if is_set(|it| it.seen) {
            Some(Self::Acknowledged)
        } else if is_set(Alarm::is_over) {
            Some(Self::Over)
        } else {
            None
        }
    }
}

/// The alarms of the station: those that stand, those that nobody has seen, and those of this
/// day (UTC) that are over. The newest is the last. Clones share the list.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Alarms {
    list: Arc<Vec<Alarm>>,
    next_id: u64,
    /// An alarm has come since the list was last opened.
    pub unopened: bool,
}

impl Alarms {
    /// The newest last.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// Adds an alarm, unless the same one or one that explains it stands already. It
    /// replaces alarms that it makes obsolete, and counts in the row of the same matter.
    pub fn raise(&mut self, antenna: Option<AntennaId>, kind: AlarmKind, now: Timestamp) {
        let is_same = |alarm: &Alarm| alarm.antenna == antenna && same_matter(&alarm.kind, &kind);
        if let AlarmKind::DriverStands(_) | AlarmKind::StationStands(_) = kind
            && self.stands(antenna, &kind)
        {
            // The duration grows while the alarm stands.
            return self.restate(antenna, &kind);
        }
        let is_known = self.list.iter().any(|alarm| {
            let same = is_same(alarm) && !kind.is_momentary();
            let explained = alarm.antenna == antenna && explains(&alarm.kind, &kind);
            !alarm.is_over() && (same || explained)
        });
        if is_known {
            return;
        }
        let place = self.list.iter().position(is_same);
        let list = Arc::make_mut(&mut self.list);
        let before = place.map(|place| list.remove(place));
        list.retain(|alarm| {
            alarm.is_over() || alarm.antenna != antenna || !replaces(&kind, &alarm.kind)
        });
        make_room(list);
        let id = self.next_id;
        self.next_id += 1;
        let shelved_until = before.as_ref().and_then(|before| before.shelved_until);
        list.push(Alarm {
            id,
            row: before.as_ref().map_or(id, |before| before.row),
            antenna,
            kind,
            raised: before.as_ref().map_or(now, |before| before.raised),
            last: now,
            count: before.map_or(1, |before| before.count.saturating_add(1)),
            seen: shelved_until.is_some(),
            over_since: None,
            shelved_until,
        });
        self.unopened |= shelved_until.is_none();
    }

    /// Raises `present`, or lets it stand in its present words, and ends the other alarms of `antenna`
    /// for which `is_of_matter` returns `true`.
    pub fn follow(
        &mut self,
        antenna: Option<AntennaId>,
        now: Timestamp,
        present: Option<AlarmKind>,
        is_of_matter: impl Fn(&AlarmKind) -> bool,
    ) {
        let is_present =
            |kind: &AlarmKind| present.as_ref().is_some_and(|present| same_matter(present, kind));
        self.clear(antenna, now, |kind| is_of_matter(kind) && !is_present(kind));
        if let Some(present) = present {
            self.restate(antenna, &present);
            self.raise(antenna, present, now);
        }
    }

    /// Returns `true` if an alarm of the matter of `kind` stands.
    pub(super) fn stands(&self, antenna: Option<AntennaId>, kind: &AlarmKind) -> bool {
        let is_same = |alarm: &Alarm| alarm.antenna == antenna && same_matter(&alarm.kind, kind);
        self.list.iter().any(|alarm| !alarm.is_over() && is_same(alarm))
    }

    /// Brings a standing alarm of the matter of `present` up to date.
    pub fn restate(&mut self, antenna: Option<AntennaId>, present: &AlarmKind) {
        self.change(
            |alarm| {
                let is_standing = alarm.antenna == antenna && !alarm.is_over();
                is_standing && alarm.kind.restated(present).is_some()
            },
            |alarm| {
                if let Some(kind) = alarm.kind.restated(present) {
                    alarm.kind = kind;
                }
            },
        );
    }

    /// Removes the alarms of antennas that are not among `antennas`.
    pub fn keep_only(&mut self, antennas: &[AntennaId]) {
        let is_known = |alarm: &Alarm| alarm.antenna.is_none_or(|id| antennas.contains(&id));
        if !self.list.iter().all(is_known) {
            Arc::make_mut(&mut self.list).retain(is_known);
        }
    }

    /// Ends the alarms of `antenna` for which `is_over` returns `true`.
    pub fn clear(
        &mut self,
        antenna: Option<AntennaId>,
        now: Timestamp,
        is_over: impl Fn(&AlarmKind) -> bool,
    ) {
        self.change(
            |alarm| alarm.antenna == antenna && !alarm.is_over() && is_over(&alarm.kind),
            |alarm| alarm.over_since = Some(now),
        );
    }

    /// Marks an alarm as seen by the operator. One about a moment is over with that.
    pub fn acknowledge(&mut self, id: u64, now: Timestamp) {
        self.change(|alarm| alarm.id == id && !alarm.seen, |alarm| alarm.acknowledge(now));
    }

    /// Marks all alarms as seen that came no later than the one with this id: one that comes
    /// while the operator acknowledges stays new.
    pub fn acknowledge_all(&mut self, newest: u64, now: Timestamp) {
        self.change(|alarm| alarm.id <= newest && !alarm.seen, |alarm| alarm.acknowledge(now));
    }

    /// Keeps an alarm quiet for a time, and what comes of the same matter meanwhile. Alarms of
    /// top priority are not shelved.
    pub fn shelve(&mut self, id: u64, time: ShelveTime, now: Timestamp) {
        self.change(
            |alarm| alarm.id == id && alarm.priority() < Priority::First,
            |alarm| {
                alarm.seen = true;
                alarm.shelved_until = now.checked_add(time.duration()).ok();
            },
        );
    }

    /// Takes an alarm back from the shelf. It is seen, as before.
    pub fn unshelve(&mut self, id: u64) {
        self.change(
            |alarm| alarm.id == id && alarm.shelved_until.is_some(),
            |alarm| alarm.shelved_until = None,
        );
    }

    /// Takes alarms back whose time on the shelf is up, as new where they stand, and forgets
    /// those that were over before this day (UTC).
    pub fn pass_time(&mut self, now: Timestamp) {
        // An end that far ahead comes from a clock that was ahead.
        let latest = now.checked_add(ShelveTime::EightHours.duration()).ok();
        let is_up = |alarm: &Alarm| {
            let until = alarm.shelved_until;
            until.is_some_and(|until| until <= now || latest.is_some_and(|latest| until > latest))
        };
        let stands = |alarm: &Alarm| is_up(alarm) && !alarm.is_over() && !alarm.kind.is_momentary();
        self.unopened |= self.list.iter().any(stands);
        self.change(stands, |alarm| alarm.seen = false);
        self.change(is_up, |alarm| {
            alarm.shelved_until = None;
            if alarm.seen {
                alarm.over_since.get_or_insert(now);
            }
        });
        let day = |at: Timestamp| at.to_zoned(TimeZone::UTC).date();
        let today = day(now);
        let is_old = |alarm: &Alarm| {
            alarm.is_done() && alarm.over_since.is_some_and(|since| day(since) < today)
        };
        if self.list.iter().any(is_old) {
            Arc::make_mut(&mut self.list).retain(|alarm| !is_old(alarm));
        }
    }

    /// Id of the newest unseen alarm.
    pub fn newest_unseen(&self) -> Option<u64> {
        self.list.iter().rev().find(|alarm| !alarm.seen).map(|alarm| alarm.id)
    }

    /// Changes the alarms for which `wanted` returns `true`. The list stays shared if there
    /// are none.
    fn change(&mut self, wanted: impl Fn(&Alarm) -> bool, change: impl Fn(&mut Alarm)) {
        if self.list.iter().any(&wanted) {
            let list = Arc::make_mut(&mut self.list);
            list.iter_mut().filter(|alarm| wanted(alarm)).for_each(change);
        }
    }
}

/// Removes the row that is missed least, where the list is full.
fn make_room(list: &mut Vec<Alarm>) {
    if list.len() < MAX {
        return;
    }
    let oldest = list
        .iter()
        .position(Alarm::is_done)
        .or_else(|| list.iter().position(|alarm| alarm.seen))
        .or_else(|| list.iter().position(|alarm| alarm.priority() < Priority::First))
        .unwrap_or(0);
    list.remove(oldest);
}
