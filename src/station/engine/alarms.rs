//! Alarms: events and states that the operator must not miss.

mod kind;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use jiff::{Timestamp, tz::TimeZone};

pub use self::kind::{alarm_of, is_over};
use self::kind::{explains, is_momentary, replaces, restated, same_matter};
use crate::{
    contract::alarms::{Alarm, AlarmKind, Alarms, Priority, ShelveTime},
    station::AntennaId,
};

/// Max number of rows. A full list drops the oldest row: first alarms that are over and seen, then
/// seen ones.
const MAX: usize = 200;

/// Operations on the alarms of a station.
pub trait KeepAlarms {
    /// Adds an alarm, unless the same alarm or one that explains it is already active. Removes
    /// alarms that the new one makes obsolete, and counts repeats of the same matter in one row.
    fn raise(&mut self, antenna: Option<AntennaId>, kind: AlarmKind, now: Timestamp);

    /// Raises `present` or updates its active alarm. Ends the other alarms of `antenna` for which
    /// `is_of_matter` returns `true`.
    fn follow(
        &mut self,
        antenna: Option<AntennaId>,
        now: Timestamp,
        present: Option<AlarmKind>,
        is_of_matter: impl Fn(&AlarmKind) -> bool,
    );

    /// Returns `true` if an alarm about the matter of `kind` is active.
    fn stands(&self, antenna: Option<AntennaId>, kind: &AlarmKind) -> bool;

    /// Updates the active alarm about the matter of `present`.
    fn restate(&mut self, antenna: Option<AntennaId>, present: &AlarmKind);

    /// Removes the alarms of antennas that are not among `antennas`.
    fn keep_only(&mut self, antennas: &[AntennaId]);

    /// Ends the alarms of `antenna` for which `is_over` returns `true`.
    fn clear(
        &mut self,
        antenna: Option<AntennaId>,
        now: Timestamp,
        is_over: impl Fn(&AlarmKind) -> bool,
    );

    /// Marks an alarm as seen by the operator. This ends an alarm about a single moment.
    fn acknowledge(&mut self, id: u64, now: Timestamp);

    /// Marks all alarms up to the id `newest` as seen. An alarm that arrives while the operator
    /// acknowledges stays new.
    fn acknowledge_all(&mut self, newest: u64, now: Timestamp);

    /// Shelves an alarm, and later alarms about the same matter, for a time. Alarms of top priority
    /// cannot be shelved.
    fn shelve(&mut self, id: u64, time: ShelveTime, now: Timestamp);

    /// Takes an alarm off the shelf. The alarm stays seen.
    fn unshelve(&mut self, id: u64);

    /// Takes alarms off the shelf when their time is up; alarms that are still active become new.
    /// Removes alarms that were over before today (UTC).
    fn pass_time(&mut self, now: Timestamp);
}

impl KeepAlarms for Alarms {
    fn raise(&mut self, antenna: Option<AntennaId>, kind: AlarmKind, now: Timestamp) {
        let is_same = |alarm: &Alarm| alarm.antenna == antenna && same_matter(&alarm.kind, &kind);
        if let AlarmKind::DriverStands(_) | AlarmKind::StationStands(_) = kind
            && self.stands(antenna, &kind)
        {
            // The duration in the alarm grows while the alarm is active.
            return self.restate(antenna, &kind);
        }
        let is_known = self.list.iter().any(|alarm| {
            let same = is_same(alarm) && !is_momentary(&kind);
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
        let new = Alarm::new(id, antenna, kind, now);
        let alarm = match before {
            None => new,
            Some(before) => Alarm {
                row: before.row,
                raised: before.raised,
                count: before.count.saturating_add(1),
                acknowledged: before.shelved_until.is_some(),
                shelved_until: before.shelved_until,
                ..new
            },
        };
        self.unopened |= alarm.shelved_until.is_none();
        list.push(alarm);
    }

    fn follow(
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

    fn stands(&self, antenna: Option<AntennaId>, kind: &AlarmKind) -> bool {
        let is_same = |alarm: &Alarm| alarm.antenna == antenna && same_matter(&alarm.kind, kind);
        self.list.iter().any(|alarm| !alarm.is_over() && is_same(alarm))
    }

    fn restate(&mut self, antenna: Option<AntennaId>, present: &AlarmKind) {
        change(
            self,
            |alarm| {
                let is_standing = alarm.antenna == antenna && !alarm.is_over();
                is_standing && restated(&alarm.kind, present).is_some()
            },
            |alarm| {
                if let Some(kind) = restated(&alarm.kind, present) {
                    alarm.kind = kind;
                }
            },
        );
    }

    fn keep_only(&mut self, antennas: &[AntennaId]) {
        let is_known = |alarm: &Alarm| alarm.antenna.is_none_or(|id| antennas.contains(&id));
        if !self.list.iter().all(is_known) {
            Arc::make_mut(&mut self.list).retain(is_known);
        }
    }

    fn clear(
        &mut self,
        antenna: Option<AntennaId>,
        now: Timestamp,
        is_over: impl Fn(&AlarmKind) -> bool,
    ) {
        change(
            self,
            |alarm| alarm.antenna == antenna && !alarm.is_over() && is_over(&alarm.kind),
            |alarm| alarm.over_since = Some(now),
        );
    }

    fn acknowledge(&mut self, id: u64, now: Timestamp) {
        change(
            self,
            |alarm| alarm.id == id && !alarm.acknowledged,
            |alarm| acknowledge(alarm, now),
        );
    }

    fn acknowledge_all(&mut self, newest: u64, now: Timestamp) {
        change(
            self,
            |alarm| alarm.id <= newest && !alarm.acknowledged,
            |alarm| acknowledge(alarm, now),
        );
    }

    fn shelve(&mut self, id: u64, time: ShelveTime, now: Timestamp) {
        change(
            self,
            |alarm| alarm.id == id && alarm.priority() < Priority::First,
            |alarm| {
                alarm.acknowledged = true;
                alarm.shelved_until = now.checked_add(time.duration()).ok();
            },
        );
    }

    fn unshelve(&mut self, id: u64) {
        change(
            self,
            |alarm| alarm.id == id && alarm.shelved_until.is_some(),
            |alarm| alarm.shelved_until = None,
        );
    }

    fn pass_time(&mut self, now: Timestamp) {
        // A later end was set while the clock was ahead.
        let latest = now.checked_add(ShelveTime::EightHours.duration()).ok();
        let is_up = |alarm: &Alarm| {
            let shelved_until = alarm.shelved_until;
            shelved_until.is_some_and(|end| end <= now || latest.is_some_and(|latest| end > latest))
        };
        let stands = |alarm: &Alarm| is_up(alarm) && !alarm.is_over() && !is_momentary(&alarm.kind);
        self.unopened |= self.list.iter().any(stands);
        change(self, stands, |alarm| alarm.acknowledged = false);
        change(self, is_up, |alarm| {
            alarm.shelved_until = None;
            if alarm.acknowledged {
                alarm.over_since.get_or_insert(now);
            }
        });
        let day = |time: Timestamp| time.to_zoned(TimeZone::UTC).date();
        let today = day(now);
        let is_old = |alarm: &Alarm| {
            alarm.is_done() && alarm.over_since.is_some_and(|start| day(start) < today)
        };
        if self.list.iter().any(is_old) {
            Arc::make_mut(&mut self.list).retain(|alarm| !is_old(alarm));
        }
    }
}

fn acknowledge(alarm: &mut Alarm, now: Timestamp) {
    alarm.acknowledged = true;
    if is_momentary(&alarm.kind) {
        alarm.over_since.get_or_insert(now);
    }
}

/// Changes the alarms for which `is_changed` returns `true`. If there are none, the list stays
/// shared.
fn change(alarms: &mut Alarms, is_changed: impl Fn(&Alarm) -> bool, change: impl Fn(&mut Alarm)) {
    if alarms.list.iter().any(&is_changed) {
        let list = Arc::make_mut(&mut alarms.list);
        list.iter_mut().filter(|alarm| is_changed(alarm)).for_each(change);
    }
}

/// Removes the least important row from a full list.
fn make_room(list: &mut Vec<Alarm>) {
    if list.len() < MAX {
        return;
    }
    let oldest = list
        .iter()
        .position(Alarm::is_done)
        .or_else(|| list.iter().position(|alarm| alarm.acknowledged))
        .or_else(|| list.iter().position(|alarm| alarm.priority() < Priority::First))
        .unwrap_or(0);
    list.remove(oldest);
}
