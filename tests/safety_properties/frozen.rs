//! Angles that freeze at a random moment of any motion.

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    scene::Scene,
    unit::Lie,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Returns the max time until a motion with frozen angles ends, seconds.
fn ends_within_s(deed: &Deed) -> u32 {
    match deed {
        Deed::Jog(_) => 6,
        Deed::GoTo(..) | Deed::Park => 10,
        // The target moves slowly near AOS and LOS.
        Deed::Point(..) | Deed::Follow | Deed::OnBoard => 120,
    }
}

/// Returns the lag of the shown angles behind the true ones, degrees.
fn behind_deg(scene: &Scene) -> f64 {
    let shown = scene.shown().state.measured;
    let axes = shown.into_iter().flat_map(|look| look.axes).zip(scene.world.unit.axes_deg());
    let off_deg = axes.filter_map(|(axis, true_deg)| {
        Some((axis.angle_deg? - true_deg + 180.0).rem_euclid(360.0) - 180.0)
    });
    off_deg.map(f64::abs).fold(0.0, f64::max)
}

/// Returns the lag below which frozen angles show nothing, degrees: the antenna may stand, or the
/// unit ignores the way.
fn hidden_deg(scene: &Scene) -> f64 {
    scene.world.make.ignores_deg.max(scene.world.coarse_deg)
}

async fn freezes(mut dice: Dice) {
    let wish =
        Wish { keep_outs: dice.below(3), overflight: Overhead::Satellite, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let deed = Deed::any(&mut dice, &scene.world);
    let before_s = dice.between(0.0, 20.0);
    let case = format!("{} {deed:?} freezes after {before_s}", scene.world.make.name);
    let mut judge = Judge::new(&scene, case);
    if matches!(deed, Deed::OnBoard) {
        scene.until_placed().await;
    }
    deed.begin(&mut scene, &mut judge).await;
    deed.go_on(&mut scene, &judge, before_s).await;
    scene.world.unit.tell(Lie::FrozenAngles);
    // Only a jog relies on the angles alone.
    judge.is_lost = deed.is_jog();
    let mut shows_s = 0.0;
    for _ in 0..ends_within_s(&deed) {
        deed.go_on(&mut scene, &judge, 1.0).await;
        let is_hidden = behind_deg(&scene) < hidden_deg(&scene);
        shows_s = if is_hidden { 0.0 } else { shows_s + 1.0 };
    }
    // A unit may begin late to turn to a position.
    let shows_within_s = if deed.is_jog() { 0.0 } else { 8.0 };
    for _ in 0..60 {
        deed.go_on(&mut scene, &judge, 0.05).await;
        let is_hidden = behind_deg(&scene) < hidden_deg(&scene);
        assert!(
            is_hidden || shows_s < shows_within_s || !scene.world.unit.is_turning(),
            "turns on: {judge}\n{}",
            scene.report()
        );
    }
    judge.end(&scene);
}

#[test]
fn any_motion_whose_angles_freeze_ends() {
    for_each_case("angles freeze at any moment", 40, freezes);
}
