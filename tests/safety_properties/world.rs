//! A random station, its antenna and its unit.

use std::sync::Arc;

use azel::{
    astro::{AzEl, time},
    clock::Instant,
    device::JogSpeeds,
    plan::Bounds,
    station::{Antenna, Direction, Entered, KeepOut, Station, SunAvoidance},
};
use jiff::Timestamp;
use tokio::io::{AsyncReadExt, AsyncWriteExt};

use super::{
    makes::{MAKES, Make},
    sky::Overflight,
    truth::{self, Outline},
    unit::{Unit, Word},
};
use crate::common::dice::Dice;

/// Random station with its antenna, its unit and the true keep-outs.
pub(super) struct World {
    pub(super) make: &'static Make,
    pub(super) unit: Arc<dyn Unit>,
    pub(super) antenna: Antenna,
    pub(super) station: Station,
    pub(super) bounds: Bounds,
    /// The keep-outs of the station with their margins in degrees, computed apart from the program.
    pub(super) outlines: Vec<(Outline, f64)>,
    pub(super) utc_origin: Timestamp,
    /// Satellite that is up at the start or rises soon.
    pub(super) overflight: Option<&'static Overflight>,
    /// Fastest motion of the unit, degrees per second.
    pub(super) fastest_deg_s: f64,
    /// Half a step of the reported figures plus the overshoot of the drive, degrees.
    pub(super) coarse_deg: f64,
}

/// Requirements for a world.
pub(super) struct Wish {
    pub(super) keep_outs: usize,
    pub(super) min_margin_deg: fn(&World) -> f64,
    pub(super) has_sun: bool,
    /// `true` for axes inside a keep-out.
    pub(super) starts_inside: bool,
    /// `true` for a make whose axes other clients can turn.
    pub(super) others_jog: bool,
    pub(super) overflight: Overhead,
    /// Name of the make; `None` for any make.
    pub(super) make: Option<&'static str>,
}

/// Objects in the sky at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Overhead {
    Nothing,
    /// A satellite that is up or rises within a minute.
    Satellite,
    /// A satellite shortly before its culmination.
    Culmination,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            keep_outs: 0,
            min_margin_deg: |world| world.coarse_deg,
            has_sun: false,
            starts_inside: false,
            others_jog: false,
            overflight: Overhead::Nothing,
            make: None,
        }
    }
}

impl World {
    /// Draws a random world with its axes in a free direction, or inside a keep-out.
    pub(super) fn random(dice: &mut Dice, wish: &Wish) -> Self {
        let can = |make: &&Make| {
            (make.others_jog.is_some() || !wish.others_jog)
                && wish.make.is_none_or(|name| make.name == name)
        };
        let makes: Vec<_> = MAKES.iter().copied().filter(can).collect();
        loop {
            let make = makes[dice.below(makes.len())];
            let (overflight, utc) = match wish.overflight {
                Overhead::Nothing => (None, some_time(dice)),
                Overhead::Satellite => {
                    let overflight = Overflight::any(dice);
                    (Some(overflight), overflight.some_time(dice))
                }
                Overhead::Culmination => {
                    let overflight = Overflight::any(dice);
                    (Some(overflight), time::add_seconds(overflight.culmination, -150.0))
                }
            };
            let mut world = Self { overflight, ..(make.random)(dice, utc) };
            let (azimuth_deg, elevation_deg) = (dice.between(0.0, 360.0), dice.between(20.0, 70.0));
            world.antenna.park = Direction { azimuth_deg, elevation_deg };
            if wish.has_sun && dice.chance(0.4) {
                let radius_deg = dice.between(1.0, 25.0);
                let ahead_min = dice.between(0.0, 30.0);
                world.station.sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min });
            }
            let min_deg = (wish.min_margin_deg)(&world);
            for number in 0..wish.keep_outs {
                let margin_deg = f64::min(min_deg + dice.between(0.0, 4.0), 30.0);
                if let Some((zone, outline)) = keep_out(dice, number, margin_deg) {
                    world.station.keep_outs.push(zone);
                    world.outlines.push((outline, margin_deg));
                }
            }
            world.bounds = Bounds::new(&world.station, &world.antenna);
            for _ in 0..200 {
                if world.place(dice, wish.starts_inside) {
                    return world;
                }
            }
        }
    }

    pub(super) fn new(
        make: &'static Make,
        unit: impl Unit + 'static,
        antenna: Antenna,
        utc_origin: Timestamp,
        fastest_deg_s: f64,
        coarse_deg: f64,
    ) -> Self {
        let (unit, station) = (Arc::new(unit), Station::default());
        let bounds = Bounds::new(&station, &antenna);
        Self {
            make,
            unit,
            antenna,
            station,
            bounds,
            outlines: Vec::new(),
            utc_origin,
            overflight: None,
            fastest_deg_s,
            coarse_deg,
        }
    }

    /// Puts the axes at a random position; returns `false` if the position does not fulfil the
    /// wish.
    fn place(&self, dice: &mut Dice, inside: bool) -> bool {
        let axes_deg = self.antenna.mount.travel_deg().map(|(from_deg, to_deg)| {
            let away_deg = f64::min(5.0, (to_deg - from_deg) / 4.0);
            dice.between(from_deg + away_deg, to_deg - away_deg).round()
        });
        let axes_deg = self.unit.as_counted(axes_deg);
        // If a unit counts within a full circle, an axis that has turned further would begin
        // outside its travel.
        if axes_deg[0] < self.antenna.mount.travel_deg()[0].0 {
            return false;
        }
        let direction = self.bounds.direction(axes_deg);
        let above_deg = direction.elevation_deg() - self.antenna.limits.minimum_elevation_deg;
        let sky = self.bounds.at_time(self.utc_origin).above_the_floor().nearest(direction);
        let clear_deg = sky.map_or(90.0, |nearest| nearest.angle.degrees());
        let is_wished = if inside { clear_deg < -0.5 } else { clear_deg > 3.0 };
        above_deg >= 3.0 && is_wished && self.unit.place(axes_deg)
    }

    /// Returns the words that the unit has received since `from`, in order.
    pub(super) fn words_since(&self, from: Instant) -> Vec<(Instant, Word)> {
        self.unit.words().into_iter().filter(|(at, _)| *at >= from).collect()
    }

    /// Returns `true` if every jog is equally fast.
    pub(super) fn has_one_speed(&self) -> bool {
        let jog = self.antenna.connection.variant().capabilities.jog;
        matches!(jog, JogSpeeds::Named([_]))
    }

    /// Turns one axis as another client.
    pub(super) async fn other_client_turns(&self, axis: usize, rate_deg_s: f64) {
        let jog = self.make.others_jog.unwrap();
        let mut near = self.unit.link();
        near.write_all(&jog(axis, rate_deg_s)).await.unwrap();
        let mut answer = [0; 64];
        drop(near.read(&mut answer).await);
    }

    /// Returns the distance of the true direction from the nearest keep-out itself, degrees.
    pub(super) fn zone_clearance_deg(&self) -> f64 {
        let direction = self.direction();
        let zones = self.station.keep_outs.iter();
        let clear_deg = zones.map(|zone| zone.zone.clearance(direction).degrees());
        clear_deg.fold(f64::INFINITY, f64::min)
    }

    /// Returns the distance of the true direction from the margin of the nearest keep-out, degrees,
    /// by formulas of the tests alone.
    pub(super) fn margin_clearance_deg(&self) -> f64 {
        self.margin_clearance_at_deg(self.unit.axes_deg())
    }

    /// Returns [`Self::margin_clearance_deg`] for axes at `axes_deg`.
    pub(super) fn margin_clearance_at_deg(&self, axes_deg: [f64; 2]) -> f64 {
        let direction = truth::direction(&self.antenna.mount, axes_deg);
        let outlines = self.outlines.iter();
        let clear_deg = outlines.map(|(zone, margin)| zone.clearance_deg(direction) - margin);
        clear_deg.fold(f64::INFINITY, f64::min)
    }

    /// Returns the height of the true direction above the minimum elevation, degrees.
    pub(super) fn floor_clearance_deg(&self) -> f64 {
        self.direction().elevation_deg() - self.antenna.limits.minimum_elevation_deg
    }

    pub(super) fn direction(&self) -> AzEl {
        self.bounds.direction(self.unit.axes_deg())
    }

    /// Returns the degrees by which an axis is beyond its travel.
    pub(super) fn beyond_travel_deg(&self) -> f64 {
        let axes = self.unit.axes_deg().into_iter().zip(self.antenna.mount.travel_deg());
        let beyond_deg = |(angle_deg, (from_deg, to_deg)): (f64, (f64, f64))| {
            let turns = [-360.0, 0.0, 360.0].into_iter();
            let beyond = turns.map(|turn| {
                let angle_deg: f64 = angle_deg + turn;
                f64::max(from_deg - angle_deg, angle_deg - to_deg)
            });
            beyond.fold(f64::INFINITY, f64::min)
        };
        axes.map(beyond_deg).fold(0.0, f64::max)
    }
}

fn some_time(dice: &mut Dice) -> Timestamp {
    let noon: Timestamp = "2026-06-21T10:00:00Z".parse().unwrap();
    time::add_seconds(noon, dice.between(0.0, 365.0).floor() * time::DAY_S)
}

/// Draws a keep-out in the form of a convex quadrilateral.
fn keep_out(dice: &mut Dice, number: usize, margin_deg: f64) -> Option<(KeepOut, Outline)> {
    let (width_deg, height_deg) = (dice.between(5.0, 60.0), dice.between(5.0, 60.0));
    let (az_deg, el_deg) = (dice.between(0.0, 360.0), dice.between(-10.0, 60.0));
    let top_deg = f64::min(el_deg + height_deg, 88.0);
    let [left_deg, right_deg] = [(); 2].map(|()| dice.between(-0.2, 0.2) * width_deg);
    let corners_deg = [
        (az_deg, el_deg),
        (az_deg + width_deg, el_deg),
        (az_deg + width_deg + right_deg, top_deg),
        (az_deg + left_deg, top_deg),
    ];
    let zone = KeepOut::zone_of(&corners_deg).ok()?;
    let name = format!("zone {number}");
    let (reason, entered) = (String::new(), Entered::Hard);
    let outline = Outline::new(corners_deg);
    Some((KeepOut { name, reason, entered, antenna: None, margin_deg, zone }, outline))
}
