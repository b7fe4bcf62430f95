//! Steps of the computer's clock, by up to a year, at any moment of any motion.

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Safety},
};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    scene::Scene,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

const YEAR_S: f64 = 366.0 * 86_400.0;

/// Draws a step from a second to a year, of either sign, seconds.
fn any_step_s(dice: &mut Dice) -> i64 {
    let size_s = YEAR_S.powf(dice.between(0.0, 1.0)).round() as i64;
    if dice.chance(0.5) { size_s } else { -size_s }
}

async fn is_stepped(mut dice: Dice) {
    let wish = Wish {
        keep_outs: dice.below(3),
        overflight: Overhead::Satellite,
        has_sun: true,
        ..Wish::default()
    };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let deed = Deed::any(&mut dice, &scene.world);
    if matches!(deed, Deed::OnBoard) {
        scene.until_placed().await;
    }
    let (before_s, step_s) = (dice.between(0.0, 15.0), any_step_s(&mut dice));
    let case = format!("{} {deed:?} after {before_s} by {step_s}", scene.world.make.name);
    let mut judge = Judge::new(&scene, case);
    deed.begin(&mut scene, &mut judge).await;
    deed.go_on(&mut scene, &judge, before_s).await;
    let followed = scene.shown().program_track.is_some();
    scene.clock.set(step_s);
    let stepped = Instant::now();
    if deed.is_program() {
        judge.forbid();
    }
    deed.go_on(&mut scene, &judge, 1.0).await;
    let is_step = |event: &Event| matches!(event, Event::Safety(Safety::ClockStepped { .. }));
    assert!(scene.told(stepped, is_step).is_some(), "not told: {judge}\n{}", scene.report());
    // The clock steps once more while Azel asks the operator.
    if dice.chance(0.3) {
        scene.clock.set(step_s + any_step_s(&mut dice));
    }
    deed.go_on(&mut scene, &judge, dice.between(5.0, 25.0)).await;
    judge.hear(&scene);
    if deed.is_program() && followed {
        assert!(!scene.world.unit.is_turning(), "goes on: {judge}\n{}", scene.report());
        judge.allow();
        scene.send(Command::Resume);
        deed.go_on(&mut scene, &judge, 5.0).await;
    }
    deed.let_go(&scene);
    judge.stop(&mut scene, 12.0).await;
}

#[test]
fn any_clock_step_ends_what_azel_follows_with_and_moves_nothing_by_itself() {
    for_each_case("the clock is set", 60, is_stepped);
}
