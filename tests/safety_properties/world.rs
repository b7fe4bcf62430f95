//! A random station, its antenna and its unit.

use azel::{
    astro::{Angle, AzEl, time},
    controller::{
        rc2000c::Calibration,
        rotator_genius::{ROTATORS, Rotators},
    },
    plan::Bounds,
    protocol::rotator_genius::WholeDegrees,
    sim::{rc2000c, rotator_genius, satrak},
    station::{Antenna, CountLine, CountPoint, Entered, KeepOut, Mount, Station, SunAvoidance},
};
use jiff::Timestamp;

use super::unit::Unit;
use crate::common::dice::Dice;

/// A station, its antenna, and where it stands.
pub(super) struct World {
    pub(super) unit: Unit,
    pub(super) antenna: Antenna,
    pub(super) station: Station,
    pub(super) bounds: Bounds,
    pub(super) utc_origin: Timestamp,
    /// Of the fastest motion of the unit, degrees a second.
    pub(super) fastest_deg_s: f64,
    /// Half a step of what is told, and what a drive may overshoot, degrees.
    pub(super) coarse_deg: f64,
}

/// What a world is to have.
pub(super) struct Wish {
    pub(super) keep_outs: usize,
    pub(super) min_margin_deg: fn(&World) -> f64,
    pub(super) has_sun: bool,
    /// The axes stand inside a keep-out.
    pub(super) starts_inside: bool,
    pub(super) makes: usize,
}

impl World {
    /// A random one, and its axes somewhere free, or inside a keep-out.
    pub(super) fn random(dice: &mut Dice, wish: &Wish) -> Self {
        loop {
            let mut world = match dice.below(wish.makes) {
                0 => Self::of_satrak(dice),
                1 => Self::of_genius(dice),
                _ => Self::of_rc2000c(dice),
            };
            if wish.has_sun && dice.chance(0.4) {
                let radius_deg = dice.between(1.0, 25.0);
                let ahead_min = dice.between(0.0, 30.0);
                world.station.sun_avoidance = Some(SunAvoidance { radius_deg, ahead_min });
            }
            let min_deg = (wish.min_margin_deg)(&world);
            for number in 0..wish.keep_outs {
                let margin_deg = f64::min(min_deg + dice.between(0.0, 4.0), 30.0);
                world.station.keep_outs.extend(keep_out(dice, number, margin_deg));
            }
            world.bounds = Bounds::of(&world.station, &world.antenna);
            for _ in 0..200 {
                if world.place(dice, wish.starts_inside) {
                    return world;
                }
            }
        }
    }

    fn of_satrak(dice: &mut Dice) -> Self {
        let utc_origin = some_time(dice);
        let station = Station::default();
        let lower_axis_deg = dice.between(0.0, 180.0);
        let options = satrak::Options {
            lower_axis: Angle::from_degrees(lower_axis_deg),
            seed: dice.next(),
            max_clients: 2,
            ..satrak::Options::new(station.site, utc_origin)
        };
        let mut antenna = Antenna::satrak("Dish", "in memory");
        antenna.mount = Mount::Xy {
            lower_axis_azimuth_deg: lower_axis_deg,
            travel_from_deg: dice.between(5.0, 30.0),
            travel_to_deg: dice.between(150.0, 175.0),
        };
        antenna.limits.maximum_rate_deg_s = dice.between(0.5, 5.0);
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 15.0);
        antenna.beam_width_deg = dice.between(0.1, 3.0);
        let unit = Unit::Satrak(satrak::Control::new(&options));
        Self::with(unit, antenna, station, utc_origin, 5.0, 0.15)
    }

    fn of_genius(dice: &mut Dice) -> Self {
        use rotator_genius::{Options, RotatorOptions};
        let highest_deg = if dice.chance(0.3) { 180.0 } else { 90.0 };
        let options = Options {
            rotators: [
                RotatorOptions::default(),
                RotatorOptions {
                    limit_cw: WholeDegrees::nearest(highest_deg).unwrap(),
                    ..RotatorOptions::elevation()
                },
            ],
            max_clients: 2,
            seed: dice.next(),
            ..Options::default()
        };
        let mut antenna = Antenna::genius("Mast", "in memory");
        antenna.connection.put(&ROTATORS, Rotators::Pair).unwrap();
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: dice.between(0.0, 40.0).round(),
            azimuth_to_deg: dice.between(320.0, 450.0).round(),
            elevation_from_deg: 0.0,
            elevation_to_deg: highest_deg,
        };
        antenna.beam_width_deg = dice.between(1.0, 20.0);
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
        let unit = Unit::Genius(rotator_genius::Control::new(&options));
        Self::with(unit, antenna, Station::default(), some_time(dice), 4.0, 2.6)
    }

    fn of_rc2000c(dice: &mut Dice) -> Self {
        let point = |counts, degrees| CountPoint { counts, degrees };
        let (from_deg, span_deg) = (dice.between(-90.0, 180.0).round(), dice.between(120.0, 420.0));
        let to_deg = from_deg + span_deg.round();
        let calibration = Calibration {
            azimuth: vec![point(30, from_deg), point(3630, to_deg)],
            elevation: vec![point(30, 0.0), point(1830, 90.0)],
        };
        let lines = [&calibration.azimuth, &calibration.elevation]
            .map(|points| CountLine::through(points).unwrap());
        let mut antenna = Antenna::rc2000c("Dish", "in memory");
        calibration.put_into(&mut antenna.connection).unwrap();
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: from_deg,
            azimuth_to_deg: to_deg,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        };
        // 40 counts a second.
        let fastest_deg_s = f64::max(40.0 * (to_deg - from_deg) / 3600.0, 2.0);
        antenna.limits.maximum_rate_deg_s = fastest_deg_s;
        antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
        antenna.beam_width_deg = dice.between(0.1, 3.0);
        let unit = Unit::Rc2000c(rc2000c::Control::new(&rc2000c::Options::default()), lines);
        Self::with(unit, antenna, Station::default(), some_time(dice), fastest_deg_s, 0.3)
    }

    fn with(
        unit: Unit,
        antenna: Antenna,
        station: Station,
        utc_origin: Timestamp,
        fastest_deg_s: f64,
        coarse_deg: f64,
    ) -> Self {
        let bounds = Bounds::of(&station, &antenna);
        Self { unit, antenna, station, bounds, utc_origin, fastest_deg_s, coarse_deg }
    }

    /// Puts the axes somewhere; `false` where that is not as wished.
    fn place(&mut self, dice: &mut Dice, inside: bool) -> bool {
        let axes_deg = self.antenna.mount.travel_deg().map(|(from_deg, to_deg)| {
            let away_deg = f64::min(5.0, (to_deg - from_deg) / 4.0);
            dice.between(from_deg + away_deg, to_deg - away_deg).round()
        });
        let axes_deg = match &self.unit {
            Unit::Genius(_) => [axes_deg[0].rem_euclid(360.0), axes_deg[1]],
            _ => axes_deg,
        };
        // Where a unit counts within a full circle, an axis that has turned further would
        // begin outside of its travel.
        if axes_deg[0] < self.antenna.mount.travel_deg()[0].0 {
            return false;
        }
        let direction = self.bounds.direction(axes_deg);
        let above_deg = direction.elevation_deg() - self.antenna.limits.minimum_elevation_deg;
        let sky = self.bounds.at(self.utc_origin).above_the_floor().nearest(direction);
        let clear_deg = sky.map_or(90.0, |nearest| nearest.angle.degrees());
        let is_wished = if inside { clear_deg < -0.5 } else { clear_deg > 3.0 };
        if above_deg < 3.0 || !is_wished {
            return false;
        }
        match &mut self.unit {
            Unit::Satrak(control) => control.place(axes_deg),
            Unit::Genius(control) => {
                control.place(axes_deg.map(|deg| WholeDegrees::nearest(deg).unwrap()));
            }
            Unit::Rc2000c(control, lines) => {
                let counts = [lines[0].counts(axes_deg[0]), lines[1].counts(axes_deg[1])];
                let [Some(azimuth), Some(elevation)] = counts else { return false };
                control.place([azimuth, elevation]);
            }
        }
        true
    }

    /// How far the true direction is from the nearest keep-out itself, degrees.
    pub(super) fn zone_clearance_deg(&self) -> f64 {
        let direction = self.direction();
        let zones = self.station.keep_outs.iter();
        let clear_deg = zones.map(|zone| zone.zone.clearance(direction).degrees());
        clear_deg.fold(f64::INFINITY, f64::min)
    }

    /// How far the true direction is above the minimum elevation, degrees.
    pub(super) fn floor_clearance_deg(&self) -> f64 {
        self.direction().elevation_deg() - self.antenna.limits.minimum_elevation_deg
    }

    pub(super) fn direction(&self) -> AzEl {
        self.bounds.direction(self.unit.axes_deg())
    }

    /// By how much an axis is beyond its travel, degrees.
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

/// A convex quadrilateral.
fn keep_out(dice: &mut Dice, number: usize, margin_deg: f64) -> Option<KeepOut> {
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
    Some(KeepOut { name, reason, entered, antenna: None, margin_deg, zone })
}
