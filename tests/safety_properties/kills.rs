//! Sessions that are killed at any moment, and new sessions that find their marks and the unit.

use std::time::Duration;

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Safety},
};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    line::Line,
    scene::Scene,
    unit::Word,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Max time until a pressed and unproved STOP is on disk.
const ON_DISK: Duration = Duration::from_millis(600);

async fn is_killed(mut dice: Dice) {
    let folder = tempfile::tempdir().unwrap();
    let wish =
        Wish { keep_outs: dice.below(3), overflight: Overhead::Satellite, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let marks = Some(folder.path().to_owned());
    let mut scene = Scene::begin(world, &mut dice, marks, Line::default());
    scene.until_read().await;
    let make = scene.world.make;
    let mut judge = Judge::new(&scene, String::new());
    for _ in 0..=dice.below(3) {
        let deed = Deed::any(&mut dice, &scene.world);
        if matches!(deed, Deed::OnBoard) {
            scene.until_placed().await;
        }
        let (before_s, down_s) = (dice.between(0.0, 8.0), dice.between(0.6, 20.0));
        // If the unit ignores STOP, Azel owes it when the session is killed.
        let owes = dice.chance(0.4);
        judge.case =
            format!("{} {deed:?} killed after {before_s} for {down_s} owes {owes}", make.name);
        deed.begin(&mut scene, &mut judge).await;
        deed.go_on(&mut scene, &judge, before_s).await;
        let was_held = deed.is_jog() && scene.shown().jog.is_some();
        if owes {
            scene.trouble(|line| line.ignores_stop = true);
            // Only STOP ends a jog whose last bytes are lost.
            judge.is_lost = deed.is_jog();
            scene.stop();
            scene.seconds(ON_DISK.as_secs_f64() + dice.between(0.0, 1.0)).await;
        }
        let is_owed = owes && scene.shown().runs_out;
        // At the end of its travel, the axis stands without STOP.
        let runs_on = was_held && make.jogs_run_on && scene.world.unit.is_turning();
        judge.is_lost = deed.is_jog() || judge.is_lost;
        judge.forbid();
        scene.kill().await;
        let killed = Instant::now();
        while Instant::now() < killed + Duration::try_from_secs_f64(down_s).unwrap() {
            scene.look().await;
        }
        scene.trouble(|line| line.ignores_stop = false);
        scene.restart();
        let begun = Instant::now();
        scene.seconds(12.0).await;
        let words = scene.world.words_since(begun);
        let first = words.iter().map(|(_, word)| *word).find(|word| *word != Word::Question);
        let is_marked = is_owed || runs_on;
        if is_marked && !make.waits_for_word {
            assert_eq!(first, Some(Word::Stop), "{judge}\n{words:?}\n{}", scene.report());
            assert!(!scene.world.unit.is_turning(), "still turns: {judge}\n{}", scene.report());
        }
        if is_marked && make.waits_for_word {
            let is_question = |event: &Event| {
                matches!(event, Event::Safety(Safety::LeftMoving { asks: true, .. }))
            };
            let asked = scene.told(begun, is_question);
            assert!(asked.is_some(), "not asked: {judge}\n{}", scene.report());
        }
        judge.hear(&scene);
        scene.send(Command::SeenStanding);
        judge.is_lost = scene.world.margin_clearance_deg() < 0.0;
        judge.stop(&mut scene, 12.0).await;
        judge.is_lost = false;
        if scene.world.margin_clearance_deg() < 0.0 {
            return;
        }
    }
}

#[test]
fn any_session_that_is_killed_leaves_its_stop_to_the_next_which_moves_nothing_by_itself() {
    for_each_case("sessions are killed", 25, is_killed);
}
