//! Two programs on one unit.

use azel::{
    contract::driver::{Command, Event, StopState},
    sim::satrak::{Control, Options},
};

use super::rig::{Rig, antenna, options};
use crate::common::network;

async fn two() -> (Rig, Rig) {
    let options = Options { max_clients: 2, ..options() };
    let control = Control::new(&options);
    let start =
        || Rig::start_over(control.clone(), options.utc_origin, &antenna(), None, network::link);
    let (mut one, mut other) = (start(), start());
    for rig in [&mut one, &mut other] {
        rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
        rig.events();
        rig.send(Command::Manual);
    }
    (one, other)
}

/// Holds a jog key in both programs.
async fn hold_both(one: &mut Rig, other: &mut Rig, seconds: f64) {
    for _ in 0..(seconds * 10.0) as u32 {
        one.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
        other.send(Command::Jog { rates_deg_s: [0.0, 1.0] });
        one.seconds(0.1).await;
        other.seconds(0.0).await;
    }
}

#[tokio::test(start_paused = true)]
async fn each_sees_what_the_other_moves_and_stop_of_either_is_proved() {
    let (mut one, mut other) = two().await;
    one.hold([1.0, 0.0], 1.0).await;
    assert!(other.shown().state.measured.unwrap().moving(), "the other sees it turn");
    assert!(!other.shown().unproved, "the other has not moved it");
    other.stop();
    other.until_event(5, |event| *event == Event::Stopped).await;
    assert!(!one.control.state().is_moving);
    assert!(matches!(other.shown().stop, StopState::Stopped { .. }));
    // The key of the first program stays down: a stopped motion does not begin again.
    let moves = one.sent("MOVE=").len();
    one.hold([1.0, 0.0], 3.0).await;
    assert!(!one.control.state().is_moving);
    assert_eq!(one.sent("MOVE=").len(), moves);
}

#[tokio::test(start_paused = true)]
async fn of_two_jogs_at_once_the_last_counts_and_either_stop_ends_it() {
    for is_first in [true, false] {
        let (mut one, mut other) = two().await;
        hold_both(&mut one, &mut other, 1.0).await;
        assert!(one.control.state().is_moving, "nobody prevents it");
        let stopping = if is_first { &mut one } else { &mut other };
        stopping.stop();
        stopping.until_event(5, |event| *event == Event::Stopped).await;
        assert!(!stopping.control.state().is_moving);
        // The operators hold both keys down.
        hold_both(&mut one, &mut other, 3.0).await;
        assert!(!one.control.state().is_moving, "by STOP of the first: {is_first}");
    }
}
