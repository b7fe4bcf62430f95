//! Motions outside the limits, which only STOP ends.

use azel::{
    contract::driver::{Command, Event, Refusal, StopState},
    controller::rotator_genius::{RESCUE, Rotators},
    device::{
        panel::{Act, CheckState},
        settings::Values,
    },
    protocol::rotator_genius::WholeDegrees,
    sim::rotator_genius::{Fault, Options, Quirk, RotatorOptions},
};

use super::{
    rig::{Rig, antenna, pair, to},
    script::{Scripted, plain, status},
};

fn whole(degrees: u16) -> WholeDegrees {
    WholeDegrees::new(degrees).unwrap()
}

/// Returns options of a pair whose azimuth is 20 degrees beyond its clockwise limit.
fn outside() -> Options {
    let Options { rotators: [_, elevation], .. } = pair();
    let azimuth = RotatorOptions {
        limit_cw: whole(270),
        limit_ccw: whole(90),
        position: whole(290),
        ..RotatorOptions::default()
    };
    Options { rotators: [azimuth, elevation], ..pair() }
}

fn arm() -> Command {
    Command::Act(Act { action: RESCUE, values: Values::new() })
}

#[tokio::test(start_paused = true)]
async fn outside_the_limits_a_jog_is_refused_but_not_the_way_back() {
    for quirk in [None, Some(Quirk::LimitBinary)] {
        let mut options = outside();
        options.quirks.extend(quirk);
        let mut rig = Rig::connected(&options, Rotators::Pair).await;
        let shown = rig.shown();
        let check = shown.state.checks.iter().find(|check| check.name == "Limits of rotator 1");
        assert_eq!(check.unwrap().state, CheckState::Caution);
        assert_eq!(rig.reading("Limits 1"), "90° to 270°, outside");
        rig.send(Command::Manual);
        rig.hold([-4.0, 0.0], 0.5).await;
        let events = rig.events();
        assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
        rig.send(Command::EndJog);
        rig.hold([0.0, 4.0], 0.3).await;
        rig.send(Command::EndJog);
        rig.seconds(3.0).await;
        rig.send(to(Some(260.0), None));
        rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
        assert_eq!(rig.orders(), ["|P2", "|S", "|A1260"]);
        assert_eq!(rig.reading("Limits 1"), "90° to 270°");
    }
}

#[tokio::test(start_paused = true)]
async fn an_armed_rescue_lets_it_be_jogged_back_for_a_minute() {
    let mut rig = Rig::connected(&outside(), Rotators::Pair).await;
    rig.send(arm());
    rig.send(Command::Manual);
    rig.seconds(0.5).await;
    assert!(
        rig.reading("Jogs outside limits").starts_with("allowed, "),
        "{}",
        rig.reading("Jogs outside limits")
    );
    let before = rig.times("|h").len();
    rig.seconds(5.0).await;
    let asked = rig.times("|h").len() - before;
    assert!((19..=21).contains(&asked), "{asked}");
    rig.hold([-4.0, 0.0], 2.0).await;
    rig.send(Command::EndJog);
    rig.seconds(3.0).await;
    assert_eq!(rig.orders(), ["|M1", "|S"]);
    assert_eq!(rig.events(), []);
    assert!(rig.rotator(1).angle_deg < 285.0);
    rig.seconds(60.0).await;
    assert_eq!(rig.reading("Jogs outside limits"), "");
    rig.hold([-4.0, 0.0], 0.5).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    assert_eq!(rig.orders(), ["|M1", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn a_rescue_that_runs_out_ends_the_jog() {
    let mut rig = Rig::connected(&outside(), Rotators::Pair).await;
    rig.send(Command::Manual);
    rig.send(arm());
    rig.seconds(59.0).await;
    rig.hold([4.0, 0.0], 2.0).await;
    assert_eq!(rig.orders(), ["|P1", "|S"]);
    let held = rig.times("|S")[0].saturating_duration_since(rig.times("|P1")[0]).as_secs_f64();
    assert!((0.9..1.3).contains(&held), "{held}");
}

#[tokio::test(start_paused = true)]
async fn only_the_stop_of_the_operator_disarms_a_rescue() {
    let mut rig = Rig::connected(&outside(), Rotators::Pair).await;
    rig.send(arm());
    rig.send(Command::Manual);
    rig.hold([-4.0, 0.0], 1.0).await;
    // The unit loses the STOP at the end of the jog, and Azel repeats it.
    rig.control.set_fault(Fault::Silence, true);
    rig.send(Command::EndJog);
    rig.seconds(2.5).await;
    assert!(rig.times("|S").len() >= 3);
    rig.control.set_fault(Fault::Silence, false);
    rig.until_still(4).await;
    rig.send(Command::Standby);
    rig.send(Command::Manual);
    rig.seconds(1.5).await;
    assert!(
        rig.reading("Jogs outside limits").starts_with("allowed, "),
        "{}",
        rig.reading("Jogs outside limits")
    );
    rig.events();
    rig.hold([-4.0, 0.0], 0.5).await;
    rig.stop();
    rig.seconds(3.0).await;
    assert_eq!(rig.reading("Jogs outside limits"), "");
    assert_eq!(rig.events(), [Event::Stopped]);
    assert_eq!(rig.orders(), ["|M1", "|S", "|M1", "|S"]);
    rig.send(Command::Manual);
    rig.hold([-4.0, 0.0], 0.5).await;
    let events = rig.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    assert_eq!(rig.orders(), ["|M1", "|S", "|M1", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn the_first_reply_that_is_missing_in_a_rescue_stops_both() {
    let mut rig = Rig::connected(&outside(), Rotators::Pair).await;
    rig.send(Command::Manual);
    rig.send(arm());
    rig.hold([4.0, 0.0], 1.0).await;
    rig.control.set_fault(Fault::Silence, true);
    let silent = azel::clock::Instant::now();
    rig.hold([4.0, 0.0], 0.8).await;
    let stopped = rig.times("|S")[0].saturating_duration_since(silent).as_secs_f64();
    assert!(stopped <= 0.66, "a question after 250 ms at most, and 400 ms for it: {stopped}");
    assert_eq!(rig.orders()[..2], ["|P1", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn after_a_link_lost_in_a_rescue_the_first_word_is_a_stop() {
    let mut rig = Rig::connected(&outside(), Rotators::Pair).await;
    rig.send(Command::Manual);
    rig.send(arm());
    rig.hold([4.0, 0.0], 1.0).await;
    let before = rig.commands().len();
    rig.control.drop_clients();
    rig.seconds(1.0).await;
    assert_eq!(rig.commands()[before], "|S");
    rig.until_still(4).await;
    // The permission for a rescue ends with the link, so this jog moves nothing.
    rig.hold([4.0, 0.0], 0.5).await;
    assert_eq!(rig.orders(), ["|P1", "|S"]);
}

#[tokio::test(start_paused = true)]
async fn a_jog_that_runs_out_of_the_limits_is_stopped() {
    let options = Options {
        rotators: [
            RotatorOptions {
                limit_cw: whole(180),
                limit_ccw: whole(90),
                stop_offset_deg: 0,
                ..RotatorOptions::default()
            },
            RotatorOptions::elevation(),
        ],
        ..pair()
    };
    let mut rig = Rig::start(&options, &antenna(Rotators::Pair));
    rig.until_up(1).await;
    rig.send(Command::Manual);
    rig.seconds(0.1).await;
    // The unit cuts the drive off at the limit, and the rotator coasts beyond it.
    rig.hold([4.0, 0.0], 6.0).await;
    assert_eq!(rig.orders()[..2], ["|P1", "|S"]);
    assert_eq!(rig.orders().iter().filter(|order| *order == "|P1").count(), 1);
    assert_eq!(rig.shown().stop, StopState::Ready);
}

#[tokio::test(start_paused = true)]
async fn a_limit_byte_without_a_meaning_counts_as_outside() {
    let script = |command: &str| match command {
        "|h" => vec![(10, status(100, 10, ['0', '0'], '?'))],
        other => plain(other),
    };
    let mut device = Scripted::start(Rotators::Pair, Box::new(script));
    device.seconds(0.5).await;
    device.handle.send(Command::Manual).unwrap();
    device.seconds(0.1).await;
    device.events();
    device.handle.send(Command::Jog { rates_deg_s: [4.0, 0.0] }).unwrap();
    device.seconds(0.2).await;
    let events = device.events();
    assert!(matches!(events[..], [Event::NotSent(Refusal::Controller(_))]), "{events:?}");
    let shown = device.handle.snapshot();
    let check = shown.state.checks.iter().find(|check| check.name == "Limits of rotator 1");
    assert_eq!(check.unwrap().state, CheckState::Unknown);
    device.handle.send(to(Some(120.0), None)).unwrap();
    device.seconds(2.0).await;
    // Azel sends STOP first, because the held key may have begun a motion.
    assert_eq!(device.orders(), ["|S", "|A1120"]);
}
