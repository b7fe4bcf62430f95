//! An axis without an angle, at the start or from a random moment on.

use azel::{
    astro::{Angle, AzEl},
    clock::Instant,
    contract::driver::{Command, Event},
};

use super::{
    cases::for_each_case,
    deeds::{Deed, rates_into_a_zone},
    judge::Judge,
    line::Line,
    scene::Scene,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

async fn loses_an_angle(mut dice: Dice) {
    let keep_outs = 2 + dice.below(4);
    let overflight = if dice.chance(0.3) { Overhead::Satellite } else { Overhead::Nothing };
    let wish = Wish { keep_outs, overflight, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut blank = [false; 2];
    blank[dice.below(2)] = true;
    if dice.chance(0.15) {
        blank = [true; 2];
    }
    let blank_text = dice.below(60);
    let from_the_start = dice.chance(0.5);
    let first = Line {
        blank: if from_the_start { blank } else { [false; 2] },
        blank_text,
        ..Line::default()
    };
    let mut scene = Scene::begin(world, &mut dice, None, first);
    if from_the_start {
        scene.seconds(5.0).await;
    } else {
        scene.until_read().await;
    }
    let mut judge = Judge::new(&scene, String::new());
    for _ in 0..2 {
        let deed = if dice.chance(0.6) {
            Deed::Jog(rates_into_a_zone(&mut dice, &scene.world))
        } else {
            Deed::any(&mut dice, &scene.world)
        };
        let (before_s, blank_s) = (dice.between(0.0, 6.0), dice.between(0.5, 30.0));
        judge.case = format!(
            "{} {blank:?} text {blank_text} at the start {from_the_start}, after {before_s} for {blank_s}: {deed:?}",
            scene.world.make.name
        );
        deed.begin(&mut scene, &mut judge).await;
        deed.go_on(&mut scene, &judge, before_s).await;
        scene.trouble(|line| (line.blank, line.blank_text) = (blank, blank_text));
        deed.go_on(&mut scene, &judge, blank_s).await;
        if dice.chance(0.5) {
            scene.trouble(|line| line.blank = [false; 2]);
        }
        deed.go_on(&mut scene, &judge, dice.between(0.0, 5.0)).await;
        deed.let_go(&scene);
    }
    scene.trouble(|line| line.blank = [false; 2]);
    judge.stop(&mut scene, 12.0).await;
}

#[test]
fn any_axis_without_an_angle_enters_no_keep_out() {
    for_each_case("an angle is missing", 10, loses_an_angle);
}

/// Checks an elevation that goes missing on a short way: Azel must not report an arrival.
async fn loses_its_elevation_on_the_way(mut dice: Dice) {
    let mut scene = Scene::start(World::random(&mut dice, &Wish::default()), &mut dice).await;
    let AzEl { azimuth, elevation } = scene.world.direction();
    let azimuth = (azimuth + Angle::from_degrees(dice.between(3.0, 6.0))).wrapped_360();
    scene.send(Command::Position { azimuth: Some(azimuth), elevation: Some(elevation) });
    scene.seconds(0.5).await;
    scene.trouble(|line| line.blank = [false, true]);
    // Azel keeps the last value of a missing angle for a moment.
    scene.seconds(1.7).await;
    let missing = Instant::now();
    scene.seconds(60.0).await;
    let arrived = scene.told(missing, |event| matches!(event, Event::Arrived(_))).is_some();
    let has_elevation = scene.world.antenna.connection.variant().capabilities.has_elevation();
    assert!(!arrived || !has_elevation, "{}\n{}", scene.world.make.name, scene.report());
}

#[test]
fn a_go_to_without_an_elevation_is_not_said_to_arrive() {
    for_each_case("the elevation is missing", 10, loses_its_elevation_on_the_way);
}

/// Checks STOP without any angle. The scene measures every turn of the session, because one thread
/// serves all antennas of a station.
async fn loses_both_angles(mut dice: Dice) {
    let world = World::random(&mut dice, &Wish { keep_outs: 5, ..Wish::default() });
    let first = Line { blank: [true; 2], ..Line::default() };
    let mut scene = Scene::begin(world, &mut dice, None, first);
    scene.seconds(5.0).await;
    let mut judge = Judge::new(&scene, scene.world.make.name.to_owned());
    judge.stop(&mut scene, 5.0).await;
}

#[test]
fn a_unit_without_angles_holds_up_no_other_antenna() {
    for_each_case("both angles are missing", 5, loses_both_angles);
}
