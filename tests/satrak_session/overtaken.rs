//! Commands that a later command overtakes before they take effect.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event, Intent, StopState},
    sim::satrak::Fault,
};

use super::rig::{Rig, iss, track, twin};

fn position() -> Command {
    Command::Position {
        azimuth: Some(Angle::from_degrees(90.0)),
        elevation: Some(Angle::from_degrees(30.0)),
    }
}

#[tokio::test(start_paused = true)]
async fn what_waits_in_the_queue_when_stop_is_pressed_is_never_sent() {
    let mut rig = Rig::usual().await;
    // The session has no turn between these commands.
    rig.send(Command::AutoTrack(true));
    rig.send(position());
    rig.send(track(iss()));
    rig.stop();
    rig.until("stopped", 2, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(20.0).await;
    assert_eq!(rig.orders(), ["STOP=", "TRACK=,0", "TRACK_AUTO_ENABLE=,0"]);
    assert_eq!(rig.events(), [Event::Stopped]);
    assert_eq!((rig.shown().intent, rig.shown().pending), (Intent::Standby, false));
}

#[tokio::test(start_paused = true)]
async fn a_goto_that_waits_for_a_reply_when_stop_is_pressed_is_never_sent() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    let asked = rig.sent("STATUS?").len();
    while rig.sent("STATUS?").len() == asked {
        rig.seconds(0.01).await;
    }
    rig.send(position());
    rig.seconds(0.3).await;
    assert_eq!(rig.shown().intent, Intent::Position, "it was taken");
    assert_eq!(rig.orders(), [""; 0], "but a reply is owed");
    rig.stop();
    rig.seconds(0.1).await;
    rig.control.set_fault(Fault::Silence, false);
    rig.until_event(10, |event| *event == Event::Stopped).await;
    rig.seconds(20.0).await;
    assert_eq!(rig.sent("GOTO="), [""; 0]);
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn standby_right_after_a_goto_stops_although_no_motion_was_seen() {
    let mut rig = Rig::usual().await;
    rig.send(position());
    while rig.sent("GOTO=").is_empty() {
        rig.seconds(0.01).await;
    }
    assert!(!rig.shown().state.measured.unwrap().moving(), "not seen yet");
    rig.send(Command::Standby);
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["GOTO=,90,30", "STOP="]);
    rig.seconds(20.0).await;
    let state = rig.control.state();
    assert!(!state.is_moving && state.el_deg > 85.0, "{state:?}");
    assert_eq!((rig.shown().intent, rig.shown().aim), (Intent::Standby, None));
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_track_that_replaces_one_in_preparation_is_the_only_one_that_starts() {
    let mut replaced = 0;
    for pause_ms in (0..200).step_by(10) {
        let mut rig = Rig::usual().await;
        rig.send(track(iss()));
        rig.seconds(f64::from(pause_ms) / 1000.0).await;
        if !rig.sent("TRACK=,1").is_empty() {
            continue;
        }
        replaced += 1;
        rig.send(track(twin()));
        let told = rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
        assert_eq!(told, Event::Tracking(twin()), "after {pause_ms} ms");
        rig.seconds(20.0).await;
        assert_eq!(rig.events(), [], "after {pause_ms} ms");
        assert_eq!(rig.sent("TRACK=,1").len(), 1, "after {pause_ms} ms");
        let started = rig.times("TRACK=,1")[0];
        let chosen = rig.times("SATELLITE=,stations.txt,TWIN,")[0];
        assert!(chosen < started, "after {pause_ms} ms");
        let last = rig.sent("SATELLITE=").pop().unwrap();
        assert_eq!(last, "SATELLITE=,stations.txt,TWIN,1,0", "after {pause_ms} ms");
        assert_eq!(rig.shown().target, Some(twin()));
    }
    assert!(replaced >= 5, "{replaced}");
}
