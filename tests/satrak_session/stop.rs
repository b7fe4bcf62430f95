//! STOP: Azel sends it before everything else, never refuses it, and ends it only with a proved
//! standstill.

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, Intent, LinkState, StopState},
    sim::{
        Mechanics,
        satrak::{Fault, Options, Quirk},
    },
};

use super::{
    rig::{Rig, antenna, iss, options, track},
    script::{STILL, Scripted, plain},
};

/// Requests that the unit receives for one STOP.
const STOP: [&str; 3] = ["STOP=", "TRACK=,0", "TRACK_AUTO_ENABLE=,0"];

fn position(azimuth_deg: f64, elevation_deg: f64) -> Command {
    Command::Position {
        azimuth: Some(Angle::from_degrees(azimuth_deg)),
        elevation: Some(Angle::from_degrees(elevation_deg)),
    }
}

fn is_stopping(stop: StopState) -> bool {
    matches!(stop, StopState::Stopping { .. })
}

async fn tracking() -> Rig {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(100.0).await;
    assert!(rig.control.state().is_moving && rig.control.state().is_tracking);
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn a_stop_in_a_goto_is_sent_at_once_and_shown_until_proved() {
    let mut rig = Rig::usual().await;
    rig.send(position(90.0, 30.0));
    rig.seconds(3.0).await;
    assert!(rig.shown().pending && rig.shown().aim.is_some());
    let pressed = azel::clock::Instant::now();
    rig.stop();
    rig.seconds(0.02).await;
    assert_eq!(rig.orders()[0], "GOTO=,90,30");
    assert_eq!(rig.orders()[1..], STOP);
    assert_eq!(rig.times("STOP=")[0], pressed);
    let shown = rig.shown();
    assert!(is_stopping(shown.stop));
    assert_eq!((shown.intent, shown.pending, shown.aim), (Intent::Standby, false, None));

    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert!(!rig.control.state().is_moving);
    assert_eq!(rig.events(), [Event::Stopped]);
    rig.until("the button is ready", 11, |shown| shown.stop == StopState::Ready).await;
    assert_eq!(rig.sent("GOTO=").len(), 1);
}

/// A request made before the STOP may arrive late from the station.
#[tokio::test(start_paused = true)]
async fn what_was_asked_for_before_a_stop_is_void_wherever_it_waited() {
    let mut rig = Rig::usual().await;
    let before = rig.handle().orders().next();
    rig.stop();
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.handle().send_as(position(90.0, 30.0), before).unwrap();
    rig.seconds(1.0).await;
    assert_eq!(rig.sent("GOTO="), [""; 0]);
    rig.send(position(90.0, 30.0));
    rig.seconds(1.0).await;
    assert_eq!(rig.sent("GOTO=").len(), 1);
}

/// The session learns the noise while the antenna stands.
#[tokio::test(start_paused = true)]
async fn a_stop_is_proved_although_the_sensors_are_noisy() {
    let mechanics = Mechanics { noise_deg: 0.3, ..Mechanics::default() };
    let mut rig = Rig::connected(&Options { mechanics, ..options() }, &antenna()).await;
    rig.seconds(60.0).await;
    rig.send(position(90.0, 30.0));
    rig.seconds(3.0).await;
    rig.stop();
    rig.until("stopped", 10, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(300.0).await;
    let events = rig.events();
    let is_wrong = |event: &Event| matches!(event, Event::Safety(_) | Event::StopNotConfirmed);
    assert!(!events.iter().any(is_wrong), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn a_stop_at_rest_is_sent_and_proved_too() {
    let mut rig = Rig::usual().await;
    rig.stop();
    rig.until("stopped", 1, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert_eq!(rig.orders(), STOP);
}

#[tokio::test(start_paused = true)]
async fn a_stop_ends_tracking_for_good() {
    let mut rig = tracking().await;
    let before = rig.orders().len();
    rig.stop();
    rig.seconds(0.02).await;
    assert_eq!(rig.orders()[before..], STOP);
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(30.0).await;
    assert!(!rig.control.state().is_moving && !rig.control.state().is_tracking);
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.target.clone()), (Intent::Standby, None));
    assert_eq!(rig.events(), [Event::Stopped]);
}

#[tokio::test(start_paused = true)]
async fn a_stop_while_a_track_is_prepared_ends_the_preparation() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.seconds(0.05).await;
    rig.stop();
    rig.seconds(20.0).await;
    assert_eq!(rig.sent("TRACK=,1"), [""; 0]);
    assert_eq!(rig.events(), [Event::Stopped]);
    assert_eq!(rig.shown().intent, Intent::Standby);
}

#[tokio::test(start_paused = true)]
async fn a_stop_overtakes_a_peer_that_owes_a_reply() {
    let mut rig = Rig::usual().await;
    rig.send(position(90.0, 30.0));
    rig.seconds(3.0).await;
    rig.control.set_fault(Fault::Silence, true);
    rig.seconds(0.7).await;
    let pressed = azel::clock::Instant::now();
    let since = azel::clock::Instant::now();
    rig.stop();
    rig.seconds(0.02).await;
    assert_eq!(rig.times("STOP="), [pressed], "not after the reply that is owed");
    rig.seconds(2.0).await;
    assert!(!rig.control.state().is_moving);
    assert!(is_stopping(rig.shown().stop), "it stands, but that is not known");
    rig.until_event(2, |event| *event == Event::StopNotConfirmed).await;
    assert_eq!(rig.shown().stop, StopState::NotConfirmed { start: since });
    let waited = (Instant::now() - pressed).as_secs_f64();
    assert!((3.0..3.1).contains(&waited), "{waited}");
    assert!(rig.sent("STOP=").len() >= 3, "a stop is repeated until proved");

    rig.control.set_fault(Fault::Silence, false);
    rig.until("stopped", 20, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(0.1).await;
    assert!(rig.events().contains(&Event::Stopped));
}

async fn switch_auto_track_on(rig: &mut Rig) {
    rig.send(Command::AutoTrack(true));
    rig.until("auto-track", 2, |shown| shown.state.program.unwrap().auto == Some(true)).await;
}

#[tokio::test(start_paused = true)]
async fn a_stop_switches_auto_track_off() {
    let mut rig = Rig::usual().await;
    switch_auto_track_on(&mut rig).await;
    rig.stop();
    rig.until_event(1, |event| *event == Event::Stopped).await;
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(false));
    assert_eq!(rig.orders()[1..], STOP);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn auto_track_that_leaves_no_window_alone_does_not_undo_a_stop() {
    let mut rig = tracking().await;
    rig.control.set_quirk(Quirk::AutoTrackRestarts, true);
    switch_auto_track_on(&mut rig).await;
    rig.stop();
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(30.0).await;
    assert!(!rig.control.state().is_tracking && !rig.control.state().is_moving);
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(false), "read back");
    assert_eq!(rig.events(), [Event::Stopped]);
}

#[tokio::test(start_paused = true)]
async fn the_end_of_a_jog_leaves_auto_track_alone_however_often_it_is_sent() {
    let mut rig = Rig::usual().await;
    switch_auto_track_on(&mut rig).await;
    rig.send(Command::Manual);
    rig.hold([2.0, 0.0], 2.0).await;
    rig.control.set_fault(Fault::Silence, true);
    rig.send(Command::EndJog);
    rig.seconds(3.0).await;
    rig.control.set_fault(Fault::Silence, false);
    rig.seconds(5.0).await;
    assert!(rig.sent("STOP=").len() > 1);
    assert_eq!(rig.sent("TRACK_AUTO_ENABLE=,0"), [""; 0]);
    assert_eq!(rig.shown().state.program.unwrap().auto, Some(true));
}

#[tokio::test(start_paused = true)]
async fn auto_track_that_a_stop_does_not_end_is_told() {
    // The unit answers OK and changes nothing.
    let on = format!("{}1", STILL.strip_suffix('0').unwrap());
    let script = move |payload: &str| match payload {
        "STATUS?" => vec![(10, on.clone())],
        other => plain(other),
    };
    let mut unit = Scripted::start(Box::new(script));
    unit.seconds(3.0).await;
    unit.handle.stop();
    unit.seconds(10.0).await;
    let told = unit.events();
    assert!(told.ends_with(&[Event::Stopped, Event::AutoTrackStillOn]), "{told:?}");
    assert_eq!(unit.sent("TRACK_AUTO_ENABLE=").len(), 4, "again and again");
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_refuses_to_switch_auto_track_off_is_told_again_and_the_operator_once() {
    let on = format!("{}1", STILL.strip_suffix('0').unwrap());
    let script = move |payload: &str| match payload {
        "STATUS?" => vec![(10, on.clone())],
        "TRACK_AUTO_ENABLE=,0" => vec![(10, "TRACK_AUTO_ENABLE=,ERR".to_owned())],
        other => plain(other),
    };
    let mut unit = Scripted::start(Box::new(script));
    unit.seconds(3.0).await;
    unit.handle.stop();
    unit.seconds(30.0).await;
    let told = unit.events();
    let count = told.iter().filter(|event| **event == Event::AutoStaysOn).count();
    assert_eq!(count, 1, "{told:?}");
    assert!(unit.sent("TRACK_AUTO_ENABLE=").len() > 8);
    unit.handle.stop();
    unit.seconds(5.0).await;
    assert!(unit.events().contains(&Event::AutoStaysOn), "a new STOP is told of anew");
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_does_not_report_auto_track_is_told_of_after_a_stop() {
    let mut rig = Rig::usual().await;
    rig.control.set_quirk(Quirk::Fields15, true);
    rig.stop();
    rig.seconds(30.0).await;
    let mut told = rig.events();
    told.sort_by_key(|event| *event != Event::Stopped);
    assert_eq!(told, [Event::Stopped, Event::AutoTrackNotKnown]);
    assert_eq!(rig.sent("TRACK_AUTO_ENABLE=").len(), 1, "it can say no more");
}

#[tokio::test(start_paused = true)]
async fn a_stop_without_a_link_is_the_first_thing_sent_when_it_is_back() {
    let mut rig = Rig::usual().await;
    rig.send(position(90.0, 10.0));
    rig.seconds(2.0).await;
    rig.set_off(true);
    rig.until("lost", 1, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    let before = rig.payloads().len();
    rig.stop();
    rig.seconds(0.02).await;
    assert!(is_stopping(rig.shown().stop));
    rig.until_event(4, |event| *event == Event::StopNotConfirmed).await;
    assert!(rig.control.state().is_moving, "the unit heard nothing");
    rig.set_off(false);
    rig.until_up(9).await;
    rig.seconds(0.05).await;
    assert_eq!(rig.payloads()[before], "STOP=");
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn a_stop_that_is_pressed_again_and_again_is_sent_each_time() {
    let mut rig = tracking().await;
    for _ in 0..5 {
        rig.stop();
        rig.seconds(0.1).await;
    }
    assert_eq!(rig.sent("STOP=").len(), 5);
    rig.until("stopped", 3, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn pressing_again_does_not_put_off_the_warning() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    let since = azel::clock::Instant::now();
    for _ in 0..5 {
        rig.stop();
        rig.seconds(0.5).await;
    }
    rig.stop();
    assert!(is_stopping(rig.shown().stop));
    rig.until_event(1, |event| *event == Event::StopNotConfirmed).await;
    let waited_s = (Instant::now() - since).as_secs_f64();
    assert!((3.0..3.1).contains(&waited_s), "{waited_s}");
    assert_eq!(rig.shown().stop, StopState::NotConfirmed { start: since });
    assert!(rig.sent("STOP=").len() >= 6);
}

#[tokio::test(start_paused = true)]
async fn a_stop_just_before_the_end_of_the_program_is_sent_and_waited_for() {
    let mut rig = tracking().await;
    rig.stop();
    rig.drop_handle().await;
    let last = rig.orders();
    assert!(last.ends_with(&STOP.map(str::to_owned)), "{last:?}");
    assert!(!rig.control.state().is_tracking);
}
