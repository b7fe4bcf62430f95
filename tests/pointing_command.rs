//! `azel pointing` on a record of passes whose pointing errors are known.

use std::{
    path::Path,
    process::{Command, Output},
};

use azel::{
    astro::{Angle, AzEl, PointingModel, Site, time::add_seconds},
    clock::Clock,
    contract::{
        driver::TimeSync,
        record::{AboutTrack, Peak, PeakBody, PeakChange, RecordedReport, TrackedBy},
    },
    controller::SPECS,
    device::Pointing,
    orbit::{PassSearch, Propagator, bundled, passes},
    plan::{
        MountLimits, Trackability,
        pass_report::{Breaks, FlownOffsets, MeasuredPosition, TrackedPass},
    },
    record::{Entry, Kind, PassNote, Recorder},
    station::{Antenna, AntennaId, Retention, load},
};
use jiff::Timestamp;
use serde_json::Value;

use super::plan_command::{folder, text};

/// Catalog numbers of ISS, METOP-C, NOAA 20, NOAA 21 and AQUA.
const SATELLITES: [u32; 5] = [25_544, 43_689, 43_013, 54_234, 27_424];
const NOISE_DEG: f64 = 0.02;

fn model() -> PointingModel {
    PointingModel {
        azimuth_offset_deg: 0.3,
        elevation_offset_deg: -0.1,
        tilt_north_deg: 0.12,
        tilt_east_deg: -0.08,
        ..PointingModel::default()
    }
}

/// Draws noise that is evenly spread in a range of 0.04° and the same in each run.
fn noise_deg(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*seed >> 40) as f64 / f64::from(1 << 24) - 0.5) * 2.0 * NOISE_DEG
}

fn fly(recorder: &Recorder, antenna: &Antenna, site: Site, number: u32, seed: &mut u64) {
    let elements = bundled().unwrap().get(number).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    let search = PassSearch::new(site, start, add_seconds(start, 86_400.0));
    for pass in passes(&propagator, &search, &|| false) {
        let (from, until) = (pass.aos.time, pass.los.time);
        let points: Vec<MeasuredPosition> = (0..pass.duration_s() as u32)
            .filter_map(|second| {
                let time = add_seconds(from, f64::from(second));
                let wanted = propagator.look_from(site, time).unwrap().direction;
                let AzEl { azimuth, elevation } = model().reading(wanted)?;
                let [a, b] = [noise_deg(seed), noise_deg(seed)].map(Angle::from_degrees);
                let pointing =
                    Pointing { azimuth: Some(azimuth + a), elevation: Some(elevation + b) };
                Some(MeasuredPosition { time, pointing })
            })
            .collect();
        let half_beam = Angle::from_degrees(0.5);
        let breaks = Breaks::default();
        let tracked = TrackedPass {
            propagator: &propagator,
            site,
            start: from,
            end: until,
            limits: MountLimits {
                mount: antenna.mount,
                maximum_rate_deg_s: 10.0,
                half_beam,
                has_elevation: true,
                min_elevation: Angle::ZERO,
            },
            trackability: Trackability::Whole,
            ended: None,
            breaks: &breaks,
        };
        recorder.note_pass(PassNote {
            antenna: antenna.id,
            report: RecordedReport {
                start: from,
                end: until,
                planned: None,
                max_elevation_deg: pass.max_elevation().degrees(),
                age_days: 1.0,
                site: Some(site),
                half_beam_deg: half_beam.degrees(),
                track: AboutTrack {
                    begun: from,
                    tracked_by: TrackedBy::ProgramTrack,
                    sent: None,
                    offsets: FlownOffsets::default(),
                    pointing_model: PointingModel::default(),
                    unit_clock_ahead_s: None,
                    unit_place: None,
                    sync: TimeSync::Synchronised,
                },
                report: tracked.report(&points),
                causes: Vec::new(),
                elements: elements.clone(),
            },
            points,
        });
        recorder.flush();
    }
}

fn pointing(folder: &Path, arguments: &[&str]) -> Output {
    let file = |name: &str| folder.join(name).display().to_string();
    Command::new(env!("CARGO_BIN_EXE_azel"))
        .args(["pointing", "--station", &file("station.toml"), "--file", &file("record.sqlite")])
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn the_model_of_recorded_passes_is_told_with_what_it_is_sure_of() {
    let folder = folder();
    let station = load(&folder.path().join("station.toml"), SPECS).unwrap().station;
    let antenna = station.antennas.iter().find(|antenna| antenna.name == "RC2000C").unwrap();
    let clock = Clock::new(|| "2026-08-13T00:00:00Z".parse().unwrap());
    let path = folder.path().join("record.sqlite");
    let recorder = Recorder::start(path, clock, Retention::default()).unwrap();
    let mut seed = 7;
    for number in SATELLITES {
        fly(&recorder, antenna, station.site, number, &mut seed);
    }
    // Record a peak as Preferences does, for this antenna and for another one.
    let at = "2026-08-12T10:00:00Z".parse().unwrap();
    let peak = Peak { body: PeakBody::Moon, time: at, azimuth_deg: 180.0, elevation_deg: 60.0 };
    for of in [antenna.id, AntennaId(99)] {
        let now = Clock::new(|| "2026-08-13T00:00:00Z".parse().unwrap()).now();
        recorder.note(Entry::new(now, Some(of), Kind::Peak, &PeakChange::Added(peak)));
    }
    drop(recorder);

    let json = pointing(folder.path(), &["--antenna", "RC2000C", "--format", "json"]);
    assert_eq!(json.status.code(), Some(0), "{}", text(&json.stderr));
    assert!(text(&json.stderr).contains("Nothing of it is applied"));
    let told: Value = serde_json::from_slice(&json.stdout).unwrap();
    let truth = serde_json::to_value(model()).unwrap();
    let mut kept = 0;
    for term in told["terms"].as_array().unwrap() {
        let name = term["term"].as_str().unwrap();
        let Some(value) = term["value"].as_f64() else {
            assert!(!term["not_told_from"].as_array().unwrap().is_empty(), "{name}");
            continue;
        };
        let half = term["half_of_95_percent"].as_f64().unwrap();
        let key = if name == "elevation_scale" { name.to_owned() } else { format!("{name}_deg") };
        let off = (value - truth[&key].as_f64().unwrap()).abs();
        assert!(off <= 2.0 * half, "{name} {value} ±{half}, {off} off");
        kept += 1;
    }
    assert_eq!(kept, 8, "{told}");
    // The noise is evenly spread in ±0.02°.
    let noise_deg = told["noise"][0]["noise_deg"].as_f64().unwrap();
    assert!((noise_deg - NOISE_DEG / 3.0_f64.sqrt()).abs() < 0.001, "{noise_deg}");

    // The offset of the azimuth is the greatest error; the tilt acts with it.
    let best = &told["causes"]["explanations"][0];
    let kinds = ["cause", "with"].map(|key| match &best[key] {
        Value::Object(second) => second["cause"].as_str().unwrap().to_owned(),
        first => first.as_str().unwrap().to_owned(),
    });
    assert_eq!(kinds, ["azimuth_offset", "tilt"], "{told}");
    assert!(best["share"].as_f64().unwrap() > 0.9, "{best}");

    let sun = "2026-08-12T12:00:00Z,180.0,60.0";
    let table = pointing(folder.path(), &["--antenna", "RC2000C", "--sun", sun]);
    let table = text(&table.stdout);
    assert!(table.contains("Tilt to the north") && table.contains("Points on Sun: 1,"), "{table}");
    assert!(table.contains("Azimuth offset +0.3"), "{table}");
    assert!(table.contains("Points on Moon: 1,"), "the one that was entered: {table}");
    let none = pointing(folder.path(), &["--antenna", "RC2000C", "--to", "2026-08-12"]);
    assert_eq!(none.status.code(), Some(1));
    assert!(text(&none.stderr).contains("too few"), "{}", text(&none.stderr));
}

#[test]
fn an_antenna_that_has_no_such_model_is_refused_by_name() {
    let folder = folder();
    let refusal = |arguments: &[&str]| {
        let output = pointing(folder.path(), arguments);
        assert_ne!(output.status.code(), Some(0));
        text(&output.stderr)
    };
    assert!(refusal(&[]).contains("Name one with --antenna: Satrak, Genius, RC2000C."));
    assert!(refusal(&["--antenna", "Satrak"]).contains("Satrak has an X/Y mount"));
    assert!(refusal(&["--antenna", "Nobody"]).contains("There is no antenna Nobody"));
    let wrong = refusal(&["--antenna", "RC2000C", "--sun", "2026-08-12T12:00:00Z,900,60"]);
    assert!(wrong.contains("900 is not an angle from -360 to 720"), "{wrong}");
}
