//! Judges how a device that tracks by itself will follow a pass: where it will
//! point by what it tells of itself, how far that is from the satellite, and why.
//! Pure functions; what the device tells comes in.

mod cause;
mod clear;
mod path;

use jiff::Timestamp;

pub use cause::{Cause, Ranked, Unknown};
pub use clear::{OffLimits, Trespass, path_is_clear};

use crate::{
    astro::{Angle, AzEl, Site, time::seconds_between},
    device::{OnBoard, TrackTarget},
    orbit::{Elements, PropagationError, Propagator},
    plan::{Bounds, Sample},
    station::{Antenna, Mount},
};
use path::{Unit, spread};

/// A pass that a device is to track by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoardPass {
    /// What the device is told.
    pub target: TrackTarget,
    /// Where the satellite is, as well as we know.
    pub elements: Elements,
    /// Where the antenna stands.
    pub site: Site,
    /// The operator has agreed that the antenna may miss the satellite.
    pub is_agreed: bool,
}

/// An orbit as well as we know it, and from where it is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownOrbit {
    /// Where the satellite is.
    pub elements: Elements,
    /// Where the antenna stands.
    pub site: Site,
}

impl KnownOrbit {
    /// What a device does by itself that tells `told`, in its own window; `None` where
    /// it holds another satellite, or tells no window.
    pub fn pass_of(&self, told: &OnBoard) -> Option<OnBoardPass> {
        let held = told.satellite.as_ref()?;
        let (from, until) = told.window?;
        let is_this = held.catalog_number == self.elements.catalog_number();
        is_this.then(|| OnBoardPass {
            target: TrackTarget {
                catalog_number: held.catalog_number,
                name: held.name.clone(),
                from,
                until,
            },
            elements: self.elements.clone(),
            site: self.site,
            is_agreed: true,
        })
    }
}

/// What an antenna that is to track by itself must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ability {
    /// How its axes are arranged and how far they travel.
    pub mount: Mount,
    /// It must not point lower.
    pub minimum_elevation: Angle,
    /// A direction that is off by less is within the beam.
    pub half_beam: Angle,
    /// Its axes turn no faster, degrees a second.
    pub maximum_rate_deg_s: f64,
}

impl Ability {
    /// Those of `antenna`.
    pub fn of(antenna: &Antenna) -> Self {
        Self {
            mount: antenna.mount,
            minimum_elevation: Angle::from_degrees(antenna.limits.minimum_elevation_deg),
            half_beam: Angle::from_degrees(antenna.beam_width_deg / 2.0),
            maximum_rate_deg_s: antenna.limits.maximum_rate_deg_s,
        }
    }
}

/// How a device will follow a pass by what it tells of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Supervision {
    /// How far it will be off at worst.
    pub worst: Error,
    /// Within the beam at worst.
    pub is_within_beam: bool,
    /// Why, the likeliest first.
    pub causes: Vec<Ranked>,
    /// What the device does not tell, or was not asked yet.
    pub unknown: Vec<Unknown>,
    /// The lowest elevation of the device, where it is below that of the station.
    pub lower_minimum_deg: Option<f64>,
}

/// How far the beam axis will be off, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Error {
    /// Between beam axis and satellite.
    pub off: Angle,
    /// When.
    pub at: Timestamp,
}

/// A pass, ready to be compared with a device again and again.
#[derive(Debug, Clone)]
pub struct Judge {
    pass: OnBoardPass,
    propagator: Propagator,
    ability: Ability,
    /// Where the satellite stands along the window.
    truth: Vec<Sample>,
}

impl Judge {
    /// Of `pass` with an antenna of these `ability`; an error where the elements
    /// describe no orbit.
    pub fn new(pass: OnBoardPass, ability: Ability) -> Result<Self, PropagationError> {
        let propagator = Propagator::new(&pass.elements)?;
        let truth = spread(pass.target.from, pass.target.until)
            .map_while(|time| {
                let look = propagator.look_from(pass.site, time).ok()?;
                Some(Sample { time, direction: look.direction })
            })
            .collect();
        Ok(Self { pass, propagator, ability, truth })
    }

    /// The pass.
    pub fn pass(&self) -> &OnBoardPass {
        &self.pass
    }

    /// Where the satellite stands at `at`.
    pub fn direction(&self, at: Timestamp) -> Option<AzEl> {
        Some(self.propagator.look_from(self.pass.site, at).ok()?.direction)
    }

    /// How a device that tells `unit` will follow the pass. `holds_target` says
    /// that the target was put on it: what it holds before tells nothing.
    pub fn supervise(&self, unit: &OnBoard, holds_target: bool) -> Supervision {
        let all = Unit::of(unit, self);
        let worst = all.either_way().map(|unit| self.worst(&unit)).reduce(worse);
        let worst = worst.unwrap_or(Error { off: Angle::ZERO, at: self.pass.target.from });
        let lowest_deg = self.ability.minimum_elevation.degrees();
        let lower = |offsets: &crate::device::Offsets| {
            (offsets.minimum_elevation_deg < lowest_deg).then_some(offsets.minimum_elevation_deg)
        };
        Supervision {
            worst,
            is_within_beam: worst.off <= self.ability.half_beam,
            causes: cause::ranked(self, unit, holds_target),
            unknown: cause::unknown(unit),
            lower_minimum_deg: unit.offsets.as_ref().and_then(lower),
        }
    }

    /// Whether the device will keep to the ability of its antenna, wherever it will
    /// really point; where it goes wrong first if not.
    pub fn is_clear(&self, unit: &OnBoard, bounds: &Bounds) -> Result<(), Trespass> {
        let unit = Unit::of(unit, self);
        unit.either_way().try_for_each(|unit| path_is_clear(self.path(unit), &self.ability, bounds))
    }

    /// Where the device will wait for the window.
    pub fn start(&self, unit: &OnBoard) -> Option<AzEl> {
        self.path(Unit::of(unit, self)).next().map(|first| first.direction)
    }

    /// Where the antenna will really point by what the device tells: at most a
    /// second or half a degree from one sample to the next, from where it waits for
    /// the window to where it ends.
    fn path<'a>(&'a self, unit: Unit<'a>) -> impl Iterator<Item = Sample> + 'a {
        path::samples(unit, (self.pass.target.from, self.pass.target.until))
    }

    fn worst(&self, unit: &Unit<'_>) -> Error {
        let errors = self.truth.iter().filter_map(|truth| {
            let off = unit.direction(truth.time)?.separation(truth.direction);
            Some(Error { off, at: truth.time })
        });
        errors.reduce(worse).unwrap_or(Error { off: Angle::ZERO, at: self.pass.target.from })
    }

    /// The greatest elevation that the device will compute for the window.
    fn highest(&self, unit: &Unit<'_>) -> Option<Angle> {
        let elevations = self.truth.iter().filter_map(|at| unit.computed(at.time));
        elevations.map(|direction| direction.elevation).reduce(|a, b| if b > a { b } else { a })
    }

    /// The window is long enough for more than one look.
    fn span_s(&self) -> f64 {
        seconds_between(self.pass.target.from, self.pass.target.until)
    }
}

fn worse(a: Error, b: Error) -> Error {
    if b.off > a.off { b } else { a }
}

#[cfg(test)]
mod tests;
