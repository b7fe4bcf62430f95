//! On-board tracks and their requests to the unit.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event, Intent},
    device::{Phase, PrepareError, TrackTarget},
    sim::satrak::Options,
};
use jiff::SignedDuration;

use super::{
    rig::{Rig, antenna, iss, options, track, twin},
    scene::from_the_west,
};

fn window_of(target: &TrackTarget) -> String {
    let text = |time| {
        let civil = jiff::tz::TimeZone::UTC.to_datetime(time);
        civil.strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string()
    };
    format!("START_STOP_TIME=,{},{}", text(target.start), text(target.end))
}

/// Returns the frames of a track in their order, without the polling around them.
fn steps(rig: &Rig) -> Vec<String> {
    let payloads = rig.payloads();
    let first = payloads.iter().position(|payload| payload.starts_with("SATELLITE=")).unwrap();
    let last = payloads.iter().position(|payload| payload == "TRACK=,1").unwrap();
    payloads[first..=last].to_vec()
}

async fn tracking(rig: &mut Rig, target: &TrackTarget) {
    rig.send(track(target.clone()));
    let told = rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    assert_eq!(told, Event::Tracking(target.clone()));
}

#[tokio::test(start_paused = true)]
async fn every_step_is_read_back_before_the_program_starts() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.seconds(0.02).await;
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending), (Intent::Track, true));
    assert_eq!(shown.target, Some(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    assert_eq!(
        steps(&rig),
        [
            "SATELLITE=,stations.txt,ISS (ZARYA),1,0",
            "SATELLITE?",
            "ERRSTATUS?",
            &window_of(&iss()),
            "START_STOP_TIME?",
            "TRACK=,1",
        ]
    );
    let shown = rig.shown();
    assert!(!shown.pending && shown.state.program.unwrap().enabled);
    assert_eq!(shown.state.on_board.satellite.as_ref().unwrap().name, "ISS (ZARYA)");
    rig.until("on the way to the start", 40, |shown| {
        shown.state.program.unwrap().phase == Phase::AtStart
    })
    .await;
    rig.until("in the pass", 70, |shown| shown.state.program.unwrap().phase == Phase::Tracking)
        .await;
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn at_the_end_of_the_window_the_operator_is_back_in_standby() {
    let mut rig = Rig::usual().await;
    tracking(&mut rig, &iss()).await;
    let ended = rig.until_event(1500, |event| matches!(event, Event::TrackingEnded { .. })).await;
    assert_eq!(ended, Event::TrackingEnded { completed: true });
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.target.clone()), (Intent::Standby, None));
    rig.seconds(30.0).await;
    assert!(!rig.control.state().is_moving && !rig.control.state().is_tracking);
    assert_eq!(rig.sent("TRACK=,1").len(), 1);
    assert_eq!(rig.events(), []);
}

/// A file of the same name may have come with new elements.
#[tokio::test(start_paused = true)]
async fn a_file_that_the_station_names_is_chosen_for_each_track() {
    let mut rig = Rig::usual().await;
    let target = TrackTarget { element_file: Some("stations.txt".to_owned()), ..iss() };
    for round in 1..=2 {
        tracking(&mut rig, &target).await;
        rig.send(Command::Standby);
        rig.until("the track is over", 20, |shown| shown.intent == Intent::Standby).await;
        assert_eq!(rig.sent("SATELLITE=,stations.txt,ISS").len(), round);
    }
}

#[tokio::test(start_paused = true)]
async fn a_satellite_that_the_unit_does_not_have_is_told_and_nothing_moves() {
    let mut rig = Rig::usual().await;
    let unknown = TrackTarget { catalog_number: 7530, name: "AO-7".into(), ..iss() };
    rig.send(track(unknown.clone()));
    let told = rig.until_event(10, |event| matches!(event, Event::CannotTrack(..))).await;
    let reason = PrepareError::NotOnDevice { file: "stations.txt".into() };
    assert_eq!(told, Event::CannotTrack(unknown, reason));
    rig.seconds(10.0).await;
    assert_eq!(rig.orders(), ["SATELLITE=,stations.txt,AO-7,1,0", "STOP="]);
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending, shown.target.clone()), (Intent::Standby, false, None));
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn a_name_that_the_protocol_cannot_carry_is_told() {
    let mut rig = Rig::usual().await;
    let odd = TrackTarget { name: "AO-7, OSCAR 7".into(), ..iss() };
    rig.send(track(odd));
    let told = rig.until_event(10, |event| matches!(event, Event::CannotTrack(..))).await;
    assert!(matches!(told, Event::CannotTrack(_, PrepareError::CannotBeSent(_))), "{told:?}");
    assert_eq!(rig.orders(), ["STOP="]);
}

#[tokio::test(start_paused = true)]
async fn a_pass_at_another_time_is_refused_for_where_it_leads() {
    let mut rig = Rig::usual().await;
    let hour = SignedDuration::from_hours(1);
    let over = TrackTarget { start: iss().start - hour, end: iss().end - hour, ..iss() };
    rig.send(track(over));
    let told = rig.until_event(10, |event| matches!(event, Event::WouldMiss { .. })).await;
    let Event::WouldMiss { found, .. } = told else { panic!("{told:?}") };
    assert!(found.worst.angle.degrees() > 10.0, "the satellite is below the horizon: {found:?}");
    assert_eq!((rig.shown().intent, rig.orders()), (Intent::Standby, vec![]));
    rig.seconds(5.0).await;
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn switching_to_another_satellite_stops_first() {
    let mut rig = Rig::usual().await;
    tracking(&mut rig, &iss()).await;
    rig.seconds(100.0).await;
    let before = rig.orders().len();
    tracking(&mut rig, &twin()).await;
    let orders = rig.orders();
    assert_eq!(orders[before..before + 2], ["STOP=", "TRACK=,0"]);
    let chosen = rig.times("SATELLITE=,stations.txt,TWIN")[0];
    let waited = chosen.saturating_duration_since(rig.times("STOP=")[0]).as_secs_f64();
    assert!(waited > 0.1, "{waited}");
    assert_eq!(orders.last().unwrap(), "TRACK=,1");
    assert_eq!(rig.shown().target, Some(twin()));
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_change_of_mind_during_the_preparation_tracks_the_last_choice() {
    for pause_ms in (0..300).step_by(5) {
        let mut rig = Rig::usual().await;
        // The unit has the twin already, from an earlier choice.
        tracking(&mut rig, &twin()).await;
        rig.stop();
        rig.until_event(3, |event| *event == Event::Stopped).await;
        rig.send(track(iss()));
        rig.seconds(f64::from(pause_ms) / 1000.0).await;
        rig.events();
        tracking(&mut rig, &twin()).await;
        rig.seconds(1.0).await;
        let last = rig.sent("SATELLITE=").pop().unwrap();
        assert_eq!(last, "SATELLITE=,stations.txt,TWIN,1,0", "after {pause_ms} ms");
        rig.until("read again", 20, |shown| {
            shown.state.on_board.satellite.as_ref().is_some_and(|held| held.name == "TWIN")
        })
        .await;
        assert_eq!(rig.shown().target, Some(twin()));
    }
}

#[tokio::test(start_paused = true)]
async fn standby_ends_tracking_and_is_quiet_about_it() {
    let mut rig = Rig::usual().await;
    tracking(&mut rig, &iss()).await;
    rig.seconds(100.0).await;
    let before = rig.orders().len();
    rig.send(Command::Standby);
    rig.seconds(20.0).await;
    assert_eq!(rig.orders()[before..], ["STOP=", "TRACK=,0"]);
    assert!(!rig.control.state().is_moving && !rig.control.state().is_tracking);
    assert_eq!(rig.shown().intent, Intent::Standby);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn auto_track_is_shown_as_the_unit_reports_it() {
    let mut rig = Rig::connected(&options(), &antenna()).await;
    let auto = |rig: &Rig| rig.shown().state.program.unwrap().auto;
    assert_eq!(auto(&rig), Some(false));
    rig.send(Command::AutoTrack(true));
    rig.seconds(0.6).await;
    assert_eq!(auto(&rig), Some(true));
    rig.send(Command::AutoTrack(false));
    rig.seconds(0.6).await;
    assert_eq!(auto(&rig), Some(false));
    assert_eq!(rig.orders(), ["TRACK_AUTO_ENABLE=,1", "TRACK_AUTO_ENABLE=,0"]);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn tracking_that_the_unit_ends_by_itself_is_told() {
    let mut rig = Rig::usual().await;
    tracking(&mut rig, &iss()).await;
    rig.seconds(100.0).await;
    // A second client, such as the panel of the unit, switches the track off.
    let (mut near, far) = tokio::io::duplex(256);
    let control = rig.control.clone();
    let other = tokio::spawn(async move { control.serve(far).await });
    tokio::io::AsyncWriteExt::write_all(&mut near, b"$TRACK=,0*6E\r\n").await.unwrap();
    let told = rig.until_event(2, |event| matches!(event, Event::TrackingEnded { .. })).await;
    assert_eq!(told, Event::TrackingEnded { completed: false });
    assert_eq!(rig.shown().intent, Intent::Standby);
    other.abort();
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_starts_to_track_by_itself_is_told_once_and_can_be_stopped() {
    let mut rig = Rig::usual().await;
    tracking(&mut rig, &iss()).await;
    rig.send(Command::Standby);
    rig.seconds(2.0).await;
    rig.send(Command::AutoTrack(true));
    rig.until_event(120, |event| *event == Event::StartedByItself).await;
    assert!(rig.control.state().is_tracking);
    assert_eq!((rig.shown().intent, rig.shown().target.clone()), (Intent::Standby, None));
    rig.seconds(60.0).await;
    assert_eq!(rig.events(), [], "told once");
    assert!(rig.control.state().is_tracking, "what the operator allowed is not ended");
    assert_eq!(rig.sent("TRACK=,1").len(), 1, "not by us");
    rig.stop();
    rig.until_event(4, |event| *event == Event::Stopped).await;
    rig.seconds(5.0).await;
    assert!(!rig.control.state().is_tracking && !rig.control.state().is_moving);
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(false));
    assert_eq!(rig.events(), []);
}

/// On the unit's own way to a pass, both axes turn at once, and an X/Y mount dips in between.
#[tokio::test(start_paused = true)]
async fn on_the_way_to_a_pass_the_antenna_keeps_above_its_minimum_elevation() {
    let target = from_the_west();
    let early = target.start - SignedDuration::from_mins(3);
    let early = Options { utc_origin: early, ..options() };
    let mut went_first = 0;
    for azimuth_deg in (5..360).step_by(15) {
        let mut rig = Rig::connected(&early, &antenna()).await;
        let angle = |deg: f64| Some(Angle::from_degrees(deg));
        let azimuth = angle(f64::from(azimuth_deg));
        rig.send(Command::Position { azimuth, elevation: angle(5.6) });
        rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
        let gone = rig.sent("GOTO=").len();
        rig.send(track(target.clone()));
        // The unit sets out some time before its window.
        for _ in 0..900 {
            rig.seconds(0.2).await;
            let lowest_deg = rig.control.state().el_deg;
            assert!(lowest_deg > 4.5, "from {azimuth_deg}: {lowest_deg}");
        }
        went_first += usize::from(rig.sent("GOTO=").len() > gone);
        assert_eq!(rig.events(), [Event::Tracking(target.clone())]);
    }
    assert!((1..24).contains(&went_first), "{went_first}");
}
