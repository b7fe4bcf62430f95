//! Beginning of a link, and the rate of questions.

use std::time::Duration;

use azel::{
    contract::driver::{Command, Event, Found, Intent, LinkState, StopState},
    station::{Antenna, PollRates},
};

use super::rig::{Rig, antenna, options};

#[tokio::test(start_paused = true)]
async fn a_new_link_is_probed_in_order_and_nothing_moves() {
    let mut rig = Rig::start(&options(), &antenna());
    assert!(matches!(rig.shown().link, LinkState::Connecting { .. }));
    rig.seconds(3.0).await;
    let mut asked = rig.payloads();
    assert_eq!(asked[..2], ["VERSION?", "STATUS?"]);
    asked.truncate(9);
    for query in ["ERRSTATUS?", "TIME?", "SATELLITE?", "START_STOP_TIME?", "GPS_DATA?", "SETTINGS?"]
    {
        assert!(asked.iter().any(|payload| payload == query), "{query} in {asked:?}");
    }
    assert_eq!(rig.orders(), [""; 0], "nothing is set and nothing moves");
    assert_eq!(rig.events(), [Event::Connected(Found::Still)]);

    let shown = rig.shown();
    assert!(matches!(shown.link, LinkState::Up { .. }));
    assert_eq!((shown.intent, shown.pending), (Intent::Standby, false));
    assert_eq!((shown.stop, shown.jog, shown.aim), (StopState::Ready, None, None));
    let measured = shown.state.measured.unwrap();
    assert!((measured.direction().unwrap().elevation_deg() - 90.0).abs() < 0.01);
    assert!(shown.state.identity.is_some() && shown.state.checked_at.is_some());
    let clock = shown.state.on_board.clock.unwrap();
    assert!(clock.ahead_s.abs() < 0.02, "{clock:?}");
    let traffic = shown.state.traffic;
    assert!(traffic.replies >= 10, "{traffic:?}");
    assert_eq!([traffic.damaged, traffic.unreadable, traffic.unanswered, traffic.odd], [0; 4]);
}

async fn questions_in_ten_seconds(rig: &mut Rig) -> usize {
    let before = rig.sent("STATUS?").len();
    rig.seconds(10.0).await;
    rig.sent("STATUS?").len() - before
}

#[tokio::test(start_paused = true)]
async fn the_unit_is_asked_twice_a_second_at_rest_and_five_times_in_motion() {
    let mut rig = Rig::usual().await;
    let at_rest = questions_in_ten_seconds(&mut rig).await;
    assert!((18..=20).contains(&at_rest), "{at_rest}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(500));

    rig.send(Command::Manual);
    rig.hold([0.1, 0.0], 1.0).await;
    let before = rig.sent("STATUS?").len();
    rig.hold([0.1, 0.0], 10.0).await;
    let moving = rig.sent("STATUS?").len() - before;
    assert!((42..=50).contains(&moving), "{moving}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(200));
}

#[tokio::test(start_paused = true)]
async fn ten_questions_a_second_can_be_had() {
    let fast = Antenna { poll: PollRates { idle_hz: 10.0, moving_hz: 10.0 }, ..antenna() };
    let mut rig = Rig::connected(&options(), &fast).await;
    let count = questions_in_ten_seconds(&mut rig).await;
    assert!((75..=100).contains(&count), "{count}");
    assert_eq!(rig.shown().poll_period, Duration::from_millis(100));
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_off_is_shown_as_lost_with_the_reason() {
    let mut rig = Rig::start(&options(), &antenna());
    rig.set_off(true);
    rig.seconds(0.2).await;
    let LinkState::Lost { reason, .. } = rig.shown().link.clone() else {
        panic!("{:?}", rig.shown().link)
    };
    assert_eq!(rig.events(), [Event::LinkLost(reason)]);
    rig.set_off(false);
    rig.until_up(2).await;
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), [Event::Connected(Found::Still)], "it was never there before");
}
