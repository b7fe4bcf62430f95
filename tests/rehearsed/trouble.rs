//! Ten minutes with trouble on all lines.

use azel::{
    astro::time::seconds_between,
    contract::{Command, Snapshot, alarms::AlarmKind, driver},
    engine::{Client, status::LinkStatus},
    plan::{ProgramTrack, Target},
    sim::{rc2000c, rotator_genius, satrak},
};

use super::scene::Scene;
use crate::common::units::{Units, antenna, measured, start, station, until};

/// Serializes every snapshot of a station until the station ends. Returns the number of snapshots.
async fn write_down(mut client: Client) -> usize {
    let mut count = 0;
    while client.changed().await {
        let snapshot = client.snapshot();
        let text = serde_json::to_string(&*snapshot).unwrap();
        let back: Snapshot = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
        // Only the catalog and the pass lists leave values out of the text.
        let shown = |of: &Snapshot| {
            let of = (
                (&of.moment, &of.time_sync, &of.station, &of.sources),
                (&of.antennas, &of.alarms, &of.reminders),
                (&of.schedule, &of.day),
            );
            format!("{of:?}")
        };
        assert_eq!(shown(&back), shown(&snapshot));
        count += 1;
    }
    count
}

/// Switches one of nine kinds of trouble on or off.
fn trouble(kind: u32, units: &Units, is_on: bool) {
    use rc2000c::Fault as Line;
    use rotator_genius::Fault as Socket;
    use satrak::Fault;
    match kind % 9 {
        0 => units.dish.set_fault(Fault::Silence, is_on),
        1 => units.dish.set_fault(Fault::Garbage, is_on),
        2 => units.dish.set_fault(Fault::HangUp, is_on),
        3 => units.mast.set_fault(Socket::DropReply, is_on),
        4 => units.mast.set_fault(Socket::Split, is_on),
        5 => units.mast.drop_clients(),
        6 => units.horn.set_fault(Line::BitError, is_on),
        7 => units.horn.set_fault(Line::Truncate, is_on),
        _ => units.horn.drop_clients(),
    }
}

#[tokio::test(start_paused = true)]
async fn a_station_lives_with_trouble_on_the_lines_and_each_snapshot_can_be_written() {
    let scene = Scene::new(start(), &station());
    let (client, units) = (scene.client(), scene.units.clone());
    let written = tokio::spawn(write_down(client.clone()));
    with_trouble(&client, &units).await;
    drop(client);
    scene.ended().await;
    let written = written.await.unwrap();
    assert!(written > 600, "{written} snapshots were written down");
}

#[tokio::test(start_paused = true)]
async fn a_unit_of_which_positions_are_missing_again_and_again_is_shown_as_one_until_it_answers() {
    let scene = Scene::new(start(), &station());
    let (client, units) = (scene.client(), scene.units.clone());
    measured(&client, "Mast").await;
    measured(&client, "Dish").await;
    let is_told = || {
        let snapshot = client.snapshot();
        let stands = |kind: &AlarmKind| *kind == AlarmKind::LosesPositions;
        let alarm = snapshot.alarms.list().iter().find(|alarm| stands(&alarm.kind))?;
        alarm.over_since.is_none().then_some(())
    };
    units.mast.set_fault(rotator_genius::Fault::DropReply, true);
    until("the alarm", is_told).await;
    for _ in 0..30 {
        passes(&client, 1).await;
        assert_eq!(is_told(), Some(()), "it stands");
        let lost = client.snapshot();
        assert!(lost.antennas.iter().filter(|antenna| antenna.loses_positions).count() == 1);
    }
    units.mast.set_fault(rotator_genius::Fault::DropReply, false);
    until("its end", || is_told().is_none().then_some(())).await;
    drop(client);
    scene.ended().await;
}

async fn with_trouble(client: &Client, units: &Units) {
    let site = client.snapshot().station.site;
    let sun = ProgramTrack::new(Target::Sun, site, Vec::new());
    let mast = measured(client, "Mast").await;
    let track = driver::Command::ProgramTrack(Box::new(sun));
    let _ = client.send(Command::Antenna(mast, track));
    measured(client, "Horn").await;
    let mut count = 0;
    while seconds_between(start(), client.now().utc) < 600.0 {
        trouble(count, units, true);
        passes(client, 20).await;
        trouble(count, units, false);
        passes(client, 30).await;
        count += 1;
    }
    assert!(count > 9, "each kind");
    for name in ["Dish", "Mast", "Horn"] {
        let is_up = || {
            let (id, status) = antenna(client, name)?;
            if status.link == LinkStatus::Off {
                let _ = client.send(Command::Antenna(id, driver::Command::Connect));
            }
            (status.link == LinkStatus::Up).then_some(())
        };
        until("the link after all that", is_up).await;
    }
}

/// Waits for `seconds` of the station's time.
async fn passes(client: &Client, seconds: u64) {
    let from = client.now().steady;
    until("seconds", || ((client.now().steady - from).as_secs() >= seconds).then_some(())).await;
}
