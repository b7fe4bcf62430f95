//! Upkeep of a unit's clock between passes.

use std::time::Duration;

use azel::{
    astro::time::{add_seconds, seconds_between},
    contract::{automatic::DayEvent, driver::TimeSync},
    engine::Client,
    protocol::satrak::{ClockTime, Request, Setting},
    sim::{InMemory as _, Trouble},
    station::AntennaId,
};

use super::{
    flown,
    scene::{Scene, set_automatic},
    unattended::{by_another, proved, scene_of, seconds},
};
use crate::common::units::{measured, until};

/// Starts the dish some minutes before a pass, at a computer with a synchronised clock.
async fn scene(sets_clock: bool, uses_auto_track: bool) -> (Scene, Client, AntennaId) {
    let (mut scene, client, id) = scene_of("Dish", |dish| {
        dish.upkeep.sets_clock = sets_clock;
        dish.upkeep.clock_limit_s = 5.0;
        dish.automatic.uses_auto_track = uses_auto_track;
    })
    .await;
    drop(client);
    scene.units.time_sync = || TimeSync::Synchronised;
    let scene = scene.started_again(false).await;
    let client = scene.client();
    measured(&client, "Dish").await;
    until("the schedule", || client.snapshot().schedule.made_at).await;
    (scene, client, id)
}

/// Sets the unit's clock wrong from another program, after the unit has set its clock from GPS.
async fn put_ahead(scene: &Scene, client: &Client, by_s: f64) {
    seconds(client, 10.0).await;
    let time = add_seconds(client.now().utc, by_s);
    let request = Request::Setting(Setting::Time(ClockTime::new(time).unwrap()));
    by_another(scene, &request.to_bytes()).await;
}

fn ahead_s(client: &Client) -> Option<f64> {
    let snapshot = client.snapshot();
    Some(snapshot.antennas.first()?.snapshot.state.on_board.clock?.ahead_s)
}

/// Returns the events of clock upkeep on this day.
fn upkeep(client: &Client) -> Vec<DayEvent> {
    let day = client.snapshot().day.clone();
    let is_upkeep =
        |what: &DayEvent| matches!(what, DayEvent::ClockSet { .. } | DayEvent::ClockNotSet { .. });
    day.iter().map(|line| line.event.clone()).filter(is_upkeep).collect()
}

async fn until_seen_ahead(client: &Client, least_s: f64) {
    until("the wrong clock", || ahead_s(client).filter(|ahead_s| ahead_s.abs() > least_s)).await;
}

#[tokio::test(start_paused = true)]
async fn a_clock_that_is_off_is_set_before_the_pass_and_once() {
    let (scene, client, id) = scene(true, false).await;
    put_ahead(&scene, &client, -20.0).await;
    set_automatic(&client, id, true).await;
    until("the upkeep", || (!upkeep(&client).is_empty()).then_some(())).await;
    let [DayEvent::ClockSet { was_ahead_s: Some(was_ahead_s) }] = upkeep(&client)[..] else {
        panic!("{:?}", upkeep(&client))
    };
    assert!((-21.0..-19.0).contains(&was_ahead_s), "{was_ahead_s}");
    until("the right clock", || ahead_s(&client).filter(|ahead_s| ahead_s.abs() < 2.0)).await;
    let (_, of) = until("LOS", || flown(&client).first().cloned()).await;
    assert!(of.in_beam_s > of.of_s - 2.0, "{of:?}");
    assert_eq!(upkeep(&client).len(), 1);
}

#[tokio::test(start_paused = true)]
async fn a_clock_is_left_alone_without_the_rule_below_its_limit_and_without_automatic_operation() {
    for (sets_clock, is_on, by_s) in [(false, true, 20.0), (true, true, 3.0), (true, false, 20.0)] {
        let (scene, client, id) = scene(sets_clock, false).await;
        put_ahead(&scene, &client, by_s).await;
        set_automatic(&client, id, is_on).await;
        until_seen_ahead(&client, 1.0).await;
        seconds(&client, 60.0).await;
        assert_eq!(upkeep(&client), [], "{sets_clock} {is_on} {by_s}");
        assert!(ahead_s(&client).is_some_and(|ahead_s| ahead_s > 1.0));
    }
}

/// In a second, a low satellite moves by the width of the beam.
#[tokio::test(start_paused = true)]
async fn a_clock_that_is_off_by_two_seconds_is_set_at_the_default_limit() {
    let (mut scene, client, id) = scene_of("Dish", |dish| dish.upkeep.sets_clock = true).await;
    drop(client);
    scene.units.time_sync = || TimeSync::Synchronised;
    let scene = scene.started_again(false).await;
    let client = scene.client();
    measured(&client, "Dish").await;
    put_ahead(&scene, &client, 2.0).await;
    set_automatic(&client, id, true).await;
    until("the upkeep", || (!upkeep(&client).is_empty()).then_some(())).await;
    until("the right clock", || ahead_s(&client).filter(|ahead_s| ahead_s.abs() < 0.2)).await;
}

/// A unit with GPS would undo the setting.
#[tokio::test(start_paused = true)]
async fn a_clock_that_the_unit_sets_from_gps_is_left_alone() {
    let (scene, client, id) = scene(true, false).await;
    seconds(&client, 10.0).await;
    assert!(scene.units.dish.set_trouble(Trouble::ClockLate(Duration::from_secs(20)), true));
    set_automatic(&client, id, true).await;
    until_seen_ahead(&client, 10.0).await;
    seconds(&client, 60.0).await;
    assert_eq!(upkeep(&client), []);
}

#[tokio::test(start_paused = true)]
async fn a_clock_is_not_set_by_a_computer_that_may_be_wrong_itself() {
    let (scene, client, id) = scene_of("Dish", |dish| dish.upkeep.sets_clock = true).await;
    put_ahead(&scene, &client, 20.0).await;
    set_automatic(&client, id, true).await;
    until_seen_ahead(&client, 10.0).await;
    seconds(&client, 60.0).await;
    assert_eq!(upkeep(&client), []);
}

#[tokio::test(start_paused = true)]
async fn a_clock_is_not_set_during_a_pass_or_shortly_before_but_after_it() {
    for uses_auto_track in [false, true] {
        let (scene, client, id) = scene(true, uses_auto_track).await;
        proved(&client, id).await;
        put_ahead(&scene, &client, 8.0).await;
        until_seen_ahead(&client, 7.0).await;
        let los = client.snapshot().antennas[0].operation.taking().unwrap().end;
        until("LOS", || {
            let is_over = client.now().utc >= los;
            assert!(is_over || upkeep(&client).is_empty());
            is_over.then_some(())
        })
        .await;
        until("the upkeep", || (!upkeep(&client).is_empty()).then_some(())).await;
        assert!(seconds_between(los, client.now().utc) < 120.0);
        assert!(matches!(upkeep(&client)[..], [DayEvent::ClockSet { .. }]));
        // Azel does not set the clock again within an hour, because somebody may keep setting it.
        put_ahead(&scene, &client, 8.0).await;
        until_seen_ahead(&client, 7.0).await;
        seconds(&client, 120.0).await;
        assert_eq!(upkeep(&client).len(), 1);
    }
}
