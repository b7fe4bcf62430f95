//! Link that ends before, in or after any write of the session, and comes back later.

use std::time::Duration;

use azel::{
    clock::Instant,
    contract::driver::{Command, Event},
};

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    line::Cut,
    scene::Scene,
    unit::Word,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Time in which Azel dials a new link, reads the unit and sends STOP until the antenna stands,
/// seconds.
const BACK_S: f64 = 22.0;
/// Outage after which Azel asks before it continues a track, seconds.
const ASKS_AFTER_S: f64 = 6.0;

fn cut(dice: &mut Dice) -> Cut {
    let at_order = dice.chance(0.6);
    let after = if at_order { dice.below(4) } else { dice.below(60) };
    let share = [0.0, dice.between(0.0, 1.0), 1.0][dice.below(3)];
    Cut { after, at_order, share }
}

async fn is_cut(mut dice: Dice) {
    let wish =
        Wish { keep_outs: dice.below(3), overflight: Overhead::Satellite, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let deed = Deed::any(&mut dice, &scene.world);
    if matches!(deed, Deed::OnBoard) {
        scene.until_placed().await;
    }
    let cut = cut(&mut dice);
    let (down_s, presses_stop) = (dice.between(0.0, 20.0), dice.chance(0.4));
    let make = scene.world.make;
    let case = format!("{} {deed:?} {cut:?} for {down_s} STOP {presses_stop}", make.name);
    let mut judge = Judge::new(&scene, case);
    let began = Instant::now();
    scene.trouble(|line| line.cut = Some(cut));
    deed.begin(&mut scene, &mut judge).await;
    let end = Instant::now() + Duration::from_secs(12);
    while !scene.was_cut() && Instant::now() < end {
        deed.go_on(&mut scene, &judge, 0.1).await;
    }
    if !scene.was_cut() {
        return judge.stop(&mut scene, 12.0).await;
    }
    scene.set_off(true);
    // Bytes before the cut may still be on their way.
    scene.look().await;
    let lost = Instant::now();
    // On a unit whose jogs run on, only STOP ends a jog.
    judge.is_lost = deed.is_jog();
    deed.go_on(&mut scene, &judge, down_s).await;
    if presses_stop {
        scene.stop();
        judge.forbid();
        scene.seconds(0.2).await;
    }
    let is_asked = deed.is_program() && down_s > ASKS_AFTER_S;
    let turned = scene.world.unit.is_turning();
    if deed.is_jog() || is_asked {
        judge.forbid();
    }
    scene.set_off(false);
    let back = Instant::now();
    deed.go_on(&mut scene, &judge, BACK_S).await;
    let words = scene.world.words_since(back);
    let first = words.iter().map(|(_, word)| *word).find(|word| *word != Word::Question);
    let runs_on = deed.is_jog() && make.jogs_run_on && turned;
    if presses_stop || runs_on {
        assert_eq!(first, Some(Word::Stop), "{judge}\n{words:?}\n{}", scene.report());
        assert!(!scene.world.unit.is_turning(), "still turns: {judge}\n{}", scene.report());
    }
    judge.hear(&scene);
    if matches!(deed, Deed::GoTo(..) | Deed::Park | Deed::OnBoard) {
        let words = scene.world.words_since(began);
        let moved = words.iter().filter(|(_, word)| *word == Word::Motion).count();
        // The way may have two legs, and a third from a place beside its corner.
        assert!(moved <= 3 * make.words_of_a_go_to, "{judge}\n{words:?}\n{}", scene.report());
    }
    if is_asked && !presses_stop && asks(&scene, lost) {
        judge.allow();
        scene.send(Command::Resume);
        deed.go_on(&mut scene, &judge, 3.0).await;
    }
    deed.let_go(&scene);
    judge.is_lost = false;
    if scene.world.margin_clearance_deg() < 0.0 {
        // Without a link, the jog ran on into the keep-out.
        judge.is_lost = true;
    }
    judge.stop(&mut scene, 12.0).await;
}

fn asks(scene: &Scene, since: Instant) -> bool {
    let is_question = |event: &Event| {
        matches!(event, Event::Safety(azel::contract::driver::Safety::AsksToResume { .. }))
    };
    scene.told(since, is_question).is_some()
}

#[test]
fn any_link_that_is_cut_at_any_byte_moves_nothing_by_itself_and_pays_its_stop() {
    for_each_case("links are cut", 60, is_cut);
}
