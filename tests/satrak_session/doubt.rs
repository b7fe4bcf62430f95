//! Late or lost replies: Azel takes none for another and gives no order twice.

use azel::{
    astro::Angle,
    contract::driver::{Command, Event, Intent},
    device::{Motion, MotionRequest},
};

use super::{
    scene::{iss, track},
    script::{STILL, Scripted, plain},
};

/// A status with a moving X axis.
const MOVING: &str = "STATUS?,0,299.49,34.35,0,0,0,0,0,0,0,0,1,0,80.0,35.0,0";

fn goto() -> Command {
    Command::Position {
        azimuth: Some(Angle::from_degrees(125.1)),
        elevation: Some(Angle::from_degrees(32.6)),
    }
}

/// Starts a unit that loses the replies to `word` and reports `then` afterwards.
fn swallowing(word: &'static str, then: &'static str) -> Scripted {
    let mut is_swallowed = false;
    Scripted::start(Box::new(move |payload| match payload {
        order if order.starts_with(word) => {
            is_swallowed = true;
            Vec::new()
        }
        "STATUS?" if is_swallowed => vec![(10, then.to_owned())],
        other => plain(other),
    }))
}

#[tokio::test(start_paused = true)]
async fn a_goto_without_a_reply_that_moves_is_no_news() {
    let mut unit = swallowing("GOTO=", MOVING);
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(goto()).unwrap();
    // After a longer time, Azel would report the angles, which do not change.
    unit.seconds(4.0).await;
    assert_eq!(unit.sent("GOTO="), ["GOTO=,125.1,32.6"]);
    assert_eq!(unit.events(), []);
    let shown = unit.handle.snapshot();
    assert_eq!((shown.intent, shown.pending), (Intent::Position, true));
    assert_eq!(shown.state.traffic.unanswered, 1);
}

#[tokio::test(start_paused = true)]
async fn a_goto_without_a_reply_that_does_not_move_is_told() {
    let mut unit = swallowing("GOTO=", STILL);
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(goto()).unwrap();
    unit.seconds(10.0).await;
    assert_eq!(unit.sent("GOTO="), ["GOTO=,125.1,32.6"]);
    let events = unit.events();
    assert!(
        matches!(events[..], [Event::Unanswered(MotionRequest::Motion(Motion::Position { .. }))]),
        "{events:?}"
    );
    assert_eq!(unit.handle.snapshot().intent, Intent::Standby);
}

#[tokio::test(start_paused = true)]
async fn a_step_without_a_reply_that_was_made_is_no_news() {
    // The unit makes the step within the timeout, so the axis already stands at its new position.
    let made = "STATUS?,0,299.49,34.35,0,0,0,0,0,0,0,0,0,0,82.0,35.0,0";
    let mut unit = swallowing("STEP=", made);
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(Command::Manual).unwrap();
    unit.handle.send(Command::Step { steps_deg: [2.0, 0.0] }).unwrap();
    unit.seconds(10.0).await;
    assert_eq!(unit.sent("STEP="), ["STEP=,2,0"]);
    assert_eq!(unit.events(), []);
}

#[tokio::test(start_paused = true)]
async fn a_step_without_a_reply_that_was_not_made_is_told() {
    let mut unit = swallowing("STEP=", STILL);
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(Command::Manual).unwrap();
    unit.handle.send(Command::Step { steps_deg: [2.0, 0.0] }).unwrap();
    unit.seconds(10.0).await;
    assert_eq!(unit.sent("STEP="), ["STEP=,2,0"]);
    let step = Motion::Step { x_deg: 2.0, y_deg: 0.0 };
    assert_eq!(unit.events(), [Event::Unanswered(step.into())]);
}

#[tokio::test(start_paused = true)]
async fn a_jog_without_a_reply_is_sent_once_and_stopped() {
    let mut unit = swallowing("MOVE=", STILL);
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(Command::Manual).unwrap();
    let rates_deg_s = [1.0, 0.0];
    // The position stays recent, and the key stays down after the STOP.
    for _ in 0..40 {
        unit.handle.send(Command::Jog { rates_deg_s }).unwrap();
        unit.seconds(0.1).await;
    }
    assert_eq!(unit.sent("MOVE="), ["MOVE=,1,0"]);
    assert_eq!(unit.sent("STOP=")[0], "STOP=");
    let jog = Motion::Jog { x_deg_s: 1.0, y_deg_s: 0.0 };
    assert_eq!(unit.events(), [Event::Unanswered(jog.into())]);
}

#[tokio::test(start_paused = true)]
async fn a_setting_without_a_reply_is_not_sent_again() {
    let mut unit = Scripted::start(Box::new(|payload| match payload {
        "SATELLITE?" => vec![(10, "SATELLITE?,stations.txt,OTHER,1,7,50.0".to_owned())],
        order if order.starts_with("SATELLITE=") => Vec::new(),
        other => plain(other),
    }));
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(track(iss())).unwrap();
    unit.seconds(20.0).await;
    assert_eq!(unit.sent("SATELLITE=").len(), 1);
    assert_eq!(unit.sent("TRACK="), [""; 0]);
    let events = unit.events();
    assert!(matches!(events[..], [Event::CannotTrack(..)]), "{events:?}");
}

#[tokio::test(start_paused = true)]
async fn a_late_reply_is_not_taken_for_that_of_another_question() {
    // The version comes so late that Azel gives the question up each time.
    let mut unit = Scripted::start(Box::new(|payload| match payload {
        "VERSION?" => vec![(4300, "VERSION?,LATE,LATE".to_owned())],
        other => plain(other),
    }));
    unit.seconds(4.2).await;
    assert!(unit.handle.snapshot().state.measured.is_some());
    unit.seconds(10.0).await;
    let shown = unit.handle.snapshot();
    assert!(shown.link.is_open(), "{:?}", shown.link);
    assert_eq!(shown.state.identity, None);
    assert_eq!(shown.state.traffic.unsolicited, 3);
    assert_eq!(shown.state.traffic.unreadable, 0);
    let measured = shown.state.measured.unwrap();
    assert!((measured.direction().unwrap().azimuth_deg() - 299.49).abs() < 1e-9);
}

#[tokio::test(start_paused = true)]
async fn a_late_refusal_of_a_goto_does_not_end_a_track_that_came_after() {
    let unit_with_pass = with_pass();
    let mut unit = Scripted::start(Box::new(move |payload| match payload {
        order if order.starts_with("GOTO=") => vec![(4000, "GOTO=,ERR,9".to_owned())],
        other => unit_with_pass(other),
    }));
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(goto()).unwrap();
    // Azel has given the reply up by now.
    unit.seconds(2.7).await;
    unit.handle.send(track(iss())).unwrap();
    unit.seconds(3.0).await;
    let events = unit.events();
    let refused = events.iter().any(|event| matches!(event, Event::Refused(..)));
    assert!(!refused, "{events:?}");
    let shown = unit.handle.snapshot();
    assert_eq!(shown.state.traffic.unsolicited, 1);
    assert_eq!((shown.intent, unit.sent("TRACK=")), (Intent::Track, vec!["TRACK=,1".to_owned()]));
}

/// Returns the answers of a unit that reads back the pass of the ISS.
fn with_pass() -> impl Fn(&str) -> Vec<(u64, String)> + Send {
    let window = {
        let text = |time| {
            let civil = jiff::tz::TimeZone::UTC.to_datetime(time);
            civil.strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string()
        };
        format!("START_STOP_TIME?,{},{}", text(iss().start), text(iss().end))
    };
    move |payload| match payload {
        "SATELLITE?" => vec![(10, "SATELLITE?,stations.txt,ISS (ZARYA),1,25544,50.0".to_owned())],
        "START_STOP_TIME?" => vec![(10, window.clone())],
        other => plain(other),
    }
}

#[tokio::test(start_paused = true)]
async fn a_program_that_is_accepted_and_never_starts_is_told() {
    let mut unit = Scripted::start(Box::new(with_pass()));
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(track(iss())).unwrap();
    unit.seconds(14.0).await;
    let shown = unit.handle.snapshot();
    assert_eq!((shown.intent, shown.pending), (Intent::Track, true));
    unit.seconds(3.0).await;
    assert_eq!(unit.sent("TRACK="), ["TRACK=,1"]);
    assert_eq!(unit.events(), [Event::TrackingEnded { completed: false }]);
    assert_eq!(unit.handle.snapshot().intent, Intent::Standby);
}
