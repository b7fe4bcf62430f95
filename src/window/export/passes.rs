//! Lists of passes as a table, CSV, JSON or iCalendar.

mod calendar;
mod event_ids;
mod row;
mod table;
#[cfg(test)]
pub(super) mod testing;

use std::{
    borrow::Borrow,
    io::{self, Write},
};

use glam::DVec3;
use jiff::Timestamp;

pub(super) use self::event_ids::event_ids;
use self::row::Row;
use super::{EventFormat, RowFormat, rounded, rows::write_many};
use crate::{
    astro::{Air, HorizonMask, Site, frames::SiteFrame, time},
    orbit::{
        Distance, Elements, OverGround, Pass, PassSearch, PropagationError, Propagator,
        clear_stretches, passes,
    },
};

/// Sun elevation below which a sunlit satellite can be seen from the ground, degrees.
const DARK_SUN_DEG: f64 = -6.0;

/// A satellite prepared for computation and export.
#[derive(Debug, Clone)]
pub struct Satellite {
    pub elements: Elements,
    pub propagator: Propagator,
}

impl Satellite {
    pub fn new(elements: Elements) -> Result<Self, PropagationError> {
        let propagator = Propagator::new(&elements)?;
        Ok(Self { elements, propagator })
    }

    /// Returns the age of the elements at `time` in days, negative before their epoch.
    fn age_days(&self, time: Timestamp) -> f64 {
        rounded(self.elements.age_s(time) / time::DAY_S, 1e4)
    }
}

/// Max difference between the ranges, km, and range rates, km/s, of [`Propagator::over_ground`] and
/// [`Propagator::state_at`], at 70 km and beyond.
const NEAR_KM: f64 = 1e-6;
const NEAR_KM_S: f64 = 1e-8;

/// Site of the observer, and the carrier for the Doppler shift.
#[derive(Debug, Clone, Copy)]
struct View {
    site: SiteFrame,
    carrier_hz: Option<f64>,
}

impl View {
    /// Returns a distance that `written` formats exactly like the distance from
    /// [`Propagator::state_at`]. The approximation `near` suffices nearly always.
    fn distance<T: PartialEq>(
        &self,
        satellite: &Satellite,
        near: &OverGround,
        time: Timestamp,
        written: impl Fn(Distance) -> T,
    ) -> Distance {
        let distance = near.distance_from(self.site.ecef_km);
        let shifted = |side: f64| Distance {
            range_km: distance.range_km + side * NEAR_KM,
            range_rate_km_s: distance.range_rate_km_s + side * NEAR_KM_S,
        };
        if written(shifted(-1.0)) == written(shifted(1.0)) {
            return distance;
        }
        let exact = satellite.propagator.state_at(time);
        exact.map_or(distance, |exact| exact.over_ground(time).distance_from(self.site.ecef_km))
    }

    /// Returns `true` if the sky over the site is dark enough to see a satellite in sunlight.
    fn is_dark(&self, sun_ecef_km: DVec3) -> bool {
        let sun_km = self.site.enu_km(sun_ecef_km);
        sun_km.z < sun_km.length() * DARK_SUN_DEG.to_radians().sin()
    }
}

impl Borrow<Propagator> for Satellite {
    fn borrow(&self) -> &Propagator {
        &self.propagator
    }
}

/// A search for passes, and the horizon mask that cuts them.
#[derive(Debug, Clone)]
pub struct PassQuery {
    pub search: PassSearch,
    /// Horizon mask; each stretch of a pass above the mask counts as a pass.
    pub mask: Option<HorizonMask>,
}

impl PassQuery {
    /// Returns the parts of `pass` that belong to the query.
    pub fn parts(&self, propagator: &Propagator, pass: Pass) -> Vec<Pass> {
        let Some(mask) = &self.mask else { return vec![pass] };
        let mut stretches = clear_stretches(propagator, self.search.site, mask, &pass);
        stretches.retain(|stretch| stretch.max_elevation() >= self.search.floor);
        stretches
    }

    /// Returns the passes of one satellite that belong to the query, in another time window.
    fn passes_between(
        &self,
        propagator: &Propagator,
        start: Timestamp,
        end: Timestamp,
    ) -> Vec<Pass> {
        let search = PassSearch { start, end, ..self.search };
        let found = passes(propagator, &search, &|| false);
        found.into_iter().flat_map(|pass| self.parts(propagator, pass)).collect()
    }
}

#[derive(Debug, Clone, Copy)]
pub struct ExportedPass<'a> {
    pub satellite: &'a Satellite,
    pub pass: Pass,
}

/// Context of a list of passes: all data except the passes.
#[derive(Debug, Clone, Copy)]
pub struct PassList<'a> {
    pub query: &'a PassQuery,
    /// Name of the site, for calendars.
    pub place: Option<&'a str>,
    /// Carrier frequency of the Doppler shift, Hz.
    pub carrier_hz: Option<f64>,
    /// Time between the alarm of a calendar event and AOS, seconds.
    pub alarm_before_s: Option<f64>,
    /// Time stamp of the events of a calendar.
    pub now: Timestamp,
}

impl PassList<'_> {
    /// Writes the list of `rows` in their order. All times are UTC. The threads of the current
    /// rayon pool make the rows of CSV and JSON, some thousand at a time.
    pub fn write<'a>(
        &self,
        out: &mut impl Write,
        format: EventFormat,
        rows: impl Iterator<Item = ExportedPass<'a>>,
    ) -> io::Result<()> {
        match format {
            EventFormat::Table => {
                table::write(out, &rows.collect::<Vec<_>>())?;
                writeln!(out, "{}", about_elevations(self.is_apparent()))
            }
            EventFormat::Csv => self.write_rows(out, RowFormat::Csv, rows),
            EventFormat::Json => self.write_rows(out, RowFormat::Json, rows),
            EventFormat::Ics => calendar::write(out, self, &rows.collect::<Vec<_>>()),
        }
    }

    fn write_rows<'a>(
        &self,
        out: &mut impl Write,
        format: RowFormat,
        rows: impl Iterator<Item = ExportedPass<'a>>,
    ) -> io::Result<()> {
        let view = self.view();
        let columns = Row::columns(self.carrier_hz.is_some());
        let make = |rows: &[ExportedPass<'a>]| Row::all(&view, format, rows);
        write_many(out, format, ("passes", &[]), &columns, rows, make)
    }

    fn site(&self) -> Site {
        self.query.search.site
    }

    /// Returns `true` if the elevations of the passes are apparent.
    fn is_apparent(&self) -> bool {
        self.site().refraction().in_passes && is_refracted(self.site())
    }

    fn view(&self) -> View {
        View { site: self.site().into(), carrier_hz: self.carrier_hz }
    }
}

pub(super) fn is_refracted(site: Site) -> bool {
    site.refraction().air != Air::None
}

/// Returns the last line of a table.
pub(super) fn about_elevations(are_apparent: bool) -> &'static str {
    if are_apparent {
        "Elevations are apparent, with the refraction of radio waves."
    } else {
        "Elevations are geometric, without refraction."
    }
}

/// Returns the times of AOS, TCA and LOS.
fn times(pass: &Pass) -> [Timestamp; 3] {
    [pass.aos.time, pass.tca.time, pass.los.time]
}

/// Returns an azimuth, degrees, that is never written as 360.0.
pub(super) fn turn(azimuth_deg: f64) -> f64 {
    if azimuth_deg >= 359.95 { 0.0 } else { azimuth_deg }
}

/// Returns an angle in degrees, rounded to the sixth decimal.
pub(super) fn degrees(value: f64) -> f64 {
    rounded(value, 1e6)
}
