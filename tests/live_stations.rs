//! Whole stations on threads of their own, with simulators instead of units, in memory.

use std::{
    num::NonZeroU32,
    sync::{Arc, mpsc},
    thread,
    time::Duration,
};

use azel::{
    astro::time::seconds_between,
    cli::serve::{Ended, Wake, until_the_end},
    clock::Clock,
    driver,
    engine::{Client, Command, Handle, Settings, Snapshot, status::LinkStatus},
    plan::{ProgramTrack, Target},
    sim::{rc2000c, rotator_genius, satrak},
    station,
};
use tokio::time::timeout;

use crate::units::{Units, antenna, measured, start, station, until};

/// Speed, in multiples of real time.
const FAST: NonZeroU32 = NonZeroU32::new(200).unwrap();
/// Longer than a test here takes.
const PATIENCE: Duration = Duration::from_mins(5);

struct Live {
    station: Handle,
    units: Units,
}

/// A station and the folder of its files.
fn begun(speed: NonZeroU32, wake: azel::job::Wake) -> (Live, tempfile::TempDir) {
    let clock = Clock::at_speed(start(), speed);
    let units = Units::new(&clock, start());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    station::save(&station(), &path).unwrap();
    let library = Some(folder.path().join("elements"));
    let settings = Settings { path: Some(path), library, ..Settings::default() };
    let station = Handle::start(settings, units.outside(&clock), wake).unwrap();
    (Live { station, units }, folder)
}

fn passed_s(client: &Client) -> f64 {
    seconds_between(start(), client.now().utc)
}

/// Sends `command` until the antenna is seen to move: in a live station at speed, a busy computer
/// may act on it too late.
async fn move_by(client: &Client, name: &str, command: &driver::Command) {
    let id = measured(client, name).await;
    let moved = || {
        let _ = client.send(Command::Antenna(id, command.clone()));
        let moves = antenna(client, name)?.1.moves;
        (moves == Some(true)).then_some(())
    };
    until("motion", moved).await;
}

#[tokio::test]
async fn two_stations_live_in_one_process_one_of_them_at_200_times_real_time() {
    timeout(PATIENCE, two_stations()).await.unwrap();
}

async fn two_stations() {
    let (real, _folder) = begun(NonZeroU32::MIN, Arc::new(|| {}));
    let (fast, _other_folder) = begun(FAST, Arc::new(|| {}));
    let (here, there) = (real.station.client(), fast.station.client());
    for name in ["Dish", "Mast", "Horn"] {
        measured(here, name).await;
        measured(there, name).await;
    }
    let before = here.now().steady;
    let went = there.now().steady;
    let sun = ProgramTrack::new(Target::Sun, there.snapshot().station.site, Vec::new());
    move_by(there, "Mast", &driver::Command::ProgramTrack(Box::new(sun))).await;
    until("ten minutes", || ((there.now().steady - went).as_secs() > 600).then_some(())).await;
    assert!((here.now().steady - before).as_secs() < 60, "{:?}", here.now().steady - before);
    assert!(passed_s(there) > 600.0);
    assert!(antenna(here, "Mast").unwrap().1.tracks.is_none(), "they share nothing");
    assert!(real.units.all_stand());
    there.stop_all();
    until("standstill", || fast.units.all_stand().then_some(())).await;
}

/// Serializes every snapshot that it gets of a station until the station ends; returns
/// their number.
fn write_down(mut client: Client) -> usize {
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    let mut count = 0;
    while runtime.block_on(client.changed()) {
        let snapshot = client.snapshot();
        let text = serde_json::to_string(&*snapshot).unwrap();
        let back: Snapshot = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
        // Only the catalog and the pass lists leave anything out.
        let shown = |of: &Snapshot| {
            let of = (
                (&of.at, &of.time_sync, &of.station, &of.sources),
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

/// Switches one of nine kinds of trouble.
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

/// An hour of a station without a window, in the main loop of the program.
#[tokio::test]
async fn a_served_station_lives_an_hour_with_trouble_on_the_lines() {
    let (end, woken) = mpsc::sync_channel(1);
    let by_station = end.clone();
    let wake = Arc::new(move || {
        let _ = by_station.try_send(Wake::Station);
    });
    let (Live { station, units }, _folder) = begun(FAST, wake);
    let client = station.client().clone();
    let witness = client.clone();
    let written = thread::Builder::new().name("writes".to_owned()).spawn(|| write_down(witness));
    let serving = thread::Builder::new().name("serves".to_owned()).spawn(move || {
        let mut lines = 0_u32;
        (until_the_end(station, &woken, &mut |_| lines += 1), lines)
    });
    timeout(PATIENCE, an_hour_with_trouble(&client, &units)).await.unwrap();
    end.send(Wake::End).unwrap();
    let (Ended { not_proved, broke_down }, lines) = serving.unwrap().join().unwrap();
    let written = written.unwrap().join().unwrap();
    assert!(written > 100, "{written} snapshots were written down");
    assert!(!broke_down);
    assert_eq!(not_proved, [""; 0]);
    assert!(units.all_stand());
    assert!(lines > 10, "{lines} lines of an hour with trouble");
}

async fn an_hour_with_trouble(client: &Client, units: &Units) {
    let site = client.snapshot().station.site;
    let sun = ProgramTrack::new(Target::Sun, site, Vec::new());
    move_by(client, "Mast", &driver::Command::ProgramTrack(Box::new(sun))).await;
    measured(client, "Horn").await;
    let mut count = 0;
    while passed_s(client) < 3600.0 {
        trouble(count, units, true);
        passes(client, 20).await;
        trouble(count, units, false);
        passes(client, 30).await;
        count += 1;
    }
    println!("an hour with {count} troubles");
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

/// Waits for so many seconds of the station.
async fn passes(client: &Client, seconds: u64) {
    let from = client.now().steady;
    until("seconds", || ((client.now().steady - from).as_secs() >= seconds).then_some(())).await;
}
