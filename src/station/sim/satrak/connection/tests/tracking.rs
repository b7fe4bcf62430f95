//! Tests of tracking, elements and the clock.

use super::*;

/// Returns a pass that is high enough for a test, and low enough for an X/Y mount.
fn iss_pass() -> Pass {
    let propagator = Propagator::new(&iss()).unwrap();
    let start = iss().epoch();
    let end = time::add_seconds(start, 3.0 * time::DAY_S);
    let aos_elevation = Angle::from_degrees(10.0);
    let search = PassSearch { aos_elevation, ..PassSearch::new(site(), start, end) };
    passes(&propagator, &search, &|| false)
        .into_iter()
        .find(|pass| pass.max_elevation().degrees() > 40.0)
        .unwrap()
}

fn window(start: Timestamp, stop: Timestamp) -> String {
    let text = |time: Timestamp| {
        jiff::tz::TimeZone::UTC.to_datetime(time).strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string()
    };
    format!("START_STOP_TIME=,{},{}", text(start), text(stop))
}

/// Returns a unit that is ready to track a pass in 90 seconds.
async fn before_pass() -> (Client, Control, Pass) {
    let pass = iss_pass();
    let (mut client, control) = Client::new(&options(time::add_seconds(pass.aos.time, -90.0)));
    client.refused("TRACK=,1", "5").await;
    client.done("SATELLITE=,stations.txt,ISS (ZARYA),1,0").await;
    client.done(&window(pass.aos.time, pass.los.time)).await;
    (client, control, pass)
}

#[tokio::test(start_paused = true)]
async fn tracking_follows_the_satellite_through_the_window() {
    let (mut client, control, pass) = before_pass().await;
    let start = time::add_seconds(pass.aos.time, -90.0);
    let started = Instant::now();
    client.done("TRACK=,1").await;
    assert_eq!(client.status().await.track_state, TrackState::NotInTrackTime);
    let propagator = Propagator::new(&iss()).unwrap();
    let mut states = Vec::new();
    let mut samples = 0;
    let whole = Duration::try_from_secs_f64(pass.duration_s() + 110.0).unwrap();
    while started.elapsed() < whole {
        let status = client.status().await;
        states.push(status.track_state.code());
        let time = time::add_seconds(start, started.elapsed().as_secs_f64());
        if status.track_state == TrackState::InTrackTime && time < pass.los.time {
            let snapshot = control.state();
            let expected = propagator.look_from(site().airless(), time).unwrap().direction;
            let error =
                AzEl::from_degrees(snapshot.az_deg, snapshot.el_deg).separation(expected).degrees();
            // The set-up replies took a fraction of a second.
            assert!(error < 0.2, "{error} at {time}");
            samples += 1;
        }
        seconds(1).await;
    }
    states.dedup();
    assert_eq!(states, [0, 3, 1, 2]);
    assert!(samples > 100, "{samples}");
    let status = client.status().await;
    assert!(!status.tracking_enabled && !status.is_moving());
}

#[tokio::test(start_paused = true)]
async fn after_a_stop_tracking_takes_over_again_unless_switched_off() {
    let (mut client, control, _pass) = before_pass().await;
    client.done("TRACK=,1").await;
    seconds(150).await;
    assert!(control.state().is_moving);
    client.done("STOP=").await;
    sleep(Duration::from_millis(900)).await;
    assert!(!control.state().is_moving && control.state().is_tracking);
    seconds(1).await;
    assert!(control.state().is_moving);
    client.done("STOP=").await;
    client.done("TRACK=,0").await;
    seconds(20).await;
    assert!(!control.state().is_moving && !control.state().is_tracking);
}

#[tokio::test(start_paused = true)]
async fn auto_track_starts_by_itself_and_leaves_a_declined_window_alone() {
    let (mut client, control, _pass) = before_pass().await;
    client.done("TRACK_AUTO_ENABLE =,1").await;
    assert_eq!(client.status().await.auto_track, Some(true));
    assert!(!control.state().is_tracking);
    seconds(40).await;
    assert_eq!(client.status().await.track_state, TrackState::BeforeStart);
    client.done("TRACK=,0").await;
    seconds(100).await;
    assert!(!control.state().is_tracking && !control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn a_missing_file_or_satellite_becomes_a_fault() {
    let (mut client, _control) = Client::new(&options(iss().epoch()));
    for (request, kind) in [
        ("SATELLITE=,other.txt,ISS (ZARYA),1,1", FaultKind::TleMissing),
        ("SATELLITE=,stations.txt,AO-7,1,1", FaultKind::SatelliteMissing),
    ] {
        client.done(request).await;
        assert!(client.status().await.fault);
        let Said::Faults(faults) = client.reply("ERRSTATUS?").await else { panic!("no faults") };
        assert_eq!(faults.active().collect::<Vec<_>>(), [kind]);
    }
    client.done("SATELLITE=,stations.txt,ISS (ZARYA),1,1").await;
    assert!(!client.status().await.fault);
    client.refused("SATELLITE=,sysImage.json", "2").await;
}

#[tokio::test(start_paused = true)]
async fn gps_locks_late_and_sets_an_unset_clock() {
    let unset = Options { clock_is_unset: true, ..options(some_day()) };
    let (mut client, _control) = Client::new(&unset);
    client.refused("RTC_REUPDATE=", "5").await;
    let Said::Clock(clock) = client.reply("TIME?").await else { panic!("no clock") };
    assert!(!clock.is_set());
    let Said::GpsData(gps) = client.reply("GPS_DATA?").await else { panic!("no GPS") };
    assert!(!gps.valid && !client.status().await.rtc_from_gps);
    seconds(8).await;
    let Said::Clock(UnitTime { time: shown, .. }) = client.reply("TIME?").await else {
        panic!("no clock")
    };
    let age = time::seconds_between(some_day(), shown);
    assert!((8.0..9.0).contains(&age), "{shown}");
    let Said::GpsData(GpsData { valid, position, .. }) = client.reply("GPS_DATA?").await else {
        panic!("no GPS")
    };
    assert!(valid && (position.unwrap().longitude_deg() - 29.17).abs() < 1e-9);
    assert!(client.status().await.rtc_from_gps);
    client.done("TIME=,1,2,3,4,5,2030").await;
    assert_eq!(&client.ask("TIME?").await.fields()[..6], ["1", "2", "3", "4", "5", "2030"]);
    client.done("RTC_REUPDATE=").await;
    assert_eq!(client.ask("TIME?").await.fields()[5], "2026");
}

#[tokio::test(start_paused = true)]
async fn switching_tracking_off_beforehand_does_not_stop_auto_track() {
    let (mut client, control, _pass) = before_pass().await;
    client.done("TRACK_AUTO_ENABLE=,1").await;
    client.done("TRACK=,0").await;
    seconds(100).await;
    assert!(control.state().is_tracking);
    client.done("TRACK_AUTO_ENABLE=,0").await;
    assert_eq!(client.status().await.auto_track, Some(false));
    assert!(control.state().is_tracking, "the running track goes on");
}

#[tokio::test(start_paused = true)]
async fn a_move_while_tracking_lasts_a_second() {
    let (mut client, control, _pass) = before_pass().await;
    client.done("TRACK=,1").await;
    seconds(150).await;
    let tracked = control.state();
    client.done("MOVE=,-5,0").await;
    sleep(Duration::from_millis(900)).await;
    let pulled = control.state().x_deg - tracked.x_deg;
    assert!(pulled < -1.0, "{pulled}");
    seconds(4).await;
    let back = control.state().x_deg - tracked.x_deg;
    assert!(back > pulled + 1.0, "{back}");
}

#[tokio::test(start_paused = true)]
async fn offsets_act_at_once_on_a_track_that_runs() {
    let (mut client, control, pass) = before_pass().await;
    let start = time::add_seconds(pass.aos.time, -90.0);
    let started = Instant::now();
    client.done("TRACK=,1").await;
    let propagator = Propagator::new(&iss()).unwrap();
    seconds(180).await;
    let (azimuth_deg, elevation_deg) = (0.8, -0.6);
    for (request, azimuth_deg, elevation_deg) in [
        ("SETTINGS=,?,?,0.8,-0.6,?,?,?,?,?,?,?", azimuth_deg, elevation_deg),
        ("SETTINGS=,?,?,0,0,?,?,?,?,?,?,?", 0.0, 0.0),
    ] {
        client.done(request).await;
        seconds(2).await;
        let time = time::add_seconds(start, started.elapsed().as_secs_f64());
        let expected = propagator.look_from(site().airless(), time).unwrap().direction;
        let snapshot = control.state();
        let difference = (Angle::from_degrees(snapshot.az_deg) - expected.azimuth).wrapped_180();
        assert!((difference.degrees() - azimuth_deg).abs() < 0.2, "{request}: {difference:?}");
        let above_deg = snapshot.el_deg - expected.elevation_deg();
        assert!((above_deg - elevation_deg).abs() < 0.2, "{request}: {above_deg}");
    }
}
