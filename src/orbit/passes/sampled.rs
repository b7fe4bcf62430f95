//! Passes of all other orbits: far, eccentric or about to decay.
//!
//! The search takes exact states along the orbit, closer together where the satellite is faster.
//! Between two states, a polynomial of fifth degree describes each coordinate of the satellite,
//! seen from the turning site. The polynomial matches the positions, velocities and accelerations
//! of both states. Evaluated six times a step, it shows where the height (the sine of the
//! elevation) turns. Exact states correct the extremes that matter. Between two neighbouring
//! extremes, the height crosses the horizon once or not at all.

use super::{
    compact::CompactPass,
    local_series::{Bend, GRAVITY_KM3_S2, Height, LocalSeries, LocalState},
    sighting::Sighting,
    track::Track,
};
use crate::{astro::frames::EARTH_RATE_RAD_S, simd::Vector};

/// Step in units of sqrt(r³/mu), the time in which a circular orbit advances by a radian.
const STEP: f64 = 1.1;
/// Min step, seconds. No orbit above the ground needs a shorter step. Without a minimum, the search
/// would never leave a state near the centre of the Earth.
const MIN_STEP_S: f64 = 60.0;
/// Number of looks per step.
const LOOKS: u32 = 6;
/// Max difference between places of the polynomial and true places, as a share of their distance
/// from the centre of the Earth. Measured at eccentricities up to 0.9: 0.015.
const PLACE_MARGIN: f64 = 0.02;
/// Factor of the margin with each halving of a step: the error is of the sixth order.
const HALVED: f64 = 1.0 / 64.0;
/// Min distance between satellite and site in a step, in multiples of the margin. Closer steps are
/// halved, because the polynomial may pass on the other side of the zenith, or below the site.
const NEAR: f64 = 4.0;
/// Step to the next attempt after an instant without a state, seconds.
const GAP_STEP_S: f64 = 60.0;
/// Accuracy of the last state of an orbit, seconds.
const END_TOLERANCE_S: f64 = 1e-3;

/// Adds all passes of the window, in order.
pub(super) fn passes(
    track: &Track<'_>,
    cancelled: &dyn Fn() -> bool,
    found: &mut Vec<CompactPass>,
) {
    let mut finder = Finder { track, last: None, guess_s: None, open: None, found };
    let end_s = track.window.length_s;
    let mut from_s = 0.0;
    while from_s <= end_s && !cancelled() {
        if let Some(first) = track.series(from_s) {
            let last_s = finder.stretch(&first, cancelled);
            if last_s >= end_s || track.has_decayed_at(last_s + END_TOLERANCE_S) {
                break;
            }
            from_s = last_s;
        } else if track.has_decayed_at(from_s) {
            break;
        }
        from_s += GAP_STEP_S;
    }
}

/// Builder of passes from the extremes of the height, in order of time.
struct Finder<'a> {
    track: &'a Track<'a>,
    /// Last extreme, or the start.
    last: Option<Extreme>,
    /// Time at which the polynomial has crossed the horizon since the last extreme.
    guess_s: Option<f64>,
    open: Option<OpenPass>,
    found: &'a mut Vec<CompactPass>,
}

#[derive(Clone, Copy)]
struct Extreme {
    at_s: f64,
    is_up: bool,
}

/// A pass without a known end.
struct OpenPass {
    aos: LocalState,
    highest: LocalState,
    starts_before: bool,
}

impl Finder<'_> {
    /// Follows the satellite from `first` to the end of the window or of its states. Returns the
    /// time of that end.
    fn stretch(&mut self, first: &LocalSeries, cancelled: &dyn Fn() -> bool) -> f64 {
        let end_s = self.track.window.length_s;
        self.begin(first.place(0.0));
        let mut here = *first;
        while here.at_s < end_s && !cancelled() {
            let next_s = (here.at_s + step_s(&here)).min(end_s);
            if let Some(next) = self.track.series(next_s) {
                self.span(&here, &next);
                here = next;
            } else {
                let last = self.last_state(here, next_s);
                self.span(&here, &last);
                here = last;
                break;
            }
        }
        self.end(here.place(0.0));
        here.at_s
    }

    /// Returns the last state between a time with a state and a time without one.
    fn last_state(&self, good: LocalSeries, bad_s: f64) -> LocalSeries {
        let (mut good, mut bad_s) = (good, bad_s);
        while bad_s - good.at_s > END_TOLERANCE_S {
            let middle_s = f64::midpoint(good.at_s, bad_s);
            match self.track.series(middle_s) {
                Some(series) => good = series,
                None => bad_s = middle_s,
            }
        }
        good
    }

    fn is_up(&self, sine: f64) -> bool {
        sine >= self.track.window.sin_aos_elevation
    }

    fn begin(&mut self, first: LocalState) {
        let is_up = self.is_up(first.height.sine);
        self.last = Some(Extreme { at_s: first.at_s, is_up });
        self.guess_s = None;
        self.open = is_up.then_some(OpenPass { aos: first, highest: first, starts_before: true });
    }

    /// Searches for extremes between two states.
    fn span(&mut self, start: &LocalSeries, end: &LocalSeries) {
        self.span_within(start, end, PLACE_MARGIN);
    }

    fn span_within(&mut self, start: &LocalSeries, end: &LocalSeries, place_margin: f64) {
        let curve = Quintic::new(start, end, place_margin);
        let mut looks = (0..=LOOKS).map(|index| curve.look(f64::from(index) / f64::from(LOOKS)));
        let is_near = looks.any(|look| look.range_km < NEAR * self.off_km(&look));
        if is_near
            && place_margin > HALVED * HALVED
            && let Some(middle) = self.track.series(f64::midpoint(start.at_s, end.at_s))
        {
            self.span_within(start, &middle, place_margin * HALVED);
            self.span_within(&middle, end, place_margin * HALVED);
            return;
        }
        let mut a = curve.look(0.0);
        for index in 1..=LOOKS {
            let b = curve.look(f64::from(index) / f64::from(LOOKS));
            // Two extremes close together show at the minimum of the rate between them.
            let hidden = (a.height.rate > 0.0) == (b.height.rate > 0.0)
                && a.height.rate * a.height.curve < 0.0
                && b.height.rate * b.height.curve > 0.0;
            if hidden {
                let share = a.height.curve / (a.height.curve - b.height.curve);
                let middle = curve.look(a.share + share * (b.share - a.share));
                self.advance(&curve, a, middle);
                a = middle;
            }
            self.advance(&curve, a, b);
            a = b;
        }
    }

    fn advance(&mut self, curve: &Quintic, a: HeightLook, b: HeightLook) {
        if (a.height.rate > 0.0) == (b.height.rate > 0.0) {
            self.note_crossing(a, b);
        } else {
            let extreme = curve.extreme(a, b);
            self.note_crossing(a, extreme);
            self.turn(extreme, if a.height.rate > 0.0 { Bend::Crest } else { Bend::Trough });
            self.note_crossing(extreme, b);
        }
    }

    /// Returns the max distance of the satellite from a place of the polynomial, km.
    fn off_km(&self, look: &HeightLook) -> f64 {
        look.place_margin * self.track.window.radius_of_place_km(look.enu_km)
    }

    fn note_crossing(&mut self, a: HeightLook, b: HeightLook) {
        let spare = |look: &HeightLook| look.height.sine - self.track.window.sin_aos_elevation;
        let (before, after) = (spare(&a), spare(&b));
        if (before >= 0.0) != (after >= 0.0) {
            self.guess_s = Some(a.at_s + (b.at_s - a.at_s) * before / (before - after));
        }
    }

    /// Processes an extreme of the polynomial.
    fn turn(&mut self, look: HeightLook, bend: Bend) {
        let spare = look.height.sine - self.track.window.sin_aos_elevation;
        // The direction of a satellite that passes close by may differ widely from the polynomial.
        let is_far = spare.abs() * look.range_km > self.off_km(&look);
        if is_far && (spare < 0.0 || bend == Bend::Trough) {
            self.reach(Extreme { at_s: look.at_s, is_up: spare > 0.0 });
            return;
        }
        // Within a step of the polynomial, a nearly constant height turns far from its true
        // extreme.
        let (near_s, far_s) = (look.spacing_s, look.spacing_s * f64::from(LOOKS));
        let by_newton = self.track.extreme(look.at_s, near_s, bend).map(|(_, place)| place);
        let by_halves = |max_s| self.track.extreme_by_halves(look.at_s, max_s, bend);
        let since_s = self.last.map_or(f64::NEG_INFINITY, |last| last.at_s);
        let is_next = |place: &LocalState| place.at_s > since_s;
        let exact =
            by_newton.or_else(|| by_halves(near_s)).or_else(|| by_halves(far_s).filter(is_next));
        if let Some(place) = exact.or_else(|| self.track.place(look.at_s)) {
            self.reach(Extreme { at_s: place.at_s, is_up: self.is_up(place.height.sine) });
            self.raise(place);
        }
    }

    /// Keeps the highest point of the pass.
    fn raise(&mut self, place: LocalState) {
        let end_s = self.track.window.length_s;
        if let Some(open) = &mut self.open
            && place.height.sine > open.highest.height.sine
            && (0.0..=end_s).contains(&place.at_s)
        {
            open.highest = place;
        }
    }

    /// Advances to the next extreme, across the horizon if the horizon lies in between.
    fn reach(&mut self, next: Extreme) {
        let guess_s = self.guess_s.take();
        let Some(last) = self.last.replace(next).filter(|last| last.is_up != next.is_up) else {
            return;
        };
        let guess_s = guess_s.unwrap_or(f64::midpoint(last.at_s, next.at_s));
        let (below, above) = if next.is_up { (last, next) } else { (next, last) };
        let Some(crossing) = self.track.crossing(below.at_s, guess_s, above.at_s) else {
            return;
        };
        if next.is_up {
            self.open = Some(OpenPass { aos: crossing, highest: crossing, starts_before: false });
        } else if let Some(open) = self.open.take() {
            self.close(&open, &crossing, false);
        }
    }

    fn end(&mut self, last: LocalState) {
        self.reach(Extreme { at_s: last.at_s, is_up: self.is_up(last.height.sine) });
        self.raise(last);
        if let Some(open) = self.open.take() {
            self.close(&open, &last, true);
        }
    }

    fn close(&mut self, open: &OpenPass, los: &LocalState, ends_after: bool) {
        let OpenPass { aos, highest, starts_before } = open;
        if highest.height.sine >= self.track.window.sin_floor {
            let sightings = [aos, highest, los].map(Sighting::new);
            self.found.push(self.track.pass(sightings.each_ref(), [*starts_before, ends_after]));
        }
    }
}

/// Returns the time to the next state, seconds.
fn step_s(series: &LocalSeries) -> f64 {
    let (r, v) = (series.state.position_km, series.state.velocity_km_s);
    let radius_km = r.length();
    let at_radius =
        |radius_km: f64| (STEP * (radius_km.powi(3) / GRAVITY_KM3_S2).sqrt()).max(MIN_STEP_S);
    let level = at_radius(radius_km);
    // On the way down, the satellite gets faster within the step. The step is therefore the step of
    // the lower place half a step later.
    let lower_km = radius_km + (0.5 * level * r.dot(v) / radius_km).min(0.0);
    let inverse_axis = 2.0 / radius_km - v.length_squared() / GRAVITY_KM3_S2;
    let parameter_km = r.cross(v).length_squared() / GRAVITY_KM3_S2;
    let eccentricity = (1.0 - parameter_km * inverse_axis).max(0.0).sqrt();
    let perigee_km = parameter_km / (1.0 + eccentricity);
    level.min(at_radius(lower_km.max(perigee_km))).min(STEP / EARTH_RATE_RAD_S)
}

/// Polynomials of fifth degree between two states.
struct Quintic {
    from_s: f64,
    span_s: f64,
    place_margin: f64,
    coefficients: [Vector<f64>; 6],
}

/// The height of the polynomial at one instant.
#[derive(Clone, Copy)]
struct HeightLook {
    share: f64,
    at_s: f64,
    enu_km: Vector<f64>,
    range_km: f64,
    place_margin: f64,
    height: Height,
    /// Time between two looks, seconds.
    spacing_s: f64,
}

impl Quintic {
    fn new(start: &LocalSeries, end: &LocalSeries, place_margin: f64) -> Self {
        let span_s = end.at_s - start.at_s;
        let (v0, v1) = (start.velocity * span_s, end.velocity * span_s);
        let half_square = 0.5 * span_s * span_s;
        let (a0, a1) = (start.acceleration * half_square, end.acceleration * half_square);
        // The vectors are the difference between the end and the parabola of the start.
        let position = end.position - (start.position + v0 + a0);
        let velocity = v1 - (v0 + a0 * 2.0);
        let acceleration = a1 - a0;
        let coefficients = [
            start.position,
            v0,
            a0,
            position * 10.0 - velocity * 4.0 + acceleration,
            velocity * 7.0 - position * 15.0 - acceleration * 2.0,
            position * 6.0 - velocity * 3.0 + acceleration,
        ];
        Self { from_s: start.at_s, span_s, place_margin, coefficients }
    }

    /// Returns the look at a `share` of the step, 0 to 1.
    fn look(&self, share: f64) -> HeightLook {
        let zero = [Vector::new(0.0, 0.0, 0.0); 3];
        let [q, v, a] = self.coefficients.iter().rev().fold(zero, |[q, v, a], coefficient| {
            [q * share + *coefficient, v * share + q, a * share + v]
        });
        let (inverse_s, range_km) = (1.0 / self.span_s, q.length());
        HeightLook {
            share,
            at_s: self.from_s + share * self.span_s,
            enu_km: q,
            range_km,
            place_margin: self.place_margin,
            height: Height::new(q, range_km, v * inverse_s, a * (2.0 * inverse_s * inverse_s)),
            spacing_s: self.span_s / f64::from(LOOKS),
        }
    }

    /// Returns the extreme between two looks whose rates differ in sign.
    fn extreme(&self, a: HeightLook, b: HeightLook) -> HeightLook {
        let (mut a, mut b) = (a, b);
        let mut middle = a;
        for round in 0..8 {
            let secant = a.height.rate / (a.height.rate - b.height.rate);
            // An occasional halving keeps both ends moving.
            let part = if round % 3 == 2 { 0.5 } else { secant };
            middle = self.look(a.share + part * (b.share - a.share));
            if (middle.height.rate > 0.0) == (a.height.rate > 0.0) {
                a = middle;
            } else {
                b = middle;
            }
        }
        middle
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use crate::{
        PassSearch, Propagator,
        astro::{Angle, Site, time},
        bundled, passes, passes_and_effort, read_elements,
    };

    /// The test uses orbits whose perigee passes a site more closely than the distance of their
    /// states. The greatest elevation comes from states a tenth of a second apart.
    #[test]
    fn the_greatest_elevation_of_a_close_fly_by_is_exact() {
        let epoch: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let mut dice = 12_345_u32;
        let mut roll = |min: f64, max: f64| {
            dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            min + f64::from(dice >> 8) / f64::from(1_u32 << 24) * (max - min)
        };
        let (mut nearest_km, mut high) = (f64::MAX, 0);
        for _ in 0..if cfg!(debug_assertions) { 120 } else { 4000 } {
            let (eccentricity, perigee_km) = (roll(0.1, 0.75), roll(80.0, 140.0));
            let axis_km = (6378.135 + perigee_km) / (1.0 - eccentricity);
            let motion = (398_600.8 / axis_km.powi(3)).sqrt() * 86_400.0 / std::f64::consts::TAU;
            let text = serde_json::json!([{
                "NORAD_CAT_ID": 1, "EPOCH": "2026-08-12T00:00:00", "MEAN_MOTION": motion,
                "ECCENTRICITY": eccentricity, "INCLINATION": roll(5.0, 80.0),
                "RA_OF_ASC_NODE": roll(0.0, 360.0), "ARG_OF_PERICENTER": roll(0.0, 360.0),
                "MEAN_ANOMALY": 330.0, "BSTAR": 0
            }]);
            let elements = read_elements(&text.to_string()).elements.remove(0);
            let propagator = Propagator::new(&elements).unwrap();
            // Perigee comes after 30 degrees of mean anomaly.
            let perigee = time::add_seconds(epoch, elements.period_s() / 12.0);
            let below = |offset_s: f64| {
                let time = time::add_seconds(perigee, offset_s);
                let state = propagator.state_at(time).unwrap();
                let p = state.position_km;
                let longitude = p.y.atan2(p.x) - time::gmst(time).radians();
                let latitude = (p.z / p.length()).asin().to_degrees();
                Site::new(latitude, Angle::from_radians(longitude).wrapped_180().degrees(), 4500.0)
            };
            let site = below(roll(-60.0, 60.0)).unwrap().airless();
            let end = time::add_seconds(perigee, 1500.0);
            let search = PassSearch::new(site, epoch, end);
            let look = |offset_s: f64| {
                let utc = time::add_seconds(perigee, offset_s);
                propagator.look_from(site, utc).unwrap()
            };
            let looks: Vec<_> = (-3000..3000).map(|tenth| look(f64::from(tenth) / 10.0)).collect();
            let highest =
                looks.iter().map(|look| look.direction.elevation_deg()).fold(f64::MIN, f64::max);
            nearest_km = looks.iter().map(|look| look.range_km).fold(nearest_km, f64::min);
            // A pass that hardly reaches an elevation is found from that elevation as from the
            // horizon.
            for aos_deg in [0.0, 30.0, 60.0, highest - 0.1] {
                let aos_elevation = Angle::from_degrees(aos_deg);
                let found = passes(&propagator, &PassSearch { aos_elevation, ..search }, &|| false);
                let tops = found.iter().map(|pass| pass.max_elevation().degrees());
                let reported = tops.fold(f64::MIN, f64::max);
                if highest < aos_deg {
                    continue;
                }
                high += u32::from(aos_deg >= 30.0);
                // A tenth of a second from the crest, a satellite at 100 km has moved by 0.4
                // degrees. It is below the crest by the square of that angle.
                assert!(
                    reported > highest - 1e-4 && reported < highest + 0.5,
                    "{reported} {highest} from {aos_deg}: {site:?} {text}"
                );
            }
        }
        assert!(high > 100, "{high}");
        assert!(nearest_km < 120.0, "{nearest_km}");
    }

    #[test]
    fn the_greatest_elevation_of_a_geosynchronous_satellite_is_exact_and_takes_few_states() {
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let site = Site::new(41.02, 29.17, 100.0).unwrap().airless();
        let search = PassSearch::new(site, start, time::add_seconds(start, time::DAY_S));
        let catalog = bundled().unwrap();
        for number in [35_696, 44_637, 45_985, 50_002, 53_813] {
            let propagator = Propagator::new(catalog.get(number).unwrap()).unwrap();
            let (found, effort) = passes_and_effort(&propagator, &search, &|| false);
            assert!(found.len() == 1 && effort < 20, "{number}: {effort} states, {found:?}");
            let elevation = |half_minute: u32| {
                let time = time::add_seconds(start, 30.0 * f64::from(half_minute));
                propagator.look_from(site, time).unwrap().direction.elevation.radians()
            };
            let highest = (0..2880).map(elevation).fold(f64::MIN, f64::max);
            let reported = found[0].max_elevation().radians();
            assert!((reported - highest).abs() < 3e-7, "{number}: {reported} {highest}");
        }
    }

    /// The test uses geosynchronous satellites over sites all round the Earth, whose elevation
    /// hardly changes.
    #[test]
    fn the_greatest_elevation_of_any_geosynchronous_satellite_is_exact() {
        let start: Timestamp = "2026-08-10T05:03:34Z".parse().unwrap();
        let (mut worst, mut count) = (0.0_f64, 0);
        let catalog = bundled().unwrap();
        let geosynchronous =
            |elements: &&crate::Elements| (85_000.0..87_500.0).contains(&elements.period_s());
        let every = if cfg!(debug_assertions) { 12 } else { 1 };
        for (number, elements) in catalog.iter().filter(geosynchronous).enumerate().step_by(every) {
            let Ok(propagator) = Propagator::new(elements) else { continue };
            for share in 0..3_u32 {
                let below = propagator.state_at(start).unwrap().sub_point(start).point;
                let index = 3 * number as u32 + share;
                let latitude = f64::from(index * 37 % 130) - 65.0;
                let east = below.longitude.degrees() + f64::from(index * 53 % 90) - 45.0;
                let longitude = Angle::from_degrees(east).wrapped_180().degrees();
                let site = Site::new(latitude, longitude, 2850.0).unwrap().airless();
                let hours = 6.0 + f64::from(index * 29 % 67);
                let begin = time::add_seconds(start, f64::from(index * 997 % 86_400));
                let end = time::add_seconds(begin, hours * 3600.0);
                let aos_elevation = Angle::from_degrees(10.0);
                let search = PassSearch { aos_elevation, ..PassSearch::new(site, begin, end) };
                let found = passes(&propagator, &search, &|| false);
                let steps = (hours * 12.0) as u32;
                let times =
                    (0..=steps).map(|step| time::add_seconds(begin, f64::from(step) * 300.0));
                let elevation_deg = |time: Timestamp| {
                    propagator.look_from(site, time).unwrap().direction.elevation_deg()
                };
                for pass in found {
                    let in_pass =
                        times.clone().filter(|utc| (pass.aos.time..=pass.los.time).contains(utc));
                    let highest = in_pass.map(elevation_deg).fold(f64::MIN, f64::max);
                    let low = highest - pass.max_elevation().degrees();
                    worst = worst.max(low);
                    count += 1;
                }
            }
        }
        println!("{count} passes, at most {worst} degrees too low");
        assert!(count > 20 && worst < 2e-5, "{count} {worst}");
    }
}
