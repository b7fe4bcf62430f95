//! Jogging: a key press moves the antenna, its release stops it, and no motion outlasts the key.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use azel::{
    contract::driver::{Command, Event, Intent, LinkState, Refusal, StopState, StoppingWay},
    protocol::satrak::FaultKind,
    sim::satrak::Fault,
    station::Mount,
};

use super::{
    rig::{Rig, antenna, options},
    script::{STILL, Scripted, plain},
};

async fn in_manual() -> Rig {
    let rig = Rig::usual().await;
    rig.send(Command::Manual);
    rig
}

#[tokio::test(start_paused = true)]
async fn a_held_key_moves_once_and_its_release_stops() {
    let mut rig = in_manual().await;
    rig.hold([2.0, 0.0], 2.0).await;
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.jog), (Intent::Manual, Some([2.0, 0.0])));
    assert!(shown.state.measured.unwrap().moving());
    assert_eq!(rig.orders(), ["MOVE=,2,0"]);

    rig.send(Command::EndJog);
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["MOVE=,2,0", "STOP="]);
    assert_eq!(rig.shown().jog, None);
    rig.seconds(2.0).await;
    assert!(!rig.control.state().is_moving);
    assert_eq!(rig.shown().intent, Intent::Manual);
    assert_eq!(rig.shown().stop, StopState::Ready, "the stop button was not pressed");
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn how_long_it_runs_on_is_learned_from_three_fast_jogs() {
    let mut rig = in_manual().await;
    let fastest_deg_s = antenna().limits.maximum_rate_deg_s;
    let usual = rig.shown().stopping_way;
    let mut before = 0;
    // Azel learns nothing about a fast motion from a slow one.
    for (share, stops) in [(0.2, 0), (0.9, 1), (-0.6, 2), (1.0, 3)] {
        assert_eq!(rig.shown().stopping_way, StoppingWay { stops: before, ..usual });
        before = stops;
        rig.hold([fastest_deg_s * share, 0.0], 2.0).await;
        rig.send(Command::EndJog);
        rig.seconds(3.0).await;
        assert_eq!(rig.shown().stopping_way.stops, stops, "{share}");
    }
    let learned = rig.shown().stopping_way;
    assert!(learned.is_learned);
    // The overrun is the braking from the fastest rate at 5 degrees a second squared, and a look.
    let braking_s = fastest_deg_s / 5.0 / 2.0;
    assert!((braking_s * 0.8..braking_s + 0.5).contains(&learned.overrun_s), "{learned:?}");
}

#[tokio::test(start_paused = true)]
async fn a_lease_that_is_not_renewed_ends_the_jog() {
    let mut rig = in_manual().await;
    rig.hold([0.0, -1.5], 0.5).await;
    // The lease of a jog uses the steady clock.
    rig.clock.set(-3600);
    rig.hold([0.0, -1.5], 0.5).await;
    let renewed = rig.times("MOVE=")[0];
    assert_eq!(rig.orders(), ["MOVE=,0,-1.5"]);
    rig.until_event(1, |event| *event == Event::JogLeaseOver).await;
    rig.seconds(0.02).await;
    assert_eq!(rig.orders(), ["MOVE=,0,-1.5", "STOP="]);
    // The last renewal came 0.9 s after the first.
    let held = rig.times("STOP=")[0].saturating_duration_since(renewed).as_secs_f64();
    assert!((1.15..1.25).contains(&held), "{held}");
}

#[tokio::test(start_paused = true)]
async fn a_window_that_goes_away_while_a_key_is_held_stops_the_antenna() {
    let mut rig = in_manual().await;
    rig.hold([1.0, 0.0], 0.5).await;
    rig.drop_handle().await;
    assert_eq!(rig.orders(), ["MOVE=,1,0", "STOP="]);
    rig.seconds(2.0).await;
    assert!(!rig.control.state().is_moving);
}

#[tokio::test(start_paused = true)]
async fn turning_round_stops_first_and_waits_for_standstill() {
    let mut rig = in_manual().await;
    rig.hold([3.0, 0.0], 2.0).await;
    rig.hold([-3.0, 0.0], 3.0).await;
    assert_eq!(rig.orders(), ["MOVE=,3,0", "STOP=", "MOVE=,-3,0"]);
    let between =
        rig.times("MOVE=")[1].saturating_duration_since(rig.times("STOP=")[0]).as_secs_f64();
    // The simulated axis needs 0.6 s to slow down, and two looks must agree.
    assert!((0.6..1.7).contains(&between), "{between}");
    assert_eq!(rig.shown().jog, Some([-3.0, 0.0]));
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn in_standby_a_jog_is_refused_once_with_the_reason() {
    let mut rig = Rig::usual().await;
    rig.hold([1.0, 0.0], 1.0).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Intent(Intent::Standby))]);
    rig.send(Command::Step { steps_deg: [1.0, 0.0] });
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::Intent(Intent::Standby))]);
    assert_eq!(rig.orders(), [""; 0]);
    assert_eq!(rig.shown().jog, None);
}

#[tokio::test(start_paused = true)]
async fn a_limit_switch_blocks_its_own_direction_only() {
    // The switch of the unit comes before the end of the travel in the settings.
    let mut wide = antenna();
    wide.limits.minimum_elevation_deg = 0.0;
    let travel = (0.0, 190.0);
    if let Mount::Xy { travel_from_deg, travel_to_deg, .. } = &mut wide.mount {
        (*travel_from_deg, *travel_to_deg) = travel;
    }
    let mut rig = Rig::connected(&options(), &wide).await;
    rig.send(Command::Manual);
    rig.hold([3.0, 0.0], 32.0).await;
    rig.send(Command::EndJog);
    rig.until("at the limit", 3, |shown| shown.state.measured.unwrap().axes[0].plus_limit).await;
    rig.seconds(1.0).await;
    assert_eq!(rig.orders(), ["MOVE=,3,0", "STOP="]);
    rig.events();

    rig.hold([1.0, 0.0], 0.5).await;
    let blocked = Event::NotSent(Refusal::Limit { axis: "X", plus: true });
    assert_eq!(rig.events(), [blocked]);
    rig.send(Command::EndJog);
    rig.hold([-1.0, 0.0], 1.0).await;
    assert_eq!(rig.orders(), ["MOVE=,3,0", "STOP=", "MOVE=,-1,0"]);
    assert!(!rig.shown().state.measured.unwrap().axes[0].plus_limit);
}

#[tokio::test(start_paused = true)]
async fn a_jog_that_is_too_fast_or_nothing_is_not_sent() {
    let mut rig = in_manual().await;
    rig.send(Command::Jog { rates_deg_s: [3.1, 0.0] });
    rig.send(Command::Jog { rates_deg_s: [0.0, 0.0] });
    rig.send(Command::Jog { rates_deg_s: [f64::NAN, 0.0] });
    rig.send(Command::Step { steps_deg: [0.0, -5.5] });
    rig.seconds(0.1).await;
    assert_eq!(
        rig.events(),
        [
            Event::NotSent(Refusal::TooFast { asked_deg_s: 3.1, allowed_deg_s: 3.0 }),
            Event::NotSent(Refusal::Nothing),
            Event::NotSent(Refusal::Nothing),
            Event::NotSent(Refusal::StepTooLarge { asked_deg: 5.5, allowed_deg: 5.0 }),
        ]
    );
    assert_eq!(rig.orders(), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn a_step_is_sent_once_and_taken() {
    let mut rig = in_manual().await;
    rig.send(Command::Step { steps_deg: [0.0, -2.5] });
    rig.seconds(3.0).await;
    assert_eq!(rig.orders(), ["STEP=,0,-2.5"]);
    assert!((rig.shown().state.measured.unwrap().axes[1].angle_deg.unwrap() - 87.5).abs() < 0.01);
    assert_eq!(rig.events(), []);
}

#[tokio::test(start_paused = true)]
async fn after_a_link_lost_in_a_jog_the_first_frame_is_a_stop() {
    let mut rig = in_manual().await;
    rig.hold([1.0, 1.0], 1.0).await;
    let before = rig.payloads().len();
    let lost = azel::clock::Instant::now();
    rig.control.drop_clients();
    rig.seconds(0.05).await;
    assert!(matches!(rig.shown().link, LinkState::Lost { .. }));
    assert!(rig.control.state().is_moving, "the unit goes on by itself");
    assert_eq!(rig.shown().jog, None);
    // The operator holds the key down.
    rig.hold([1.0, 1.0], 3.0).await;
    rig.until_up(2).await;
    assert_eq!(rig.payloads()[before], "STOP=");
    let gap = rig.times("STOP=")[0].saturating_duration_since(lost).as_secs_f64();
    assert!(gap < 0.3, "soon, not after the usual wait: {gap}");
    assert!(!rig.control.state().is_moving);
    assert_eq!(rig.sent("MOVE=").len(), 1, "it does not start again");
    rig.send(Command::EndJog);
    rig.hold([1.0, 1.0], 0.5).await;
    assert_eq!(rig.sent("MOVE=").len(), 2, "a new press starts it");
}

#[tokio::test(start_paused = true)]
async fn a_fault_during_a_held_jog_ends_it_although_the_key_stays_down() {
    let mut rig = in_manual().await;
    rig.hold([1.0, 0.0], 1.0).await;
    rig.control.set_fault(Fault::Unit(FaultKind::YMotor), true);
    let appeared = azel::clock::Instant::now();
    rig.hold([1.0, 0.0], 3.0).await;
    let stopped = rig.times("STOP=")[0].saturating_duration_since(appeared).as_secs_f64();
    assert!(stopped < 0.3, "with the next status: {stopped}");
    assert_eq!(rig.sent("MOVE=").len(), 1, "the held key does not start it again");
    assert!(!rig.control.state().is_moving);
    let events = rig.events();
    let is_fault =
        |event: &Event| matches!(event, Event::NotSent(Refusal::Fault | Refusal::FaultsUnknown));
    assert!(!events.is_empty() && events.iter().all(is_fault), "{events:?}");
    assert_eq!(rig.shown().jog, None);
}

#[tokio::test(start_paused = true)]
async fn a_limit_switch_during_a_held_jog_ends_it_although_the_key_stays_down() {
    const MOVING: &str = "STATUS?,0,299.49,34.35,0,0,0,0,0,0,0,0,1,0,80.0,35.0,0";
    let with_x_plus_limit = |status: &str| {
        let mut fields: Vec<&str> = status.split(',').collect();
        fields[4] = "1";
        fields.join(",")
    };
    let at_limit = Arc::new(AtomicBool::new(false));
    let mut is_sent = false;
    let mut unit = Scripted::start({
        let at_limit = Arc::clone(&at_limit);
        Box::new(move |payload| {
            is_sent = (is_sent || payload.starts_with("MOVE=")) && payload != "STOP=";
            let status = if is_sent { MOVING } else { STILL };
            match payload {
                "STATUS?" if at_limit.load(Ordering::Relaxed) => {
                    vec![(10, with_x_plus_limit(status))]
                }
                "STATUS?" => vec![(10, status.to_owned())],
                other => plain(other),
            }
        })
    });
    unit.seconds(1.0).await;
    unit.events();
    unit.handle.send(Command::Manual).unwrap();
    for tenth in 0..40 {
        at_limit.store(tenth >= 10, Ordering::Relaxed);
        unit.handle.send(Command::Jog { rates_deg_s: [1.0, 0.0] }).unwrap();
        unit.seconds(0.1).await;
        let is_stopped = !unit.sent("STOP=").is_empty();
        // The next status may come at once or after its period.
        assert!(is_stopped || tenth < 12, "after {tenth} tenths");
        assert!(!is_stopped || tenth >= 10, "after {tenth} tenths");
        if tenth == 9 {
            assert_eq!(unit.handle.snapshot().jog, Some([1.0, 0.0]));
        }
    }
    assert_eq!(unit.sent("MOVE="), ["MOVE=,1,0"]);
    let events = unit.events();
    let limit = Event::NotSent(Refusal::Limit { axis: "X", plus: true });
    assert!(!events.is_empty() && events.iter().all(|event| *event == limit), "{events:?}");
    assert_eq!(unit.handle.snapshot().jog, None);
}

#[tokio::test(start_paused = true)]
async fn a_second_step_waits_until_the_first_is_over() {
    let mut rig = in_manual().await;
    for _ in 0..3 {
        rig.send(Command::Step { steps_deg: [2.0, 0.0] });
    }
    rig.seconds(0.3).await;
    assert_eq!(rig.events(), vec![Event::NotSent(Refusal::StillMoving); 2]);
    assert_eq!(rig.shown().step, Some([2.0, 0.0]));
    rig.until("it stands", 5, |shown| shown.step.is_none()).await;
    assert!((rig.shown().state.measured.unwrap().axes[0].angle_deg.unwrap() - 92.0).abs() < 0.01);
    rig.send(Command::Step { steps_deg: [-1.0, 0.0] });
    rig.seconds(3.0).await;
    assert_eq!(rig.orders(), ["STEP=,2,0", "STEP=,-1,0"]);
}

#[tokio::test(start_paused = true)]
async fn no_step_comes_into_a_jog_and_stop_ends_a_step() {
    let mut rig = in_manual().await;
    rig.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
    rig.send(Command::Step { steps_deg: [2.0, 0.0] });
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::StillMoving)]);
    rig.send(Command::EndJog);
    rig.seconds(2.0).await;
    rig.send(Command::Step { steps_deg: [5.0, 0.0] });
    rig.seconds(0.3).await;
    rig.stop();
    rig.until_event(3, |event| *event == Event::Stopped).await;
    assert_eq!(rig.shown().step, None);
    assert!(rig.shown().state.measured.unwrap().axes[0].angle_deg.unwrap() < 94.0);
}
