//! Requests of the operator in a case: one motion, and a key that may stay down.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::{Angle, AzEl},
    clock::Instant,
    contract::driver::Command,
    plan::{ProgramTrack, Target, on_board::KnownOrbit},
};

use super::{judge::Judge, scene::Scene, world::World};
use crate::common::dice::Dice;

/// Motion that the operator asks for.
#[derive(Debug, Clone)]
pub(super) enum Deed {
    /// Jog with a held key, degrees a second.
    Jog([f64; 2]),
    GoTo(f64, f64),
    Park,
    /// Program track of a fixed direction.
    Point(f64, f64),
    /// Program track of a satellite.
    Follow,
    /// Track of a satellite by the unit.
    OnBoard,
}

impl Deed {
    /// Draws any motion that the unit of `world` knows. It tracks a satellite only if one is up.
    pub(super) fn any(dice: &mut Dice, world: &World) -> Self {
        let (az_deg, el_deg) = (dice.between(0.0, 360.0), dice.between(15.0, 80.0));
        match dice.below(if world.overflight.is_some() { 6 } else { 4 }) {
            0 => Self::Jog(any_rates(dice, world)),
            1 => Self::GoTo(az_deg, el_deg),
            2 => Self::Park,
            3 => Self::Point(az_deg, el_deg),
            4 => Self::Follow,
            _ if world.make.tracks_on_board => Self::OnBoard,
            _ => Self::Follow,
        }
    }

    /// Draws a motion by hand, or to a position that no setting of a random world forbids.
    pub(super) fn any_by_hand(dice: &mut Dice, world: &World) -> Self {
        match dice.below(3) {
            0 => Self::Jog(rates_to_the_middle(dice, world)),
            1 => Self::GoTo(dice.between(10.0, 350.0), dice.between(15.0, 80.0)),
            _ => Self::Park,
        }
    }

    pub(super) fn is_jog(&self) -> bool {
        matches!(self, Self::Jog(_))
    }

    /// Returns `true` if Azel sends one position after another.
    pub(super) fn is_program(&self) -> bool {
        matches!(self, Self::Point(..) | Self::Follow)
    }

    pub(super) async fn begin(&self, scene: &mut Scene, judge: &mut Judge) {
        judge.allow();
        match self {
            Self::Jog(_) => {
                scene.send(Command::Manual);
                scene.seconds(1.0).await;
            }
            Self::GoTo(az_deg, el_deg) => scene.send(Command::Position {
                azimuth: Some(Angle::from_degrees(*az_deg)),
                elevation: Some(Angle::from_degrees(*el_deg)),
            }),
            Self::Park => scene.send(Command::Park),
            Self::Point(az_deg, el_deg) => {
                let target = Target::Fixed(AzEl::from_degrees(*az_deg, *el_deg));
                let track = ProgramTrack::new(target, scene.world.station.site, Vec::new());
                scene.send(Command::ProgramTrack(Box::new(track)));
            }
            Self::Follow => {
                let track = scene.world.overflight.unwrap().program_track();
                scene.send(Command::ProgramTrack(Box::new(track)));
            }
            Self::OnBoard => {
                let pass = scene.world.overflight.unwrap().on_board();
                let orbit = KnownOrbit { elements: pass.elements.clone(), site: pass.site };
                scene.know_orbit(Arc::new(orbit));
                scene.send(Command::Track(Box::new(pass)));
            }
        }
    }

    /// Lets time pass, with the key of a jog held.
    pub(super) async fn go_on(&self, scene: &mut Scene, judge: &Judge, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        let mut is_renewed = false;
        while Instant::now() < end {
            if let Self::Jog(rates_deg_s) = *self {
                is_renewed = !is_renewed;
                if is_renewed {
                    scene.send(Command::Jog { rates_deg_s });
                }
            }
            scene.look().await;
            judge.look(scene);
        }
    }

    /// Releases the key of a jog.
    pub(super) fn let_go(&self, scene: &Scene) {
        if self.is_jog() {
            scene.send(Command::EndJog);
        }
    }
}

/// Draws rates of a jog that leads into a keep-out unless something stops it. Draws any jog if none
/// leads there.
pub(super) fn rates_into_a_zone(dice: &mut Dice, world: &World) -> [f64; 2] {
    let axes_deg = world.unit.axes_deg();
    let ways = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
    let leads_into = |(axis, way): &(usize, f64)| {
        let (from_deg, to_deg) = world.antenna.mount.travel_deg()[*axis];
        let turns = (0..120).map(|turned_deg| {
            let mut axes_deg = axes_deg;
            axes_deg[*axis] += way * f64::from(turned_deg);
            (axes_deg, (from_deg..=to_deg).contains(&axes_deg[*axis]))
        });
        let mut reached = turns.take_while(|(_, is_within)| *is_within);
        reached.any(|(axes_deg, _)| world.margin_clearance_at_deg(axes_deg) < 0.0)
    };
    let leading: Vec<_> = ways.into_iter().filter(leads_into).collect();
    if leading.is_empty() {
        return any_rates(dice, world);
    }
    let (axis, way) = leading[dice.below(leading.len())];
    let share = if world.has_one_speed() { 1.0 } else { dice.between(0.3, 1.0) };
    let mut rates_deg_s = [0.0; 2];
    rates_deg_s[axis] = way * share * world.antenna.limits.maximum_rate_deg_s;
    rates_deg_s
}

/// Draws rates of a jog of one axis away from the nearer end of its travel.
fn rates_to_the_middle(dice: &mut Dice, world: &World) -> [f64; 2] {
    let travel_deg = world.antenna.mount.travel_deg();
    let mut rates_deg_s = any_rates(dice, world);
    let axes = rates_deg_s.iter_mut().zip(world.unit.axes_deg()).zip(travel_deg);
    for ((rate, at_deg), (from_deg, to_deg)) in axes {
        *rate = rate.copysign(f64::midpoint(from_deg, to_deg) - at_deg);
    }
    rates_deg_s
}

/// Draws rates of a jog of one axis, degrees a second.
fn any_rates(dice: &mut Dice, world: &World) -> [f64; 2] {
    let share = if world.has_one_speed() { 1.0 } else { dice.between(0.3, 1.0) };
    let way = if dice.chance(0.5) { 1.0 } else { -1.0 };
    let mut rates_deg_s = [0.0; 2];
    rates_deg_s[dice.below(2)] = way * share * world.antenna.limits.maximum_rate_deg_s;
    rates_deg_s
}
