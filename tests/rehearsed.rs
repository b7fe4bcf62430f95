//! Whole stations in tokio's paused time: simulators instead of units, and engine, sessions and
//! simulators as tasks of one thread. Every run gives the same events at the same times, even on a
//! busy computer.

mod automatic;
mod elements;
mod ends;
mod explained;
mod full_disk;
mod hooks;
mod learned;
mod prices;
mod recorded;
mod rehearsal;
mod replay;
mod saving;
pub(crate) mod scene;
mod size;
mod trouble;
mod unattended;
mod upkeep;
mod week;

use std::{sync::Arc, time::Duration};

use azel::{
    astro::time::seconds_between,
    contract::{
        Command,
        alarms::AlarmKind,
        automatic::{DayEvent, Flown},
    },
    engine::Client,
    orbit::{PassSearch, Propagator, bundled, passes},
    station::{AntennaId, Notices, Station},
};
use jiff::ToSpan as _;

use self::scene::Scene;
use crate::common::units::{self, antenna, measured, start, until};

/// Waits for an entry of a record with long pauses, because each look reads the file.
async fn until_recorded<T>(what: &str, found: impl FnMut() -> Option<T>) -> T {
    units::until_looking(Duration::from_secs(5), what, found).await
}

/// Returns the finished passes of the schedule with their results.
fn flown(client: &Client) -> Vec<(AntennaId, Flown)> {
    let day = Arc::clone(&client.snapshot().day);
    let flown = day.iter().filter_map(|line| match &line.event {
        DayEvent::Flown(flown) => Some((line.antenna, flown.clone())),
        _ => None,
    });
    flown.collect()
}

#[tokio::test(start_paused = true)]
async fn a_marked_pass_is_reminded_of_and_its_alarm_ends_when_an_antenna_takes_it() {
    const ISS: u32 = 25_544;
    let station = Station::default();
    let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let aos = passes(&propagator, &search, &|| false)[0].aos.time;
    let notices = Notices { reminder_min: 10.0, reminders: [ISS].into(), ..Notices::default() };
    let station = Station { notices, ..units::station() };
    let scene = Scene::new(aos - 5.minutes(), &station);
    let client = scene.client();
    let is_raised = || {
        let snapshot = client.snapshot();
        let mut standing = snapshot.alarms.list().iter().filter(|alarm| !alarm.is_over());
        standing.any(|alarm| matches!(alarm.kind, AlarmKind::NoAntennaFor { .. }))
    };
    let reminder = until("the reminder", || client.snapshot().reminders.first().cloned()).await;
    assert!(seconds_between(reminder.aos(), aos).abs() < 1.0, "{reminder:?}");
    assert_eq!((reminder.pass.0, &*reminder.name), (ISS, "ISS"));
    until("the alarm", || is_raised().then_some(())).await;
    assert!(seconds_between(client.snapshot().moment.utc, aos) <= 30.0);
    let mast = measured(&client, "Mast").await;
    until("its end", || {
        let pass = reminder.pass;
        let _ = client.send(Command::ProgramTrackPass { antenna: mast, pass });
        (!is_raised()).then_some(())
    })
    .await;
    assert!(client.snapshot().moment.utc < reminder.los, "not by LOS");
    until("the track", || antenna(&client, "Mast")?.1.tracks).await;
}
