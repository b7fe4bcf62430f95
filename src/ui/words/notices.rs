//! Sentences of notifications and reminders.

use jiff::Timestamp;

use super::{alarm, alarm_times};
use crate::{
    astro::time::seconds_between,
    desktop::{Outlets, Sound},
    engine::{
        Snapshot, alarms::AlarmKind, antenna::AntennaModel, notices::About, reminders::Reminder,
    },
    ui::format,
};

/// Title and text of a notification.
pub fn notice(about: &About, station: &Snapshot) -> (String, String) {
    let (now, antennas) = (station.at.utc, &station.antennas);
    let (word, text) = match about {
        About::Alarm(of) => {
            let antenna = antennas.iter().find(|antenna| Some(antenna.id()) == of.antenna);
            let name = antenna.map_or("Azel", |antenna| antenna.config.name.as_str());
            let times = alarm_times(of, now);
            ("Alarm", format!("{} {times}.", alarm(&of.kind, name)))
        }
        About::StationStands(stood) => ("Alarm", alarm(&AlarmKind::StationStands(*stood), "Azel")),
        About::Reminder(of) => ("Reminder", reminder(of, antennas, now)),
    };
    (format!("{word}, {}", station.station.name), text)
}

/// A reminder in words.
pub fn reminder(of: &Reminder, antennas: &[AntennaModel], now: Timestamp) -> String {
    let able = antennas.iter().filter(|antenna| of.can_track.contains(&antenna.id()));
    let names: Vec<&str> = able.map(|antenna| antenna.config.name.as_str()).collect();
    let names = if names.is_empty() { "no antenna".to_owned() } else { format::list(&names) };
    format!(
        "{} AOS in {} at {}, max {}, {names} can track it.",
        of.name,
        format::time_left(seconds_between(now, of.aos())),
        format::time_z(of.aos()),
        format::degrees(of.max_elevation.degrees(), 0),
    )
}

/// Title and text of a notification with which the operator tries the desktop.
pub fn trial(sound: Sound) -> (String, String) {
    let text = match sound {
        Sound::Alarm => "This is how a new alarm is told.",
        Sound::Reminder => "This is how a reminder is told.",
    };
    ("Azel".to_owned(), text.to_owned())
}

/// What the desktop does not do, in sentences.
pub fn missing_outlets(outlets: &Outlets) -> Vec<String> {
    let notifications = outlets.notifications.as_ref().map(|why| {
        format!("Nothing is shown by the desktop: {why}. It is tried again with each alarm.")
    });
    let sounds = outlets
        .sounds
        .as_ref()
        .map(|why| format!("Nothing is sounded: {why}. It is tried again with each alarm."));
    notifications.into_iter().chain(sounds).collect()
}
