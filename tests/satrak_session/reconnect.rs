//! Link that breaks and comes back.

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{
        Command, Event, Found, Intent, LinkLoss, LinkState, Refusal, Safety, StopState, Unlike,
    },
    device::PrepareError,
    protocol::satrak::{Goto, Halt, Motion, Request},
    sim::satrak::Fault,
};
use tokio::io::AsyncWriteExt as _;

use super::{
    on_board::by_another,
    rig::{Rig, antenna, iss, options, track},
};

async fn tracking() -> Rig {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.until_event(10, |event| matches!(event, Event::Tracking(_))).await;
    rig.seconds(100.0).await;
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_is_off_is_tried_again_less_and_less_often() {
    let mut rig = Rig::usual().await;
    let before = rig.dials().len();
    rig.set_off(true);
    rig.seconds(40.0).await;
    let tries = rig.dials().split_off(before);
    let waits: Vec<f64> = tries
        .windows(2)
        .map(|pair| pair[1].saturating_duration_since(pair[0]).as_secs_f64())
        .collect();
    for (wait, wanted) in waits.iter().zip([1.0, 2.0, 4.0, 8.0, 8.0, 8.0]) {
        assert!((wait - wanted).abs() < 0.01, "{waits:?}");
    }
    assert!(waits.len() >= 6, "{waits:?}");
    let LinkState::Lost { retry_at, .. } = rig.shown().link else { panic!("{:?}", rig.shown()) };
    assert!(retry_at > Instant::now());
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Closed)], "told once");
}

#[tokio::test(start_paused = true)]
async fn the_first_try_comes_after_half_a_second() {
    let mut rig = Rig::usual().await;
    let before = rig.payloads().len();
    rig.control.drop_clients();
    let lost = azel::clock::Instant::now();
    rig.seconds(1.0).await;
    let wait = rig.dials()[1].saturating_duration_since(lost).as_secs_f64();
    assert!((0.49..0.52).contains(&wait), "{wait}");
    let back = rig.until_event(1, |event| matches!(event, Event::Back { .. })).await;
    assert!(matches!(back, Event::Back { found: Found::Still, .. }), "{back:?}");
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Closed)]);
    rig.seconds(5.0).await;
    let asked = rig.payloads().split_off(before);
    for question in
        ["VERSION?", "STATUS?", "TIME?", "SATELLITE?", "START_STOP_TIME?", "GPS_DATA?", "SETTINGS?"]
    {
        assert!(asked.iter().any(|payload| payload == question), "{question} in {asked:?}");
    }
    assert_eq!(rig.orders(), [""; 0], "nothing is sent again or started");
}

#[tokio::test(start_paused = true)]
async fn tracking_goes_on_without_the_link_and_is_found_again() {
    let mut rig = tracking().await;
    rig.set_off(true);
    rig.seconds(20.0).await;
    let shown = rig.shown();
    assert!(matches!(shown.link, LinkState::Lost { .. }), "{:?}", shown.link);
    assert_eq!((shown.intent, shown.target.clone()), (Intent::Track, Some(iss())));
    let before = rig.orders().len();
    rig.set_off(false);
    let back = rig.until_event(9, |event| matches!(event, Event::Back { .. })).await;
    let Event::Back { after, found, .. } = back else { panic!("{back:?}") };
    assert_eq!(found, Found::Tracking);
    assert!((20.0..30.0).contains(&after.as_secs_f64()), "{after:?}");
    rig.seconds(5.0).await;
    let shown = rig.shown();
    assert_eq!((shown.intent, shown.pending), (Intent::Track, false));
    assert_eq!(rig.orders().len(), before, "nothing is sent that the unit does already");
    let told = [Event::Safety(Safety::SilentInMotion), Event::LinkLost(LinkLoss::Closed)];
    assert_eq!(rig.events(), told);
}

#[tokio::test(start_paused = true)]
async fn tracking_that_ended_meanwhile_is_not_started_again() {
    let mut rig = tracking().await;
    rig.set_off(true);
    rig.seconds(1500.0).await;
    rig.set_off(false);
    let back = rig.until_event(9, |event| matches!(event, Event::Back { .. })).await;
    assert!(matches!(back, Event::Back { found: Found::Still, .. }), "{back:?}");
    rig.seconds(5.0).await;
    assert_eq!((rig.shown().intent, rig.shown().target.clone()), (Intent::Standby, None));
    assert_eq!(rig.sent("TRACK=,1").len(), 1);
}

/// Motion during which the link is lost.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Begun {
    GoTo,
    Park,
    Track,
}

async fn moving(begun: Begun) -> Rig {
    if begun == Begun::Track {
        return tracking().await;
    }
    let mut rig = Rig::usual().await;
    rig.send(position());
    if begun == Begun::Park {
        rig.until_event(60, |event| matches!(event, Event::Arrived(_))).await;
        rig.send(Command::Park);
    }
    rig.seconds(1.0).await;
    rig
}

/// The antenna keeps moving while the link is down, until it receives STOP.
#[tokio::test(start_paused = true)]
async fn a_motion_that_is_left_while_the_link_is_down_is_stopped_first_when_it_is_back() {
    let commands = [Command::Standby, Command::Manual, Command::Hold, Command::Park, track(iss())];
    let go_tos = commands.map(|command| (Begun::GoTo, command));
    let others = [Begun::Park, Begun::Track].map(|begun| (begun, Command::Standby));
    for (begun, command) in go_tos.into_iter().chain(others) {
        let mut rig = moving(begun).await;
        rig.set_off(true);
        rig.seconds(1.0).await;
        assert!(rig.control.state().is_moving, "{begun:?} {command:?}");
        let before = rig.orders().len();
        rig.send(command.clone());
        rig.seconds(1.0).await;
        rig.set_off(false);
        rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
        rig.seconds(10.0).await;
        let orders = rig.orders().split_off(before);
        let case = format!("{begun:?} {command:?} {orders:?}");
        assert_eq!(orders.first().map(String::as_str), Some("STOP="), "{case}");
        let state = rig.control.state();
        assert!(!state.is_moving && !state.is_tracking, "{case}");
        assert_eq!(rig.shown().intent, Intent::Standby, "{case}");
    }
}

fn position() -> Command {
    let degrees = |degrees| Some(Angle::from_degrees(degrees));
    Command::Position { azimuth: degrees(200.0), elevation: degrees(40.0) }
}

/// Sends `request` to the unit from another client.
async fn elsewhere(rig: &Rig, request: Request) {
    let (mut near, far) = tokio::io::duplex(4096);
    let unit = rig.control.clone();
    tokio::spawn(async move { unit.serve(far).await });
    near.write_all(&request.to_bytes()).await.unwrap();
    tokio::time::sleep(std::time::Duration::from_millis(100)).await;
}

fn goto() -> Request {
    Request::Motion(Motion::Goto(Goto::new(Some(200.0), Some(40.0)).unwrap()))
}

/// Returns the motion of the unit after an outage in which it received `request`, and `true` if
/// commands from Azel explain its state.
async fn after_an_outage(rig: &mut Rig, request: Option<Request>, waits_s: f64) -> (Found, bool) {
    rig.set_off(true);
    rig.seconds(1.0).await;
    if let Some(request) = request {
        elsewhere(rig, request).await;
    }
    rig.seconds(waits_s).await;
    rig.set_off(false);
    let back = rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    let Event::Back { found, is_explained, .. } = back else { panic!("{back:?}") };
    (found, is_explained)
}

#[tokio::test(start_paused = true)]
async fn a_unit_at_rest_that_was_turned_while_out_of_reach_is_not_as_it_was_left() {
    for parks_first in [false, true] {
        for (waits_s, request, wanted) in [
            (5.0, None, (Found::Still, true)),
            (5.0, Some(goto()), (Found::Moving, false)),
            (90.0, Some(goto()), (Found::Still, false)),
        ] {
            let mut rig = Rig::usual().await;
            if parks_first {
                rig.send(Command::Park);
                rig.until_event(200, |event| matches!(event, Event::Arrived(_))).await;
            }
            assert_eq!(after_an_outage(&mut rig, request, waits_s).await, wanted);
        }
    }
}

/// Near the end of the lower axis, directions say little about the axes. The axes at rest still do.
#[tokio::test(start_paused = true)]
async fn one_at_rest_near_the_end_of_its_lower_axis_is_compared_with_where_it_was_left() {
    for (request, wanted) in [(None, true), (Some(goto()), false)] {
        let mut rig = Rig::usual().await;
        let [azimuth, elevation] = [0.0, 7.0].map(|deg| Some(Angle::from_degrees(deg)));
        rig.send(Command::Position { azimuth, elevation });
        rig.until_event(200, |event| matches!(event, Event::Arrived(_))).await;
        rig.seconds(30.0).await;
        assert_eq!(after_an_outage(&mut rig, request, 90.0).await, (Found::Still, wanted));
    }
}

/// The position alone decides, because a STOP without a send or an answer turns nothing.
#[tokio::test(start_paused = true)]
async fn a_stop_that_is_owed_after_an_outage_hides_no_foreign_motion_and_pretends_none() {
    for (waits_s, request, wanted) in
        [(5.0, None, (Found::Still, true)), (90.0, Some(goto()), (Found::Still, false))]
    {
        let mut rig = Rig::usual().await;
        rig.set_off(true);
        rig.seconds(1.0).await;
        rig.stop();
        assert_eq!(after_an_outage(&mut rig, request, waits_s).await, wanted);
    }
    let mut rig = moving(Begun::GoTo).await;
    rig.set_off(true);
    rig.seconds(1.0).await;
    rig.stop();
    assert!(after_an_outage(&mut rig, None, 2.0).await.1);
}

#[tokio::test(start_paused = true)]
async fn a_track_that_somebody_has_ended_while_out_of_reach_is_not_as_it_was_left() {
    let mut rig = tracking().await;
    assert_eq!(after_an_outage(&mut rig, None, 10.0).await, (Found::Tracking, true));
    let off = Request::Halt(Halt::TrackOff);
    assert_eq!(after_an_outage(&mut rig, Some(off), 10.0).await, (Found::Still, false));
    let mut rig = tracking().await;
    // The track has ended during the outage.
    assert_eq!(after_an_outage(&mut rig, None, 1500.0).await, (Found::Still, true));
}

#[tokio::test(start_paused = true)]
async fn a_motion_that_was_stopped_on_its_way_while_out_of_reach_is_not_as_it_was_left() {
    for stops in [false, true] {
        let mut rig = Rig::usual().await;
        rig.send(Command::Position {
            azimuth: Some(Angle::from_degrees(200.0)),
            elevation: Some(Angle::from_degrees(30.0)),
        });
        rig.seconds(1.0).await;
        let stop = stops.then_some(Request::Halt(Halt::Stop));
        let (_, is_explained) = after_an_outage(&mut rig, stop, 1.0).await;
        assert_eq!(is_explained, !stops);
    }
}

/// Another unit at the same address, or one whose settings have changed.
#[tokio::test(start_paused = true)]
async fn a_unit_that_differs_after_an_outage_is_told_and_compared_before_anything_is_sent() {
    for (is_other, changes) in [(false, ""), (true, "SETTINGS=,?,?,?,8.0,?,?,?,?,?,?,?")] {
        let mut rig = Rig::usual().await;
        rig.seconds(30.0).await;
        rig.events();
        rig.set_off(true);
        rig.seconds(1.0).await;
        if is_other {
            by_another(&rig, changes).await;
        }
        rig.set_off(false);
        rig.until("it is back", 20, |shown| shown.being_compared).await;
        rig.until("it is compared", 20, |shown| !shown.being_compared).await;
        let differs = Event::Safety(Safety::UnitDiffers { unlike: Unlike::Offsets });
        assert_eq!(rig.events().contains(&differs), is_other);
    }
}

#[tokio::test(start_paused = true)]
async fn commands_without_a_link_are_told_and_not_kept_for_later() {
    let mut rig = Rig::usual().await;
    rig.set_off(true);
    rig.seconds(0.1).await;
    rig.events();
    rig.send(track(iss()));
    rig.send(Command::Park);
    rig.send(Command::Jog { rates_deg_s: [1.0, 0.0] });
    rig.seconds(0.1).await;
    assert_eq!(rig.events(), vec![Event::NotSent(Refusal::PositionUnknown); 2]);
    rig.set_off(false);
    rig.until_up(3).await;
    rig.seconds(5.0).await;
    assert_eq!(rig.orders(), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn silence_is_stale_first_and_lost_after_five_and_a_half_seconds() {
    let mut rig = Rig::usual().await;
    rig.control.set_fault(Fault::Silence, true);
    rig.until("stale", 2, |shown| matches!(shown.link, LinkState::Stale { .. })).await;
    let last_reply = rig.shown().state.traffic.last_reply.unwrap();
    let periods = (Instant::now() - last_reply).div_duration_f64(rig.shown().poll_period);
    assert!((2.0..2.1).contains(&periods), "{periods}");
    rig.until("lost", 6, |shown| matches!(shown.link, LinkState::Lost { .. })).await;
    let waited = Instant::now() - last_reply;
    assert!((5.5..5.6).contains(&waited.as_secs_f64()), "{waited:?}");
    assert!(rig.shown().state.traffic.unanswered >= 2);
    rig.seconds(60.0).await;
    rig.control.set_fault(Fault::Silence, false);
    rig.until_up(20).await;
    let back = rig.until_event(20, |event| matches!(event, Event::Back { .. })).await;
    let Event::Back { after, .. } = back else { panic!("{back:?}") };
    assert!(after.as_secs() >= 60, "{after:?}");
    assert_eq!(rig.events(), [Event::LinkLost(LinkLoss::Silent)]);
}

#[tokio::test(start_paused = true)]
async fn a_unit_that_never_says_a_word_is_lost_after_the_same_time() {
    let mut rig = Rig::start(&options(), &antenna());
    rig.control.set_fault(Fault::Silence, true);
    rig.until("lost", 6, |shown| {
        matches!(shown.link, LinkState::Lost { reason: LinkLoss::Silent, .. })
    })
    .await;
    assert_eq!(rig.shown().state.measured, None);
}

#[tokio::test(start_paused = true)]
async fn a_motion_to_a_position_is_watched_on_after_a_lost_link() {
    let mut rig = Rig::usual().await;
    rig.send(Command::Position {
        azimuth: Some(Angle::from_degrees(90.0)),
        elevation: Some(Angle::from_degrees(10.0)),
    });
    rig.seconds(2.0).await;
    rig.control.drop_clients();
    let back = rig.until_event(2, |event| matches!(event, Event::Back { .. })).await;
    assert!(matches!(back, Event::Back { found: Found::Moving, .. }), "{back:?}");
    assert_eq!((rig.shown().intent, rig.shown().pending), (Intent::Position, true));
    rig.until_event(30, |event| matches!(event, Event::Arrived(_))).await;
    assert_eq!(rig.orders(), ["GOTO=,90,10"]);
}

#[tokio::test(start_paused = true)]
async fn a_link_lost_while_a_track_is_prepared_ends_the_intent_with_the_reason() {
    let mut rig = Rig::usual().await;
    rig.send(track(iss()));
    rig.seconds(0.05).await;
    rig.control.drop_clients();
    let told = rig.until_event(3, |event| matches!(event, Event::CannotTrack(..))).await;
    assert_eq!(told, Event::CannotTrack(iss(), PrepareError::Unanswered));
    rig.seconds(5.0).await;
    assert_eq!((rig.shown().intent, rig.shown().target.clone()), (Intent::Standby, None));
    assert_eq!(rig.sent("TRACK="), [""; 0]);
}

#[tokio::test(start_paused = true)]
async fn a_link_lost_soon_after_a_stop_shows_the_button_ready_in_its_time() {
    let mut rig = Rig::usual().await;
    rig.stop();
    rig.until_event(2, |event| *event == Event::Stopped).await;
    rig.set_off(true);
    rig.seconds(5.0).await;
    assert!(matches!(rig.shown().stop, StopState::Stopped { .. }));
    rig.seconds(15.0).await;
    assert_eq!(rig.shown().stop, StopState::Ready);
}
