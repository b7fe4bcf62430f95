//! Pass as seen from the site: its directions, and the times above an elevation and the horizon
//! mask.

use glam::DVec3;
use jiff::Timestamp;

use super::way::{Span, at_ms, ms};
use crate::{
    astro::{
        Angle, AzEl, HorizonMask, Site,
        frames::{EARTH_RATE_RAD_S, SiteFrame},
    },
    orbit::{Local, Pass, PassPoint, Propagator, State, clear_stretches},
    plan::Sample,
};

/// Distance between samples, seconds, and max numbers of samples.
const FINE_S: f64 = 2.0;
const COARSE_S: f64 = 20.0;
const MAX_FINE: f64 = 600.0;
const MAX_COARSE: f64 = 60.0;
/// Gravitational parameter of the Earth, km³/s².
const GRAVITY_KM3_S2: f64 = 398_600.4;
/// Max error of a direction between two known places, radians: insignificant for any beam.
const SAME_RAD: f64 = 5e-7;
/// Number of halvings that find the crossing of an elevation, to some milliseconds.
const HALVINGS: usize = 18;

/// Directions at equal intervals.
#[derive(Debug, Clone, Default)]
pub(super) struct Samples {
    pub(super) list: Vec<Sample>,
    pub(super) step_s: f64,
}

impl Samples {
    /// Returns whether the samples begin after the first of `spans`, and whether they end before
    /// the last.
    pub(super) fn leave_out(&self, spans: &[Span]) -> [bool; 2] {
        let [first, last] = [self.list.first(), self.list.last()]
            .map(|end_sample| end_sample.map(|sample| ms(sample.time)));
        let is_late = spans.first().zip(first).is_some_and(|(span, first)| span.from_ms < first);
        let is_early = spans.last().zip(last).is_some_and(|(span, last)| last < span.to_ms);
        [is_late, is_early]
    }
}

/// Few places of a pass from which the others are interpolated.
struct Nodes {
    span: Span,
    places: Vec<(i64, Local)>,
    samples: Samples,
}

/// Pass, prepared for all antennas of a site.
pub struct Sight<'a> {
    propagator: &'a Propagator,
    site: Site,
    frame: SiteFrame,
    mask: Option<&'a HorizonMask>,
    pass: &'a Pass,
    /// Name of the satellite; `None` if no unit needs it.
    name: Option<&'a str>,
    /// Nodes of the last coarse sampling.
    coarse: Option<Nodes>,
    fine: Option<([Span; 2], Samples)>,
    clear: Option<Vec<Span>>,
}

impl<'a> Sight<'a> {
    pub fn new(
        propagator: &'a Propagator,
        site: Site,
        mask: Option<&'a HorizonMask>,
        pass: &'a Pass,
    ) -> Self {
        let frame = site.into();
        Self {
            propagator,
            site,
            frame,
            mask,
            pass,
            name: None,
            coarse: None,
            fine: None,
            clear: None,
        }
    }

    /// Sets the name of the satellite, by which some units find its elements.
    #[must_use]
    pub fn named(self, name: &'a str) -> Self {
        Self { name: Some(name), ..self }
    }

    pub(super) fn name(&self) -> Option<&'a str> {
        self.name
    }

    /// Returns the span from the first to the last time at which an antenna points at `elevation`
    /// or higher; `None` if the pass stays below.
    pub(super) fn above(&self, elevation: Angle) -> Option<Span> {
        let [aos, tca, los] = [self.pass.aos, self.pass.tca, self.pass.los];
        let pointed = |point: PassPoint| self.site.pointing_of_pass(point.direction).elevation;
        if pointed(tca) < elevation {
            return None;
        }
        let top_ms = ms(tca.time);
        let end = |end_ms: i64, level: Angle| {
            if level >= elevation { end_ms } else { self.crossing(end_ms, top_ms, elevation) }
        };
        let from_ms = end(ms(aos.time), pointed(aos));
        let to_ms = end(ms(los.time), pointed(los));
        (from_ms < to_ms).then_some(Span { from_ms, to_ms })
    }

    /// Returns the apparent elevation of an object at the elevation `geometric`.
    pub(super) fn appearing_at(&self, geometric: Angle) -> Angle {
        self.site.apparent(AzEl { azimuth: Angle::ZERO, elevation: geometric }).elevation
    }

    fn crossing(&self, mut below_ms: i64, mut above_ms: i64, elevation: Angle) -> i64 {
        for _ in 0..HALVINGS {
            let middle_ms = i64::midpoint(below_ms, above_ms);
            let look = self.propagator.look_from(self.site, at_ms(middle_ms));
            // A satellite that has decayed counts as below.
            if look.is_ok_and(|look| look.direction.elevation >= elevation) {
                above_ms = middle_ms;
            } else {
                below_ms = middle_ms;
            }
        }
        // Take the upper side, because the span must not begin or end too low.
        above_ms
    }

    /// Returns the parts of `span` above the horizon mask.
    pub(super) fn clear(&mut self, span: Span) -> Vec<Span> {
        let Some(mask) = self.mask else { return vec![span] };
        let (propagator, site, pass) = (self.propagator, self.site, self.pass);
        let clear = self.clear.get_or_insert_with(|| {
            let stretches = clear_stretches(propagator, site, mask, pass);
            let span = |pass: &Pass| Span { from_ms: ms(pass.aos.time), to_ms: ms(pass.los.time) };
            stretches.iter().map(span).filter(|span| span.from_ms < span.to_ms).collect()
        });
        Span::intersections(clear, &[span])
    }

    /// Returns samples far apart, for a first check.
    pub(super) fn coarse(&mut self, span: Span) -> &Samples {
        &self.nodes(span).samples
    }

    /// Returns samples of a part of `span`, as close together as judged positions.
    pub(super) fn fine(&mut self, span: Span, part: Span) -> &Samples {
        let cached = self.fine.take().filter(|(spans, _)| *spans == [span, part]);
        let (_, samples) = cached.unwrap_or_else(|| {
            let (propagator, frame) = (self.propagator, self.frame);
            ([span, part], self.nodes(span).fine(propagator, &frame, part))
        });
        &self.fine.insert(([span, part], samples)).1
    }

    /// Does the same as [`Self::fine`] for all of `span`, each sample by the whole propagation.
    #[cfg(test)]
    pub(super) fn exact(&self, span: Span) -> Samples {
        let (times, step_s) = times(span, FINE_S, MAX_FINE);
        let sample = |time_ms: i64| {
            let look = self.propagator.look_from(self.site, at_ms(time_ms)).ok()?;
            Some(Sample { time: at_ms(time_ms), direction: look.direction })
        };
        Samples { list: times.filter_map(sample).collect(), step_s }
    }

    fn nodes(&mut self, span: Span) -> &Nodes {
        let cached = self.coarse.take().filter(|nodes| nodes.span == span);
        let nodes = cached.unwrap_or_else(|| Nodes::new(self.propagator, &self.frame, span));
        self.coarse.insert(nodes)
    }
}

impl Nodes {
    fn new(propagator: &Propagator, site: &SiteFrame, span: Span) -> Self {
        let (times, step_s) = times(span, COARSE_S, MAX_COARSE);
        let times: Vec<i64> = times.collect();
        let stamps: Vec<Timestamp> = times.iter().map(|time_ms| at_ms(*time_ms)).collect();
        let states = times.iter().zip(&stamps).zip(propagator.states_at(&stamps));
        let place = |((time_ms, time), state): ((&i64, &Timestamp), Option<State>)| {
            Some((*time_ms, state?.local(site, *time)))
        };
        let places: Vec<(i64, Local)> = states.filter_map(place).collect();
        let list = places
            .iter()
            .map(|(time_ms, place)| sample(site, *time_ms, place.position_km))
            .collect();
        Self { span, places, samples: Samples { list, step_s } }
    }

    fn fine(&self, propagator: &Propagator, site: &SiteFrame, part: Span) -> Samples {
        let (times, step_s) = times(self.span, FINE_S, MAX_FINE);
        let times = times.filter(|at_ms| (part.from_ms..=part.to_ms).contains(at_ms));
        let centre_km = site.to_enu * site.ecef_km;
        let pairs = self.places.iter().zip(self.places.iter().skip(1));
        let mut cubics = pairs.map(|(start, end)| Cubic::new(*start, *end, centre_km)).peekable();
        let list = times.filter_map(|time_ms| {
            while cubics.next_if(|cubic| cubic.to_ms < time_ms).is_some() {}
            let interpolated = cubics.peek().and_then(|cubic| cubic.position_km(time_ms));
            let exact = || place(propagator, site, time_ms).map(|place| place.position_km);
            Some(sample(site, time_ms, interpolated.or_else(exact)?))
        });
        Samples { list: list.collect(), step_s }
    }
}

fn place(propagator: &Propagator, site: &SiteFrame, time_ms: i64) -> Option<Local> {
    let time = at_ms(time_ms);
    Some(propagator.state_at(time).ok()?.local(site, time))
}

fn sample(site: &SiteFrame, time_ms: i64, position_km: DVec3) -> Sample {
    Sample { time: at_ms(time_ms), direction: site.direction(position_km) }
}

/// Returns the times of samples and the seconds between them.
fn times(span: Span, min_s: f64, max: f64) -> (impl Iterator<Item = i64>, f64) {
    let seconds = span.length_ms() as f64 / 1000.0;
    let steps = (seconds / min_s.max(seconds / max)).ceil().max(1.0);
    let step_s = seconds / steps;
    let time = move |step: i64| span.from_ms + (step as f64 * step_s * 1000.0).round() as i64;
    ((0..=steps as i64).map(time), step_s)
}

/// Path between two places, by the cubic through their positions and velocities.
struct Cubic {
    from_ms: i64,
    to_ms: i64,
    ends: [Local; 2],
    /// `true` if the two places are close enough for the cubic.
    is_exact: bool,
}

impl Cubic {
    /// Creates the cubic as seen from a site at `centre_km` from the centre of the Earth.
    fn new((from_ms, a): (i64, Local), (to_ms, b): (i64, Local), centre_km: DVec3) -> Self {
        let ends = [a, b];
        let radius_km = ends.map(|local| (local.position_km + centre_km).length());
        let radius_km = radius_km[0].min(radius_km[1]);
        // The error of a cubic depends on the fourth derivative. This estimate assumes a circular
        // orbit over ground that turns the other way.
        let rate_rad_s = (GRAVITY_KM3_S2 / radius_km.powi(3)).sqrt() + EARTH_RATE_RAD_S;
        let span_s = (to_ms - from_ms) as f64 / 1000.0;
        let off_km = (span_s * rate_rad_s).powi(4) / 384.0 * radius_km;
        let near_km = a.position_km.length().min(b.position_km.length());
        Self { from_ms, to_ms, ends, is_exact: off_km <= SAME_RAD * near_km }
    }

    fn position_km(&self, at_ms: i64) -> Option<DVec3> {
        if !self.is_exact || !(self.from_ms..=self.to_ms).contains(&at_ms) {
            return None;
        }
        let [a, b] = self.ends;
        let span_s = (self.to_ms - self.from_ms) as f64 / 1000.0;
        let share = (at_ms - self.from_ms) as f64 / 1000.0 / span_s;
        let rest = 1.0 - share;
        let position_km = a.position_km * (rest * rest * (1.0 + 2.0 * share))
            + b.position_km * (share * share * (1.0 + 2.0 * rest))
            + (a.velocity_km_s * rest - b.velocity_km_s * share) * (share * rest * span_s);
        Some(position_km)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::time::add_seconds,
        orbit::{PassSearch, bundled, passes},
        plan::schedule::testing::noon,
        station::Station,
    };

    #[test]
    fn between_few_states_every_satellite_is_where_its_orbit_is() {
        let (station, catalog) = (Station::default(), bundled().unwrap());
        let end = add_seconds(noon(), 86_400.0);
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            ..PassSearch::new(station.site, noon(), end)
        };
        let (mut compared, mut worst_deg) = (0, 0.0_f64);
        // Each orbit of the catalogue represents some hundred others.
        for elements in catalog.iter().step_by(97) {
            let Ok(propagator) = Propagator::new(elements) else { continue };
            for pass in passes(&propagator, &search, &|| false).iter().take(2) {
                let mut sight = Sight::new(&propagator, station.site, None, pass);
                let span = Span { from_ms: ms(pass.aos.time), to_ms: ms(pass.los.time) };
                let exact = sight.exact(span);
                let fine = sight.fine(span, span);
                assert_eq!(fine.list.len(), exact.list.len());
                for (fine, exact) in fine.list.iter().zip(&exact.list) {
                    assert_eq!(fine.time, exact.time);
                    let off_deg = fine.direction.separation(exact.direction).degrees();
                    let name = elements.short_name();
                    assert!(off_deg < 1e-3, "{name} {}: {off_deg}", exact.time);
                    worst_deg = worst_deg.max(off_deg);
                    compared += 1;
                }
            }
        }
        println!("{compared} directions, at most {worst_deg:.6} degrees apart");
        assert!(compared > 10_000, "{compared}");
    }
}
