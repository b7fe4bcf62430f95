//! Traces that a station leaves in its record.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use azel::{
    astro::{Angle, Offset, PointingModel, Term, TrackOffsets},
    contract::{
        Command,
        alarms::AlarmKind,
        driver::{self, OffsetChange},
        passes::PredictedPass,
        record::{ListedKind, PassQuery, Peak, PeakBody, PeakChange, Peaks, Row},
        recorded::{Found, RecordLook},
    },
    controller::SPECS,
    engine::{Client, record_path},
    orbit::{Pass, PassSearch, Propagator, bundled, passes},
    plan::{
        pass_report::{Cause, LossCause, PassReport, PassVerdict},
        pointing,
    },
    record::{Kind, Query, Record, RowKind, read_peaks},
    sim::{InMemory as _, Trouble},
    station::{self, OffsetsSubject, Station},
};
use jiff::{SignedDuration, ToSpan as _};
use tokio::time::sleep;

use super::scene::{Scene, operation, set_automatic};
use crate::common::units::{self, antenna, measured, start, until};

pub(super) const ISS: u32 = 25_544;

pub(super) fn rows(scene: &Scene, what: RowKind) -> Vec<Row> {
    rows_in(scene.folder(), what)
}

/// Returns the path of the station's record in this folder.
pub(super) fn path_in(folder: &Path) -> PathBuf {
    record_path(&folder.join("records"), &folder.join("station.toml"))
}

pub(super) fn rows_in(folder: &Path, what: RowKind) -> Vec<Row> {
    let mut rows = Vec::new();
    let query = Query { row_kinds: vec![what], ..Query::default() };
    let Ok(mut record) = Record::open(&path_in(folder)) else { return rows };
    let read = record.read(&query, &mut |row| {
        rows.push(row);
        true
    });
    read.unwrap();
    rows
}

/// Max number of looks for a report, one every five seconds; each look reads the file of the
/// record.
const LOOKS: usize = 2_000;

/// Waits for the reports of passes and returns them.
pub(super) async fn reports(scene: &Scene) -> Vec<Row> {
    for _ in 0..LOOKS {
        let reports = rows(scene, RowKind::Pass);
        if !reports.is_empty() {
            return reports;
        }
        sleep(Duration::from_secs(5)).await;
    }
    panic!("waited too long for the report of a pass");
}

pub(super) fn next_pass(station: &Station) -> Pass {
    let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    passes(&propagator, &search, &|| false)[0]
}

/// Tracks the next listed pass of the ISS with the antenna of this name.
pub(super) async fn track(client: &Client, name: &str) {
    let id = measured(client, name).await;
    let pass = until("the pass", || {
        let lists = client.snapshot().pass_lists.clone();
        let list = lists.favourites.passes.iter().find(|pass| pass.number() == ISS)?.key();
        Some(list)
    })
    .await;
    until("the track", || {
        let _ = client.send(Command::ProgramTrackPass { antenna: id, pass });
        antenna(client, name)?.1.tracks
    })
    .await;
}

#[tokio::test(start_paused = true)]
async fn a_pass_that_was_tracked_is_reported_when_it_is_over() {
    let station = Station { favourites: [ISS].into(), ..units::station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let client = scene.client();
    track(&client, "Mast").await;
    let reports = reports(&scene).await;
    let [row] = &reports[..] else { panic!("{reports:?}") };
    assert_eq!(row.antenna.as_deref(), Some("Mast"));
    assert_eq!(row.data["satellite"], ISS);
    let told = &row.data["report"];
    assert_eq!(
        (&told["tracked_by"], &told["elements"]["catalog_number"]),
        (&"program_track".into(), &ISS.into())
    );
    assert!(told["sent"].as_u64().unwrap() > 0, "{told}");
    let report: PassReport = serde_json::from_value(told.clone()).unwrap();
    assert!((report.counted_s - pass.duration_s()).abs() < 60.0, "{report:?}");
    assert!(report.known_s > 0.9 * report.counted_s, "{report:?}");
    // Steps of whole degrees stay within half of the wider beam.
    assert!(report.share() > 0.9, "{report:?}");
    assert!(rows(&scene, RowKind::Position).len() > 500);

    let all = PassQuery { count: 10, ..PassQuery::default() };
    let found = look(&client, &RecordLook { query: all.clone(), opened: None }).await;
    assert_eq!((found.page.matching, found.page.all, found.page.unreadable), (1, 1, 0));
    let [listed] = &found.page.passes[..] else { panic!("{found:?}") };
    assert_eq!((listed.antenna_name.as_str(), &listed.report.report), ("Mast", &report));
    assert_eq!(found.opened, None);
    let opened =
        look(&client, &RecordLook { query: all.clone(), opened: Some(listed.id) }).await.opened;
    let opened = opened.unwrap();
    assert!(opened.track.len() as f64 > 0.8 * report.counted_s, "about a point a second");
    let worst = opened.track.iter().map(|point| point.error.off_deg).fold(0.0, f64::max);
    let known = report.worst.unwrap().error.off_deg;
    assert!(worst <= known + 1e-3 && worst > 0.5 * known, "{worst} {known}");
    let (first, last) = (opened.path.first().unwrap(), opened.path.last().unwrap());
    assert_eq!((first.time, last.time), (listed.report.start, listed.report.end));
    let asked = |row: &Row| row.kind == "command" && row.time < listed.report.end;
    assert!(opened.entries.iter().any(asked), "{:?}", opened.entries);
    for (text, matching) in [("iss", 1), ("25544", 1), ("METOP", 0), ("1999-01-01", 0)] {
        let query = PassQuery { text: text.to_owned(), ..all.clone() };
        let found = look(&client, &RecordLook { query, opened: None }).await;
        assert_eq!(found.page.matching, matching, "{text}");
    }
    let poor = PassQuery { kind: Some(ListedKind::Tracked(PassVerdict::Poor)), ..all };
    let is_poor = u32::from(report.verdict == PassVerdict::Poor);
    let found = look(&client, &RecordLook { query: poor, opened: None }).await;
    assert_eq!(found.page.matching, is_poor);
}

#[tokio::test(start_paused = true)]
async fn with_a_pointing_model_the_axes_read_otherwise_and_the_report_tells_no_error_of_it() {
    let model = PointingModel {
        azimuth_offset_deg: 4.0,
        elevation_offset_deg: -1.5,
        tilt_east_deg: 0.8,
        ..PointingModel::default()
    };
    let mut station = Station { favourites: [ISS].into(), ..units::station() };
    let mast = station.antennas.iter_mut().find(|of| of.name == "Mast").unwrap();
    mast.pointing_model = model;
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let file = scene.folder().join("station.toml");
    let read = station::load(&file, SPECS).unwrap().station;
    assert!(read.antennas.iter().any(|of| of.name == "Mast" && of.pointing_model == model));
    let client = scene.client();
    track(&client, "Mast").await;
    let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
    let [read, on_sky] = until("the track", || {
        let snapshot = client.snapshot();
        let mast = snapshot.antennas.iter().find(|of| of.config.name == "Mast")?;
        mast.error().filter(|error| error.off_beam.degrees() < 1.5)?;
        let at = mast.snapshot.state.measured?;
        let read = at.direction()?;
        let satellite = propagator.look_from(station.site, at.time).ok()?.direction;
        let is_high = satellite.elevation_deg() > 6.0;
        is_high
            .then_some([read, model.direction(read)].map(|of| of.separation(satellite).degrees()))
    })
    .await;
    assert!(read > 2.5 && on_sky < 1.5, "{read} {on_sky}");
    let reports = reports(&scene).await;
    let told = &reports[0].data["report"];
    assert_eq!(told["pointing_model"], serde_json::to_value(model).unwrap());
    let report: PassReport = serde_json::from_value(told.clone()).unwrap();
    assert!(report.share() > 0.9 && report.rms.unwrap().off_deg < 1.5, "{report:?}");
    let query = PassQuery { count: 10, ..PassQuery::default() };
    let listed = look(&client, &RecordLook { query: query.clone(), opened: None }).await;
    let opened = Some(listed.page.passes[0].id);
    let opened = look(&client, &RecordLook { query, opened }).await.opened.unwrap();
    let median = &opened.track[opened.track.len() / 2];
    assert!(median.antenna.separation(median.satellite).degrees() < 1.5, "{median:?}");
    let id = measured(&client, "Mast").await;
    client.send(Command::FitPointing(id, Vec::new())).unwrap();
    let fit = until("its fit", || {
        let fitted = client.snapshot().pointing_fitted.clone()?;
        fitted.found.clone().filter(|_| fitted.antenna == id)
    })
    .await
    .unwrap();
    // The pass was flown with the model, and the fit finds the model again.
    let offset = &fit.terms[0];
    let value = offset.value.unwrap();
    assert_eq!((fit.passes, offset.term), (1, Term::AzimuthOffset));
    assert!((value - model.azimuth_offset_deg).abs() < 1.0, "{offset:?}");
    assert_eq!(offset.half_of_95_percent, None, "one pass does not tell it from a collimation");
    let peak = Peak { body: PeakBody::Sun, time: start(), azimuth_deg: 100.0, elevation_deg: 20.0 };
    let wrong = Peak { azimuth_deg: 10.0, ..peak };
    for change in [PeakChange::Added(wrong), PeakChange::Added(peak), PeakChange::Removed(wrong)] {
        client.send(Command::ChangePeaks(id, change)).unwrap();
    }
    let is_known = |peaks: &Peaks| peaks.for_antenna(id).eq([&peak]);
    until("the peak", || is_known(&client.snapshot().peaks).then_some(())).await;
    client.send(Command::FitPointing(id, vec![Term::Sag])).unwrap();
    let fit = until("a fit with it", || {
        let found = client.snapshot().pointing_fitted.clone()?.found.clone()?.unwrap();
        (found.excluded == [Term::Sag]).then_some(found)
    })
    .await;
    let of_sun = fit.noise.iter().find(|of| of.kind == pointing::Kind::Sun).unwrap();
    assert_eq!(of_sun.points, 1);
    assert!(fit.terms.iter().any(|of| of.term == Term::Sag && of.value.is_none()), "{fit:?}");
    drop(client);
    let ended = scene.ended().await;
    let kept = read_peaks(&path_in(ended.path())).unwrap();
    assert!(is_known(&kept), "{kept:?}");
}

#[tokio::test(start_paused = true)]
async fn a_pass_is_flown_with_the_offsets_that_are_remembered_and_reported_beside_them() {
    let mut station = Station { favourites: [ISS].into(), ..units::station() };
    let mast = station.antennas.iter().find(|of| of.name == "Mast").unwrap().id;
    let with = |step| TrackOffsets::NONE.plus(step).unwrap();
    let azimuth = with(Offset::Azimuth(Angle::from_degrees(6.0)));
    station.keep_offsets(OffsetsSubject::Antenna(mast), azimuth);
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let client = scene.client();
    track(&client, "Mast").await;
    let time = with(Offset::Time(SignedDuration::from_secs(2)));
    let of = OffsetsSubject::Satellite(ISS);
    client.send(Command::KeepOffsets { subject: of, offsets: time }).unwrap();
    let row = reports(&scene).await.remove(0);
    let told = &row.data["report"];
    assert_eq!(told["offsets"][0][1]["azimuth_deg"], 6.0, "{told}");
    let report: PassReport = serde_json::from_value(told.clone()).unwrap();
    let rms = report.rms.unwrap();
    assert!(rms.off_deg < 2.0, "whole degrees beside where it should point: {rms:?}");
    let shown = client.snapshot();
    assert_eq!(shown.station.first_offsets(mast, Some(ISS)), time.with_axes_of(azimuth));
}

#[tokio::test(start_paused = true)]
async fn a_pass_of_a_unit_is_reported_beside_the_offset_that_was_added_to_it() {
    let station = Station { favourites: [ISS].into(), ..units::station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let client = scene.client();
    let dish = measured(&client, "Dish").await;
    let key = until("the pass", || {
        let lists = client.snapshot().pass_lists.clone();
        lists.favourites.passes.iter().find(|pass| pass.number() == ISS).map(PredictedPass::key)
    })
    .await;
    client.send(Command::Track { antenna: dish, pass: key, is_agreed: false }).unwrap();
    let dish_of = |snapshot: &azel::contract::Snapshot| {
        let found = snapshot.antennas.iter().find(|of| of.id() == dish)?;
        Some(std::sync::Arc::clone(&found.snapshot))
    };
    until("the track", || {
        let shown = dish_of(&client.snapshot())?;
        let is_on = shown.state.program.is_some_and(|program| program.enabled);
        (is_on && !shown.pending).then_some(())
    })
    .await;
    let azimuth = Offset::Azimuth(Angle::from_degrees(2.0));
    let step = driver::Command::Offset(OffsetChange::Step(azimuth));
    client.send(Command::Antenna(dish, step)).unwrap();
    let row = reports(&scene).await.remove(0);
    let told = &row.data["report"];
    assert_eq!(told["tracked_by"], "on_board");
    assert_eq!(told["offsets"][0][1]["azimuth_deg"], 2.0, "{told}");
    let report: PassReport = serde_json::from_value(told.clone()).unwrap();
    let rms = report.rms.unwrap();
    assert!(rms.off_deg < 0.3, "beside where it should point: {rms:?}");
    until("it is taken back", || dish_of(&client.snapshot())?.unit_offsets.is_none().then_some(()))
        .await;
    let alarms = client.snapshot().alarms.clone();
    assert!(!alarms.list().iter().any(|alarm| matches!(
        alarm.kind,
        AlarmKind::OffTarget { .. } | AlarmKind::UnitDiffers(_) | AlarmKind::OffsetsLeft { .. }
    )));
}

#[tokio::test(start_paused = true)]
async fn while_a_unit_tracks_by_itself_its_late_clock_is_told_by_the_error() {
    let station = Station { favourites: [ISS].into(), ..units::station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let client = scene.client();
    let dish = measured(&client, "Dish").await;
    let late = Trouble::ClockLate(Duration::from_millis(1500));
    assert!(scene.units.dish.set_trouble(late, true));
    let pass = until("the pass", || {
        let lists = client.snapshot().pass_lists.clone();
        let list = lists.favourites.passes.iter().find(|pass| pass.number() == ISS)?.key();
        Some(list)
    })
    .await;
    client.send(Command::Track { antenna: dish, pass, is_agreed: true }).unwrap();
    until("the track", || antenna(&client, "Dish")?.1.tracks).await;
    let explained = until("its explanation", || {
        let snapshot = client.snapshot();
        snapshot.antennas.iter().find(|of| of.id() == dish)?.explained.clone()
    })
    .await;
    let Cause::Late { late_s } = explained.causes[0].cause else { panic!("{explained:?}") };
    assert!((1.3..1.7).contains(&late_s) && explained.causes[0].share > 0.8, "{explained:?}");
    assert!(rows(&scene, RowKind::Pass).is_empty(), "the pass goes on");
}

#[tokio::test(start_paused = true)]
async fn a_pass_under_way_is_reported_when_the_program_ends() {
    let station = Station { favourites: [ISS].into(), ..units::station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 4.minutes(), &station);
    let client = scene.client();
    track(&client, "Mast").await;
    until("the middle of the pass", || (client.now().utc > pass.tca.time).then_some(())).await;
    drop(client);
    let ended = scene.ended().await;
    let reports = rows_in(ended.path(), RowKind::Pass);
    let [row] = &reports[..] else { panic!("{reports:?}") };
    let report: PassReport = serde_json::from_value(row.data["report"].clone()).unwrap();
    let last = report.losses.last().unwrap();
    assert_eq!((last.cause, report.verdict), (LossCause::ProgramEnded, PassVerdict::Poor));
    assert!(report.in_beam_s > 60.0 && report.known_s < 0.8 * report.counted_s, "{report:?}");
}

/// Asks for a part of the record and waits until the station publishes it.
async fn look(client: &Client, look: &RecordLook) -> Found {
    client.send(Command::LookAtRecord(Some(look.clone()))).unwrap();
    until("the record", || {
        let recorded = client.snapshot().recorded.clone()?;
        (recorded.look == *look).then(|| recorded.found.clone().unwrap())
    })
    .await
}

#[tokio::test(start_paused = true)]
async fn what_automatic_operation_does_is_in_the_record() {
    let station = Station { favourites: [ISS].into(), ..units::station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 6.minutes(), &station);
    let client = scene.client();
    let mast = measured(&client, "Mast").await;
    set_automatic(&client, mast, true).await;
    until("the pass", || operation(&client, mast).taking()?.proved_at).await;
    let is_track = |row: &Row| {
        let data = &row.data;
        let what = &data["command"]["Antenna"][1];
        data["by"] == "station" && what["ProgramTrack"]["target"]["Satellite"].is_object()
    };
    super::until_recorded("its command", || {
        let commands = rows(&scene, RowKind::Entry(Kind::Command));
        commands.iter().any(is_track).then_some(())
    })
    .await;
    let day = rows(&scene, RowKind::Entry(Kind::Day));
    assert_eq!(day[0].data["what"], "switched_on", "{day:?}");

    until("the middle of the pass", || (client.now().utc > pass.tca.time).then_some(())).await;
    let states = rows(&scene, RowKind::Entry(Kind::State)).into_iter();
    let mut states =
        states.filter(|row| row.antenna.as_deref() == Some("Mast")).map(|row| row.data);
    let mut before = states.next().unwrap();
    for mut state in states {
        if let Some(on) = state.pointer_mut("/operation/on") {
            on["moved_at"] = serde_json::Value::Null;
        }
        assert_ne!(before, state, "nothing has changed but the time");
        before = state;
    }
}
