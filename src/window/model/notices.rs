//! Notices of alarms and reminders through the desktop. Azel gives each notice once, and no setting
//! silences a top-priority alarm.

#[cfg(test)]
mod tests;

use std::{cmp::Reverse, collections::BTreeSet, time::Duration};

use jiff::tz::TimeZone;

use crate::{
    contract::{
        Snapshot,
        alarms::{Alarm, Priority},
        passes::PassListKey,
        reminders::Reminder,
    },
    station::{HoursOfDay, Notices, Tones},
};

/// An alarm or reminder to announce.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    pub subject: NoticeSubject,
    /// `true` if the desktop shows the notice.
    pub is_shown: bool,
    pub tones: Tones,
}

#[derive(Debug, Clone, PartialEq)]
pub enum NoticeSubject {
    Alarm(Alarm),
    /// Time for which the station has published nothing. The station itself raises no alarm for
    /// this.
    StationStands(Duration),
    Reminder(Reminder),
}

impl NoticeSubject {
    pub fn has_top_priority(&self) -> bool {
        matches!(self, Self::Alarm(alarm) if alarm.priority() == Priority::First)
    }
}

/// News since the last look.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct News {
    /// Notices to give, top-priority alarms first.
    pub notices: Vec<Notice>,
    /// Rows of alarms that were active at the last look and are over.
    pub ended: Vec<u64>,
}

/// Record of the notices already given.
#[derive(Debug, Default)]
pub struct Teller {
    /// Ids of the alarms that were new at the last look.
    new: BTreeSet<u64>,
    /// Rows of the alarms that were active at the last look.
    standing: BTreeSet<u64>,
    /// Passes of the reminders at the last look.
    reminded: Vec<PassListKey>,
    /// `true` if the station published nothing at the last look.
    stood: bool,
}

impl Teller {
    /// Returns the alarms that became new, the new reminders and the alarms that ended since the
    /// last look. `stood` is the time for which the station has published nothing. Quiet hours
    /// follow the clock of `zone`.
    pub fn look(&mut self, station: &Snapshot, stood: Option<Duration>, zone: &TimeZone) -> News {
        let new = |alarm: &&Alarm| !alarm.acknowledged;
        let alarms = station.alarms.list().iter().filter(new);
        let untold = alarms.clone().filter(|alarm| !self.new.contains(&alarm.id));
        let untold = untold.map(|alarm| NoticeSubject::Alarm(alarm.clone()));
        let reminders = station.reminders.iter().filter(|reminder| {
            reminder.aos() > station.moment.utc && !self.reminded.contains(&reminder.pass)
        });
        let stands = stood.filter(|_| !self.stood).map(NoticeSubject::StationStands);
        let subjects = untold.chain(reminders.cloned().map(NoticeSubject::Reminder)).chain(stands);
        let notices = &station.station.notices;
        let is_quiet =
            notices.quiet.is_some_and(|hours: HoursOfDay| hours.contain(station.moment.utc, zone));
        let mut list: Vec<Notice> = subjects
            .map(|subject| {
                let is_told =
                    |requested: bool| subject.has_top_priority() || requested && !is_quiet;
                Notice {
                    is_shown: is_told(notices.notifications),
                    tones: if is_told(notices.sounds) {
                        tones(&subject, notices)
                    } else {
                        Tones::None
                    },
                    subject,
                }
            })
            .filter(|notice| notice.is_shown || notice.tones != Tones::None)
            .collect();
        list.sort_by_key(|notice| Reverse(notice.subject.has_top_priority()));
        self.stood = stood.is_some();
        self.new = alarms.map(|alarm| alarm.id).collect();
        let stand = station.alarms.list().iter().filter(|alarm| !alarm.is_over());
        let standing: BTreeSet<u64> = stand.map(|alarm| alarm.row).collect();
        let ended = self.standing.difference(&standing).copied().collect();
        self.standing = standing;
        self.reminded = station.reminders.iter().map(|reminder| reminder.pass).collect();
        News { notices: list, ended }
    }
}

/// Returns the sound of a notice. The operator cannot change the sound of a top-priority alarm.
fn tones(subject: &NoticeSubject, notices: &Notices) -> Tones {
    match subject {
        NoticeSubject::Alarm(alarm) => match alarm.priority() {
            Priority::First => Tones::Falling,
            Priority::Warning => notices.warning_tones,
            Priority::Caution => notices.caution_tones,
        },
        NoticeSubject::StationStands(_) => notices.warning_tones,
        NoticeSubject::Reminder(_) => notices.reminder_tones,
    }
}
