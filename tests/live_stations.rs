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
    contract::{Command, driver},
    controller::SPECS,
    engine::{Client, Handle, Settings},
    plan::{ProgramTrack, Target},
    station,
};
use tokio::time::timeout;

use crate::units::{Units, antenna, measured, start, station, until};

/// Speed, in multiples of real time.
const FAST: NonZeroU32 = NonZeroU32::new(200).unwrap();
/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_mins(5);

struct Live {
    station: Handle,
    units: Units,
}

/// Starts a station. Returns it with the folder of its files.
fn begun(speed: NonZeroU32, wake: azel::job::Wake) -> (Live, tempfile::TempDir) {
    let clock = Clock::at_speed(start(), speed);
    let units = Units::new(&clock);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    station::save(&station(), &path, SPECS).unwrap();
    let library = Some(folder.path().join("elements"));
    let settings = Settings { path: Some(path), library, ..Settings::default() };
    let station = Handle::start(settings, units.outside(&clock), wake).unwrap();
    (Live { station, units }, folder)
}

fn passed_s(client: &Client) -> f64 {
    seconds_between(start(), client.now().utc)
}

/// Repeats `command` until the antenna moves. On an accelerated clock, a busy computer may act on a
/// single command too late.
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

/// The station runs in the main loop of the program, in real time.
#[tokio::test]
async fn a_served_station_ends_when_its_antennas_are_proved_to_stand() {
    let (end, woken) = mpsc::sync_channel(1);
    let by_station = end.clone();
    let wake = Arc::new(move || {
        let _ = by_station.try_send(Wake::Station);
    });
    let (Live { station, units }, _folder) = begun(NonZeroU32::MIN, wake);
    let client = station.client().clone();
    let serving = thread::Builder::new().name("serves".to_owned()).spawn(move || {
        let mut lines = 0_u32;
        (until_the_end(station, &woken, &mut |_| lines += 1), lines)
    });
    let site = client.snapshot().station.site;
    let sun = ProgramTrack::new(Target::Sun, site, Vec::new());
    let sun = driver::Command::ProgramTrack(Box::new(sun));
    timeout(PATIENCE, move_by(&client, "Mast", &sun)).await.unwrap();
    timeout(PATIENCE, measured(&client, "Horn")).await.unwrap();
    assert!(!units.all_stand());
    end.send(Wake::End).unwrap();
    let (Ended { not_proved, broke_down }, lines) = serving.unwrap().join().unwrap();
    assert!(!broke_down);
    assert_eq!(not_proved, [""; 0]);
    assert!(units.all_stand());
    assert!(lines > 0);
}
