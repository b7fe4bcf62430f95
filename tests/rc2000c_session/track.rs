//! Track mode of the unit, which Azel shows, leaves alone and ends only on request.

use azel::{
    contract::{
        alarms::AlarmKind,
        driver::{Command, Event, Found, LinkState, Refusal},
    },
    device::{MotionRequest, panel::CheckState, settings::Value},
    engine::alarms::alarm_of,
    sim::rc2000c::{Fault, Mode, Options, Quirk},
};

use super::rig::{Rig, antenna, check, reading};

fn named(name: &str) -> [(&'static str, Value); 1] {
    [("satellite", Value::Text(name.to_owned()))]
}

/// Starts a unit that tracks an inclined satellite, searching or peaking.
pub(super) async fn tracking() -> Rig {
    let mut rig = Rig::in_manual().await;
    rig.act_unseen("to_satellite", named("GSTAR 3"));
    rig.until("TRACK", 30, |shown| {
        reading(shown, "TRACK").is_some_and(|text| !text.starts_with("off"))
    })
    .await;
    rig
}

async fn refused(rig: &mut Rig) -> String {
    let event = rig.until_event(2, |event| matches!(event, Event::Refused(..))).await;
    let Event::Refused(MotionRequest::Action(_), reason) = event else { panic!("{event:?}") };
    reason
}

#[tokio::test(start_paused = true)]
async fn a_move_by_name_may_lead_to_track_which_is_told_and_shown() {
    let mut rig = tracking().await;
    assert_eq!(rig.events(), [Event::StartedByItself]);
    assert!(rig.shown().state.program.unwrap().enabled);
    rig.seconds(8.0).await;
    assert_eq!(reading(&rig.shown(), "TRACK").as_deref(), Some("step track, K band"));
    assert_eq!(rig.control.state().mode, Mode::Track);
    assert_eq!(rig.orders(), ["2 GSTAR 3   "]);
}

#[tokio::test(start_paused = true)]
async fn a_move_out_of_track_needs_to_be_told_so() {
    let mut rig = tracking().await;
    rig.act_unseen("to_satellite", named("SBS 6"));
    assert_eq!(refused(&mut rig).await, "TRACK is active on the unit");
    let counts = [("az_counts", Value::Integer(1525)), ("el_counts", Value::Integer(750))];
    rig.act("to_counts", counts.clone());
    assert_eq!(refused(&mut rig).await, "TRACK is active on the unit");
    assert_eq!(rig.times("2").len(), 1);
    let [az, el] = counts;
    rig.act("to_counts", [az, el, ("end_track", Value::Flag(true))]);
    rig.seconds(20.0).await;
    assert_eq!(rig.counts(), [1525, 750]);
    assert_eq!(rig.control.state().mode, Mode::Remote);
    assert_eq!(rig.shown().state.program, None);
}

#[tokio::test(start_paused = true)]
async fn stop_is_not_believed_while_the_unit_goes_on_tracking() {
    let mut rig = tracking().await;
    rig.control.set_quirk(Quirk::StopSparesTracking, true);
    rig.stop();
    rig.until_event(5, |event| *event == Event::StopNotConfirmed).await;
    rig.control.set_quirk(Quirk::StopSparesTracking, false);
    rig.until_event(5, |event| *event == Event::Stopped).await;
    assert_eq!(rig.control.state().mode, Mode::Remote);
}

#[tokio::test(start_paused = true)]
async fn a_unit_found_tracking_is_left_to_it() {
    let mut rig = tracking().await;
    rig.send(Command::Disconnect);
    rig.until("off", 5, |shown| shown.link == LinkState::Off).await;
    rig.events();
    let before = rig.orders().len();
    rig.send(Command::Connect);
    let found = rig.until_event(5, |event| *event == Event::Connected(Found::Tracking)).await;
    assert_eq!(alarm_of(&found), Some(AlarmKind::StartedByItself));
    rig.seconds(5.0).await;
    assert_eq!(rig.orders().len(), before);
    assert_eq!(rig.control.state().mode, Mode::Track);
}

#[tokio::test(start_paused = true)]
async fn the_band_and_the_reset_go_out_only_while_track_is_active() {
    let mut rig = Rig::in_manual().await;
    for action in ["track_c_band", "track_k_band", "restart_track"] {
        rig.act(action, []);
        assert_eq!(refused(&mut rig).await, "TRACK is not active");
    }
    assert!(rig.orders().is_empty());

    let mut rig = tracking().await;
    rig.act("track_c_band", []);
    rig.seconds(1.0).await;
    assert!(reading(&rig.shown(), "TRACK").unwrap().ends_with("C band"));
    rig.act("restart_track", []);
    let told = rig.until_event(2, |event| matches!(event, Event::NotSent(_))).await;
    assert!(matches!(told, Event::NotSent(Refusal::Unseen { .. })), "{told:?}");
    rig.control.set_fault(Fault::PeakLimit, true);
    rig.seconds(10.0).await;
    assert_eq!(check(&rig.shown(), "TRACK"), Some(CheckState::Fault));
    assert_eq!(reading(&rig.shown(), "TRACK").as_deref(), Some("error: no peak, C band"));
    rig.control.set_fault(Fault::PeakLimit, false);
    rig.act_unseen("restart_track", []);
    rig.seconds(1.0).await;
    assert_eq!(check(&rig.shown(), "TRACK"), None);
    let sent: Vec<String> = rig.orders().into_iter().filter(|text| text.starts_with('6')).collect();
    assert_eq!(sent, ["6TC", "6TR"]);
    let frames = rig.control.received();
    let last = frames.iter().rfind(|(_, frame)| frame.code() == b'6').unwrap();
    assert_eq!(last.1.to_bytes(), b"\x02\x32\x36TR\x03\x03");
}

#[tokio::test(start_paused = true)]
async fn a_band_that_the_satellite_does_not_have_is_explained() {
    let mut options = Options::default();
    for satellite in &mut options.satellites {
        satellite.is_dual_band = false;
    }
    let mut rig = Rig::connected(&options, &antenna()).await;
    rig.send(Command::Manual);
    rig.act_unseen("to_satellite", named("GSTAR 3"));
    rig.until("TRACK", 30, |shown| shown.state.program.is_some()).await;
    rig.act("track_c_band", []);
    assert_eq!(refused(&mut rig).await, "the satellite has one band only");
}
