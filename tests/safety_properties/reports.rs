//! Clocks, windows, elements, limits and settings that a unit reports wrong, with absurd figures.

use azel::contract::driver::Command;

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    line::Line,
    link_up::room_deg,
    scene::Scene,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

async fn reports(mut dice: Dice) {
    let wish = Wish {
        keep_outs: dice.below(3),
        // A unit that tracks uses its true values, not the reported ones.
        min_margin_deg: room_deg,
        overflight: Overhead::Satellite,
        make: dice.chance(0.7).then_some("Satrak"),
        ..Wish::default()
    };
    let world = World::random(&mut dice, &wish);
    let share = [0.05, 0.3, 1.0][dice.below(3)];
    let first = Line { falsified: share, ..Line::default() };
    let mut scene = Scene::begin(world, &mut dice, None, first);
    scene.seconds(dice.between(5.0, 40.0)).await;
    let mut judge = Judge::new(&scene, String::new());
    for _ in 0..2 {
        let deed = Deed::any(&mut dice, &scene.world);
        judge.case = format!("{} {deed:?} share {share}", scene.world.make.name);
        deed.begin(&mut scene, &mut judge).await;
        if scene.world.make.tracks_on_board && dice.chance(0.4) {
            let auto = [Command::AutoTrack(true), Command::TakeOver, Command::AutoTrack(false)];
            scene.send(auto[dice.below(3)].clone());
        }
        // Azel stops a track by the unit at the zone.
        judge.is_lost = matches!(deed, Deed::OnBoard);
        for _ in 0..10 {
            deed.go_on(&mut scene, &judge, dice.between(0.2, 3.0)).await;
            let zone_deg = scene.world.zone_clearance_deg();
            assert!(zone_deg >= 0.0, "{} inside a zone: {judge}\n{}", -zone_deg, scene.report());
        }
        deed.let_go(&scene);
        if dice.chance(0.5) {
            scene.trouble(|line| line.falsified = 0.0);
        }
    }
    judge.stop(&mut scene, 12.0).await;
}

#[test]
fn any_reports_of_a_unit_are_harmless() {
    for_each_case("reports are wrong", 40, reports);
}
