//! Release of a unit: the operator leaves it to others, and comes back.

use azel::contract::driver::{Command, Event, Found, Intent, LinkState, Refusal, StopState};

use super::rig::{Rig, iss, track};

async fn let_go(rig: &mut Rig) {
    rig.send(Command::Disconnect);
    rig.until("off", 3, |shown| shown.link == LinkState::Off).await;
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_let_go_is_not_asked_until_the_operator_connects_again() {
    let mut rig = Rig::usual().await;
    let_go(&mut rig).await;
    let (asked, dials) = (rig.payloads().len(), rig.dials().len());
    rig.seconds(60.0).await;
    assert_eq!((rig.payloads().len(), rig.dials().len()), (asked, dials));
    assert_eq!(rig.events(), [], "it was on purpose");
    rig.send(Command::Position { azimuth: None, elevation: None });
    rig.seconds(1.0).await;
    assert_eq!(rig.events(), [Event::NotSent(Refusal::PositionUnknown)]);

    rig.send(Command::Connect);
    rig.until_up(3).await;
    let event = rig.until_event(3, |event| matches!(event, Event::Connected(_))).await;
    assert_eq!(event, Event::Connected(Found::Still));
    assert_eq!(rig.orders(), [""; 0], "nothing that was asked meanwhile is sent");
}

#[tokio::test(start_paused = true)]
async fn a_stop_reaches_a_unit_that_was_let_go() {
    let mut rig = Rig::usual().await;
    let_go(&mut rig).await;
    rig.seconds(10.0).await;
    rig.stop();
    rig.until("stopped", 5, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    assert_eq!(rig.orders()[..2], ["STOP=", "TRACK=,0"]);
    rig.until("let go again", 3, |shown| shown.link == LinkState::Off).await;
    let dials = rig.dials().len();
    rig.until("said long enough", 11, |shown| shown.stop == StopState::Ready).await;
    assert_eq!(rig.dials().len(), dials);
}

#[tokio::test(start_paused = true)]
async fn whoever_connects_during_a_stop_stays_connected() {
    let mut rig = Rig::usual().await;
    let_go(&mut rig).await;
    rig.stop();
    rig.seconds(0.01).await;
    rig.send(Command::Connect);
    rig.until("stopped", 5, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
    rig.seconds(5.0).await;
    assert!(matches!(rig.shown().link, LinkState::Up { .. }));
}

#[tokio::test(start_paused = true)]
async fn a_jog_ends_before_the_unit_is_let_go_and_tracking_on_board_goes_on() {
    let mut rig = Rig::usual().await;
    rig.send(Command::Manual);
    rig.hold([1.0, 0.0], 1.0).await;
    let_go(&mut rig).await;
    assert_eq!(rig.orders().last().map(String::as_str), Some("STOP="));

    rig.send(Command::Connect);
    rig.until_up(3).await;
    rig.seconds(3.0).await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    let orders = rig.orders().len();
    let_go(&mut rig).await;
    assert_eq!(rig.orders().len(), orders, "nothing is stopped");
    assert_eq!(rig.shown().intent, Intent::Standby);
    rig.events();
    rig.send(Command::Connect);
    let event = rig.until_event(5, |event| matches!(event, Event::Connected(_))).await;
    assert_eq!(event, Event::Connected(Found::Tracking), "and is told when it is seen again");
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_cannot_be_reached_is_given_up_on_word() {
    let mut rig = Rig::usual().await;
    rig.set_off(true);
    rig.seconds(3.0).await;
    let_go(&mut rig).await;
    let dials = rig.dials().len();
    rig.seconds(30.0).await;
    assert_eq!(rig.dials().len(), dials);
}

#[tokio::test(start_paused = true)]
async fn while_a_stop_is_owed_the_unit_is_not_let_go() {
    let mut rig = Rig::usual().await;
    rig.set_off(true);
    rig.seconds(1.0).await;
    rig.events();
    rig.stop();
    rig.seconds(0.1).await;
    rig.send(Command::Disconnect);
    let event = rig.until_event(1, |event| matches!(event, Event::NotSent(_))).await;
    assert_eq!(event, Event::NotSent(Refusal::Stopping));
    rig.set_off(false);
    rig.until("stopped", 5, |shown| matches!(shown.stop, StopState::Stopped { .. })).await;
}
