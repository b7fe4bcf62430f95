//! Records for tests, also of higher packages.

#![allow(clippy::unwrap_used, clippy::missing_panics_doc, reason = "a test may end here")]

use std::path::Path;

use jiff::{Timestamp, ToSpan as _};

use super::{PassNote, RecordedSession, Recorder};
use crate::{
    astro::{PointingModel, time::add_seconds},
    clock::Clock,
    contract::{
        driver::{TimeSync, WireLog},
        record::{AboutTrack, RecordedReport, TrackedBy},
    },
    device::Pointing,
    driver::PositionLog,
    orbit::{Propagator, bundled},
    plan::pass_report::{
        FlownOffsets, LossCause, LostStretch, MeasuredPosition, PassReport, PassVerdict,
    },
    station::{AntennaId, Retention},
};

/// Number of points of a pass.
pub const POINTS: usize = 60;

/// Returns a pass of ten minutes that lost its second minute.
pub fn note(antenna: AntennaId, satellite: u32, start: Timestamp) -> PassNote {
    let elements = bundled().unwrap().get(satellite).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let point = |second| {
        let time = add_seconds(start, second);
        let direction =
            propagator.look_from(crate::astro::Site::default(), time).unwrap().direction;
        MeasuredPosition { time, pointing: Pointing::from(direction) }
    };
    let points = (0..POINTS).map(|second| point(second as f64)).collect();
    let lost = LostStretch {
        start: start + 1.minutes(),
        end: start + 2.minutes(),
        cause: LossCause::Slew,
    };
    let report = RecordedReport {
        start,
        end: start + 10.minutes(),
        planned: None,
        max_elevation_deg: 50.0,
        age_days: 0.5,
        elements,
        site: None,
        half_beam_deg: 0.5,
        track: AboutTrack {
            begun: start,
            tracked_by: TrackedBy::ProgramTrack,
            sent: None,
            offsets: FlownOffsets::default(),
            pointing_model: PointingModel::default(),
            unit_clock_ahead_s: None,
            unit_place: None,
            sync: TimeSync::NotKnown,
        },
        report: PassReport {
            verdict: PassVerdict::Poor,
            counted_s: 600.0,
            known_s: 600.0,
            in_beam_s: 540.0,
            rms: None,
            worst: None,
            losses: vec![lost],
        },
        causes: Vec::new(),
    };
    PassNote { antenna, report, points }
}

/// Writes passes of the antenna "Dish" into the record at `path`.
pub fn record(path: &Path, notes: impl IntoIterator<Item = PassNote>) {
    let clock = Clock::new(Timestamp::now);
    let recorder = Recorder::start(path.to_owned(), clock.clone(), Retention::default()).unwrap();
    for note in notes {
        recorder.follow(RecordedSession {
            moment: clock.now(),
            antenna: note.antenna,
            name: "Dish".to_owned(),
            make: "satrak",
            wire: WireLog::default(),
            positions: PositionLog::default(),
        });
        recorder.note_pass(note);
    }
    recorder.flush();
}
