//! Positions of passes, and directions of their satellites.

use glam::DVec3;
use jiff::Timestamp;

use super::{Cause, CauseFit, MIN_KNOWN, SURE};
use crate::{
    astro::{
        Angle, AzEl, Site,
        time::{add_seconds, apart, seconds_between},
    },
    orbit::Propagator,
    station::Mount,
};

/// Min time between two used positions, seconds.
const STEP_S: f64 = 0.95;
/// Max number of used positions of a pass.
const MAX_POSITIONS: usize = 1500;
/// Min rate of approach of an antenna that is on its way to its satellite, degrees per second. Only
/// drives change an error this fast, and their error grows first.
const ARRIVES_DEG_S: f64 = 0.1;
/// Min visible difference of a clock or a place, seconds and km.
const MIN_CLOCK_S: f64 = 0.05;
const MIN_PLACE_KM: f64 = 0.5;
/// Kilometres in a degree of latitude.
const KM_PER_DEG: f64 = 111.2;

/// Origin of the path that an antenna followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathSource {
    /// Azel, which computed the path and sent positions.
    Azel,
    /// Unit, which computed the path without refraction.
    Unit {
        /// Clock of the unit against UTC, seconds; `None` if the unit does not report it.
        clock_ahead_s: Option<f64>,
        /// Place for which the unit computes; `None` if the unit does not report it.
        place: Option<Site>,
    },
}

/// Position with its satellite.
#[derive(Debug, Clone, Copy)]
pub(super) struct EvidencePoint<'a> {
    pub(super) propagator: &'a Propagator,
    pub(super) time: Timestamp,
    pub(super) satellite: AzEl,
    /// Direction of the satellite at the time of the unit's clock, seen from the unit's place.
    pub(super) followed: AzEl,
    pub(super) clock_late_s: f64,
    /// Place of the unit, with the refraction by which the unit leads the antenna.
    pub(super) place: Site,
    pub(super) is_airless: bool,
    /// Azimuth of `followed`, continued over north, degrees.
    pub(super) azimuth_deg: f64,
    /// Measured minus true direction, as vectors of the sphere.
    pub(super) error: DVec3,
    pub(super) measured: AzEl,
}

/// Positions of passes, and directions of their satellites.
pub struct Evidence<'a> {
    /// Points of each pass in order of time.
    pub(super) passes: Vec<Vec<EvidencePoint<'a>>>,
    sources: Vec<PathSource>,
    site: Option<Site>,
    pub(super) mount: Mount,
    pub(super) has_elevation: bool,
    half_beam: Angle,
    noise: f64,
    pub(super) only_drives: bool,
}

impl<'a> Evidence<'a> {
    /// Creates empty evidence. `has_elevation`: the antenna measures its elevation; otherwise the
    /// elevation of the satellite replaces it.
    pub fn new(mount: Mount, has_elevation: bool, half_beam: Angle) -> Self {
        Self {
            passes: Vec::new(),
            sources: Vec::new(),
            site: None,
            mount,
            has_elevation,
            half_beam,
            noise: 0.0,
            only_drives: false,
        }
    }

    /// Restricts the explanations to the drives, for an antenna with an axis that did not turn as
    /// commanded.
    #[must_use]
    pub fn only_drives(self) -> Self {
        Self { only_drives: true, ..self }
    }

    /// Adds the measured directions of one more pass, oldest first.
    #[must_use]
    pub fn with_pass(
        mut self,
        propagator: &'a Propagator,
        site: Site,
        source: PathSource,
        measured: impl Iterator<Item = (Timestamp, AzEl)>,
    ) -> Self {
        let (clock_late_s, place, is_airless) = match source {
            PathSource::Azel => (0.0, site, false),
            PathSource::Unit { clock_ahead_s, place } => {
                let late_s = clock_ahead_s.map_or(0.0, |ahead_s| -ahead_s);
                let late_s = if late_s.abs() < MIN_CLOCK_S { 0.0 } else { late_s };
                let is_elsewhere = |place: &Site| distance_km(site, *place) >= MIN_PLACE_KM;
                let place = place.filter(is_elsewhere).unwrap_or(site);
                // An unmeasured elevation has no error.
                let place = if self.has_elevation { place.airless() } else { place };
                (late_s, place, self.has_elevation)
            }
        };
        let measured: Vec<(Timestamp, AzEl)> = apart(measured, STEP_S, |(time, _)| *time).collect();
        let stride = measured.len() / MAX_POSITIONS + 1;
        let mut points: Vec<EvidencePoint<'a>> = Vec::new();
        for (time, mut measured) in measured.into_iter().step_by(stride) {
            let Ok(look) = propagator.look_from(site, time) else { continue };
            let followed = propagator.look_from(place, add_seconds(time, -clock_late_s));
            let (satellite, Ok(followed)) = (look.direction, followed) else { continue };
            let followed = followed.direction;
            if !self.has_elevation {
                measured.elevation = satellite.elevation;
            }
            let azimuth_deg = match points.last() {
                None => followed.azimuth.degrees(),
                Some(last) => {
                    let turned = (followed.azimuth - last.followed.azimuth).wrapped_180();
                    last.azimuth_deg + turned.degrees()
                }
            };
            let error = measured.to_enu() - satellite.to_enu();
            let point = EvidencePoint {
                propagator,
                time,
                satellite,
                followed,
                clock_late_s,
                place,
                is_airless,
                azimuth_deg,
                error,
                measured,
            };
            points.push(point);
        }
        let arrives = |pair: &&[EvidencePoint<'_>]| {
            let [before, after] = pair else { return false };
            let closer = before.error.length() - after.error.length();
            closer.to_degrees() > ARRIVES_DEG_S * seconds_between(before.time, after.time)
        };
        let on_its_way = points.windows(2).take_while(arrives).count();
        let points = points.split_off(on_its_way);
        // A lasting error hardly changes from one position to the next.
        let changes = points.windows(2).filter_map(|pair| match pair {
            [before, after] => Some((after.error - before.error).length_squared() / 2.0),
            _ => None,
        });
        self.noise += changes.sum::<f64>();
        self.passes.push(points);
        self.sources.push(source);
        self.site = Some(site);
        self
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &EvidencePoint<'a>> {
        self.passes.iter().flatten()
    }

    /// Returns the sum of the squares of the differences between consecutive positions.
    pub(super) fn noise(&self) -> f64 {
        self.noise
    }

    /// Returns the root mean square of a sum of squares over all positions, degrees.
    pub(super) fn rms_deg(&self, sum: f64) -> f64 {
        (sum / self.points().count().max(1) as f64).sqrt().to_degrees()
    }

    /// Returns `true` if the unit computed all paths.
    pub(super) fn is_of_unit(&self) -> bool {
        self.sources.iter().all(|source| matches!(source, PathSource::Unit { .. }))
    }

    /// Returns `true` if the unit's place is unknown for any path.
    pub(super) fn is_site_open(&self) -> bool {
        self.sources.iter().any(|source| matches!(source, PathSource::Unit { place: None, .. }))
    }

    /// Returns the fit of a model, which predicts the direction of the antenna.
    pub(super) fn fit_of(&self, model: impl Fn(&EvidencePoint<'_>) -> Option<AzEl>) -> CauseFit {
        let left = self.passes.iter().map(|points| {
            let left = points.iter().map(|point| {
                let model = model(point).unwrap_or(point.satellite);
                point.error - (model.to_enu() - point.satellite.to_enu())
            });
            left.collect()
        });
        self.fit_of_residuals(&left.collect::<Vec<Vec<DVec3>>>())
    }

    /// Returns the fit for the remainder of each position.
    pub(super) fn fit_of_residuals(&self, left: &[Vec<DVec3>]) -> CauseFit {
        let all = || left.iter().flatten();
        let count = all().count().max(1) as f64;
        let sum: f64 = all().map(|left| left.length_squared()).sum();
        let beam = self.half_beam.radians();
        let outside = all().filter(|left| left.length() > beam).count() as f64 / count;
        CauseFit { left: sum, variance: sum / (2.0 * count) * lasting(left), outside }
    }

    /// Returns the largest known part of the error besides the part that `fit` removes.
    pub(super) fn known_cause(&self, fit: CauseFit, whole: f64) -> Option<Cause> {
        // Several passes have different clocks.
        let [points] = &self.passes[..] else { return None };
        let (first, site) = (points.first()?, self.site?);
        let late_s = first.clock_late_s;
        let [north_km, east_km] = apart_km(site, first.place);
        let place = moved(site, north_km, east_km)?;
        let causes = [
            (Cause::Late { late_s }, site, late_s),
            (Cause::OtherSite { north_km, east_km }, place, 0.0),
            (Cause::Refraction, if first.is_airless { site.airless() } else { site }, 0.0),
        ];
        let parts = causes.map(|(cause, true_place, late_s)| {
            let moved = points.iter().filter_map(|point| {
                let time = add_seconds(point.time, -late_s);
                let direction = point.propagator.look_from(true_place, time).ok()?.direction;
                Some((direction.to_enu() - point.satellite.to_enu()).length_squared())
            });
            (cause, moved.sum::<f64>())
        });
        let (cause, makes) = parts.into_iter().max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (makes > SURE * fit.variance && makes > MIN_KNOWN * whole).then_some(cause)
    }
}

/// Returns a place at this distance from `site`; `None` beyond a pole.
pub(super) fn moved(site: Site, north_km: f64, east_km: f64) -> Option<Site> {
    let per_deg = KM_PER_DEG * site.latitude().radians().cos().max(1e-3);
    let latitude_deg = site.latitude().degrees() + north_km / KM_PER_DEG;
    let longitude = Angle::from_degrees(site.longitude().degrees() + east_km / per_deg);
    let moved =
        Site::new(latitude_deg, longitude.wrapped_180().degrees(), site.altitude_m()).ok()?;
    moved.with_refraction(site.refraction()).ok()
}

/// Returns the distance from `site` to `other` to the north and to the east, km.
fn apart_km(site: Site, other: Site) -> [f64; 2] {
    let per_deg = KM_PER_DEG * site.latitude().radians().cos();
    let north_deg = (other.latitude() - site.latitude()).degrees();
    let east_deg = (other.longitude() - site.longitude()).wrapped_180().degrees();
    [north_deg * KM_PER_DEG, east_deg * per_deg]
}

fn distance_km(site: Site, other: Site) -> f64 {
    let [north_km, east_km] = apart_km(site, other);
    north_km.hypot(east_km)
}

/// Returns the number of consecutive correlated positions; 1 for white noise. Computes the sum of
/// the autocorrelation up to the lag where it fades.
fn lasting(left: &[Vec<DVec3>]) -> f64 {
    let correlation = |lag: usize| -> f64 {
        let pairs = left.iter().flat_map(|left| left.iter().zip(left.iter().skip(lag)));
        pairs.map(|(before, after)| before.dot(*after)).sum()
    };
    let square = correlation(0);
    if square <= 0.0 {
        return 1.0;
    }
    let longest = left.iter().map(Vec::len).max().unwrap_or_default();
    let lags = (1..longest / 4).map(|lag| correlation(lag) / square);
    let fading = lags.take_while(|share| *share > 0.05);
    1.0 + 2.0 * fading.sum::<f64>()
}
