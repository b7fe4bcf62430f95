//! Sentences for notifications and reminders.

use jiff::Timestamp;

use super::{alarm, alarm_times};
use crate::{
    contract::{Snapshot, alarms::AlarmKind, antenna::AntennaModel, reminders::Reminder},
    desktop::{Missing, Outlets, Sound},
    model::notices::NoticeSubject,
    ui::format,
};

/// Returns title and text of a notification.
pub fn notice(subject: &NoticeSubject, station: &Snapshot) -> (String, String) {
    let (now, antennas) = (station.moment.utc, &station.antennas);
    let (word, text) = match subject {
        NoticeSubject::Alarm(raised) => {
            let antenna = antennas.iter().find(|antenna| Some(antenna.id()) == raised.antenna);
            let name = antenna.map_or("Azel", |antenna| antenna.config.name.as_str());
            let times = alarm_times(raised, now);
            ("Alarm", format!("{} {times}.", alarm(&raised.kind, name, now)))
        }
        NoticeSubject::StationStands(stood) => {
            ("Alarm", alarm(&AlarmKind::StationStands(*stood), "Azel", now))
        }
        NoticeSubject::Reminder(due) => ("Reminder", reminder(due, antennas, now)),
    };
    (format!("{word}, {}", station.station.name), text)
}

/// Describes a reminder.
pub fn reminder(due: &Reminder, antennas: &[AntennaModel], now: Timestamp) -> String {
    let able = antennas.iter().filter(|antenna| due.can_track.contains(&antenna.id()));
    let names: Vec<&str> = able.map(|antenna| antenna.config.name.as_str()).collect();
    let names = if names.is_empty() { "no antenna".to_owned() } else { format::list(&names) };
    format!(
        "{} AOS in {} at {}, max {}, {names} can track it.",
        due.name,
        format::time_left(now, due.aos()),
        format::moment(due.aos(), now),
        format::degrees(due.max_elevation.degrees(), 0),
    )
}

/// Returns title and text of a test notification.
pub fn trial(sound: Sound) -> (String, String) {
    let text = match sound {
        Sound::Falling => "This is how falling tones sound.",
        Sound::Rising => "This is how rising tones sound.",
    };
    ("Azel".to_owned(), text.to_owned())
}

/// Describes the services that the desktop lacks.
pub fn missing_outlets(outlets: &Outlets) -> Vec<MissingOutlet> {
    let words_for = |subject, missing: &Option<Missing>| {
        let missing = missing.as_ref()?;
        let (reason, cure) = why_and_cure(missing);
        Some(MissingOutlet { words: format!("{subject}: {reason}. {cure}"), raw: raw(missing) })
    };
    let notifications = words_for("The desktop shows no notifications", &outlets.notifications);
    let sounds = words_for("Azel cannot play sounds", &outlets.sounds);
    notifications.into_iter().chain(sounds).collect()
}

/// A kind of notice that the desktop does not deliver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingOutlet {
    /// Service, reason and remedy in words.
    pub words: String,
    /// Unchanged answer of the system.
    pub raw: Option<String>,
}

fn why_and_cure(missing: &Missing) -> (&'static str, String) {
    match missing {
        Missing::Bus(_) => (
            "Azel is not running in a desktop session",
            "Start it from the desktop, not over a remote shell or as another user.".to_owned(),
        ),
        Missing::Service(_) => (
            "no notification service answers",
            "Start one, such as dunst or mako. Azel tries again at the next alarm.".to_owned(),
        ),
        Missing::Player(names) => {
            ("no sound player is installed", format!("Install one of {names}."))
        }
        Missing::NotPlayed(_) => (
            "the player failed",
            "Check the sound output of this computer. Azel tries again at the next alarm."
                .to_owned(),
        ),
        Missing::Elsewhere => (
            "Azel does not support this on this operating system",
            "The list of alarms in the window has everything.".to_owned(),
        ),
    }
}

fn raw(missing: &Missing) -> Option<String> {
    match missing {
        Missing::Bus(raw) | Missing::Service(raw) | Missing::NotPlayed(raw) => Some(raw.clone()),
        Missing::Player(_) | Missing::Elsewhere => None,
    }
}
