//! The search: samples along the orbit, extremes between them, crossings
//! between the extremes.
//!
//! The height of the satellite is taken as the sine of its elevation, which is
//! smooth even through the zenith, with its rate from the velocity. Between two
//! neighbouring extremes the height only rises or only falls, so it crosses the
//! horizon at most once there.

use glam::{DMat3, DVec3};
use jiff::Timestamp;

use super::{Pass, PassPoint};
use crate::{
    astro::{Angle, AzEl, Site, frames, time},
    orbit::{Propagator, State},
};

/// How far a satellite may go around the Earth between two samples, in radians.
/// Three degrees give a low satellite a sample every 45 s; its height has two
/// extremes in a revolution of 90 minutes.
const SAMPLE_STEP_RAD: f64 = 0.052;
/// Bounds of the time between two samples in seconds: the upper one keeps far
/// and slow objects honest about the turning Earth.
const SAMPLE_STEP_S: std::ops::RangeInclusive<f64> = 2.0..=600.0;
/// How exactly times are found, in seconds.
const TIME_TOLERANCE_S: f64 = 2e-4;
/// Distance of the heights that place an extreme, in seconds: wide enough to
/// stand above the noise of the sidereal time, narrow enough for a parabola.
const POLISH_STEP_S: f64 = 1.0;

/// The site and the satellite.
struct Sky<'a> {
    propagator: &'a Propagator,
    from: Timestamp,
    site_km: DVec3,
    to_enu: DMat3,
}

/// The satellite at one time.
#[derive(Clone, Copy)]
struct Sample {
    /// Seconds from the start of the window.
    at_s: f64,
    /// Sine of the elevation.
    height: f64,
    /// Its change per second.
    rate: f64,
    enu: DVec3,
    /// Time to the next sample.
    step_s: f64,
}

pub(super) fn run(
    propagator: &Propagator,
    site: Site,
    from: Timestamp,
    to: Timestamp,
    horizon: Angle,
    cancelled: &dyn Fn() -> bool,
) -> Vec<Pass> {
    let sky = Sky {
        propagator,
        from,
        site_km: frames::site_ecef_km(site),
        to_enu: frames::ecef_to_enu(site),
    };
    let threshold = horizon.radians().sin();
    let mut finder = Finder { sky: &sky, threshold, open: None, found: Vec::new() };
    let window_s = time::seconds_between(from, to);
    let Some(mut last) = sky.sample(0.0).filter(|_| window_s > 0.0) else {
        return Vec::new();
    };
    finder.begin(last);
    while last.at_s < window_s && !cancelled() {
        let Some(next) = sky.sample((last.at_s + last.step_s).min(window_s)) else {
            break;
        };
        if (last.rate > 0.0) != (next.rate > 0.0)
            && let Some(extreme) = sky.extreme(last, next)
        {
            finder.advance(last, extreme);
            finder.advance(extreme, next);
        } else {
            finder.advance(last, next);
        }
        last = next;
    }
    finder.end(last)
}

impl Sky<'_> {
    /// The satellite `at_s` seconds into the window; `None` once it has decayed.
    fn sample(&self, at_s: f64) -> Option<Sample> {
        let at = time::add_seconds(self.from, at_s);
        let State { position_km, velocity_km_s } = self.propagator.state_at(at).ok()?;
        let to_ecef = frames::teme_to_ecef(at);
        let ground_km = to_ecef * position_km;
        let speed = frames::velocity_over_ground_km_s(ground_km, to_ecef * velocity_km_s);
        let enu = self.to_enu * (ground_km - self.site_km);
        let enu_speed = self.to_enu * speed;
        let range_km = enu.length();
        let height = enu.z / range_km;
        let range_rate = enu.dot(enu_speed) / range_km;
        let turn_rad_s = position_km.cross(velocity_km_s).length() / position_km.length_squared();
        let step_s =
            (SAMPLE_STEP_RAD / turn_rad_s).clamp(*SAMPLE_STEP_S.start(), *SAMPLE_STEP_S.end());
        let rate = (enu_speed.z - height * range_rate) / range_km;
        Some(Sample { at_s, height, rate, enu, step_s })
    }

    /// The sample between `a` and `b` where `value` changes its sign, which it
    /// has to have opposite at the two. Illinois' variant of the false position.
    fn root(&self, a: Sample, b: Sample, value: impl Fn(&Sample) -> f64) -> Option<Sample> {
        let (mut a, mut value_a) = (a, value(&a));
        let (mut b, mut value_b) = (b, value(&b));
        let mut kept_side = 0;
        for round in 0..100 {
            if (b.at_s - a.at_s).abs() <= TIME_TOLERANCE_S {
                break;
            }
            let secant = (a.at_s * value_b - b.at_s * value_a) / (value_b - value_a);
            // A halving now and then bounds the effort whatever the curve.
            let at_s = if round % 8 == 7 || !secant.is_finite() {
                f64::midpoint(a.at_s, b.at_s)
            } else {
                secant
            };
            let middle = self.sample(at_s)?;
            let value_middle = value(&middle);
            if value_middle == 0.0 {
                return Some(middle);
            }
            if (value_middle > 0.0) == (value_a > 0.0) {
                (a, value_a) = (middle, value_middle);
                if kept_side == 1 {
                    value_b *= 0.5;
                }
                kept_side = 1;
            } else {
                (b, value_b) = (middle, value_middle);
                if kept_side == -1 {
                    value_a *= 0.5;
                }
                kept_side = -1;
            }
        }
        Some(if value_a.abs() < value_b.abs() { a } else { b })
    }

    /// The highest or lowest point between `a` and `b`, whose rates differ in sign.
    ///
    /// SGP4's velocity is not quite the derivative of its position: the rate
    /// alone would be wrong by up to half a second. The top of the parabola
    /// through three heights puts it right.
    fn extreme(&self, a: Sample, b: Sample) -> Option<Sample> {
        let middle = self.root(a, b, |sample| sample.rate)?;
        let before = self.sample(middle.at_s - POLISH_STEP_S)?.height;
        let after = self.sample(middle.at_s + POLISH_STEP_S)?.height;
        let curve = before - 2.0 * middle.height + after;
        let shift_s = 0.5 * POLISH_STEP_S * (before - after) / curve;
        if shift_s.abs() <= POLISH_STEP_S {
            self.sample((middle.at_s + shift_s).clamp(a.at_s, b.at_s))
        } else {
            Some(middle)
        }
    }
}

/// Puts passes together from stretches that only rise or only fall.
struct Finder<'a> {
    sky: &'a Sky<'a>,
    threshold: f64,
    open: Option<Open>,
    found: Vec<Pass>,
}

/// A pass whose end is not found yet.
struct Open {
    aos: Sample,
    highest: Sample,
    starts_before: bool,
}

impl Finder<'_> {
    fn is_up(&self, sample: &Sample) -> bool {
        sample.height >= self.threshold
    }

    fn begin(&mut self, first: Sample) {
        if self.is_up(&first) {
            self.open = Some(Open { aos: first, highest: first, starts_before: true });
        }
    }

    fn advance(&mut self, a: Sample, b: Sample) {
        if self.is_up(&a) != self.is_up(&b) {
            let threshold = self.threshold;
            let crossing = self.sky.root(a, b, |sample| sample.height - threshold);
            let Some(crossing) = crossing else { return };
            if self.is_up(&b) {
                self.open = Some(Open { aos: crossing, highest: crossing, starts_before: false });
            } else if let Some(open) = self.open.take() {
                self.close(&open, crossing, false);
            }
        }
        if let Some(open) = &mut self.open
            && b.height > open.highest.height
        {
            open.highest = b;
        }
    }

    fn close(&mut self, open: &Open, los: Sample, ends_after: bool) {
        let highest = if los.height > open.highest.height { los } else { open.highest };
        self.found.push(Pass {
            aos: self.point(open.aos),
            tca: self.point(highest),
            los: self.point(los),
            starts_before: open.starts_before,
            ends_after,
        });
    }

    fn point(&self, sample: Sample) -> PassPoint {
        PassPoint {
            time: time::add_seconds(self.sky.from, sample.at_s),
            direction: AzEl::from_enu(sample.enu),
        }
    }

    fn end(mut self, last: Sample) -> Vec<Pass> {
        if let Some(open) = self.open.take() {
            self.close(&open, last, true);
        }
        self.found
    }
}
