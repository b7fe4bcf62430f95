//! Folder of marks that cannot be written, from the start or from a random moment on.

use std::{fs, path::Path};

use azel::contract::driver::{Command, Event, Safety};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    line::Line,
    scene::Scene,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Puts a file in the place of the folder, so that every write fails.
fn fill(folder: &Path) {
    drop(fs::remove_dir_all(folder));
    fs::write(folder, "").unwrap();
}

fn make_room(folder: &Path) {
    fs::remove_file(folder).unwrap();
    fs::create_dir(folder).unwrap();
}

async fn is_full(mut dice: Dice) {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("marks");
    fs::create_dir(&folder).unwrap();
    let wish =
        Wish { keep_outs: dice.below(3), overflight: Overhead::Satellite, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let at_the_start = dice.chance(0.5);
    if at_the_start {
        fill(&folder);
    }
    let mut scene = Scene::begin(world, &mut dice, Some(folder.clone()), Line::default());
    scene.until_read().await;
    if !at_the_start {
        fill(&folder);
    }
    // An unreadable mark counts as a mark of unknown age.
    scene.send(Command::SeenStanding);
    scene.seconds(0.5).await;
    let mut judge = Judge::new(&scene, String::new());
    for _ in 0..2 {
        let deed = Deed::any(&mut dice, &scene.world);
        if matches!(deed, Deed::OnBoard) {
            scene.until_placed().await;
        }
        let (seconds, frees) = (dice.between(0.5, 10.0), dice.chance(0.2));
        let name = scene.world.make.name;
        judge.case = format!("{name} {deed:?} at the start {at_the_start} frees {frees}");
        let asked = azel::clock::Instant::now();
        deed.begin(&mut scene, &mut judge).await;
        deed.go_on(&mut scene, &judge, 1.2).await;
        if deed.is_jog() {
            let is_refused = |event: &Event| {
                matches!(event, Event::NotSent(_) | Event::Safety(Safety::Forbidden { .. }))
            };
            let is_answered =
                scene.shown().jog.is_some() || scene.told(asked, is_refused).is_some();
            assert!(is_answered, "the jog is held up: {judge}\n{}", scene.report());
        }
        deed.go_on(&mut scene, &judge, seconds).await;
        if frees {
            make_room(&folder);
        }
        if dice.chance(0.3) {
            scene.set_off(true);
            judge.is_lost = deed.is_jog();
            deed.go_on(&mut scene, &judge, 3.0).await;
            scene.set_off(false);
            deed.go_on(&mut scene, &judge, 10.0).await;
        }
        deed.let_go(&scene);
        judge.is_lost |= scene.world.margin_clearance_deg() < 0.0;
        judge.stop(&mut scene, 12.0).await;
        if frees {
            fill(&folder);
        }
        if judge.is_lost {
            return;
        }
    }
}

#[test]
fn any_full_disk_holds_up_no_motion_and_no_stop() {
    for_each_case("the disk is full", 25, is_full);
}
