//! Views of a record that holds a year of passes of three antennas: `cargo bench --bench record`.
//! The bench first writes the file of about a gigabyte, which takes a minute or two.
//!
//! Opening a pass is the work after a click in the list: its report, its track with the error at
//! each point, the predicted path, and its events. A page is the work after a letter in the search:
//! the newest 200 matching passes, and their number. The file is in the memory of the system.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::{hint::black_box, path::Path, time::Instant};

use azel::{
    astro::{Angle, PointingModel, Site, time::add_seconds},
    clock::Clock,
    contract::{
        driver::TimeSync,
        record::{AboutTrack, PassQuery, RecordedReport, TrackedBy},
    },
    device::Pointing,
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes},
    plan::pass_report::{
        Evidence, FlownOffsets, MeasuredPosition, PassReport, PassVerdict, PathSource,
    },
    record::{self, PassNote, Recorder, open_pass},
    station::{Antenna, AntennaId, Retention, Station},
};
use jiff::{Timestamp, ToSpan as _};

const DAYS: i64 = 365;
const ANTENNAS: u32 = 3;
const LONGEST_S: f64 = 3600.0;
/// Number of runs; the bench reports the median and the longest.
const RUNS: usize = 50;
/// Number of passes between two writes: the recorder accepts at most some thousand pending orders.
const AT_ONCE: usize = 200;

/// Returns the passes of one day, as recorded by antennas.
fn day(site: Site, from: Timestamp) -> Vec<PassNote> {
    let catalog = bundled().unwrap();
    let mut notes = Vec::new();
    for number in Station::default().favourites.numbers() {
        let elements = catalog.get(number).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let search = PassSearch::new(site, from, from + 24.hours());
        // A satellite that does not set has a pass of a day.
        let found = passes(&propagator, &search, &|| false);
        for pass in found.into_iter().filter(|pass| pass.duration_s() < LONGEST_S) {
            let antenna = AntennaId(notes.len() as u32 % ANTENNAS + 1);
            notes.push(note(antenna, &elements, &propagator, site, &pass));
        }
    }
    notes
}

fn note(
    antenna: AntennaId,
    elements: &Elements,
    propagator: &Propagator,
    site: Site,
    pass: &Pass,
) -> PassNote {
    let (from, until) = (pass.aos.time, pass.los.time);
    let points: Vec<MeasuredPosition> = (0..pass.duration_s() as u32)
        .map(|second| {
            let time = add_seconds(from, f64::from(second));
            // The antenna points where the satellite was a third of a second ago.
            let look = propagator.look_from(site, add_seconds(time, -0.3)).unwrap().direction;
            let pointing =
                Pointing { azimuth: Some(look.azimuth), elevation: Some(look.elevation) };
            MeasuredPosition { time, pointing }
        })
        .collect();
    let measured = points.iter().filter_map(|flown| {
        let azimuth = flown.pointing.azimuth?;
        let elevation: Angle = flown.pointing.elevation?;
        Some((flown.time, azel::astro::AzEl { azimuth, elevation }))
    });
    let mount = Antenna::rc2000c("Horn", "/dev/ttyS0").mount;
    let source = PathSource::Unit { clock_ahead_s: None, place: None };
    let causes = Evidence::new(mount, true, Angle::from_degrees(0.44))
        .with_pass(propagator, site, source, measured)
        .explanations(&[]);
    let counted_s = pass.duration_s();
    let report = RecordedReport {
        start: from,
        end: until,
        planned: None,
        max_elevation_deg: pass.max_elevation().degrees(),
        age_days: 0.4,
        elements: elements.clone(),
        site: Some(site),
        half_beam_deg: 0.44,
        track: AboutTrack {
            begun: from,
            tracked_by: TrackedBy::OnBoard,
            sent: None,
            offsets: FlownOffsets::default(),
            pointing_model: PointingModel::default(),
            unit_clock_ahead_s: Some(-0.3),
            unit_place: None,
            sync: TimeSync::Synchronised,
        },
        report: PassReport {
            verdict: PassVerdict::Good,
            counted_s,
            known_s: counted_s,
            in_beam_s: counted_s,
            rms: None,
            worst: None,
            losses: Vec::new(),
        },
        causes,
    };
    PassNote { antenna, report, points }
}

/// Returns the same pass `days` days later.
fn later(note: &PassNote, days: i64) -> PassNote {
    let by = (days * 24).hours();
    let mut note = note.clone();
    let report = &mut note.report;
    for time in [&mut report.start, &mut report.end, &mut report.track.begun] {
        *time += by;
    }
    note.points.iter_mut().for_each(|point| point.time += by);
    note
}

/// Writes a year of passes that ends now, and returns their number per day.
fn write(path: &Path, site: Site) -> usize {
    let from = Timestamp::now() - (DAYS * 24).hours();
    let day = day(site, from);
    let recorder = Recorder::start(path.to_owned(), Clock::system(), Retention::default()).unwrap();
    for days in 0..DAYS {
        for (place, note) in day.iter().enumerate() {
            recorder.note_pass(later(note, days));
            if place % AT_ONCE == AT_ONCE - 1 {
                recorder.flush();
            }
        }
        recorder.flush();
    }
    day.len()
}

fn timed(what: &str, mut run: impl FnMut()) {
    let mut taken_ms: Vec<f64> = (0..RUNS)
        .map(|_| {
            let started = Instant::now();
            run();
            started.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    taken_ms.sort_by(f64::total_cmp);
    let [median, longest] = [RUNS / 2, RUNS - 1].map(|place| *taken_ms.get(place).unwrap());
    println!("{what}: {median:.1} ms, at most {longest:.1} ms");
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.sqlite");
    let site = Station::default().site;
    let started = Instant::now();
    let a_day = write(&path, site);
    let megabytes = path.metadata().unwrap().len() as f64 / 1e6;
    let taken_s = started.elapsed().as_secs_f64();
    println!("{a_day} passes a day for {DAYS} days: {megabytes:.0} MB, written in {taken_s:.0} s");

    let newest = PassQuery { count: 200, ..PassQuery::default() };
    let all = record::passes(&path, &newest).unwrap().all;
    let a_month_ago = i64::from(all) - 30 * i64::try_from(a_day).unwrap();
    assert!(open_pass(&path, a_month_ago, site).unwrap().is_some());
    timed("open a pass of a month ago", || {
        black_box(open_pass(&path, black_box(a_month_ago), site).unwrap());
    });
    timed("the newest 200 passes", || {
        black_box(record::passes(&path, &newest).unwrap());
    });
    for text in ["ISS", "20", "no such satellite"] {
        let query = PassQuery { text: text.to_owned(), ..newest.clone() };
        timed(&format!("the newest 200 passes of \"{text}\""), || {
            black_box(record::passes(&path, &query).unwrap());
        });
    }
}
