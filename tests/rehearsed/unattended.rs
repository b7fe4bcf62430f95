//! Events that end automatic operation, and events that do not: one antenna, some minutes before a
//! pass.

use std::{
    sync::{
        Arc,
        atomic::{AtomicI64, Ordering},
    },
    time::Duration,
};

use azel::{
    astro::time::{add_seconds, seconds_between},
    clock::{Clock, Instant},
    contract::{
        Command,
        alarms::AlarmKind,
        automatic::{
            DayEvent, Doing, GivenUp, Interruption, MissCause, NotReady, OffBecause, On, Operation,
        },
        closing::CloseHow,
        driver::{self, LinkState, TimeSync},
    },
    device::{Measured, Phase},
    engine::Client,
    orbit::{PassSearch, Propagator, bundled, passes},
    protocol::{
        rotator_genius::WholeDegrees,
        satrak::{FaultKind, Goto, Motion, Request, encode},
    },
    sim::{InMemory as _, Trouble, rotator_genius, satrak},
    station::{Antenna, AntennaId, LockOut, Monitor, Resume, Station},
};
use jiff::{Timestamp, ToSpan as _};
use tokio::io::AsyncWriteExt as _;

use super::{
    flown,
    scene::{Scene, operation, set_automatic},
};
use crate::common::units::{self, measured, start, until};

/// Time from the start of the station to AOS, seconds.
const BEFORE_S: f64 = 240.0;

/// Returns a station with this antenna alone, changed by `set`.
fn station(antenna: &str, set: impl FnOnce(&mut Antenna)) -> Station {
    let mut station = units::station();
    station.antennas.retain(|of| of.name == antenna);
    if let Some(antenna) = station.antennas.first_mut() {
        set(antenna);
    }
    station
}

/// Returns a time some minutes before a high pass of a favourite.
fn before_a_pass() -> Timestamp {
    let station = Station::default();
    let catalog = bundled().unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start(), start() + 12.hours())
    };
    let aos = station.favourites.numbers().into_iter().flat_map(|number| {
        let propagator = Propagator::new(catalog.get(number).unwrap()).unwrap();
        passes(&propagator, &search, &|| false)
    });
    let is_high = |maximum_deg: f64| (30.0..80.0).contains(&maximum_deg);
    let high = aos.filter(|pass| is_high(pass.tca.direction.elevation_deg()));
    let first = high.map(|pass| pass.aos.time).min().unwrap();
    add_seconds(first, -BEFORE_S)
}

pub(super) async fn scene_of(
    antenna: &str,
    set: impl FnOnce(&mut Antenna),
) -> (Scene, Client, AntennaId) {
    let scene = Scene::new(before_a_pass(), &station(antenna, set));
    let client = scene.client();
    let id = measured(&client, antenna).await;
    until("the schedule", || client.snapshot().schedule.made_at).await;
    (scene, client, id)
}

/// Switches automatic operation on and waits for the proof that the unit has taken its first pass.
pub(super) async fn proved(client: &Client, id: AntennaId) {
    set_automatic(client, id, true).await;
    until("the proof", || operation(client, id).taking()?.proved_at).await;
}

fn auto_track(client: &Client, id: AntennaId) -> Option<bool> {
    let snapshot = client.snapshot();
    let antenna = snapshot.antennas.iter().find(|of| of.id() == id)?;
    antenna.snapshot.state.program?.auto
}

async fn until_auto_track(client: &Client, id: AntennaId, is_on: bool) {
    until("auto-track", || (auto_track(client, id) == Some(is_on)).then_some(())).await;
}

async fn until_off(client: &Client, id: AntennaId, because: OffBecause) {
    until("its end", || (operation(client, id) == Operation::Off(because)).then_some(())).await;
}

fn stands(client: &Client, is_that: impl Fn(&AlarmKind) -> bool) -> bool {
    let snapshot = client.snapshot();
    let mut standing = snapshot.alarms.list().iter().filter(|alarm| !alarm.is_over());
    standing.any(|alarm| is_that(&alarm.kind))
}

async fn until_lost(client: &Client, id: AntennaId) {
    until("the loss of the link", || {
        let snapshot = client.snapshot();
        let antenna = snapshot.antennas.iter().find(|of| of.id() == id)?;
        matches!(antenna.snapshot.link, LinkState::Lost { .. }).then_some(())
    })
    .await;
}

/// Returns a go-to away from the start position of the dish.
fn elsewhere() -> Vec<u8> {
    Request::Motion(Motion::Goto(Goto::new(Some(200.0), Some(60.0)).unwrap())).to_bytes()
}

/// Sends `bytes` to the unit of the dish from another program.
pub(super) async fn by_another(scene: &Scene, bytes: &[u8]) {
    let (mut near, far) = tokio::io::duplex(4096);
    near.write_all(bytes).await.unwrap();
    near.shutdown().await.unwrap();
    let _ = scene.units.dish.serve(far).await;
}

#[tokio::test(start_paused = true)]
async fn stop_ends_it_and_auto_track_with_it() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    assert_eq!(auto_track(&client, id), Some(false));
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    client.stop_all();
    until_off(&client, id, OffBecause::Stop).await;
    until_auto_track(&client, id, false).await;
    until("standstill", || scene.units.all_stand().then_some(())).await;
    assert!(!stands(&client, |kind| matches!(kind, AlarmKind::AutomaticOff(_))), "by the operator");
    let stopped_at = client.now().utc;
    until("minutes", || (seconds_between(stopped_at, client.now().utc) > 400.0).then_some(()))
        .await;
    assert!(scene.units.all_stand(), "the pass does not start it again");
    assert_eq!(auto_track(&client, id), Some(false));
}

#[tokio::test(start_paused = true)]
async fn auto_track_of_a_unit_out_of_reach_is_switched_off_once_it_answers() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, true);
    until_lost(&client, id).await;
    set_automatic(&client, id, false).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, false);
    until_auto_track(&client, id, false).await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_cannot_tell_whether_auto_track_is_off_is_an_alarm() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    scene.units.dish.set_quirk(satrak::Quirk::Fields15, true);
    proved(&client, id).await;
    until("auto-track", || scene.units.dish.state().is_auto.then_some(())).await;
    set_automatic(&client, id, false).await;
    until("its end", || (!scene.units.dish.state().is_auto).then_some(())).await;
    until("the alarm", || stands(&client, |of| *of == AlarmKind::AutoTrackNotKnown).then_some(()))
        .await;
}

#[tokio::test(start_paused = true)]
async fn stop_after_another_start_ends_the_auto_track_of_the_run_before() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    let scene = scene.started_again(false).await;
    let client = scene.client();
    measured(&client, "Dish").await;
    until_auto_track(&client, id, true).await;
    client.stop_all();
    until_auto_track(&client, id, false).await;
}

#[tokio::test(start_paused = true)]
async fn what_the_operator_then_makes_of_auto_track_stays() {
    let (_scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    set_automatic(&client, id, false).await;
    until_auto_track(&client, id, false).await;
    until("the operator's choice", || {
        let _ = client.send(Command::Antenna(id, driver::Command::AutoTrack(true)));
        auto_track(&client, id).filter(|is_on| *is_on)
    })
    .await;
    let at = client.now().utc;
    until("a minute", || (seconds_between(at, client.now().utc) > 60.0).then_some(())).await;
    assert_eq!(auto_track(&client, id), Some(true));
}

#[tokio::test(start_paused = true)]
async fn an_antenna_that_another_program_moves_is_left_to_it_until_the_operator_comes() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    set_automatic(&client, id, true).await;
    by_another(&scene, &elsewhere()).await;
    let by = Interruption::Elsewhere;
    until("the suspension", || {
        let is_that =
            |of| matches!(of, Operation::Suspended { interruption: found, .. } if found == by);
        is_that(operation(&client, id)).then_some(())
    })
    .await;
    until("the alarm", || {
        stands(&client, |of| *of == AlarmKind::AutomaticSuspended(Interruption::Elsewhere))
            .then_some(())
    })
    .await;
    until("standstill", || scene.units.all_stand().then_some(())).await;
    assert!(!operation(&client, id).is_on(), "its end ends no suspension");
    let _ = client.send(Command::GoOn(id));
    until("it to go on", || operation(&client, id).is_on().then_some(())).await;
    until("the end", || {
        (!stands(&client, |of| *of == AlarmKind::AutomaticSuspended(Interruption::Elsewhere)))
            .then_some(())
    })
    .await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_given_another_satellite_is_left_to_whoever_did_it() {
    for is_in_pass in [false, true] {
        // The other satellite may be below the horizon.
        let (scene, client, id) = scene_of("Dish", |dish| dish.monitor = Monitor::Alarm).await;
        proved(&client, id).await;
        let taken = operation(&client, id).taking().copied().unwrap();
        if is_in_pass {
            let middle = add_seconds(taken.start, 60.0);
            until("the pass", || (client.now().utc > middle).then_some(())).await;
        }
        let favourites = Station::default().favourites.numbers();
        let number = favourites.into_iter().find(|number| *number != taken.pass.0).unwrap();
        let catalog = bundled().unwrap();
        let name = catalog.get(number).unwrap().name().trim();
        by_another(&scene, &encode(&format!("SATELLITE=,{},{name},1,1", satrak::BUNDLED_FILE)))
            .await;
        let by = Interruption::Elsewhere;
        until("the suspension", || {
            let is_that =
                |of| matches!(of, Operation::Suspended { interruption: found, .. } if found == by);
            is_that(operation(&client, id)).then_some(())
        })
        .await;
        let alarm = AlarmKind::AutomaticSuspended(by);
        until("the alarm", || stands(&client, |of| *of == alarm).then_some(())).await;
    }
}

#[tokio::test(start_paused = true)]
async fn an_antenna_that_is_nudged_at_its_panel_is_left_to_whoever_did_it() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    set_automatic(&client, id, true).await;
    let at = client.now().utc;
    until("it to stand", || (seconds_between(at, client.now().utc) > 30.0).then_some(())).await;
    assert!(operation(&client, id).is_on());
    let [x_deg, y_deg] = scene.units.dish.state().metal_deg;
    scene.units.dish.place([x_deg + 0.5, y_deg]);
    let by = Interruption::Elsewhere;
    until("the suspension", || {
        let is_that =
            |of| matches!(of, Operation::Suspended { interruption: found, .. } if found == by);
        is_that(operation(&client, id)).then_some(())
    })
    .await;
    let alarm = AlarmKind::AutomaticSuspended(by);
    until("the alarm", || stands(&client, |of| *of == alarm).then_some(())).await;
    let _ = client.send(Command::GoOn(id));
    proved(&client, id).await;
}

#[tokio::test(start_paused = true)]
async fn an_antenna_that_is_turned_while_it_tracks_or_waits_is_left_to_whoever_did_it() {
    for waits in [true, false] {
        let (scene, client, id) = scene_of("Mast", |_| {}).await;
        proved(&client, id).await;
        let is_on_its_path = || {
            let snapshot = client.snapshot();
            let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == id)?;
            if waits {
                let measured = antenna.snapshot.state.measured?;
                let view = antenna.snapshot.program_track.as_ref();
                let is_due = view.is_none_or(|view| {
                    view.commanded.is_some_and(|to| {
                        to.separation(measured.pointing).is_some_and(|off| off.degrees() < 2.0)
                    })
                });
                let program = antenna.snapshot.state.program;
                let is_at_start = program.is_none_or(|it| it.phase == Phase::AtStart);
                return (is_due && is_at_start && !measured.moving()).then_some(());
            }
            let error = antenna.error().filter(|_| antenna.tracks())?;
            (error.off_beam.degrees() < 2.0).then_some(())
        };
        until("the path", is_on_its_path).await;
        let (at, rest_s) = (client.now().utc, if waits { 15.0 } else { 60.0 });
        until("seconds", || (seconds_between(at, client.now().utc) > rest_s).then_some(())).await;
        assert!(operation(&client, id).is_on());
        let angles = scene.units.mast.state().rotators.map(|rotator| rotator.angle_deg);
        let [azimuth_deg, elevation_deg] = angles;
        let turned_deg = azimuth_deg + if azimuth_deg > 180.0 { -30.0 } else { 30.0 };
        let place = [turned_deg, elevation_deg].map(|deg| WholeDegrees::nearest(deg).unwrap());
        scene.units.mast.place(place);
        until("the suspension", || {
            let operation = operation(&client, id);
            let is_suspended = matches!(
                operation,
                Operation::Suspended { interruption: Interruption::Elsewhere, .. }
            );
            is_suspended.then_some(())
        })
        .await;
        assert!(
            stands(&client, |kind| *kind == AlarmKind::AutomaticSuspended(Interruption::Elsewhere)),
            "no alarm"
        );
        until("standstill", || scene.units.all_stand().then_some(())).await;
        let at = client.now().utc;
        until("a minute", || (seconds_between(at, client.now().utc) > 60.0).then_some(())).await;
        assert!(scene.units.all_stand(), "nothing takes it back");
        let _ = client.send(Command::GoOn(id));
        until("the path", is_on_its_path).await;
    }
}

#[tokio::test(start_paused = true)]
async fn an_antenna_that_is_turned_on_its_way_to_a_pass_is_left_to_whoever_did_it() {
    let (scene, client, id) = scene_of("Mast", |_| {}).await;
    let place = [350.0, 80.0].map(|deg| WholeDegrees::nearest(deg).unwrap());
    scene.units.mast.place(place);
    let at = client.now().utc;
    until("seconds", || (seconds_between(at, client.now().utc) > 5.0).then_some(())).await;
    set_automatic(&client, id, true).await;
    let turned_deg = || {
        let snapshot = client.snapshot();
        let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == id)?;
        let measured = antenna.snapshot.state.measured.filter(Measured::moving)?;
        Some(measured.axes.map(|axis| axis.angle_deg))
    };
    let began = until("the slew", turned_deg).await;
    let changed = || {
        let now = turned_deg()?;
        let turned = now.into_iter().zip(began).map(|(now, began)| Some(now? - began?));
        let turned_deg = turned.map(Option::unwrap_or_default).collect::<Vec<_>>();
        turned_deg.iter().any(|turned| turned.abs() > 5.0).then_some(turned_deg)
    };
    let way_deg = until("5 deg of the way", changed).await;
    assert!(operation(&client, id).is_on());
    // Turns the axis back that has turned most.
    let back = |at_deg: [f64; 2]| {
        let axis = usize::from(way_deg[1].abs() > way_deg[0].abs());
        let mut to_deg = at_deg;
        to_deg[axis] -= 10.0 * way_deg[axis].signum();
        to_deg
    };
    let angles = scene.units.mast.state().rotators.map(|rotator| rotator.angle_deg);
    scene.units.mast.place(back(angles).map(|deg| WholeDegrees::nearest(deg).unwrap()));
    until("the suspension", || {
        let operation = operation(&client, id);
        let is_suspended =
            matches!(operation, Operation::Suspended { interruption: Interruption::Elsewhere, .. });
        is_suspended.then_some(())
    })
    .await;
    let duty = client.snapshot();
    let antenna = duty.antennas.iter().find(|antenna| antenna.id() == id).unwrap();
    assert!(!antenna.tracks(), "on the way");
    until("standstill", || scene.units.all_stand().then_some(())).await;
    let at = client.now().utc;
    until("a minute", || (seconds_between(at, client.now().utc) > 60.0).then_some(())).await;
    assert!(scene.units.all_stand(), "nothing takes it back");
}

#[tokio::test(start_paused = true)]
async fn after_an_outage_it_goes_on_only_with_a_unit_that_is_as_it_was_left() {
    let offsets = encode("SETTINGS=,?,?,?,8.0,?,?,?,?,?,?,?");
    for change in [None, Some(elsewhere()), Some(offsets)] {
        let (scene, client, id) = scene_of("Dish", |_| {}).await;
        set_automatic(&client, id, true).await;
        scene.units.dish.set_fault(satrak::Fault::Silence, true);
        until_lost(&client, id).await;
        if let Some(change) = &change {
            by_another(&scene, change).await;
            until("standstill", || scene.units.all_stand().then_some(())).await;
        }
        scene.units.dish.set_fault(satrak::Fault::Silence, false);
        if change.is_some() {
            until_off(&client, id, OffBecause::NotAsLeft).await;
            let is_that = |of: &AlarmKind| *of == AlarmKind::AutomaticOff(OffBecause::NotAsLeft);
            until("the alarm", || stands(&client, is_that).then_some(())).await;
        } else {
            until("the pass", || operation(&client, id).taking()?.proved_at).await;
        }
    }
}

#[tokio::test(start_paused = true)]
async fn two_passes_that_the_unit_refuses_end_it_and_both_are_in_the_list_of_the_day() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    scene.units.dish.set_fault(satrak::Fault::RefuseSettings, true);
    set_automatic(&client, id, true).await;
    until_off(&client, id, OffBecause::Failures).await;
    let is_that = |of: &AlarmKind| *of == AlarmKind::AutomaticOff(OffBecause::Failures);
    until("the alarm", || stands(&client, is_that).then_some(())).await;
    until("both passes", || (flown(&client).len() >= 2).then_some(())).await;
    let causes: Vec<_> = flown(&client).iter().map(|(_, of)| of.cause).collect();
    let ended = MissCause::Off(OffBecause::Failures);
    assert_eq!(causes[..2], [Some(MissCause::Refused), Some(ended)]);
    assert!(scene.units.all_stand());
}

#[tokio::test(start_paused = true)]
async fn it_is_on_at_the_start_only_after_an_end_in_order_and_where_nothing_had_ended_it() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.is_on_at_start = true).await;
    assert!(!operation(&client, id).is_on(), "nothing is known of an earlier run");
    set_automatic(&client, id, true).await;
    let again = async |scene: Scene, is_crash: bool| {
        let scene = scene.started_again(is_crash).await;
        let client = scene.client();
        measured(&client, "Dish").await;
        let is_on = operation(&client, id).is_on();
        (scene, client, is_on)
    };
    let (scene, client, is_on) = again(scene, false).await;
    assert!(is_on, "after an end in order");
    drop(client);
    let (scene, client, is_on) = again(scene, true).await;
    assert!(!is_on, "after a crash");
    set_automatic(&client, id, true).await;
    set_automatic(&client, id, false).await;
    let (scene, client, is_on) = again(scene, false).await;
    assert!(!is_on, "the operator had switched it off");
    set_automatic(&client, id, true).await;
    client.stop_all();
    until_off(&client, id, OffBecause::Stop).await;
    let (scene, client, is_on) = again(scene, false).await;
    assert!(!is_on, "STOP had ended it");
    set_automatic(&client, id, true).await;
    let _ = client.send(Command::Antenna(id, driver::Command::Standby));
    until("the suspension", || (!operation(&client, id).is_on()).then_some(())).await;
    let (scene, client, is_on) = again(scene, false).await;
    assert!(!is_on, "the operator had not let it go on");
    set_automatic(&client, id, true).await;
    let (scene, client, is_on) = again(scene, false).await;
    assert!(is_on, "the operator had switched it on again");
    drop(client);
    let path = scene.folder().join("station.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{text}\n[[keep_out]]\nname = 'mast'\n")).unwrap();
    let (_scene, _, is_on) = again(scene, false).await;
    assert!(!is_on, "a keep-out cannot be read");
}

#[tokio::test(start_paused = true)]
async fn a_pass_that_the_unit_tracks_through_another_start_is_taken_over_without_a_motion() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.is_on_at_start = true).await;
    proved(&client, id).await;
    let taken = operation(&client, id).taking().copied().unwrap();
    until("the pass", || (client.now().utc > add_seconds(taken.start, 60.0)).then_some(())).await;
    let is_start = |(_, payload): &(_, String)| payload.starts_with("TRACK=");
    let starts =
        |scene: &Scene| scene.units.dish.received().iter().filter(|one| is_start(one)).count();
    let before = starts(&scene);
    let scene = scene.started_again(false).await;
    let client = scene.client();
    until("the pass again", || operation(&client, id).taking()?.proved_at).await;
    assert!(scene.units.dish.state().is_tracking);
    assert_eq!(starts(&scene), before);
    until("LOS", || flown(&client).first().cloned()).await;
    let (_, of) = &flown(&client)[0];
    assert!(of.in_beam_s > 0.5 * of.of_s, "{of:?}");
    assert!(operation(&client, id).is_on());
}

/// A motor fails before the pass and is repaired in the middle of it.
#[tokio::test(start_paused = true)]
async fn a_faulty_unit_raises_an_alarm_and_tracks_once_repaired() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    scene.units.dish.set_fault(satrak::Fault::Unit(FaultKind::XMotor), true);
    set_automatic(&client, id, true).await;
    let is_told = |kind: &AlarmKind| {
        matches!(kind, AlarmKind::NotOnItsWay { reason: Some(NotReady::Fault), .. })
    };
    until("the alarm", || stands(&client, is_told).then_some(())).await;
    assert!(scene.units.all_stand());
    seconds(&client, 200.0).await;
    assert!(operation(&client, id).is_on() && scene.units.all_stand());
    scene.units.dish.set_fault(satrak::Fault::Unit(FaultKind::XMotor), false);
    until("the pass", || operation(&client, id).taking()?.proved_at).await;
    until("the end of the alarm", || (!stands(&client, is_told)).then_some(())).await;
    let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
    assert!(of.in_beam_s > 60.0, "{of:?}");
    assert_eq!(of.cause, Some(MissCause::NotReady(NotReady::Fault)));
}

/// Switches automatic operation of the Genius on, runs `change`, and restarts the station after a
/// crash.
async fn after_a_crash(
    set: impl FnOnce(&mut Antenna),
    change: impl AsyncFnOnce(&Scene, &Client, AntennaId),
) -> (Scene, Client, AntennaId) {
    let (scene, client, id) = scene_of("Mast", |mast| {
        mast.automatic.resumes_after_crash = true;
        set(mast);
    })
    .await;
    set_automatic(&client, id, true).await;
    until("the next turn", || operation(&client, id).is_on().then_some(())).await;
    change(&scene, &client, id).await;
    drop(client);
    let mut scene = scene;
    scene.units.time_sync = || TimeSync::Synchronised;
    let scene = scene.started_again(true).await;
    let client = scene.client();
    measured(&client, "Mast").await;
    (scene, client, id)
}

pub(super) async fn seconds(client: &Client, seconds: f64) {
    let at = client.now().utc;
    let is_over = || (seconds_between(at, client.now().utc) > seconds).then_some(());
    until("seconds", is_over).await;
}

#[tokio::test(start_paused = true)]
async fn automatic_operation_resumes_after_a_crash_and_announces_motion() {
    let (scene, client, id) = after_a_crash(|_| {}, async |_, _, _| {}).await;
    assert!(!operation(&client, id).is_on(), "the unit has to rest first");
    seconds(&client, 15.0).await;
    assert!(operation(&client, id).is_on());
    let is_announced = || match operation(&client, id) {
        Operation::On(On { doing: Doing::Announces { .. }, .. }) => Some(()),
        _ => None,
    };
    until("the announcement", is_announced).await;
    assert!(scene.units.all_stand());
    until("the pass", || operation(&client, id).taking()?.proved_at).await;
}

#[tokio::test(start_paused = true)]
async fn a_reply_that_is_missing_now_and_then_does_not_keep_automatic_operation_off_after_a_crash()
{
    let loses = async |scene: &Scene, _: &Client, _: AntennaId| {
        scene.units.mast.set_fault(rotator_genius::Fault::DropReply, true);
    };
    let (_scene, client, id) = after_a_crash(|_| {}, loses).await;
    seconds(&client, 30.0).await;
    assert!(operation(&client, id).is_on());
}

#[tokio::test(start_paused = true)]
async fn automatic_operation_stays_off_if_anything_changed() {
    let stays_off = async |why: &str, (scene, client, id): (Scene, Client, AntennaId)| {
        seconds(&client, 600.0).await;
        assert!(!operation(&client, id).is_on(), "{why}");
        assert!(scene.units.all_stand(), "{why}");
    };
    let nothing = async |_: &Scene, _: &Client, _: AntennaId| {};
    let off = |mast: &mut Antenna| mast.automatic.resumes_after_crash = false;
    stays_off("it is not allowed", after_a_crash(off, nothing).await).await;
    let stop = async |_: &Scene, client: &Client, id: AntennaId| {
        client.clone().stop(id);
        until_off(client, id, OffBecause::Stop).await;
    };
    stays_off("it was stopped", after_a_crash(|_| {}, stop).await).await;

    let edited = async |scene: &Scene, _: &Client, _: AntennaId| {
        let path = scene.folder().join("station.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        let other = text.replace("beam_width_deg = ", "beam_width_deg = 1");
        assert_ne!(text, other);
        std::fs::write(&path, other).unwrap();
    };
    stays_off("the station was edited", after_a_crash(|_| {}, edited).await).await;

    // Somebody works on the unit, and leaves it.
    let (scene, client, id) = after_a_crash(|_| {}, nothing).await;
    let since = client.now().utc;
    let lock_out =
        LockOut { operator: "Ada".to_owned(), reason: "feed off".to_owned(), start: since };
    let _ = client.send(Command::Antenna(id, driver::Command::LockOut(lock_out)));
    let is_locked_out = || {
        let snapshot = client.snapshot();
        let antenna = snapshot.antennas.iter().find(|antenna| antenna.id() == id)?;
        antenna.snapshot.lock_out.is_some().then_some(())
    };
    until("the lock-out", is_locked_out).await;
    let _ = client.send(Command::Antenna(id, driver::Command::Unlock));
    stays_off("it was locked out", (scene, client, id)).await;

    // The operator sends Hold before automatic operation resumes.
    let (scene, client, id) = after_a_crash(|_| {}, nothing).await;
    let _ = client.send(Command::Antenna(id, driver::Command::Hold));
    stays_off("the operator took it", (scene, client, id)).await;
}

#[tokio::test(start_paused = true)]
async fn the_rest_of_a_pass_is_taken_after_a_crash_although_passes_are_taken_whole() {
    let in_the_pass = async |_: &Scene, client: &Client, id: AntennaId| {
        until("the proof", || operation(client, id).taking()?.proved_at).await;
        let from = operation(client, id).taking().unwrap().start;
        until("the pass", || (client.now().utc > add_seconds(from, 60.0)).then_some(())).await;
    };
    let (_scene, client, id) = after_a_crash(|_| {}, in_the_pass).await;
    assert_eq!(client.snapshot().station.scheduling.partly, None);
    let crashed_at = client.now().utc;
    let taken = until("the rest", || {
        let taking = *operation(&client, id).taking()?;
        taking.proved_at.map(|_| taking)
    })
    .await;
    assert!(taken.pass.1 < crashed_at && crashed_at < taken.end, "{taken:?}");
    let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
    assert!(of.in_beam_s > seconds_between(crashed_at, taken.end) - 120.0, "{of:?}");
}

#[tokio::test(start_paused = true)]
async fn automatic_operation_waits_for_a_synchronised_clock() {
    let (scene, client, id) = scene_of("Mast", |mast| {
        mast.automatic.resumes_after_crash = true;
    })
    .await;
    set_automatic(&client, id, true).await;
    drop(client);
    let scene = scene.started_again(true).await;
    let client = scene.client();
    measured(&client, "Mast").await;
    seconds(&client, 600.0).await;
    assert!(!operation(&client, id).is_on(), "the clock is not synchronised");
}

#[tokio::test(start_paused = true)]
async fn a_pass_that_was_tracked_to_its_end_raises_no_alarm() {
    let (_scene, client, id) = scene_of("Dish", |_| {}).await;
    proved(&client, id).await;
    let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
    assert!(of.in_beam_s > of.of_s - 2.0, "{of:?}");
    let shown = client.snapshot();
    let raised = |kind: &AlarmKind| !matches!(kind, AlarmKind::AutomaticMoves { .. });
    let raised: Vec<_> = shown.alarms.list().iter().filter(|of| raised(&of.kind)).collect();
    assert!(raised.is_empty(), "{raised:?}");
}

#[tokio::test(start_paused = true)]
async fn new_settings_end_it_with_an_alarm_and_a_line_and_auto_track_with_it() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    let mut station = Station::clone(&client.snapshot().station);
    station.antennas[0].automatic.uses_auto_track = false;
    let _ = client.send(Command::SaveStation(Box::new(station)));
    until_off(&client, id, OffBecause::Changed).await;
    let is_that = |of: &AlarmKind| *of == AlarmKind::AutomaticOff(OffBecause::Changed);
    until("the alarm", || stands(&client, is_that).then_some(())).await;
    until_auto_track(&client, id, false).await;
    let day = client.snapshot().day.clone();
    assert!(day.iter().any(|line| line.event == DayEvent::SwitchedOff(OffBecause::Changed)));
    drop(client);
    let scene = scene.started_again(false).await;
    let client = scene.client();
    measured(&client, "Dish").await;
    assert!(!operation(&client, id).is_on());
}

#[tokio::test(start_paused = true)]
async fn auto_track_of_a_unit_that_the_station_no_longer_has_is_switched_off_once_it_answers() {
    for is_moved in [false, true] {
        let (scene, client, id) =
            scene_of("Dish", |dish| dish.automatic.uses_auto_track = true).await;
        proved(&client, id).await;
        until_auto_track(&client, id, true).await;
        scene.units.dish.set_fault(satrak::Fault::Silence, true);
        until_lost(&client, id).await;
        let mut station = Station::clone(&client.snapshot().station);
        if is_moved {
            // The new address leads to a unit that does not understand the requests.
            "Mast".clone_into(&mut station.antennas[0].name);
            "elsewhere:1".clone_into(&mut station.antennas[0].connection.address);
        } else {
            station.antennas.clear();
        }
        let _ = client.send(Command::SaveStation(Box::new(station)));
        let is_owed = |of: &AlarmKind| matches!(of, AlarmKind::AutoTrackOwed(_));
        until("the alarm", || stands(&client, is_owed).then_some(())).await;
        scene.units.dish.set_fault(satrak::Fault::Silence, false);
        until("its end", || (!stands(&client, is_owed)).then_some(())).await;
        assert!(!scene.units.dish.state().is_auto);
    }
}

#[tokio::test(start_paused = true)]
async fn auto_track_that_is_to_be_off_is_switched_off_after_the_next_start() {
    let alone = station("Dish", |dish| dish.automatic.uses_auto_track = true);
    let scene = Scene::marking(before_a_pass(), &alone);
    let client = scene.client();
    let id = measured(&client, "Dish").await;
    until("the schedule", || client.snapshot().schedule.made_at).await;
    proved(&client, id).await;
    until_auto_track(&client, id, true).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, true);
    until_lost(&client, id).await;
    let mut station = Station::clone(&client.snapshot().station);
    station.antennas.clear();
    let _ = client.send(Command::SaveStation(Box::new(station)));
    let is_owed = |of: &AlarmKind| matches!(of, AlarmKind::AutoTrackOwed(_));
    until("the alarm", || stands(&client, is_owed).then_some(())).await;
    drop(client);
    let scene = scene.started_again(false).await;
    let client = scene.client();
    until("the alarm of the next run", || stands(&client, is_owed).then_some(())).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, false);
    until("its end", || (!stands(&client, is_owed)).then_some(())).await;
    assert!(!scene.units.dish.state().is_auto);
    drop(client);
    let scene = scene.started_again(false).await;
    let marks = scene.folder().join("marks");
    assert_eq!(std::fs::read_dir(marks).unwrap().count(), 0, "paid");
}

#[tokio::test(start_paused = true)]
async fn parking_for_the_end_is_not_taken_over_by_the_pass() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    proved(&client, id).await;
    let taken = operation(&client, id).taking().copied().unwrap();
    until("the pass", || (client.now().utc > taken.start).then_some(())).await;
    let _ = client.send(Command::CloseAfter(CloseHow::Park));
    let is_suspended = || {
        let by_hand = Interruption::ByHand;
        matches!(operation(&client, id), Operation::Suspended { interruption, .. } if interruption == by_hand)
    };
    until("the suspension", || is_suspended().then_some(())).await;
    until("standstill", || scene.units.all_stand().then_some(())).await;
    until("LOS", || (client.now().utc > taken.end).then_some(())).await;
    assert!(is_suspended() && scene.units.all_stand());
}

/// The clock steps between two passes, when nothing moves and no track notices the step.
#[tokio::test(start_paused = true)]
async fn a_clock_step_suspends_automatic_operation_first() {
    for by_s in [-86_400, 300, 86_400 * 365] {
        let (begun, at) = (Instant::now(), before_a_pass());
        let ahead_s: Arc<AtomicI64> = Arc::default();
        let set = Arc::clone(&ahead_s);
        let clock = Clock::new(move || {
            let elapsed_s = (Instant::now() - begun).as_secs_f64();
            add_seconds(at, elapsed_s + set.load(Ordering::Relaxed) as f64)
        });
        let scene = Scene::by(clock, &station("Dish", |_| {}));
        let client = scene.client();
        let id = measured(&client, "Dish").await;
        until("the schedule", || client.snapshot().schedule.made_at).await;
        set_automatic(&client, id, true).await;
        ahead_s.store(by_s, Ordering::Relaxed);
        let sent = sent_to_dish(&scene);
        until("the suspension", || {
            let by = Interruption::Clock;
            let is_that =
                |of| matches!(of, Operation::Suspended { interruption: found, .. } if found == by);
            is_that(operation(&client, id)).then_some(())
        })
        .await;
        let alarm = AlarmKind::AutomaticSuspended(Interruption::Clock);
        until("the alarm", || stands(&client, |of| *of == alarm).then_some(())).await;
        tokio::time::sleep(Duration::from_mins(10)).await;
        let moved = |payload: &String| payload.starts_with("GOTO=") || payload.starts_with("TRACK");
        let after = sent_to_dish(&scene);
        assert!(!after[sent.len()..].iter().any(moved), "{by_s}: {after:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn the_rest_of_a_pass_is_taken_once_the_clock_of_the_unit_is_right() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    let late = Trouble::ClockLate(Duration::from_mins(2));
    scene.units.dish.set_trouble(late, true);
    tokio::time::sleep(Duration::from_secs(20)).await;
    set_automatic(&client, id, true).await;
    let taken = until("the objection", || {
        let taking = *operation(&client, id).taking()?;
        (taking.given_up == Some(GivenUp::WouldMiss)).then_some(taking)
    })
    .await;
    let middle = add_seconds(taken.start, 120.0);
    until("the middle", || (client.now().utc > middle).then_some(())).await;
    assert!(scene.units.all_stand());
    scene.units.dish.set_trouble(late, false);
    let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
    assert!(of.in_beam_s > of.of_s - 200.0, "{of:?}");
    assert_eq!(of.cause, Some(MissCause::NotReady(NotReady::WouldMiss)));
}

/// The link breaks in the middle of a pass and comes back after LOS.
#[tokio::test(start_paused = true)]
async fn after_an_outage_over_the_end_of_a_pass_the_next_ones_are_taken() {
    for resume in [Resume::Ask, Resume::Continue] {
        let (scene, client, id) = scene_of("Dish", |dish| {
            dish.resume = resume;
            dish.resume_after_s = 600.0;
        })
        .await;
        proved(&client, id).await;
        let taken = operation(&client, id).taking().copied().unwrap();
        let before_los = add_seconds(taken.end, -60.0);
        until("the middle", || (client.now().utc > before_los).then_some(())).await;
        scene.units.dish.set_fault(satrak::Fault::Silence, true);
        let after_los = add_seconds(taken.end, 60.0);
        until("LOS", || (client.now().utc > after_los).then_some(())).await;
        scene.units.dish.set_fault(satrak::Fault::Silence, false);
        until("the next pass", || {
            let next = flown(&client).get(1).cloned();
            next.map(|(_, of)| assert!(of.in_beam_s > of.of_s - 2.0, "{resume:?}: {of:?}"))
        })
        .await;
        assert!(operation(&client, id).is_on());
    }
}

/// Starts an antenna before a pass. Returns it with the lead of this computer's clock, seconds,
/// which the time service calls synchronised.
async fn scene_by_a_clock_that_can_step(antenna: &str) -> (Scene, Arc<AtomicI64>) {
    let (begun, at) = (Instant::now(), before_a_pass());
    let ahead_s: Arc<AtomicI64> = Arc::default();
    let set = Arc::clone(&ahead_s);
    let clock = Clock::new(move || {
        let elapsed_s = (Instant::now() - begun).as_secs_f64();
        add_seconds(at, elapsed_s + set.load(Ordering::Relaxed) as f64)
    });
    let mut scene = Scene::by(clock, &station(antenna, |_| {}));
    scene.units.time_sync = || TimeSync::Synchronised;
    (scene.started_again(false).await, ahead_s)
}

/// The unit tracks by its own clock, which stays right.
#[tokio::test(start_paused = true)]
async fn a_unit_tracks_on_while_the_clock_of_this_computer_is_wrong() {
    for by_s in [-40, 40] {
        let (scene, ahead_s) = scene_by_a_clock_that_can_step("Dish").await;
        let client = scene.client();
        let id = measured(&client, "Dish").await;
        until("the schedule", || client.snapshot().schedule.made_at).await;
        proved(&client, id).await;
        let taken = operation(&client, id).taking().copied().unwrap();
        let high = add_seconds(taken.start, seconds_between(taken.start, taken.end) / 3.0);
        until("the pass", || (client.now().utc > high).then_some(())).await;
        ahead_s.store(by_s, Ordering::Relaxed);
        tokio::time::sleep(Duration::from_secs(90)).await;
        assert!(scene.units.dish.state().is_tracking, "{by_s}");
        assert!(stands(&client, |kind| matches!(kind, AlarmKind::ClockOff(_))));
        ahead_s.store(0, Ordering::Relaxed);
        let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
        assert!(of.in_beam_s > of.of_s - 150.0, "{by_s}: {of:?}");
        assert!(operation(&client, id).is_on());
    }
}

/// The clock steps and steps back while a Genius tracks the middle of a pass.
#[tokio::test(start_paused = true)]
async fn a_track_goes_on_after_a_clock_step_if_a_time_service_keeps_the_clock() {
    for by_s in [-40, 40] {
        let (scene, ahead_s) = scene_by_a_clock_that_can_step("Mast").await;
        let client = scene.client();
        let id = measured(&client, "Mast").await;
        until("the schedule", || client.snapshot().schedule.made_at).await;
        proved(&client, id).await;
        let taken = operation(&client, id).taking().copied().unwrap();
        until("the pass", || (client.now().utc > add_seconds(taken.start, 60.0)).then_some(()))
            .await;
        for ahead in [by_s, 0] {
            ahead_s.store(ahead, Ordering::Relaxed);
            tokio::time::sleep(Duration::from_secs(20)).await;
        }
        let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
        assert!(of.in_beam_s > of.of_s - 60.0, "{by_s}: {of:?}");
        assert!(operation(&client, id).is_on());
    }
}

fn sent_to_dish(scene: &Scene) -> Vec<String> {
    scene.units.dish.received().into_iter().map(|(_, payload)| payload).collect()
}

#[tokio::test(start_paused = true)]
async fn a_track_whose_angles_freeze_ends_it() {
    let (scene, client, id) = scene_of("Dish", |_| {}).await;
    proved(&client, id).await;
    let taken = operation(&client, id).taking().copied().unwrap();
    until("the pass", || {
        (client.snapshot().moment.utc > add_seconds(taken.start, 60.0)).then_some(())
    })
    .await;
    scene.units.dish.set_fault(satrak::Fault::FrozenAngles, true);
    until("the end", || {
        let is_off = |of| matches!(of, Operation::Off(OffBecause::Safety));
        is_off(operation(&client, id)).then_some(())
    })
    .await;
    tokio::time::sleep(Duration::from_mins(2)).await;
    assert!(scene.units.all_stand(), "nothing takes the pass again");
}

#[tokio::test(start_paused = true)]
async fn it_is_off_at_the_start_while_a_stop_is_owed_on_disk() {
    let set = |dish: &mut Antenna| dish.automatic.is_on_at_start = true;
    let scene = Scene::marking(before_a_pass(), &station("Dish", set));
    let client = scene.client();
    let id = measured(&client, "Dish").await;
    set_automatic(&client, id, true).await;
    drop(client);
    let marks = scene.folder().join("marks");
    std::fs::create_dir_all(&marks).unwrap();
    let since = before_a_pass();
    let mark = format!("make = \"satrak\"\naddress = \"dish:1\"\nsince = \"{since}\"\n");
    std::fs::write(marks.join("satrak-dish-1-6ec784e4.toml"), mark).unwrap();
    let before = scene.units.dish.received().len();
    let scene = scene.started_again(false).await;
    let client = scene.client();
    let first_word = || Some(scene.units.dish.received().get(before)?.1.clone());
    assert_eq!(until("its first word", first_word).await, "STOP=");
    measured(&client, "Dish").await;
    assert!(!operation(&client, id).is_on());
}
