//! Judgement of the on-board track of a pass: the predicted direction of the antenna from the
//! unit's reports, its distance from the satellite, and the causes. All functions are pure; the
//! reports are arguments.

mod cause;
mod clear;
mod path;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use cause::{Cause, Ranked, Unknown};
pub use clear::ALONG_DEG;
use clear::path_is_clear;
pub use clear::{NotClear, OffLimits, Trespass};

use crate::{
    astro::{Angle, AzEl, Site, time::seconds_between},
    device::{OnBoard, TrackTarget},
    orbit::{Elements, PropagationError, Propagator},
    plan::{Bounds, Sample},
    station::{Antenna, Mount},
};
use path::{NoDirection, UnitPath, spread};

/// Pass that a unit tracks on its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnBoardPass {
    /// Target sent to the unit.
    pub target: TrackTarget,
    /// Best known orbit.
    pub elements: Elements,
    pub site: Site,
    /// `true` if the operator has agreed that the antenna may miss the satellite.
    pub is_agreed: bool,
}

/// Best known orbit, and the site.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KnownOrbit {
    pub elements: Elements,
    pub site: Site,
}

impl KnownOrbit {
    /// Returns the pass that a unit with the report `on_board` tracks, in its own window; `None` if
    /// the unit has another satellite or reports no window.
    pub fn pass_of(&self, on_board: &OnBoard) -> Option<OnBoardPass> {
        let held_satellite = on_board.satellite.as_ref()?;
        let (start, end) = on_board.window?;
        let is_this = held_satellite.catalog_number == self.elements.catalog_number();
        is_this.then(|| OnBoardPass {
            target: TrackTarget {
                catalog_number: held_satellite.catalog_number,
                name: held_satellite.name.clone(),
                element_file: None,
                start,
                end,
            },
            elements: self.elements.clone(),
            site: self.site,
            is_agreed: true,
        })
    }
}

/// Abilities and limits of an antenna whose unit tracks on its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ability {
    /// Arrangement and travel of the axes.
    pub mount: Mount,
    pub minimum_elevation: Angle,
    /// Half the beam width.
    pub half_beam: Angle,
    /// Max rate of the axes, degrees per second.
    pub maximum_rate_deg_s: f64,
}

impl Ability {
    pub fn from_antenna(antenna: &Antenna) -> Self {
        Self {
            mount: antenna.mount,
            minimum_elevation: Angle::from_degrees(antenna.limits.minimum_elevation_deg),
            half_beam: Angle::from_degrees(antenna.beam_width_deg / 2.0),
            maximum_rate_deg_s: antenna.limits.maximum_rate_deg_s,
        }
    }
}

/// Judgement of an on-board track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Supervision {
    pub worst: Error,
    /// `true` if the largest error is within the beam, refraction aside. No setting of a unit
    /// corrects refraction, which affects the ends of a pass, not the pass.
    pub is_within_beam: bool,
    /// Causes, the most likely first.
    pub causes: Vec<Ranked>,
    /// Values that the unit does not report, or that Azel has not queried yet.
    pub unknown: Vec<Unknown>,
    /// Minimum elevation of the unit, degrees, if it is below the station's value.
    pub lower_minimum_deg: Option<f64>,
}

impl Supervision {
    /// Returns the most likely cause of an error of `deviation`. A small known error is no cause of
    /// a large one.
    pub fn cause_of(&self, deviation: Angle) -> Option<&Ranked> {
        self.causes.iter().find(|cause| cause.can_make(deviation))
    }
}

/// Pointing error and its time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Error {
    /// Angle between the beam axis and the satellite.
    #[serde(rename = "off")]
    pub angle: Angle,
    #[serde(rename = "at")]
    pub time: Timestamp,
}

/// Pass, prepared for repeated comparison with a unit.
#[derive(Debug, Clone)]
pub struct Judge {
    pass: OnBoardPass,
    propagator: Propagator,
    ability: Ability,
    /// Apparent directions of the satellite along the window.
    truth: Vec<Sample>,
}

impl Judge {
    /// Prepares a pass. Fails if the elements do not describe an orbit.
    pub fn new(pass: OnBoardPass, ability: Ability) -> Result<Self, PropagationError> {
        let propagator = Propagator::new(&pass.elements)?;
        let truth = spread(pass.target.start, pass.target.end)
            .map_while(|time| {
                let look = propagator.look_from(pass.site, time).ok()?;
                Some(Sample { time, direction: look.direction })
            })
            .collect();
        Ok(Self { pass, propagator, ability, truth })
    }

    pub fn pass(&self) -> &OnBoardPass {
        &self.pass
    }

    pub fn ability(&self) -> Ability {
        self.ability
    }

    /// Returns the apparent direction of the satellite at `time`: the direction to point at.
    pub fn direction(&self, time: Timestamp) -> Option<AzEl> {
        Some(self.propagator.look_from(self.pass.site, time).ok()?.direction)
    }

    /// Judges a unit by its report `unit`. `holds_target`: Azel has sent the target to the unit, so
    /// its earlier satellite does not matter.
    pub fn supervise(&self, unit: &OnBoard, holds_target: bool) -> Supervision {
        let all = UnitPath::surely(unit, self);
        let none = Error { angle: Angle::ZERO, time: self.pass.target.start };
        let worst = |unit: UnitPath<'_>| {
            unit.either_way().map(|unit| self.worst(&unit)).reduce(worse).unwrap_or(none)
        };
        let lowest_deg = self.ability.minimum_elevation.degrees();
        let lower = |offsets: &crate::device::Offsets| {
            (offsets.minimum_elevation_deg < lowest_deg).then_some(offsets.minimum_elevation_deg)
        };
        Supervision {
            worst: worst(all),
            is_within_beam: worst(UnitPath { refracts: true, ..all }).angle
                <= self.ability.half_beam,
            causes: cause::ranked(self, unit, holds_target),
            unknown: cause::unknown(unit),
            lower_minimum_deg: unit.offsets.as_ref().and_then(lower),
        }
    }

    /// Checks the real track against the limits of the antenna. The error is the first position
    /// outside them, or the first unknown position.
    pub fn is_clear(&self, unit: &OnBoard, bounds: &Bounds) -> Result<(), NotClear> {
        let unit = UnitPath::new(unit, self);
        unit.either_way().try_for_each(|unit| path_is_clear(self.path(unit), &self.ability, bounds))
    }

    /// Returns the direction of the unit after a start at `time`: its waiting position before the
    /// window, or the satellite within it.
    pub fn start(&self, unit: &OnBoard, time: Timestamp) -> Option<AzEl> {
        UnitPath::new(unit, self).direction(time)
    }

    /// Returns the real track according to the report of the unit, from its waiting position to its
    /// end: samples are at most a second or half a degree apart.
    fn path<'a>(
        &'a self,
        unit: UnitPath<'a>,
    ) -> impl Iterator<Item = Result<Sample, NoDirection>> + 'a {
        path::samples(unit, (self.pass.target.start, self.pass.target.end))
    }

    fn worst(&self, unit: &UnitPath<'_>) -> Error {
        let errors = self.truth.iter().filter_map(|truth| {
            let deviation = unit.direction(truth.time)?.separation(truth.direction);
            Some(Error { angle: deviation, time: truth.time })
        });
        errors.reduce(worse).unwrap_or(Error { angle: Angle::ZERO, time: self.pass.target.start })
    }

    /// Returns the maximum elevation that the unit will compute for the window.
    fn highest(&self, unit: &UnitPath<'_>) -> Option<Angle> {
        let elevations = self.truth.iter().filter_map(|sample| unit.computed(sample.time));
        elevations.map(|direction| direction.elevation).reduce(|a, b| if b > a { b } else { a })
    }

    fn span_s(&self) -> f64 {
        seconds_between(self.pass.target.start, self.pass.target.end)
    }
}

fn worse(a: Error, b: Error) -> Error {
    if b.angle > a.angle { b } else { a }
}

#[cfg(test)]
mod tests;
