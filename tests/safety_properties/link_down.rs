//! Links that fail during a motion, and STOPs that the unit ignores.

use std::time::Duration;

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Event, LinkState, Safety},
};

use super::{
    cases::for_each_case,
    scene::Scene,
    unit::Word,
    world::{Wish, World},
};
use crate::common::dice::Dice;

/// Failure of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Failure {
    /// Closed link, without an answer for a while.
    Lost,
    /// Lost commands, and so no replies.
    HalfOpen,
    /// Lost replies to commands that the unit carries out.
    Mute,
    /// Open link that carries nothing either way.
    Stalled,
    /// Open link that carries everything but STOP.
    IgnoresStop,
}

impl Failure {
    fn set(self, scene: &Scene, is_on: bool) {
        match self {
            Self::Lost => scene.set_off(is_on),
            Self::HalfOpen => scene.trouble(|line| line.is_deaf = is_on),
            Self::Mute => scene.trouble(|line| line.is_mute = is_on),
            Self::Stalled => {
                scene.trouble(|line| (line.is_deaf, line.is_mute) = (is_on, is_on));
            }
            Self::IgnoresStop => scene.trouble(|line| line.ignores_stop = is_on),
        }
    }
}

fn is_silent(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::SilentInMotion))
}

/// Returns `true` if the event reports that the unit may not have obeyed a STOP.
fn is_alarm(event: &Event) -> bool {
    matches!(
        event,
        Event::StopNotConfirmed
            | Event::StopRefused(_)
            | Event::Safety(Safety::FlagsContradict { .. })
    )
}

/// Time after which a reply is missing. It includes the characters of a reply at the line speed of
/// an RC2000C.
const MISSING: Duration = Duration::from_millis(760);
/// Max time from the first missing reply to the warning of the operator.
const ALARM: Duration = Duration::from_secs(1);
/// Time for which a jog of an RC2000C runs on at its rate: the last renewal, one more if
/// commands still get through, and the overrun.
const RUNS_ON_S: f64 = 2.0;
/// Max time until Azel repeats an unproved STOP.
const AGAIN: Duration = Duration::from_millis(1500);

async fn fails(mut dice: Dice) {
    let keep_outs = dice.below(3);
    let wish = Wish { keep_outs, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let is_jog = dice.chance(0.6);
    let failure =
        [Failure::Lost, Failure::HalfOpen, Failure::Mute, Failure::Stalled, Failure::IgnoresStop]
            [dice.below(5)];
    let axis = dice.below(2);
    let rate_deg_s = scene.world.antenna.limits.maximum_rate_deg_s * dice.between(0.3, 1.0);
    let mut rates_deg_s = [0.0; 2];
    rates_deg_s[axis] = if dice.chance(0.5) { rate_deg_s } else { -rate_deg_s };
    let before_s = dice.between(0.5, 2.5);
    let down_s = dice.between(3.0, 12.0);
    let case = format!("{failure:?} {is_jog} {rates_deg_s:?} after {before_s} for {down_s}");
    if is_jog {
        scene.send(Command::Manual);
        scene.seconds(2.0).await;
        hold(&mut scene, rates_deg_s, before_s).await;
    } else {
        let elevation_deg = dice.between(20.0, 80.0);
        scene.send(Command::Position {
            azimuth: Some(Angle::from_degrees(dice.between(0.0, 360.0))),
            elevation: Some(Angle::from_degrees(elevation_deg)),
        });
        scene.seconds(before_s).await;
    }
    if !scene.world.unit.is_turning() {
        return;
    }
    // The session has just stopped an axis at the end of its travel.
    if is_jog && scene.shown().jog.is_none() {
        return;
    }
    failure.set(&scene, true);
    let failed = Instant::now();
    let from_deg = scene.world.unit.axes_deg();
    let poll = scene.world.antenna.poll.period(true);
    if failure == Failure::IgnoresStop {
        return ignores_stop(&mut scene, &case).await;
    }
    let mut was_shown = false;
    while Instant::now() < failed + Duration::try_from_secs_f64(down_s).unwrap() {
        if is_jog {
            scene.send(Command::Jog { rates_deg_s });
        }
        scene.seconds(0.1).await;
        was_shown |= Instant::now() <= failed + poll * 3 + ALARM
            && !matches!(scene.shown().link, LinkState::Up { .. });
        // Azel judged the way of a motion to a position before the motion began.
        if !is_jog {
            let zone_deg = scene.world.zone_clearance_deg();
            assert!(zone_deg >= 0.0, "{} inside a zone: {case}\n{}", -zone_deg, scene.report());
        }
    }
    scene.send(Command::EndJog);
    assert!(was_shown, "shown as up: {case}\n{}", scene.report());
    // Azel asked for the first missing reply within a poll period.
    let last = failed + poll + MISSING + ALARM + Duration::from_millis(100);
    let told = scene.told(failed, is_silent);
    assert!(
        told.is_some_and(|at| at <= last),
        "told after {:?}: {case}\n{}",
        told.map(|at| at - failed),
        scene.report()
    );
    assert_eq!(scene.count(failed, is_silent), 1, "told again: {case}\n{}", scene.report());
    assert!(scene.shown().silent, "{case}\n{}", scene.report());
    let ends_by_itself = !scene.world.make.jogs_run_on || !is_jog;
    if is_jog && !scene.world.make.jogs_run_on {
        let turned_deg = (scene.world.unit.axes_deg()[axis] - from_deg[axis]).abs();
        let max_deg = scene.world.fastest_deg_s * RUNS_ON_S;
        assert!(turned_deg <= max_deg, "ran on by {turned_deg}: {case}\n{}", scene.report());
        assert!(!scene.world.unit.is_turning(), "runs on: {case}\n{}", scene.report());
    }
    let back = Instant::now();
    failure.set(&scene, false);
    scene.seconds(AGAIN.as_secs_f64()).await;
    let turned_on = scene.world.unit.is_turning();
    scene.seconds(10.5).await;
    assert!(!scene.shown().silent, "still silent: {case}\n{}", scene.report());
    let words = scene.world.words_since(back);
    if !ends_by_itself && failure != Failure::Mute {
        // On a link that heals, only questions may precede the STOP; on a new link, nothing may.
        // For an antenna at the end of its travel, looks alone prove standstill.
        let first = words.iter().find(|(_, word)| *word != Word::Question);
        let is_soon = first.map_or(!turned_on, |(at, word)| {
            let in_time = !turned_on || failure == Failure::Lost || *at <= back + AGAIN;
            *word == Word::Stop && in_time
        });
        assert!(is_soon, "{case}\n{words:?}\n{}", scene.report());
        let dialled = scene.last_dial().filter(|dialled| *dialled >= back);
        let first = dialled.and_then(|dialled| words.iter().find(|(at, _)| *at >= dialled));
        assert!(
            first.is_none_or(|(_, word)| *word == Word::Stop),
            "{case}\n{words:?}\n{}",
            scene.report()
        );
    }
    if !ends_by_itself {
        assert!(!scene.world.unit.is_turning(), "still turns: {case}\n{}", scene.report());
    }
}

/// Checks a STOP that the unit ignores while everything else works.
async fn ignores_stop(scene: &mut Scene, case: &str) {
    let pressed = Instant::now();
    scene.stop();
    let mut was_turning = pressed;
    while Instant::now() < pressed + Duration::from_secs(6) {
        scene.look().await;
        if scene.world.unit.is_turning() {
            was_turning = Instant::now();
        }
        let stopped = scene.told(pressed, |event| matches!(event, Event::Stopped));
        let turned_at = was_turning;
        assert!(
            stopped.is_none_or(|at| at > turned_at),
            "stopped while it turns: {case}\n{}",
            scene.report()
        );
    }
    // Azel reports a standstill as unproved if its proof takes longer than three seconds.
    if was_turning >= pressed + Duration::from_millis(4500) {
        let told = scene.told(pressed, is_alarm);
        assert!(told.is_some(), "not told: {case}\n{}", scene.report());
    }
    scene.trouble(|line| line.ignores_stop = false);
    scene.seconds(8.0).await;
    assert!(!scene.world.unit.is_turning(), "still turns: {case}\n{}", scene.report());
    let stopped = scene.told(pressed, |event| matches!(event, Event::Stopped));
    assert!(stopped.is_some(), "not proved: {case}\n{}", scene.report());
}

async fn hold(scene: &mut Scene, rates_deg_s: [f64; 2], seconds: f64) {
    let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
    while Instant::now() < end {
        scene.send(Command::Jog { rates_deg_s });
        scene.seconds(0.1).await;
    }
}

/// Checks that late replies and a single lost reply are no silence.
async fn answers_late(mut dice: Dice) {
    let wish = Wish::default();
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let late_ms = dice.between(0.0, 400.0);
    scene.trouble(|line| line.late_ms = late_ms);
    let began = Instant::now();
    for _ in 0..3 {
        if dice.chance(0.5) {
            scene.send(Command::Manual);
            scene.seconds(2.0).await;
            let rate_deg_s = scene.world.antenna.limits.maximum_rate_deg_s;
            let mut rates_deg_s = [0.0; 2];
            rates_deg_s[dice.below(2)] = if dice.chance(0.5) { rate_deg_s } else { -rate_deg_s };
            hold(&mut scene, rates_deg_s, dice.between(0.5, 3.0)).await;
            scene.send(Command::EndJog);
        } else {
            scene.send(Command::Position {
                azimuth: Some(Angle::from_degrees(dice.between(0.0, 360.0))),
                elevation: Some(Angle::from_degrees(dice.between(20.0, 80.0))),
            });
        }
        scene.seconds(dice.between(0.0, 2.0)).await;
        scene.trouble(|line| line.loses_next = true);
        scene.seconds(5.0).await;
    }
    let told = scene.told(began, is_silent);
    assert!(told.is_none(), "{late_ms} ms\n{}", scene.report());
}

#[test]
fn any_replies_that_are_late_or_lost_once_are_no_silence() {
    for_each_case("replies late", 60, answers_late);
}

#[test]
fn any_failure_of_the_link_is_told_and_stopped() {
    for_each_case("link down", 80, fails);
}
