//! Tests of motion and configuration by a client's requests.

use super::*;

#[tokio::test(start_paused = true)]
async fn a_go_to_shows_its_target_and_arrives() {
    let (mut client, _control) = Client::new(&both_limits());
    assert!(client.accepts(go_to(ONE, 220)).await);
    seconds(3).await;
    let rotator = client.rotator(ONE).await;
    assert_eq!((rotator.target, rotator.start), (Some(angle(220)), Some(angle(173))));
    assert_eq!(rotator.moving, Moving::Clockwise);
    let position = rotator.position.unwrap();
    assert!((angle(180)..angle(190)).contains(&position), "{position}");
    seconds(20).await;
    let rotator = client.rotator(ONE).await;
    assert_eq!((rotator.position, rotator.moving), (Ok(angle(220)), Moving::Stopped));
    assert_eq!((rotator.target, rotator.start), (None, None));
}

#[tokio::test(start_paused = true)]
async fn a_rotation_inside_the_limits_ends_at_the_limit() {
    let (mut client, _control) = Client::new(&both_limits());
    for (direction, moving, limit) in [
        (Direction::Clockwise, Moving::Clockwise, angle(359)),
        (Direction::CounterClockwise, Moving::CounterClockwise, angle(0)),
    ] {
        assert!(client.accepts(rotate(ONE, direction)).await);
        seconds(1).await;
        let rotator = client.rotator(ONE).await;
        assert_eq!((rotator.moving, rotator.target), (moving, Some(limit)));
        seconds(120).await;
        let rotator = client.rotator(ONE).await;
        assert_eq!((rotator.position, rotator.moving), (Ok(limit), Moving::Stopped));
        assert_eq!(rotator.is_outside_limits, Some(false));
    }
}

#[tokio::test(start_paused = true)]
async fn outside_the_limits_only_stop_ends_a_rotation_and_its_client_may_leave() {
    let mut options = both_limits();
    options.rotators[0].limit_cw = angle(90);
    let (mut client, control) = Client::new(&options);
    assert_eq!(client.rotator(ONE).await.is_outside_limits, Some(true));
    assert!(!client.accepts(go_to(ONE, 120)).await);
    assert!(client.accepts(rotate(ONE, Direction::CounterClockwise)).await);
    seconds(1).await;
    let rotator = client.rotator(ONE).await;
    assert_eq!((rotator.moving, rotator.target), (Moving::CounterClockwise, None));
    drop(client);
    // The rotator turns through the whole arc and beyond its other end.
    seconds(60).await;
    let state = *control.state().rotator(ONE);
    assert!(state.is_turning && state.is_outside_limits && state.angle_deg > 90.0, "{state:?}");
    let mut client = Client::attached(&control);
    assert!(client.accepts(Request::Stop).await);
    seconds(2).await;
    let stood = control.state();
    assert!(!stood.rotator(ONE).is_turning);
    seconds(5).await;
    assert_eq!(control.state(), stood);
}

#[tokio::test(start_paused = true)]
async fn stop_stops_both_rotators_which_then_coast() {
    let (mut client, control) = Client::new(&both_limits());
    assert!(client.accepts(rotate(ONE, Direction::CounterClockwise)).await);
    assert!(client.accepts(go_to(TWO, 90)).await);
    seconds(5).await;
    let status = client.status().await;
    assert_eq!(
        status.rotators.each_ref().map(|rotator| rotator.moving),
        [Moving::CounterClockwise, Moving::Clockwise]
    );
    assert!(client.accepts(Request::Stop).await);
    let status = client.status().await;
    for rotator in &status.rotators {
        assert_eq!((rotator.moving, rotator.target), (Moving::Stopped, None));
    }
    assert!(control.state().rotators.iter().all(|rotator| rotator.is_turning));
    seconds(2).await;
    assert!(!control.state().rotators.iter().any(|rotator| rotator.is_turning));
}

#[tokio::test(start_paused = true)]
async fn a_rotator_without_a_sensor_refuses_to_move() {
    let (mut client, _control) = Client::new(&Options::default());
    assert!(client.rotator(TWO).await.position.is_err());
    for request in [
        go_to(TWO, 90),
        rotate(TWO, Direction::Clockwise),
        rotate(TWO, Direction::CounterClockwise),
    ] {
        assert!(!client.accepts(request).await);
    }
    assert!(client.accepts(go_to(ONE, 90)).await);
}

#[tokio::test(start_paused = true)]
async fn a_sensor_that_fails_on_the_way_ends_the_motion() {
    let (mut client, control) = Client::new(&both_limits());
    assert!(client.accepts(go_to(ONE, 300)).await);
    seconds(5).await;
    control.set_fault(Fault::NoSensor(ONE), true);
    seconds(2).await;
    assert!(!control.state().rotator(ONE).is_turning);
    assert!(!client.accepts(go_to(ONE, 300)).await);
    control.set_fault(Fault::NoSensor(ONE), false);
    assert!(client.accepts(go_to(ONE, 300)).await);
}

#[tokio::test(start_paused = true)]
async fn a_configuration_is_read_back_with_a_shorter_name() {
    let mut options = both_limits();
    options.rotators[0].name = "Long name 12".to_owned();
    let (mut client, _control) = Client::new(&options);
    let before = client.rotator(ONE).await;
    assert_eq!(before.name, "Long name 12");
    let cut: String = before.name.chars().take(10).collect();
    let configuration = Configuration::new(
        ONE,
        [angle(270), angle(90)],
        RotatorKind::Elevation,
        0,
        RotatorName::new(cut.trim()).unwrap(),
    );
    assert!(client.accepts(Request::Configure(configuration.unwrap())).await);
    let after = client.rotator(ONE).await;
    let expected = Rotator {
        limit_cw: Some(angle(270)),
        limit_ccw: Some(angle(90)),
        kind: RotatorKind::Elevation,
        name: "Long name".to_owned(),
        ..before
    };
    assert_eq!(after, expected);
    // Without a stop offset, the rotator slips past the limit.
    assert!(client.accepts(rotate(ONE, Direction::Clockwise)).await);
    seconds(60).await;
    let rotator = client.rotator(ONE).await;
    assert_eq!((rotator.position, rotator.is_outside_limits), (Ok(angle(272)), Some(true)));
}
