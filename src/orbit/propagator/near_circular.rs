//! States of near-circular near-earth orbits, one or several at once.
//!
//! The theory is the library's, rewritten so that each angle needs only one sine and cosine. The
//! short waves change an angle only slightly, and a few multiplications turn a sine and cosine by a
//! small angle. Over the whole bundled catalog, the positions agree within 2e-8 km.
//!
//! Source: Hoots and Roehrich, "Spacetrack Report No. 3", section 6, and Vallado et al.,
//! "Revisiting Spacetrack Report #3" (AIAA 2006-6753). As in these sources, lengths are in Earth
//! radii and times in minutes.

use glam::DVec3;
use sgp4::WGS72;

use super::{State, secular::Secular};
use crate::simd::{LANES, Lanes, Number, Vector, series, widest};

/// Min eccentricity in the theory; rounder orbits get this value.
const MIN_ECCENTRICITY: f64 = 1e-6;

/// Position, km, and inertial velocity, km/s.
pub(crate) type Motion<N> = (Vector<N>, Vector<N>);

impl<N: Number> Secular<N> {
    /// Returns the states `minutes` after the epoch, in axes turned about the pole by `turn`
    /// radians from the axes of TEME. The states are valid if the orbit [is
    /// near-circular](Secular::is_near_circular_at).
    #[inline(always)]
    pub(crate) fn motion(&self, minutes: N, turn: N) -> Motion<N> {
        motion(self, minutes, turn)
    }
}

impl Secular {
    /// Returns the states at these minutes after the epoch, in TEME; valid like [`Self::motion`].
    pub(super) fn states(&self, minutes: &[f64]) -> impl Iterator<Item = State> {
        let mut lanes = Secular::default();
        (0..LANES).for_each(|lane| lanes.set(lane, self));
        minutes.chunks(LANES).flat_map(move |chunk| {
            let mut lane_minutes = Lanes::ZERO;
            chunk.iter().enumerate().for_each(|(lane, minutes)| lane_minutes.set(lane, *minutes));
            let motions = lanes.motions(lane_minutes, Lanes::ZERO).take(chunk.len());
            motions.map(|(position_km, velocity_km_s)| State { position_km, velocity_km_s })
        })
    }
}

impl Secular<Lanes> {
    /// Returns [`Self::motion`] of each lane.
    pub(super) fn motions(
        &self,
        minutes: Lanes,
        turn: Lanes,
    ) -> impl Iterator<Item = (DVec3, DVec3)> + use<> {
        let (positions, velocities) = widest(
            #[inline(always)]
            || self.motion(minutes, turn),
        );
        (0..LANES).map(move |lane| (positions.lane(lane).into(), velocities.lane(lane).into()))
    }
}

#[inline(always)]
fn motion<N: Number>(secular: &Secular<N>, minutes: N, turn: N) -> Motion<N> {
    let Secular { plane, waves, drag_wave, .. } = secular;

    let [anomaly, anomaly_rate] = drag_wave.anomaly;
    let anomaly = minutes * anomaly_rate + anomaly;
    let (_, cos_anomaly) = anomaly.sin_cos();
    let [factor, at_epoch, per_minute] = drag_wave.angle;
    let swing = cos_anomaly * drag_wave.eta + 1.0;
    let shift = (swing * swing * swing - at_epoch) * factor + minutes * per_minute;
    let (sin_shifted, _) = (anomaly + shift).sin_cos();

    let root_axis = series(&secular.root_axis, minutes);
    let axis = root_axis * root_axis;
    let [wave, wave_at_epoch] = drag_wave.eccentricity;
    let eccentricity = (series(&plane.eccentricity, minutes)
        - (sin_shifted - wave_at_epoch) * wave)
        .clamped(MIN_ECCENTRICITY, 1.0);

    // The eccentricity vector has components towards the node and across, with the long waves.
    let (sin_perigee, cos_perigee) = (series(&plane.perigee, minutes) - shift).sin_cos();
    let by_parameter = N::splat(1.0) / (axis * (-(eccentricity * eccentricity) + 1.0));
    let along = eccentricity * cos_perigee;
    let across = eccentricity * sin_perigee + by_parameter * waves.odd_vector;
    let mean = series(&plane.argument, minutes) + by_parameter * along * waves.odd_angle;

    let (sine, cosine) = eccentric_angle(mean, along, across);
    let radial = along * cosine + across * sine;
    let crossing = along * sine - across * cosine;
    let round = -(along * along + across * across) + 1.0;
    let parameter = axis * round;
    let radius = axis * (-radial + 1.0);
    let by_radius = N::splat(1.0) / radius;
    let flatness = round.sqrt();
    let middle = crossing / (flatness + 1.0);
    let ratio = axis * by_radius;
    let sin_true = ratio * (sine - across - along * middle);
    let cos_true = ratio * (cosine - along + across * middle);

    // The short waves come twice a revolution.
    let sin_double = sin_true * cos_true * 2.0;
    let cos_double = -(sin_true * sin_true * 2.0) + 1.0;
    let by_parameter = N::splat(1.0) / parameter;
    let first = by_parameter * (0.5 * WGS72.j2);
    let second = first * by_parameter;
    let distance = radius * (-(second * flatness * waves.three * 1.5) + 1.0)
        + first * cos_double * waves.square * 0.5;
    let (sin_place, cos_place) =
        turned(sin_true, cos_true, second * sin_double * waves.seven * -0.25);
    let tilt = second * cos_double * plane.cos_inclination * plane.sin_inclination * 1.5;
    let (sin_tilt, cos_tilt) = turned(plane.sin_inclination, plane.cos_inclination, tilt);
    let node =
        series(&plane.node, minutes) - turn + second * sin_double * plane.cos_inclination * 1.5;
    let (sin_node, cos_node) = node.sin_cos();

    // The rates are in radians per time unit of the theory, in which gravity is 1.
    let rate = N::splat(1.0) / (axis * root_axis);
    let outward = root_axis * crossing * by_radius - rate * first * sin_double * waves.square;
    let tangential = parameter.sqrt() * by_radius
        + rate * first * (cos_double * waves.square + waves.three * 1.5);

    let up = Vector::new(
        cos_node * cos_place - sin_node * cos_tilt * sin_place,
        sin_node * cos_place + cos_node * cos_tilt * sin_place,
        sin_tilt * sin_place,
    );
    let ahead = Vector::new(
        -(sin_node * cos_tilt * cos_place) - cos_node * sin_place,
        cos_node * cos_tilt * cos_place - sin_node * sin_place,
        sin_tilt * cos_place,
    );
    let velocity = (up * outward + ahead * tangential) * N::splat(WGS72.ae * WGS72.ke / 60.0);
    (up * (distance * WGS72.ae), velocity)
}

/// Returns sine and cosine of the eccentric anomaly E counted from the node. It solves `E = mean +
/// along sin E - across cos E`.
///
/// From E = mean, one step of Halley's method and one of Newton's leave less than 1e-12 for the
/// eccentricities in question.
#[inline(always)]
fn eccentric_angle<N: Number>(mean: N, along: N, across: N) -> (N, N) {
    let (sine, cosine) = mean.sin_cos();
    let missing = along * sine - across * cosine;
    let slope = -(along * cosine + across * sine) + 1.0;
    let step = missing * slope / (slope * slope + missing * missing * 0.5);
    let (sine, cosine) = turned(sine, cosine, step);
    let missing = along * sine - across * cosine - step;
    let rest = missing / (-(along * cosine + across * sine) + 1.0);
    let half = rest * rest * 0.5;
    (sine - sine * half + cosine * rest, cosine - cosine * half - sine * rest)
}

/// Returns sine and cosine of an angle that is increased by `turn`, at most 0.06 radians.
#[inline(always)]
fn turned<N: Number>(sine: N, cosine: N, turn: N) -> (N, N) {
    let square = turn * turn;
    let sin_turn = turn
        * (-(square
            * (-(square * (-(square * (1.0 / 42.0)) + 1.0) * (1.0 / 20.0)) + 1.0)
            * (1.0 / 6.0))
            + 1.0);
    let less = square * (-(square * (-(square * (1.0 / 30.0)) + 1.0) * (1.0 / 12.0)) + 1.0) * 0.5;
    (sine - sine * less + cosine * sin_turn, cosine - cosine * less - sine * sin_turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Propagator, bundled, propagator::Resumable};

    #[test]
    fn states_agree_with_the_library_over_the_whole_catalog() {
        let catalog = bundled().unwrap();
        let mut compared = 0;
        let mut worst = (0.0_f64, 0.0_f64);
        for elements in catalog.iter() {
            let propagator = Propagator::new(elements).unwrap();
            let Some(secular) = propagator.secular() else { continue };
            for days in [-3.0, 0.0, 0.5, 4.0, 9.0] {
                let minutes = [0.0, 11.0, 23.0, 35.0, 47.0, 59.0, 71.0, 83.0];
                let times = minutes.map(|minute| days * 1440.0 + minute);
                if times.iter().any(|minutes| !secular.is_near_circular_at(*minutes)) {
                    continue;
                }
                let mut lanes = Secular::default();
                (0..LANES).for_each(|lane| lanes.set(lane, secular));
                let (positions, velocities) = motion(&lanes, Lanes::from(times), Lanes::splat(0.0));
                for (lane, minutes) in times.iter().enumerate() {
                    let state = propagator.state_after(minutes * 60.0, &mut Resumable::default());
                    let state = state.unwrap();
                    let position = positions.lane(lane) - state.position_km.into();
                    let velocity = velocities.lane(lane) - state.velocity_km_s.into();
                    worst = (worst.0.max(position.length()), worst.1.max(velocity.length()));
                    compared += 1;
                }
            }
        }
        assert!(compared > 580_000, "{compared}");
        assert!(worst.0 < 2e-8 && worst.1 < 2e-11, "{worst:?}");
    }

    #[test]
    fn wide_registers_change_no_bit() {
        let catalog = bundled().unwrap();
        let mut compared = 0;
        for elements in catalog.iter().step_by(50) {
            let propagator = Propagator::new(elements).unwrap();
            let Some(secular) = propagator.secular() else { continue };
            let mut lanes = Secular::default();
            (0..LANES).for_each(|lane| lanes.set(lane, secular));
            let minutes = Lanes::from([0.0, 11.0, 23.0, 355.0, 1447.0, -59.0, 71.0, 10_083.0]);
            let plain = motion(&lanes, minutes, Lanes::splat(1.2));
            let wide = widest(
                #[inline(always)]
                || motion(&lanes, minutes, Lanes::splat(1.2)),
            );
            let bits = |(position, velocity): Motion<Lanes>| {
                [position, velocity].map(|Vector { x, y, z }| {
                    [x, y, z].map(|coordinate| coordinate.as_array().map(f64::to_bits))
                })
            };
            assert_eq!(bits(plain), bits(wide));
            compared += 1;
        }
        assert!(compared > 200, "{compared}");
    }

    #[test]
    fn axes_may_turn() {
        let catalog = bundled().unwrap();
        let propagator = Propagator::new(catalog.get(25_544).unwrap()).unwrap();
        let secular = propagator.secular().unwrap();
        let turn: f64 = 1.2;
        let (still, _) = motion(secular, 100.0, 0.0);
        let (position, _) = motion(secular, 100.0, turn);
        let x = still.x * turn.cos() + still.y * turn.sin();
        let y = still.y * turn.cos() - still.x * turn.sin();
        assert!((position - Vector::new(x, y, still.z)).length() < 1e-8);
    }
}
