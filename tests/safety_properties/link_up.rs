//! Sessions over a good link: the unit obeys STOP, and its angles are true.

use std::time::Duration;

use azel::{
    astro::{Angle, AzEl},
    clock::Instant,
    contract::driver::Command,
    plan::{ProgramTrack, Target},
};

use super::{
    cases::for_each_case,
    scene::Scene,
    world::{Wish, World},
};
use crate::common::dice::Dice;

/// Next act of the operator.
#[derive(Debug)]
enum Deed {
    Hold { rates_deg_s: [f64; 2], seconds: f64 },
    Step([f64; 2]),
    GoTo(f64, f64),
    Follow(f64, f64),
    Stop,
    Standby,
    Hands,
    Stay,
    Park,
}

fn deed(dice: &mut Dice, world: &World) -> Deed {
    let rate_deg_s = world.antenna.limits.maximum_rate_deg_s;
    let both = |dice: &mut Dice, most: f64| [(); 2].map(|()| dice.between(-most, most));
    let direction = |dice: &mut Dice| (dice.between(0.0, 360.0), dice.between(0.0, 90.0));
    match dice.below(14) {
        0..5 => {
            let mut rates_deg_s = both(dice, rate_deg_s);
            let takes_one = world.antenna.connection.variant().capabilities.jogs_one_axis;
            if takes_one || dice.chance(0.5) {
                rates_deg_s[dice.below(2)] = 0.0;
            }
            Deed::Hold { rates_deg_s, seconds: dice.between(0.2, 8.0) }
        }
        5 => Deed::Step(both(dice, world.antenna.limits.maximum_step_deg)),
        6..9 => {
            let (azimuth_deg, elevation_deg) = direction(dice);
            Deed::GoTo(azimuth_deg, elevation_deg)
        }
        9 => {
            let (azimuth_deg, elevation_deg) = direction(dice);
            Deed::Follow(azimuth_deg, elevation_deg)
        }
        10 => Deed::Stop,
        11 => Deed::Standby,
        12 => Deed::Hands,
        _ if dice.chance(0.5) => Deed::Stay,
        _ => Deed::Park,
    }
}

fn assert_outside(scene: &Scene, deeds: &[Deed]) {
    let World { coarse_deg, .. } = scene.world;
    let zone_deg = scene.world.zone_clearance_deg();
    assert!(zone_deg >= 0.0, "{} inside a zone\n{deeds:?}\n{}", -zone_deg, scene.report());
    let beyond_deg = scene.world.beyond_travel_deg();
    assert!(
        beyond_deg <= coarse_deg,
        "{beyond_deg} beyond the travel\n{deeds:?}\n{}",
        scene.report()
    );
    let floor_deg = scene.world.floor_clearance_deg();
    assert!(
        floor_deg >= -coarse_deg,
        "{} below the floor\n{deeds:?}\n{}",
        -floor_deg,
        scene.report()
    );
    // The only margin of the Sun is its own radius.
    let sun_deg = scene.sun_clearance_deg();
    assert!(sun_deg > -2.0 * coarse_deg, "{sun_deg} from the Sun\n{deeds:?}\n{}", scene.report());
}

async fn watched(scene: &mut Scene, seconds: f64, deeds: &[Deed]) {
    let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
    while Instant::now() < end {
        scene.look().await;
        assert_outside(scene, deeds);
    }
}

async fn carry_out(scene: &mut Scene, dice: &mut Dice, deeds: &[Deed]) {
    let position = |azimuth_deg, elevation_deg| Command::Position {
        azimuth: Some(Angle::from_degrees(azimuth_deg)),
        elevation: Some(Angle::from_degrees(elevation_deg)),
    };
    let mut seconds = dice.between(0.1, 9.0);
    match *deeds.last().unwrap() {
        Deed::Hold { rates_deg_s, seconds: held_s } => {
            scene.send(Command::Manual);
            let end = Instant::now() + Duration::try_from_secs_f64(held_s).unwrap();
            while Instant::now() < end {
                scene.send(Command::Jog { rates_deg_s });
                watched(scene, 0.1, deeds).await;
            }
            scene.send(Command::EndJog);
            seconds = dice.between(0.0, 2.0);
        }
        Deed::Step(steps_deg) => {
            scene.send(Command::Manual);
            watched(scene, 1.5, deeds).await;
            scene.send(Command::Step { steps_deg });
        }
        Deed::GoTo(azimuth_deg, elevation_deg) => scene.send(position(azimuth_deg, elevation_deg)),
        Deed::Follow(azimuth_deg, elevation_deg) => {
            let target = Target::Fixed(AzEl::from_degrees(azimuth_deg, elevation_deg));
            let site = scene.world.station.site;
            scene.send(Command::ProgramTrack(Box::new(ProgramTrack::new(
                target,
                site,
                Vec::new(),
            ))));
        }
        Deed::Stop => scene.stop(),
        Deed::Standby => scene.send(Command::Standby),
        Deed::Hands => scene.send(Command::Manual),
        Deed::Stay => scene.send(Command::Hold),
        Deed::Park => scene.send(Command::Park),
    }
    watched(scene, seconds, deeds).await;
}

async fn drives(mut dice: Dice) {
    let keep_outs = dice.below(4);
    let wish = Wish { keep_outs, has_sun: true, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let mut deeds = Vec::new();
    for _ in 0..3 + dice.below(4) {
        if dice.chance(0.5) {
            let late_ms = if dice.chance(0.5) { dice.between(0.0, 400.0) } else { 0.0 };
            let [lost, doubled, damaged] =
                [(); 3].map(|()| if dice.chance(0.5) { dice.between(0.0, 0.3) } else { 0.0 });
            let is_split = dice.chance(0.3);
            scene.trouble(|line| {
                line.late_ms = late_ms;
                (line.lost, line.doubled, line.damaged) = (lost, doubled, damaged);
                line.is_split = is_split;
            });
        }
        deeds.push(deed(&mut dice, &scene.world));
        carry_out(&mut scene, &mut dice, &deeds).await;
    }
    scene.stop();
    watched(&mut scene, 4.0, &deeds).await;
}

/// Returns the max turn of a motion by others from the last look before it to standstill, degrees.
pub(super) fn room_deg(world: &World) -> f64 {
    const POLL_AND_REPLY_S: f64 = 0.6;
    const RUN_OUT_S: f64 = 1.0;
    world.fastest_deg_s * (POLL_AND_REPLY_S + RUN_OUT_S) + world.coarse_deg
}

async fn others_move(mut dice: Dice) {
    let keep_outs = 1 + dice.below(3);
    let wish = Wish { keep_outs, min_margin_deg: room_deg, others_jog: true, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    for _ in 0..2 {
        let axis = dice.below(2);
        let way = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let rate_deg_s = way * dice.between(0.3, scene.world.fastest_deg_s);
        scene.world.other_client_turns(axis, rate_deg_s).await;
        let end = Instant::now() + Duration::from_secs(40);
        while Instant::now() < end {
            scene.look().await;
            let zone_deg = scene.world.zone_clearance_deg();
            assert!(zone_deg >= 0.0, "{} inside a zone\n{}", -zone_deg, scene.report());
        }
        scene.stop();
        scene.seconds(4.0).await;
    }
}

/// Width below which a gap is no way out, degrees.
const GAP_DEG: f64 = 1.0;

/// Returns the degrees by which an axis turns one way until the true direction is free, searched in
/// small steps. `None` if the floor, the end of the travel or another zone comes first, or follows
/// within `gap_deg`.
fn turn_out_deg(
    scene: &Scene,
    axes_deg: [f64; 2],
    (axis, way): (usize, f64),
    gap_deg: f64,
) -> Option<f64> {
    const STEP_DEG: f64 = 0.02;
    let World { bounds, antenna, utc_origin, .. } = &scene.world;
    let clear_deg = |axes_deg| {
        let clearances = bounds.at_time(*utc_origin).clearances(bounds.direction(axes_deg));
        clearances.into_iter().map(|it| it.angle.degrees()).collect::<Vec<_>>()
    };
    let before_deg = clear_deg(axes_deg);
    let (from_deg, to_deg) = antenna.mount.travel_deg()[axis];
    for step in 0_u32..20_000 {
        let turn_deg = f64::from(step) * STEP_DEG;
        let mut there_deg = axes_deg;
        there_deg[axis] += way * turn_deg;
        let here_deg = clear_deg(there_deg);
        let enters = before_deg.iter().zip(&here_deg).any(|(a, b)| *a >= 0.0 && *b < 0.0);
        if enters || !(from_deg..=to_deg).contains(&there_deg[axis]) {
            return None;
        }
        if here_deg.iter().all(|clear_deg| *clear_deg >= 0.0) {
            // Azel refuses a narrow gap, because it judges jogs ahead.
            there_deg[axis] += way * gap_deg;
            let is_wide = clear_deg(there_deg).iter().all(|clear_deg| *clear_deg >= 0.0)
                && (from_deg..=to_deg).contains(&there_deg[axis]);
            return (is_wide || step == 0).then_some(turn_deg);
        }
    }
    None
}

/// Returns the distance in the sky to the nearest permitted direction by the shortest turn of one
/// axis, degrees, with that axis and its direction.
fn way_out(scene: &Scene, axes_deg: [f64; 2], gap_deg: f64) -> Option<(f64, usize, f64)> {
    let bounds = &scene.world.bounds;
    let ways = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
    let lengths = ways.into_iter().filter_map(|(axis, way)| {
        let turn_deg = turn_out_deg(scene, axes_deg, (axis, way), gap_deg)?;
        let mut on_deg = axes_deg;
        on_deg[axis] += 0.01;
        let moved = bounds.direction(axes_deg).separation(bounds.direction(on_deg));
        Some((turn_deg * moved.degrees() / 0.01, axis, way))
    });
    lengths.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns `true` if a jog along the shortest way is free as far as Azel judges it ahead. For a
/// unit with one speed, this stretch may reach beyond the far side of the zone.
fn is_way_wide(scene: &Scene, (_, axis, way): (f64, usize, f64), rate_deg_s: f64) -> bool {
    /// Time that exceeds Azel's judgement of a jog ahead, seconds.
    const AHEAD_S: f64 = 2.5;
    let World { bounds, antenna, utc_origin, unit, .. } = &scene.world;
    let has_one_speed = scene.world.has_one_speed();
    let fastest_deg_s = antenna.limits.maximum_rate_deg_s;
    let ahead_deg = if has_one_speed { fastest_deg_s } else { rate_deg_s } * AHEAD_S;
    let at_deg = unit.axes_deg();
    let Some(turn_deg) = turn_out_deg(scene, at_deg, (axis, way), GAP_DEG) else { return false };
    let (from_deg, to_deg) = antenna.mount.travel_deg()[axis];
    (1..=10).map(|part| ahead_deg * f64::from(part) / 10.0).all(|ahead_deg| {
        let mut axes_deg = at_deg;
        axes_deg[axis] += way * ahead_deg;
        let nearest = bounds.at_time(*utc_origin).nearest(bounds.direction(axes_deg));
        let is_free = nearest.is_none_or(|nearest| nearest.angle.degrees() >= 0.0);
        (from_deg..=to_deg).contains(&axes_deg[axis]) && (ahead_deg < turn_deg || is_free)
    })
}

async fn starts_inside(mut dice: Dice) {
    let keep_outs = 1 + dice.below(2);
    let wish = Wish { keep_outs, starts_inside: true, ..Wish::default() };
    let world = World::random(&mut dice, &wish);
    let mut scene = Scene::start(world, &mut dice).await;
    let slow_deg_s = scene.world.antenna.limits.maximum_rate_deg_s * 0.24;
    let out = way_out(&scene, scene.world.unit.axes_deg(), GAP_DEG);
    let is_open = out.is_some_and(|out| is_way_wide(&scene, out, slow_deg_s));
    let mut ways_out = 0;
    scene.send(Command::Manual);
    scene.seconds(2.0).await;
    for axis in 0..2 {
        for way in [1.0, -1.0] {
            scene.send(Command::AllowWayOut);
            let from_deg = scene.world.unit.axes_deg();
            let before = way_out(&scene, from_deg, GAP_DEG);
            let before_zone_deg = scene.world.zone_clearance_deg();
            let mut rates_deg_s = [0.0; 2];
            rates_deg_s[axis] = way * slow_deg_s;
            for _ in 0..8 {
                scene.send(Command::Jog { rates_deg_s });
                scene.seconds(0.1).await;
            }
            scene.send(Command::EndJog);
            scene.seconds(5.0).await;
            let to_deg = scene.world.unit.axes_deg();
            // The measured direction differs from the true one, so a gap may look wider.
            let after = way_out(&scene, to_deg, GAP_DEG - 0.1);
            let turned_deg = (to_deg[axis] - from_deg[axis]).abs();
            if before.is_some_and(|(length_deg, ..)| length_deg == 0.0) {
                return;
            }
            let case = || format!("{before:?} to {after:?} by {rates_deg_s:?}\n{}", scene.report());
            let coarse_deg = scene.world.coarse_deg;
            match before.zip(after) {
                Some(((before_deg, ..), (after_deg, ..))) => {
                    assert!(after_deg <= before_deg + coarse_deg, "deeper: {}", case());
                }
                // No single axis leads out.
                None => assert!(
                    scene.world.zone_clearance_deg() >= before_zone_deg - coarse_deg,
                    "deeper: {}",
                    case()
                ),
            }
            let floor_deg = scene.world.floor_clearance_deg();
            assert!(floor_deg >= -coarse_deg, "{} below the floor: {}", -floor_deg, case());
            ways_out += usize::from(turned_deg > 0.01);
        }
    }
    assert!(ways_out > 0 || !is_open, "no way out: {out:?}\n{}", scene.report());
}

#[test]
fn any_drive_stays_outside_and_within_travel() {
    for_each_case("link up, driven by Azel", 60, drives);
}

#[test]
fn any_motion_of_others_is_stopped_before_the_zone() {
    for_each_case("link up, driven by others", 40, others_move);
}

#[test]
fn any_start_inside_has_a_way_out() {
    for_each_case("link up, from inside", 40, starts_inside);
}
