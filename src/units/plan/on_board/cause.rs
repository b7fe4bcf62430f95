//! Causes of the error of an on-board track.

use serde::{Deserialize, Serialize};

use super::{
    Judge,
    path::{UnitPath, site, turned},
};
use crate::{
    astro::{Angle, frames},
    device::{Offsets, OnBoard, Place},
};

/// Min error listed as a cause, degrees.
const WORTH_NAMING_DEG: f64 = 0.02;
/// Max ignored difference in maximum elevation, degrees: the unit reports the elevation roughly,
/// and the window is not the whole pass.
const HIGHEST_ROUGH_DEG: f64 = 3.0;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Cause {
    /// Geometric direction of the unit, below the apparent direction of the satellite.
    Refraction,
    /// Different location of the unit.
    Place {
        place: Place,
        /// Distance from the station, km.
        away_km: f64,
    },
    /// Clock of the unit ahead of UTC, seconds.
    Clock { ahead_s: f64 },
    /// Time shift of the unit's track, seconds.
    TimeOffset { offset_s: f64 },
    /// Offset of the azimuth, degrees.
    AzimuthOffset(f64),
    /// Offset of the elevation, degrees.
    ElevationOffset(f64),
    /// North of the unit that differs from the station's north.
    NorthOffset {
        /// North offset reported by the unit, degrees.
        offset_deg: f64,
        /// Difference from the north of the station, degrees.
        off_deg: f64,
    },
    /// Minimum elevation of the unit, degrees, if it is above the minimum of the pass.
    MinimumElevation(f64),
    /// Different satellite on the unit.
    OtherSatellite {
        /// Catalog number of the unit's satellite; 0 for none.
        catalog_number: u32,
        name: String,
    },
    /// Different elements on the unit, which predicts another maximum elevation.
    Elements {
        /// Maximum elevation reported by the unit, degrees.
        told_deg: f64,
        /// Maximum elevation computed from the location of the unit and the best known elements,
        /// degrees.
        expected_deg: f64,
    },
}

/// Cause, with the error that it makes alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ranked {
    pub cause: Cause,
    /// Max error that this cause makes alone; `None` if unknown.
    #[serde(rename = "off")]
    pub max_error: Option<Angle>,
}

/// Min share of an error that a cause must make to count. A cause is known by its max error in a
/// pass, so it may make less at the moment.
const MADE_SHARE: f64 = 0.7;

impl Ranked {
    /// Returns `true` if this cause can make most of an error of `deviation`, or if its own error
    /// is unknown.
    pub fn can_make(&self, deviation: Angle) -> bool {
        self.max_error.is_none_or(|own| own.degrees() >= MADE_SHARE * deviation.degrees())
    }
}

/// Value that a unit does not report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unknown {
    Place,
    Clock,
    Offsets,
    /// Age of the elements, which no unit reports.
    Elements,
}

pub(super) fn unknown(on_board: &OnBoard) -> Vec<Unknown> {
    let open = [
        (on_board.place.is_none(), Unknown::Place),
        (on_board.clock.is_none(), Unknown::Clock),
        (on_board.offsets.is_none(), Unknown::Offsets),
        (true, Unknown::Elements),
    ];
    open.into_iter().filter_map(|(is_open, problem)| is_open.then_some(problem)).collect()
}

/// Returns all causes: first those with an unknown error, then the others, the largest error first.
pub(super) fn ranked(judge: &Judge, on_board: &OnBoard, holds_target: bool) -> Vec<Ranked> {
    let right = UnitPath::right(judge);
    let alone = |unit: UnitPath<'_>| {
        let errors = unit.either_way().map(|unit| judge.worst(&unit).angle);
        errors
            .fold(Angle::ZERO, |worst, deviation| if deviation > worst { deviation } else { worst })
    };
    let mut ranked = Vec::new();
    let mut add = |cause, unit: UnitPath<'_>| {
        let difference = alone(unit);
        if difference.degrees() >= WORTH_NAMING_DEG {
            ranked.push(Ranked { cause, max_error: Some(difference) });
        }
    };
    add(Cause::Refraction, UnitPath { refracts: false, ..right });
    let ours = judge.pass.site;
    if let (Some(place), Some(site)) = (on_board.place, site(on_board, ours))
        && site != ours
    {
        let away_km = frames::site_ecef_km(site).distance(frames::site_ecef_km(ours));
        add(Cause::Place { place, away_km }, UnitPath { site, ..right });
    }
    if let Some(clock) = on_board.clock {
        let unit = UnitPath { ahead_s: clock.surely_ahead_s(), ..right };
        add(Cause::Clock { ahead_s: clock.ahead_s }, unit);
    }
    if let Some(offsets) = on_board.offsets {
        let shifted = |offsets| UnitPath { offsets, ..right };
        let none = right.offsets;
        let Offsets { time_s, azimuth_deg, elevation_deg, .. } = offsets;
        add(Cause::TimeOffset { offset_s: time_s }, shifted(Offsets { time_s, ..none }));
        add(Cause::AzimuthOffset(azimuth_deg), shifted(Offsets { azimuth_deg, ..none }));
        add(Cause::ElevationOffset(elevation_deg), shifted(Offsets { elevation_deg, ..none }));
        let minimum_elevation_deg = offsets.minimum_elevation_deg;
        let raised = shifted(Offsets { minimum_elevation_deg, ..none });
        add(Cause::MinimumElevation(minimum_elevation_deg), raised);
        let turned = turned(offsets.north_deg, judge.ability.mount);
        let (offset_deg, off_deg) = (offsets.north_deg, turned.degrees());
        add(Cause::NorthOffset { offset_deg, off_deg }, UnitPath { turned, ..right });
    }
    if holds_target {
        ranked.extend(satellite(judge, on_board));
    }
    ranked.sort_by(|a, b| {
        let weight = |ranked: &Ranked| ranked.max_error.map_or(f64::INFINITY, Angle::degrees);
        weight(b).total_cmp(&weight(a))
    });
    ranked
}

/// Returns the cause of a different satellite, or of different elements of the same one.
fn satellite(judge: &Judge, on_board: &OnBoard) -> Option<Ranked> {
    let held_satellite = on_board.satellite.as_ref()?;
    let target = &judge.pass.target;
    if held_satellite.catalog_number != target.catalog_number {
        let (catalog_number, name) = (held_satellite.catalog_number, held_satellite.name.clone());
        return Some(Ranked {
            cause: Cause::OtherSatellite { catalog_number, name },
            max_error: None,
        });
    }
    let told_deg = held_satellite.maximum_elevation_deg?;
    let (start, stop) = on_board.window?;
    let is_this =
        start.as_second() == target.start.as_second() && stop.as_second() == target.end.as_second();
    let site = site(on_board, judge.pass.site)?;
    let unit = UnitPath { site, refracts: false, ..UnitPath::right(judge) };
    let expected_deg = judge.highest(&unit).filter(|_| is_this && judge.span_s() > 0.0)?.degrees();
    let differs_deg = (told_deg - expected_deg).abs();
    (differs_deg > HIGHEST_ROUGH_DEG).then_some(Ranked {
        cause: Cause::Elements { told_deg, expected_deg },
        max_error: Some(Angle::from_degrees(differs_deg)),
    })
}
