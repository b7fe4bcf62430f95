//! Simulated units in memory, set up like the antennas of a station.

use std::{collections::BTreeMap, ops::RangeInclusive, sync::Arc};

use crate::{
    astro::{Angle, Site, xy_mount::axes_from_azel},
    clock::Clock,
    controller::{
        rc2000c::{BAUD, BUS_ADDRESS, Calibration},
        rotator_genius::Rotators,
        satrak::ELEMENT_FILE,
    },
    device::{CountLine, CountPoint},
    orbit::Elements,
    protocol::{
        rc2000c::Address,
        rotator_genius::{RotatorKind, WholeDegrees},
    },
    sim::{
        InMemory, Mechanics, rc2000c,
        rotator_genius::{self, RotatorOptions},
        satrak,
    },
    station::{Antenna, Mount},
};

/// Common properties of a station's units.
pub struct Surroundings<'a> {
    pub site: Site,
    pub clock: Clock,
    /// Elements of a unit that tracks on its own.
    pub elements: &'a [Elements],
    /// Imperfections of all axes.
    pub mechanics: Mechanics,
    /// Seed of all randomness.
    pub seed: u64,
}

/// Constructor of a simulated unit for `antenna`, which starts at the park position. It enters the
/// unit's element file in `antenna` if none is set.
pub(super) type Make = fn(&mut Antenna, &Surroundings<'_>) -> Arc<dyn InMemory>;

pub(super) fn satrak(antenna: &mut Antenna, surroundings: &Surroundings<'_>) -> Arc<dyn InMemory> {
    if antenna.connection.text(&ELEMENT_FILE).is_empty() {
        // `put` cannot fail: the setting accepts any text.
        antenna.connection.put(&ELEMENT_FILE, satrak::BUNDLED_FILE).ok();
    }
    let file = antenna.connection.text(&ELEMENT_FILE).to_owned();
    let base = satrak::Options::new(surroundings.site, surroundings.clock.utc());
    let (lower_axis, ends_deg) = match antenna.mount {
        Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } => {
            (Angle::from_degrees(lower_axis_azimuth_deg), [travel_from_deg, travel_to_deg])
        }
        Mount::AzEl { .. } => (base.lower_axis, base.ends_deg),
    };
    let options = satrak::Options {
        elements: BTreeMap::from([(file, surroundings.elements.to_vec())]),
        lower_axis,
        ends_deg,
        full_rate_deg_s: antenna.limits.maximum_rate_deg_s,
        minimum_elevation_deg: antenna.limits.minimum_elevation_deg,
        mechanics: surroundings.mechanics,
        seed: surroundings.seed,
        ..base
    };
    let unit = satrak::Control::on_clock(&options, surroundings.clock.clone());
    let axes = axes_from_azel(antenna.park_direction(), lower_axis);
    unit.place([90.0 + axes.lower.degrees(), 90.0 + axes.upper.degrees()]);
    Arc::new(unit)
}

pub(super) fn genius(antenna: &mut Antenna, surroundings: &Surroundings<'_>) -> Arc<dyn InMemory> {
    let [azimuth_deg, elevation_deg] = antenna.mount.travel_deg();
    let full_rate_deg_s = antenna.limits.maximum_rate_deg_s;
    let park = antenna.park;
    // An operator sets a smaller offset for a slow rotator, because it coasts less.
    let stop_offset_deg = (full_rate_deg_s / 2.0).round().min(2.0) as u8;
    let (limit_ccw, limit_cw) = ends_of_circle(azimuth_deg);
    let azimuth = RotatorOptions {
        position: whole(park.azimuth_deg),
        limit_cw,
        limit_ccw,
        stop_offset_deg,
        full_rate_deg_s,
        ..RotatorOptions::default()
    };
    let elevation = RotatorOptions {
        kind: RotatorKind::Elevation,
        position: whole(park.elevation_deg),
        limit_cw: whole(elevation_deg.1),
        limit_ccw: whole(elevation_deg.0.max(0.0)),
        stop_offset_deg,
        full_rate_deg_s,
        ..RotatorOptions::elevation()
    };
    let other = RotatorOptions { name: "Other".to_owned(), ..RotatorOptions::default() };
    let rotators = match Rotators::from_connection(&antenna.connection) {
        Rotators::Pair => [azimuth, elevation],
        Rotators::First => [azimuth, other],
        Rotators::Second => [other, azimuth],
    };
    let options = rotator_genius::Options {
        rotators,
        mechanics: surroundings.mechanics,
        seed: surroundings.seed,
        ..rotator_genius::Options::default()
    };
    Arc::new(rotator_genius::Control::on_clock(&options, surroundings.clock.clone()))
}

fn whole(degrees: f64) -> WholeDegrees {
    WholeDegrees::nearest(degrees.clamp(0.0, 360.0)).unwrap_or(WholeDegrees::saturating(0))
}

/// Returns the ends of a travel on a circle of 0 to 360 degrees, the counter-clockwise end first.
/// Equal ends mean a whole turn.
fn ends_of_circle((from_deg, to_deg): (f64, f64)) -> (WholeDegrees, WholeDegrees) {
    let start = from_deg.rem_euclid(360.0);
    let span = (to_deg - from_deg).min(360.0);
    let end = start + span;
    (whole(start), whole(if end > 360.0 { end - 360.0 } else { end }))
}

pub(super) fn rc2000c(antenna: &mut Antenna, surroundings: &Surroundings<'_>) -> Arc<dyn InMemory> {
    let connection = &antenna.connection;
    let calibration = Calibration::from_connection(connection);
    let base = rc2000c::Options::default();
    let [azimuth_deg, elevation_deg] = antenna.mount.travel_deg();
    let rate_deg_s = antenna.limits.maximum_rate_deg_s;
    let azimuth = counted(&calibration.azimuth, azimuth_deg, rate_deg_s);
    let elevation = counted(&calibration.elevation, elevation_deg, rate_deg_s);
    let address = u8::try_from(connection.whole(&BUS_ADDRESS)).ok();
    let options = rc2000c::Options {
        address: address.and_then(|number| Address::new(number).ok()).unwrap_or(base.address),
        baud: connection.whole(&BAUD),
        azimuth: azimuth.unwrap_or(base.azimuth),
        elevation: elevation.unwrap_or(base.elevation),
        mechanics: surroundings.mechanics,
        seed: surroundings.seed,
        ..base
    };
    let unit = rc2000c::Control::on_clock(&options, surroundings.clock.clone());
    let counts = |points: &[CountPoint], deg| CountLine::from_points(points).ok()?.counts(deg);
    let park = antenna.park;
    let azimuth = counts(&calibration.azimuth, park.azimuth_deg);
    let elevation = counts(&calibration.elevation, park.elevation_deg);
    if let Some(place) = azimuth.zip(elevation) {
        unit.place(place.into());
    }
    Arc::new(unit)
}

/// Returns an axis whose sensor has these points; `None` for an uncalibrated axis.
fn counted(
    points: &[CountPoint],
    (from_deg, to_deg): (f64, f64),
    rate_deg_s: f64,
) -> Option<rc2000c::AxisOptions> {
    let line = CountLine::from_points(points).ok()?;
    let (start, end) = (line.counts(from_deg)?, line.counts(to_deg)?);
    let travel: RangeInclusive<u16> = start.min(end)..=start.max(end);
    let counts_per_deg = f64::from(start.abs_diff(end)) / (to_deg - from_deg);
    let full_rate_counts_s = rate_deg_s * counts_per_deg;
    Some(rc2000c::AxisOptions { travel, full_rate_counts_s, counts_per_deg })
}
