//! Max age of the unit's list of faults at the start of a motion.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event},
    device::{Motion, MotionRequest},
    protocol::satrak::FaultKind,
    sim::satrak::Fault,
};

use super::{
    rig::Rig,
    script::{Scripted, plain},
};

/// A status at standstill with the fault flag.
const FLAGGED: &str = "STATUS?,1,299.49,34.35,0,0,0,0,0,0,0,0,0,0,80.0,35.0,0";
/// A list with a warning that forbids nothing.
const WARNING: &str = "ERRSTATUS?,0,0,0,0,0,0,0,0,0,0,0,1";

fn go_to() -> Command {
    Command::Position {
        azimuth: Some(Angle::from_degrees(90.0)),
        elevation: Some(Angle::from_degrees(40.0)),
    }
}

/// Starts a unit with a warning, so that the fault flag cannot announce a second fault.
async fn warned() -> Rig {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Unit(FaultKind::GpsLink), true);
    rig.seconds(10.0).await;
    assert_eq!(rig.shown().state.motion_lock, Some(false));
    rig
}

fn is_refused(event: &Event) -> bool {
    matches!(event, Event::Refused(MotionRequest::Motion(Motion::Position { .. }), _))
}

#[tokio::test(start_paused = true)]
async fn a_fault_that_joins_a_warning_locks_motion_within_two_seconds() {
    let mut rig = warned().await;
    for _ in 0..5 {
        rig.control.set_fault(Fault::Unit(FaultKind::XMotor), true);
        rig.until("locked", 2, |shown| shown.state.motion_lock == Some(true)).await;
        rig.control.set_fault(Fault::Unit(FaultKind::XMotor), false);
        // Each round meets another point of the interval.
        rig.seconds(2.3).await;
        assert_eq!(rig.shown().state.motion_lock, Some(false));
    }
}

#[tokio::test(start_paused = true)]
async fn a_motion_asked_for_just_after_a_fault_joins_a_warning_is_not_sent() {
    let mut rig = warned().await;
    for _ in 0..5 {
        rig.control.set_fault(Fault::Unit(FaultKind::XMotor), true);
        rig.send(go_to());
        rig.until_event(2, is_refused).await;
        rig.control.set_fault(Fault::Unit(FaultKind::XMotor), false);
        rig.seconds(2.3).await;
    }
    assert!(rig.sent("GOTO=").is_empty());
    rig.send(go_to());
    rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
    let payloads = rig.payloads();
    let motion = payloads.iter().position(|payload| payload.starts_with("GOTO=")).unwrap();
    assert_eq!(payloads[motion - 1], "ERRSTATUS?");
}

#[tokio::test(start_paused = true)]
async fn without_the_fault_flag_a_motion_waits_for_no_list() {
    let mut rig = Rig::usual().await;
    rig.seconds(5.0).await;
    let before = rig.sent("ERRSTATUS?").len();
    rig.send(go_to());
    rig.until("sent", 1, |shown| shown.state.measured.unwrap().moving()).await;
    assert_eq!(rig.sent("GOTO=").len(), 1);
    assert_eq!(rig.sent("ERRSTATUS?").len(), before);
}

/// Starts a unit with a warning that answers only the first question for its faults. The second
/// question is due a second after the first.
async fn answering_once() -> Scripted {
    let mut is_answered = false;
    let mut unit = Scripted::start(Box::new(move |payload| match payload {
        "STATUS?" => vec![(10, FLAGGED.to_owned())],
        "ERRSTATUS?" if std::mem::replace(&mut is_answered, true) => Vec::new(),
        "ERRSTATUS?" => vec![(10, WARNING.to_owned())],
        other => plain(other),
    }));
    unit.seconds(0.9).await;
    assert_eq!(unit.handle.snapshot().state.motion_lock, Some(false));
    unit.events();
    unit
}

#[tokio::test(start_paused = true)]
async fn without_an_answer_about_the_faults_a_motion_is_not_sent() {
    let mut unit = answering_once().await;
    unit.handle.send(go_to()).unwrap();
    unit.seconds(2.5).await;
    let events = unit.events();
    assert!(matches!(&events[..], [event] if is_refused(event)), "{events:?}");
    unit.seconds(30.0).await;
    assert!(unit.sent("GOTO=").is_empty());
}

#[tokio::test(start_paused = true)]
async fn a_list_that_can_no_longer_be_read_locks_motion_until_it_can() {
    let mut unit = answering_once().await;
    unit.seconds(6.0).await;
    assert_eq!(unit.handle.snapshot().state.motion_lock, Some(true));
    let before = unit.sent("ERRSTATUS?").len();
    unit.seconds(20.0).await;
    assert!(unit.sent("ERRSTATUS?").len() > before, "it is asked again");
}

#[tokio::test(start_paused = true)]
async fn a_stop_waits_for_no_list_and_drops_the_motion_that_does() {
    let mut unit = answering_once().await;
    unit.handle.send(go_to()).unwrap();
    unit.seconds(0.1).await;
    assert!(unit.sent("STOP=").is_empty());
    unit.handle.stop();
    unit.seconds(0.02).await;
    assert_eq!(unit.sent("STOP=").len(), 1);
    unit.seconds(30.0).await;
    assert!(unit.sent("GOTO=").is_empty());
}
