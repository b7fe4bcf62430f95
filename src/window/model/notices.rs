//! Notices of alarms and reminders through the desktop. Each is given once, and nothing keeps a
//! top-priority alarm quiet.

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

/// An alarm or reminder to be told.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    pub subject: NoticeSubject,
    /// The desktop shows it.
    pub is_shown: bool,
    pub tones: Tones,
}

#[derive(Debug, Clone, PartialEq)]
pub enum NoticeSubject {
    Alarm(Alarm),
    /// The station has published nothing for this long, and raises no alarm of its own.
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
    /// Rows of alarms that stood at the last look and are over.
    pub ended: Vec<u64>,
}

/// Keeps track of the notices already given.
#[derive(Debug, Default)]
pub struct Teller {
    /// Ids of the alarms that were new when it last looked.
    new: BTreeSet<u64>,
    /// Rows of the alarms that stood then.
    standing: BTreeSet<u64>,
    /// Passes of the reminders that were there then.
    reminded: Vec<PassListKey>,
    /// The station stood then.
    stood: bool,
}

impl Teller {
    /// Alarms that became new, reminders that came and alarms that were over since the last look.
    /// `stood`: the station has published nothing for so long. Quiet hours go by the clock
    /// of `zone`.
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

/// Returns the sound of a notice. The operator cannot choose that of a top-priority alarm.
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
