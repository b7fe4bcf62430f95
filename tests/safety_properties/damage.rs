//! Damaged or lost replies, at rates from one in a hundred to one in two.

use std::time::Duration;

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, LinkState},
};

use super::{
    cases::for_each_case,
    makes::{MAKES, Make},
    scene::Scene,
    unit::Word,
    world::{Wish, World},
};
use crate::common::dice::Dice;

/// Percentages of all replies that are damaged or lost.
const RATES: [u32; 6] = [1, 2, 5, 10, 20, 50];

/// Checks that the axes were at the shown position at some time since the question.
fn assert_true(scene: &Scene, case: &str) {
    let Some(look) = scene.shown().state.measured else { return };
    let age_s = (Instant::now() - look.requested).as_secs_f64();
    let World { unit, fastest_deg_s, coarse_deg, .. } = &scene.world;
    for (axis, true_deg) in look.axes.iter().zip(unit.axes_deg()) {
        let Some(shown_deg) = axis.angle_deg else { continue };
        let off_deg = (shown_deg - true_deg + 180.0).rem_euclid(360.0) - 180.0;
        let max_deg = fastest_deg_s * age_s + coarse_deg;
        assert!(off_deg.abs() <= max_deg, "{off_deg} off: {case}\n{}", scene.report());
    }
}

async fn watched(scene: &mut Scene, seconds: f64, case: &str) {
    let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
    while Instant::now() < end {
        scene.look().await;
        assert_true(scene, case);
    }
}

async fn damaged(mut dice: Dice, make: &Make, percent: u32) {
    let wish = Wish::default();
    let world = loop {
        let world = World::random(&mut dice, &wish);
        if world.make.name == make.name {
            break world;
        }
    };
    let case = format!("{percent} %");
    let mut scene = Scene::start(world, &mut dice).await;
    let share = f64::from(percent) / 200.0;
    scene.trouble(|line| (line.damaged, line.lost) = (share, share));
    let began = Instant::now();
    scene.send(Command::Position {
        azimuth: Some(Angle::from_degrees(dice.between(0.0, 360.0))),
        elevation: Some(Angle::from_degrees(dice.between(20.0, 80.0))),
    });
    watched(&mut scene, dice.between(1.0, 15.0), &case).await;
    let moved = |scene: &Scene| {
        let words = scene.world.words_since(began);
        words.iter().filter(|(_, word)| *word == Word::Motion).count()
    };
    assert!(moved(&scene) <= make.words_of_a_go_to, "sent again: {case}\n{}", scene.report());

    // Azel stops a moving antenna even on a bad line.
    scene.stop();
    let pressed = Instant::now();
    while scene.told(pressed, |event| matches!(event, Event::Stopped)).is_none() {
        watched(&mut scene, 0.2, &case).await;
        let waited = Instant::now() - pressed;
        assert!(waited < Duration::from_mins(1), "never proved: {case}\n{}", scene.report());
    }
    assert!(!scene.world.unit.is_turning(), "stopped while it turns: {case}\n{}", scene.report());
    assert!(moved(&scene) <= make.words_of_a_go_to, "sent after STOP: {case}\n{}", scene.report());

    // On a good line, Azel shows the link as up again, and nothing has begun to move.
    scene.trouble(|line| (line.damaged, line.lost) = (0.0, 0.0));
    watched(&mut scene, 15.0, &case).await;
    let shown = scene.shown();
    assert!(matches!(shown.link, LinkState::Up { .. }) && !shown.silent, "{}", scene.report());
    assert!(!scene.world.unit.is_turning(), "{case}\n{}", scene.report());
}

#[test]
fn any_rate_of_damage_becomes_no_position_no_motion_and_no_lost_stop() {
    for make in MAKES {
        for percent in RATES {
            let class = format!("{}, {percent} % damaged", make.name);
            for_each_case(&class, 4, |dice| damaged(dice, make, percent));
        }
    }
}
