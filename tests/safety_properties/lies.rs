//! Frozen angles, and flags that report a turning antenna as standing.

use std::time::Duration;

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, Safety},
    controller::rotator_genius::Rotators,
    sim::rotator_genius::Fault,
};

use super::{
    cases::for_each_case,
    scene::Scene,
    unit::Lie,
    world::{Wish, World},
};
use crate::{common::dice::Dice, genius_session::rig};

async fn scene(dice: &mut Dice, others_jog: bool) -> Scene {
    let wish = Wish { others_jog, ..Wish::default() };
    let world = World::random(dice, &wish);
    Scene::start(world, dice).await
}

/// Rate below which two looks that prove standstill may miss a motion of a Satrak, degrees a
/// second. A Satrak reports tenths of a degree.
const SLOWEST_DEG_S: f64 = 0.5;

/// Returns the direction of an axis with the longer travel ahead.
fn long_way(scene: &Scene, axis: usize) -> f64 {
    let (from_deg, to_deg) = scene.world.antenna.mount.travel_deg()[axis];
    let at_deg = scene.world.unit.axes_deg()[axis];
    if at_deg - from_deg > to_deg - at_deg { -1.0 } else { 1.0 }
}

async fn flags_lie(mut dice: Dice) {
    let mut scene = scene(&mut dice, true).await;
    let axis = dice.below(2);
    let rate_deg_s = long_way(&scene, axis) * dice.between(SLOWEST_DEG_S, 5.0);
    scene.world.unit.tell(Lie::FalseRest);
    scene.seconds(1.0).await;
    let began = Instant::now();
    scene.world.other_client_turns(axis, rate_deg_s).await;
    scene.trouble(|line| line.ignores_stop = true);
    let presses = dice.chance(0.6);
    let press_at = began + Duration::try_from_secs_f64(dice.between(0.0, 6.0)).unwrap();
    let mut pressed = None;
    let mut turned_until = began;
    let mut was_shown = false;
    while Instant::now() < began + Duration::from_secs(10) {
        scene.look().await;
        if presses && pressed.is_none() && Instant::now() >= press_at {
            pressed = Some(Instant::now());
            scene.stop();
        }
        was_shown |= scene.shown().state.measured.is_some_and(|look| look.moving());
        if scene.world.unit.is_turning() {
            turned_until = Instant::now();
        }
        let stopped = scene.told(began, |event| matches!(event, Event::Stopped));
        assert!(
            stopped.is_none_or(|at| at > turned_until),
            "stopped while it turns\n{}",
            scene.report()
        );
    }
    let unproved = scene.told(began, |event| matches!(event, Event::StopNotConfirmed)).is_some();
    let is_told = if scene.world.make.doubts_flags {
        was_shown || unproved
    } else {
        unproved || scene.told(began, is_contradiction).is_some()
    };
    // A motion that ended early had no time to be reported.
    let had_time = turned_until >= began + Duration::from_millis(9900);
    let case = format!("{axis} {rate_deg_s} {pressed:?}");
    assert!(is_told || !had_time, "shown as standing: {case}\n{}", scene.report());
    if pressed.is_some() {
        scene.trouble(|line| line.ignores_stop = false);
        scene.seconds(8.0).await;
        assert!(!scene.world.unit.is_turning(), "still turns: {case}\n{}", scene.report());
    }
}

fn is_contradiction(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::FlagsContradict { .. }))
}

/// Max time until Azel stops a jog whose angles froze.
const JOG_ENDS_WITHIN: Duration = Duration::from_secs(6);
/// Max time until Azel stops a motion to a position whose angles froze.
const GO_TO_ENDS_WITHIN: Duration = Duration::from_secs(10);

fn is_without_effect(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::NoEffect { .. }))
}

async fn angles_freeze(mut dice: Dice) {
    let mut scene = scene(&mut dice, false).await;
    let axis = dice.below(2);
    let way = long_way(&scene, axis);
    let fastest_deg_s = scene.world.antenna.limits.maximum_rate_deg_s;
    let share = if scene.world.has_one_speed() { 1.0 } else { dice.between(0.3, 1.0) };
    let mut rates_deg_s = [0.0; 2];
    rates_deg_s[axis] = way * share * fastest_deg_s;
    scene.send(Command::Manual);
    scene.seconds(2.0).await;
    let began = Instant::now();
    // The angles freeze before the jog or in the middle of it.
    let freezes_at = began + Duration::try_from_secs_f64(dice.between(-1.0, 3.0).max(0.0)).unwrap();
    let mut frozen = None;
    while frozen.is_none_or(|at| Instant::now() < at + JOG_ENDS_WITHIN) {
        if frozen.is_none() && Instant::now() >= freezes_at {
            scene.world.unit.tell(Lie::FrozenAngles);
            frozen = Some(Instant::now());
        }
        scene.send(Command::Jog { rates_deg_s });
        scene.seconds(0.1).await;
    }
    let case = format!("{rates_deg_s:?} {:?}", freezes_at - began);
    let told = scene.told(began, is_without_effect).is_some();
    // A jog that a barrier or a limit ended also moves nothing.
    let is_refused = scene.told(began, |event| matches!(event, Event::NotSent(_))).is_some();
    assert!(told || is_refused, "not told: {case}\n{}", scene.report());
    scene.seconds(3.0).await;
    assert!(!scene.world.unit.is_turning(), "turns on: {case}\n{}", scene.report());
}

async fn angles_freeze_on_the_way(mut dice: Dice) {
    let mut scene = scene(&mut dice, false).await;
    let at = scene.world.direction();
    let azimuth = at.azimuth + Angle::from_degrees(dice.between(60.0, 120.0));
    scene.send(Command::Position { azimuth: Some(azimuth.wrapped_360()), elevation: None });
    let began = Instant::now();
    scene.seconds(dice.between(0.0, 6.0)).await;
    if scene.told(began, |event| matches!(event, Event::NotSent(_))).is_some() {
        return;
    }
    scene.world.unit.tell(Lie::FrozenAngles);
    let frozen = Instant::now();
    let mut was_stopped = false;
    while Instant::now() < frozen + GO_TO_ENDS_WITHIN {
        scene.seconds(0.1).await;
        was_stopped |= scene.told(frozen, is_without_effect).is_some();
    }
    let has_ended = |event: &Event| matches!(event, Event::Arrived(_) | Event::EndedShort { .. });
    let ended = scene.told(began, has_ended).is_some();
    assert!(was_stopped || ended, "{azimuth:?}\n{}", scene.report());
    scene.seconds(4.0).await;
    assert!(!scene.world.unit.is_turning(), "turns on: {azimuth:?}\n{}", scene.report());
}

/// Checks a pair of rotators with exchanged drives: a motion of one axis turns the other one.
async fn drives_are_crossed(mut dice: Dice) {
    let mut rig = rig::Rig::connected(&rig::pair(), Rotators::Pair).await;
    rig.control.set_fault(Fault::CrossedDrives, true);
    let asked_deg = [dice.between(0.0, 359.0), dice.between(20.0, 85.0)];
    let axes = dice.below(3);
    let [azimuth, elevation] = asked_deg.map(|deg| Some(Angle::from_degrees(deg)));
    let is_found = |event: &Event| {
        let told = matches!(event, Event::Safety(Safety::ForeignHands { .. }));
        told || is_without_effect(event) || matches!(event, Event::Refused(..) | Event::NotSent(_))
    };
    if dice.chance(0.5) {
        let azimuth = azimuth.filter(|_| axes != 1);
        let elevation = elevation.filter(|_| axes != 0);
        rig.send(Command::Position { azimuth, elevation });
        rig.until_event(GO_TO_ENDS_WITHIN.as_secs(), is_found).await;
    } else {
        let mut rates_deg_s = [0.0; 2];
        // The elevation jogs up from the horizon.
        rates_deg_s[usize::from(axes != 0)] = 5.0;
        rig.send(Command::Manual);
        let mut is_told = false;
        for _ in 0..JOG_ENDS_WITHIN.as_secs() * 10 {
            rig.send(Command::Jog { rates_deg_s });
            rig.seconds(0.1).await;
            is_told |= rig.events().iter().any(is_found);
        }
        assert!(is_told, "{rates_deg_s:?}");
    }
    rig.seconds(4.0).await;
    let rotators = rig.control.state().rotators;
    assert!(rotators.iter().all(|rotator| !rotator.is_turning), "{asked_deg:?} {rotators:?}");
}

#[test]
fn any_motion_that_turns_the_other_axis_is_stopped_and_reported() {
    for_each_case("drives are crossed", 50, drives_are_crossed);
}

#[test]
fn any_flags_that_lie_prove_no_standstill_and_are_told() {
    for_each_case("flags lie", 50, flags_lie);
}

#[test]
fn any_jog_without_effect_is_stopped_and_reported() {
    for_each_case("angles freeze", 50, angles_freeze);
}

#[test]
fn any_go_to_without_effect_is_stopped_and_reported() {
    for_each_case("angles freeze on the way", 50, angles_freeze_on_the_way);
}
