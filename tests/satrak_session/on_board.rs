//! On-board track, which Azel judges before it begins and watches while it runs.

use azel::{
    astro::{Angle, AzEl, time},
    contract::driver::{Command, Event, Intent, Refusal, Response, Safety},
    device::{Phase, TrackTarget, settings::Value},
    orbit::{PassSearch, Propagator, passes},
    plan::{
        Bounds, OnBoardPass, Supervision,
        on_board::{Cause, OffLimits, Trespass},
    },
    protocol::satrak::encode,
    sim::satrak::Fault,
    station::{Antenna, Monitor, Station},
};
use tokio::io::AsyncWriteExt as _;

use super::{
    rig::{Rig, antenna, iss, options, track, twin},
    scene,
    settings::{change, write_settings},
};
use crate::common::workers::{hold_up_workers, with_one_worker};

/// Place far enough south-east to see the pass differently: 1,596 km away.
const ELSEWHERE: [(&str, f64); 2] = [("latitude_deg", 28.94), ("longitude_deg", 38.57)];

/// Starts a unit and waits until Azel has read its location and everything else.
async fn read() -> Rig {
    let mut rig = Rig::usual().await;
    rig.until("its place", 90, |shown| shown.state.on_board.place.is_some()).await;
    rig.events();
    rig
}

async fn general(rig: &mut Rig, field: &'static str, value: Value) {
    assert_eq!(write_settings(rig, change("general", [(field, value)])).await, Ok(()));
}

async fn stand_elsewhere(rig: &mut Rig) {
    let place = ELSEWHERE.map(|(field, angle_deg)| (field, Value::Decimal(angle_deg)));
    let [latitude, longitude] = place;
    let by_hand = ("is_automatic", Value::Flag(false));
    assert_eq!(write_settings(rig, change("gps", [by_hand, latitude, longitude])).await, Ok(()));
}

/// Sends a payload as another client.
pub(super) async fn by_another(rig: &Rig, payload: &str) {
    by_another_at_once(rig, &[payload]).await;
}

/// Sends payloads as another client, one right after the other.
pub(super) async fn by_another_at_once(rig: &Rig, payloads: &[&str]) {
    let (mut near, far) = tokio::io::duplex(4096);
    let control = rig.control.clone();
    tokio::spawn(async move { control.serve(far).await });
    let bytes: Vec<u8> = payloads.iter().flat_map(|payload| encode(payload)).collect();
    near.write_all(&bytes).await.unwrap();
    tokio::time::sleep(std::time::Duration::from_secs(1)).await;
}

/// Requests a track that would miss, and returns the report on it. Checks that Azel sends nothing.
async fn refused(rig: &mut Rig) -> Supervision {
    rig.events();
    rig.send(track(iss()));
    let told = rig.until_event(10, |event| matches!(event, Event::WouldMiss { .. })).await;
    rig.seconds(5.0).await;
    assert!(rig.sent("SATELLITE=").is_empty() && rig.sent("TRACK=").is_empty());
    let Event::WouldMiss { found, .. } = told else { panic!("{told:?}") };
    assert!(!found.is_within_beam);
    (*found).clone()
}

fn first(found: &Supervision) -> Cause {
    found.causes.first().unwrap_or_else(|| panic!("{found:?}")).cause.clone()
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_goes_by_the_same_tracks_and_is_told_what_is_not_known() {
    let mut rig = read().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(200.0).await;
    let shown = rig.shown();
    let view = shown.on_board.as_ref().unwrap();
    assert_eq!((view.found.causes.clone(), view.missing), (vec![], None));
    assert_eq!(view.found.lower_minimum_deg, Some(3.0), "5 in the station");
    rig.send(Command::Standby);
    rig.seconds(2.0).await;
    assert_eq!(rig.shown().on_board, None);
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_stands_elsewhere_is_not_started_and_says_how_far() {
    let mut rig = read().await;
    stand_elsewhere(&mut rig).await;
    let Cause::Place { away_km, .. } = first(&refused(&mut rig).await) else { panic!() };
    assert!((1580.0..1610.0).contains(&away_km), "{away_km}");
}

#[tokio::test(start_paused = true)]
async fn an_operator_who_agrees_is_told_that_it_misses_while_it_does() {
    let mut rig = read().await;
    stand_elsewhere(&mut rig).await;
    // The unit must not point below the station's limit, even if the operator agreed.
    let agreed = || {
        let pass = OnBoardPass { is_agreed: true, ..scene::on_board(iss()) };
        Command::Track(Box::new(pass))
    };
    rig.send(agreed());
    let low = rig.until_event(10, |event| matches!(event, Event::NotSent(_))).await;
    assert!(matches!(low, Event::NotSent(Refusal::Path(_))), "{low:?}");
    general(&mut rig, "minimum_elevation_deg", Value::Decimal(5.0)).await;
    rig.send(agreed());
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.until("missed", 200, |shown| {
        shown.on_board.as_ref().is_some_and(|view| view.missing.is_some())
    })
    .await;
    let shown = rig.shown();
    let view = shown.on_board.as_ref().unwrap();
    assert!(view.missing.unwrap() > Angle::from_degrees(5.0), "{view:?}");
    assert!(matches!(first(&view.found), Cause::Place { .. }));
    assert!(rig.control.state().is_tracking, "it is told, not ended");
}

#[tokio::test(start_paused = true)]
async fn a_clock_and_offsets_that_miss_are_found_before_the_pass() {
    let mut rig = read().await;
    general(&mut rig, "elevation_offset_deg", Value::Decimal(2.0)).await;
    assert_eq!(first(&refused(&mut rig).await), Cause::ElevationOffset(2.0));
    general(&mut rig, "elevation_offset_deg", Value::Decimal(0.0)).await;
    general(&mut rig, "azimuth_offset_deg", Value::Decimal(-2.0)).await;
    assert_eq!(first(&refused(&mut rig).await), Cause::AzimuthOffset(-2.0));
    general(&mut rig, "azimuth_offset_deg", Value::Decimal(0.0)).await;
    general(&mut rig, "time_offset_ms", Value::Integer(9000)).await;
    assert_eq!(first(&refused(&mut rig).await), Cause::TimeOffset { offset_s: 9.0 });
    general(&mut rig, "time_offset_ms", Value::Integer(0)).await;
    general(&mut rig, "minimum_elevation_deg", Value::Decimal(30.0)).await;
    assert_eq!(first(&refused(&mut rig).await), Cause::MinimumElevation(30.0));
    general(&mut rig, "minimum_elevation_deg", Value::Decimal(5.0)).await;
    let ahead = time::add_seconds(iss().start, 3600.0);
    let civil = jiff::tz::TimeZone::UTC.to_datetime(ahead);
    let clock = civil.strftime("TIME=,%-H,%-M,%-S,%-d,%-m,%Y").to_string();
    by_another(&rig, &clock).await;
    rig.until("its clock", 15, |shown| {
        shown.state.on_board.clock.is_some_and(|clock| clock.ahead_s > 1000.0)
    })
    .await;
    assert!(matches!(first(&refused(&mut rig).await), Cause::Clock { .. }));
}

#[tokio::test(start_paused = true)]
async fn a_small_offset_is_told_and_tracked() {
    let mut rig = read().await;
    general(&mut rig, "elevation_offset_deg", Value::Decimal(0.2)).await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    let shown = rig.shown();
    let found = &shown.on_board.as_ref().unwrap().found;
    assert!(found.is_within_beam && (found.worst.angle.degrees() - 0.2).abs() < 0.05, "{found:?}");
    assert_eq!(first(found), Cause::ElevationOffset(0.2));
    rig.seconds(60.0).await;
    let shown = rig.shown();
    let causes = &shown.on_board.as_ref().unwrap().found.causes;
    assert_eq!(causes.len(), 1, "the height of the pass agrees too: {causes:?}");
}

#[tokio::test(start_paused = true)]
async fn what_another_client_changes_while_the_unit_tracks_is_read_and_told() {
    let mut rig = read().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    let in_pass = |shown: &azel::contract::driver::Snapshot| {
        shown.state.program.is_some_and(|it| it.phase == azel::device::Phase::Tracking)
    };
    rig.until("in the pass", 120, in_pass).await;
    rig.seconds(20.0).await;
    by_another(&rig, "SETTINGS=,?,?,?,8.0,?,?,?,?,?,?,?").await;
    rig.until("found", 32, |shown| {
        shown.on_board.as_ref().is_some_and(|view| !view.found.is_within_beam)
    })
    .await;
    rig.until("missed", 20, |shown| {
        shown.on_board.as_ref().is_some_and(|view| view.missing.is_some())
    })
    .await;
    assert_eq!(first(&rig.shown().on_board.as_ref().unwrap().found), Cause::ElevationOffset(8.0));
    by_another(&rig, "SETTINGS=,?,?,?,0.0,?,?,?,?,?,?,?").await;
    rig.until("on it again", 20, |shown| shown.on_board.as_ref().unwrap().missing.is_none()).await;
}

#[tokio::test(start_paused = true)]
async fn a_path_below_the_antennas_limit_is_refused_with_time_and_place() {
    let mut low = antenna();
    low.limits.minimum_elevation_deg = 30.0;
    let mut rig = Rig::connected(&options(), &low).await;
    rig.send(track(iss()));
    let told = rig.until_event(10, |event| matches!(event, Event::NotSent(_))).await;
    let Event::NotSent(Refusal::Path(Trespass { time: at, direction, limit })) = told else {
        panic!("{told:?}")
    };
    let OffLimits::Elevation { lowest_deg } = limit else { panic!("{limit:?}") };
    assert!((lowest_deg - 30.0).abs() < 1e-9);
    assert!(time::seconds_between(iss().start, at).abs() < 2.0);
    assert!((direction.elevation_deg() - 10.0).abs() < 0.5);
    rig.seconds(5.0).await;
    assert_eq!(rig.orders(), [] as [&str; 0]);

    // The unit tracks the window above the limit, and the antenna stays above it.
    let satellite = scene::on_board(iss());
    let propagator = Propagator::new(&satellite.elements).unwrap();
    let search = PassSearch {
        aos_elevation: Angle::from_degrees(30.0),
        ..PassSearch::new(scene::site(), iss().start, iss().end)
    };
    let above = passes(&propagator, &search, &|| false)[0];
    let target =
        TrackTarget { start: time::add_seconds(above.aos.time, 1.0), end: above.los.time, ..iss() };
    rig.send(track(target.clone()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    let mut lowest = AzEl::from_degrees(0.0, 90.0);
    while rig.control.state().is_tracking {
        rig.seconds(0.5).await;
        let now = rig.control.state();
        if now.el_deg < lowest.elevation_deg() {
            lowest = AzEl::from_degrees(now.az_deg, now.el_deg);
        }
    }
    assert!((29.9..31.0).contains(&lowest.elevation_deg()), "{lowest:?}");
}

/// Returns the setting of the window of `target`.
pub(super) fn window(target: &TrackTarget) -> String {
    let text = |time| {
        let civil = jiff::tz::TimeZone::UTC.to_datetime(time);
        civil.strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string()
    };
    format!("START_STOP_TIME=,{},{}", text(target.start), text(target.end))
}

/// Sets `target` and its window on the unit as another client.
async fn chosen_by_another(rig: &mut Rig, target: &TrackTarget) {
    by_another(rig, &format!("SATELLITE=,{},{},1,0", scene::FILE, target.name)).await;
    by_another(rig, &window(target)).await;
    let number = target.catalog_number;
    rig.until("it is read", 32, |shown| {
        let told = &shown.state.on_board;
        told.window.is_some_and(|(from, _)| from.as_second() == target.start.as_second())
            && told.satellite.as_ref().is_some_and(|held| held.catalog_number == number)
    })
    .await;
    rig.events();
}

/// Returns bounds with a mast from 20 to 80 degrees of elevation around the azimuth of the pass's
/// maximum.
fn in_the_way() -> Bounds {
    let highest_deg = scene::pass().tca.direction.azimuth_deg();
    let [from_deg, to_deg] = [highest_deg - 10.0, highest_deg + 10.0];
    let corners_deg = [(from_deg, 20.0), (to_deg, 20.0), (to_deg, 80.0), (from_deg, 80.0)];
    let mast = crate::common::mast(&corners_deg);
    let station = Station { keep_outs: vec![mast], ..Station::default() };
    Bounds::new(&station, &antenna())
}

/// The operator adds the keep-out while the unit tracks a pass that Azel requested.
#[tokio::test(start_paused = true)]
async fn an_on_board_track_that_azel_started_stops_before_a_keep_out() {
    let alarm_alone = Antenna { monitor: Monitor::Alarm, ..antenna() };
    let mut rig = Rig::connected(&options(), &alarm_alone).await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.handle().keep_within(in_the_way());
    let forbidden = |event: &Event| matches!(event, Event::Safety(Safety::Forbidden { .. }));
    let event = rig.until_event(1000, forbidden).await;
    let Event::Safety(Safety::Forbidden { response, .. }) = event else { panic!("{event:?}") };
    assert_eq!(response, Response::Stopped);
    rig.seconds(5.0).await;
    let state = rig.control.state();
    assert!(!state.is_moving && !state.is_tracking);
    let bounds = in_the_way();
    let at = AzEl::from_degrees(state.az_deg, state.el_deg);
    assert_eq!(bounds.at_time(iss().start).forbids(at), None, "{at:?}");
}

#[tokio::test(start_paused = true)]
async fn an_on_board_track_whose_angles_freeze_is_stopped() {
    let mut rig = Rig::connected(&options(), &antenna()).await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    let aos = iss().start;
    rig.until("up", 2000, |shown| {
        shown.state.measured.is_some_and(|it| time::seconds_between(aos, it.time) > 120.0)
    })
    .await;
    rig.control.set_fault(Fault::FrozenAngles, true);
    let is_told = |event: &Event| matches!(event, Event::Safety(Safety::NoEffect { .. }));
    rig.until_event(60, is_told).await;
    rig.seconds(5.0).await;
    let state = rig.control.state();
    assert!(!state.is_moving && !state.is_tracking);
}

async fn auto_track_refused(rig: &mut Rig) -> Refusal {
    rig.send(Command::AutoTrack(true));
    let told = rig.until_event(2, |event| matches!(event, Event::NotSent(_))).await;
    rig.seconds(2.0).await;
    assert!(rig.sent("TRACK_AUTO_ENABLE=").is_empty());
    let Event::NotSent(refusal) = told else { panic!("{told:?}") };
    refusal
}

#[tokio::test(start_paused = true)]
async fn auto_track_is_judged_by_where_the_unit_would_go_when_it_takes_over() {
    let mut rig = read().await;
    chosen_by_another(&mut rig, &iss()).await;
    rig.handle().keep_within(in_the_way());
    let told = auto_track_refused(&mut rig).await;
    assert!(matches!(told, Refusal::Path(_) | Refusal::Forbidden { .. }), "{told:?}");
    rig.handle().keep_within(Bounds::of_antenna(&antenna()));
    rig.send(Command::AutoTrack(true));
    rig.seconds(1.0).await;
    assert_eq!(rig.sent("TRACK_AUTO_ENABLE=").len(), 1);
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(true));
}

#[tokio::test(start_paused = true)]
async fn auto_track_of_a_satellite_that_is_not_known_here_is_refused_by_its_name() {
    let mut rig = read().await;
    chosen_by_another(&mut rig, &twin()).await;
    let told = auto_track_refused(&mut rig).await;
    assert_eq!(told, Refusal::OrbitUnknown { name: "TWIN".to_owned() });
}

/// Checking the whole window would block the driver of all antennas for more than a minute.
#[tokio::test(start_paused = true)]
async fn a_window_of_years_is_refused_before_it_is_judged() {
    let mut rig = read().await;
    let years = TrackTarget { end: "2099-12-31T00:00:00Z".parse().unwrap(), ..iss() };
    chosen_by_another(&mut rig, &years).await;
    let refusal = auto_track_refused(&mut rig).await.to_string();
    assert!(refusal.contains("window") && refusal.contains("hours"), "{refusal}");
}

/// Time stands still here while Azel judges the path, so events in between wait for nothing.
#[test]
fn stop_waits_for_no_judgement_of_a_path_and_ends_what_waits_for_it() {
    with_one_worker(async {
        let mut rig = read().await;
        let hours =
            TrackTarget { end: iss().start + jiff::SignedDuration::from_hours(23), ..iss() };
        chosen_by_another(&mut rig, &hours).await;
        let before = rig.sent("STOP=").len();
        let held_up = hold_up_workers();
        rig.send(Command::AutoTrack(true));
        while !rig.shown().being_judged {
            tokio::task::yield_now().await;
        }
        rig.stop();
        while rig.sent("STOP=").len() == before {
            tokio::task::yield_now().await;
        }
        assert!(rig.shown().being_judged, "STOP did not wait");
        drop(held_up);
        rig.seconds(20.0).await;
        assert!(!rig.shown().being_judged);
        assert_eq!(rig.shown().state.program.unwrap().auto, Some(false));
        assert!(rig.sent("TRACK_AUTO_ENABLE=,1").is_empty(), "nothing is begun after STOP");
    });
}

#[tokio::test(start_paused = true)]
async fn a_window_that_is_over_leads_nowhere() {
    let mut rig = read().await;
    let hours = jiff::SignedDuration::from_hours(-3);
    let over = TrackTarget { start: iss().start + hours, end: iss().end + hours, ..twin() };
    chosen_by_another(&mut rig, &over).await;
    rig.send(Command::AutoTrack(true));
    rig.seconds(1.0).await;
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(true));
    assert_eq!(rig.events(), []);
}

/// The tolerance of an arrival does not hide that a satellite is outside the beam.
#[tokio::test(start_paused = true)]
async fn an_antenna_just_outside_its_beam_is_told_and_tracks_on() {
    let mut rig = read().await;
    chosen_by_another(&mut rig, &iss()).await;
    by_another(&rig, "TRACK=,1").await;
    let tracks = |shown: &azel::contract::driver::Snapshot| {
        shown.state.program.unwrap().phase == Phase::Tracking
    };
    rig.until("in the pass", 120, tracks).await;
    rig.seconds(20.0).await;
    by_another(&rig, "SETTINGS=,?,?,?,0.9,?,?,?,?,?,?,?").await;
    rig.until("outside its beam", 20, |shown| {
        shown.on_board.as_ref().is_some_and(|view| view.missing.is_some())
    })
    .await;
    let off = rig.shown().on_board.as_ref().unwrap().missing.unwrap();
    assert!((0.8..1.0).contains(&off.degrees()), "{off:?}");
    rig.seconds(60.0).await;
    assert!(rig.control.state().is_tracking, "a small error stops nothing");
}

#[tokio::test(start_paused = true)]
async fn what_the_unit_tracks_unasked_is_watched_like_what_it_was_asked_to() {
    let mut rig = read().await;
    chosen_by_another(&mut rig, &iss()).await;
    by_another(&rig, "TRACK=,1").await;
    rig.until_event(5, |event| *event == Event::StartedByItself).await;
    rig.until("it is watched", 2, |shown| shown.on_board.is_some()).await;
    let tracks = |shown: &azel::contract::driver::Snapshot| {
        shown.state.program.unwrap().phase == Phase::Tracking
    };
    rig.until("in the pass", 120, tracks).await;
    rig.seconds(20.0).await;
    let shown = rig.shown();
    let view = shown.on_board.as_ref().unwrap();
    assert_eq!((view.missing, view.found.causes.clone()), (None, vec![]));
    assert_eq!(shown.target, None, "nobody asked for it from here");

    by_another(&rig, "SETTINGS=,?,?,?,8.0,?,?,?,?,?,?,?").await;
    rig.seconds(8.0).await;
    assert_eq!(rig.shown().on_board.as_ref().unwrap().missing, None, "within its ten seconds");
    rig.until("missed", 45, |shown| {
        shown.on_board.as_ref().is_some_and(|view| view.missing.is_some())
    })
    .await;
    let shown = rig.shown();
    let view = shown.on_board.as_ref().unwrap();
    assert!(view.missing.unwrap() > Angle::from_degrees(7.0), "{view:?}");
    rig.until("its cause", 30, |shown| !shown.on_board.as_ref().unwrap().found.causes.is_empty())
        .await;
    assert_eq!(first(&rig.shown().on_board.as_ref().unwrap().found), Cause::ElevationOffset(8.0));
    assert!(rig.control.state().is_tracking, "it is told, not ended");

    rig.know_orbit(None);
    rig.until("nothing to compare with", 2, |shown| shown.on_board.is_none()).await;
    rig.know_orbit(Some(scene::orbit(25_544)));
    rig.until("watched again", 2, |shown| shown.on_board.is_some()).await;
    by_another(&rig, "TRACK=,0").await;
    rig.until("over", 5, |shown| shown.on_board.is_none()).await;
}

#[tokio::test(start_paused = true)]
async fn what_the_unit_tracks_unasked_is_taken_over_without_a_motion() {
    let mut rig = read().await;
    rig.send(Command::TakeOver);
    rig.seconds(1.0).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::PassUnknown)], "nothing is tracked");
    chosen_by_another(&mut rig, &iss()).await;
    by_another(&rig, "TRACK=,1").await;
    rig.until_event(5, |event| *event == Event::StartedByItself).await;
    rig.until("it is watched", 2, |shown| shown.on_board.is_some()).await;
    let orders = |rig: &Rig| {
        let received = rig.control.received();
        received.into_iter().filter(|(_, frame)| !frame.contains('?')).count()
    };
    let before = orders(&rig);
    rig.send(Command::TakeOver);
    rig.until("it is ours", 2, |shown| shown.intent == Intent::Track).await;
    assert_eq!(rig.shown().target.as_ref().map(|target| target.catalog_number), Some(25_544));
    rig.seconds(30.0).await;
    assert_eq!(orders(&rig), before, "nothing was sent but questions");
    assert!(rig.control.state().is_tracking && rig.shown().on_board.is_some());
    rig.send(Command::Manual);
    rig.until("ended like any other track", 5, |_| true).await;
    rig.seconds(3.0).await;
    assert!(!rig.control.state().is_tracking);
}

#[tokio::test(start_paused = true)]
async fn a_track_that_misses_is_not_taken_over() {
    let mut rig = read().await;
    stand_elsewhere(&mut rig).await;
    general(&mut rig, "minimum_elevation_deg", Value::Decimal(5.0)).await;
    chosen_by_another(&mut rig, &iss()).await;
    by_another(&rig, "TRACK=,1").await;
    rig.until("it is watched", 10, |shown| shown.on_board.is_some()).await;
    rig.events();
    rig.send(Command::TakeOver);
    rig.until_event(5, |event| matches!(event, Event::WouldMiss { .. })).await;
    assert_ne!(rig.shown().intent, Intent::Track);
    assert!(rig.shown().on_board.is_some(), "it is watched on");
}

#[tokio::test(start_paused = true)]
async fn a_unit_found_tracking_that_stands_elsewhere_is_told_with_the_cause() {
    let mut rig = read().await;
    stand_elsewhere(&mut rig).await;
    general(&mut rig, "minimum_elevation_deg", Value::Decimal(5.0)).await;
    chosen_by_another(&mut rig, &iss()).await;
    by_another(&rig, "TRACK=,1").await;
    rig.send(Command::Disconnect);
    rig.seconds(60.0).await;
    rig.events();
    rig.send(Command::Connect);
    let found =
        |event: &Event| matches!(event, Event::Connected(azel::contract::driver::Found::Tracking));
    rig.until_event(10, found).await;
    rig.until("missed", 150, |shown| {
        shown.on_board.as_ref().is_some_and(|view| view.missing.is_some())
    })
    .await;
    assert!(matches!(first(&rig.shown().on_board.as_ref().unwrap().found), Cause::Place { .. }));
}
