//! Full disk from before a pass to its middle, for longer than the queues for the disk can hold.

use std::{
    fs,
    path::{Path, PathBuf},
};

use azel::{
    astro::time::seconds_between,
    contract::{
        Command,
        alarms::AlarmKind,
        record::{Peak, PeakBody, PeakChange, Row},
    },
    engine::{Client, film::Projector},
    record::{Kind, RowKind, open_pass},
    station::{PollRates, Station},
};
use jiff::ToSpan as _;
use tokio::time::sleep;

use super::{
    recorded::{ISS, next_pass, path_in, reports, rows_in, track},
    scene::Scene,
};
use crate::common::units::{self, LOOK, antenna, until};

const MAST: &str = "Mast";
/// Poll rates that fill the log of positions in a quarter of an hour.
const RATES: PollRates = PollRates { idle_hz: 10.0, moving_hz: 10.0 };
/// Number of commands while the disk is full: more than the entries that can wait for it.
const COMMANDS: usize = 20_300;
/// Number of commands that a station takes in one turn.
const AT_ONCE: usize = 58;
/// Number of peaks that the test enters besides the commands. A picture shows all earlier peaks, so
/// the film outgrows the queue for the disk.
const PEAKS: u32 = 4;
/// Max time between two positions that Azel reads ten times a second, seconds.
const LONGEST_S: f64 = 0.3;

/// Disk that takes nothing until this value is dropped.
struct FullDisk {
    folder: PathBuf,
    aside: PathBuf,
}

impl FullDisk {
    fn at(folder: &Path) -> Self {
        let aside = folder.with_extension("aside");
        fs::rename(folder, &aside).unwrap();
        // A file in the place of the folder makes every write fail.
        fs::write(folder, "").unwrap();
        Self { folder: folder.to_owned(), aside }
    }
}

impl Drop for FullDisk {
    fn drop(&mut self) {
        fs::remove_file(&self.folder).unwrap();
        fs::rename(&self.aside, &self.folder).unwrap();
    }
}

fn is_failing(client: &Client) -> bool {
    let shown = client.snapshot();
    let mut standing = shown.alarms.list().iter().filter(|alarm| !alarm.is_over());
    standing.any(|alarm| matches!(alarm.kind, AlarmKind::NoRecord(_)))
}

fn is_ordered(row: &Row) -> bool {
    row.data["command"]["AcknowledgeAlarm"].is_u64()
}

#[tokio::test(start_paused = true)]
async fn a_disk_that_is_full_in_a_pass_costs_what_did_not_fit_and_neither_the_track_nor_the_past() {
    let mut station = Station { favourites: [ISS].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name == MAST);
    station.antennas.iter_mut().for_each(|antenna| antenna.poll = RATES);
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 18.minutes(), &station);
    let client = scene.client();
    track(&client, MAST).await;
    until("the disk to be full", || {
        (client.now().utc > pass.aos.time - 14.minutes()).then_some(())
    })
    .await;
    let before = rows_in(scene.folder(), RowKind::Position);
    let disk = FullDisk::at(&scene.folder().join("records"));
    let full_at = client.now().utc;
    let mast = antenna(&client, MAST).unwrap().0;
    until("the alarm", || is_failing(&client).then_some(())).await;
    for _ in 0..COMMANDS / AT_ONCE {
        for _ in 0..AT_ONCE {
            client.send(Command::AcknowledgeAlarm(u64::MAX)).unwrap();
        }
        for elevation in 0..PEAKS {
            let (of, at) = (PeakBody::Sun, client.now().utc);
            let peak =
                Peak { body: of, time: at, azimuth_deg: 10.0, elevation_deg: f64::from(elevation) };
            client.send(Command::ChangePeaks(mast, PeakChange::Added(peak))).unwrap();
        }
        sleep(LOOK).await;
    }
    let middle = pass.tca.time;
    until("the middle of the pass", || (client.now().utc > middle).then_some(())).await;
    assert!(antenna(&client, MAST).unwrap().1.tracks.is_some());
    assert!(is_failing(&client));
    drop(disk);
    until("the record to go on", || (!is_failing(&client)).then_some(())).await;
    assert!(client.now().utc < middle + 10.seconds(), "by itself, and soon");
    let told = reports(&scene).await.remove(0);
    assert!(
        told.data["report"]["in_beam_s"].as_f64().unwrap() > 0.9 * pass.duration_s(),
        "{told:?}"
    );
    drop(client);
    let ended = scene.ended().await;

    let after = rows_in(ended.path(), RowKind::Position);
    assert_eq!(before[..], after[..before.len()], "nothing that was written is lost");
    assert!(after.iter().any(|row| row.time > middle + 1.minutes()), "it goes on");
    let gaps = rows_in(ended.path(), RowKind::Entry(Kind::Gap));
    let lost = ["entries", "positions", "frames", "pictures"]
        .map(|of| gaps.iter().map(|gap| gap.data[of].as_u64().unwrap()).sum::<u64>());
    assert!(lost.iter().all(|count| *count > 0), "{lost:?}");
    let [entries, positions, ..] = lost.map(|count| usize::try_from(count).unwrap());
    let commands = rows_in(ended.path(), RowKind::Entry(Kind::Command));
    assert!(commands.iter().filter(|row| is_ordered(row)).count() + entries >= COMMANDS);
    // The log of the session kept the positions of the pass, so only one stretch is missing.
    let both = after.iter().zip(after.iter().skip(1));
    let mut apart: Vec<f64> =
        both.map(|(one, next)| seconds_between(one.time, next.time)).collect();
    apart.sort_by(f64::total_cmp);
    let (hole_s, longest_s) = (apart.pop().unwrap(), apart.pop().unwrap());
    println!("lost {lost:?}; positions at most {longest_s} s apart, but for {hole_s:.1} s");
    assert!(longest_s <= LONGEST_S, "{longest_s}");
    assert!((hole_s * RATES.idle_hz - positions as f64).abs() < 0.1 * positions as f64, "{hole_s}");

    let file = path_in(ended.path());
    let opened = open_pass(&file, 1, station.site).unwrap().unwrap();
    let gap = opened.entries.iter().find(|row| row.kind == "gap").unwrap();
    let since = gap.gap_since().unwrap();
    assert!((full_at - 2.seconds()..full_at + 2.seconds()).contains(&since), "{since} {full_at}");
    let mut projector = Projector::open(&file).unwrap();
    let hole = projector.film().hole_at(full_at + 5.seconds()).unwrap().expect("a hole");
    assert!(hole.0 < full_at + 2.seconds() && hole.1 < middle, "{hole:?}");
    assert_eq!(projector.film().hole_at(middle + 1.minutes()).unwrap(), None);
}
