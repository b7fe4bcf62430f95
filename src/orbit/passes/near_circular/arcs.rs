//! Arcs in which the turning Earth brings a site near the plane of an orbit.
//!
//! Let beta be the angle, along the equator, from the ascending node of the orbit to the site; it
//! grows by one turn in about a sidereal day. With the geocentric latitude phi of the site and the
//! inclination i, the sine of the angle d from the orbit plane to the site is
//!
//! sin d = sin phi cos i - cos phi sin i sin beta
//!
//! A satellite in the plane can be seen only while |d| is at most the reach rho. The reach is the
//! angle, at the centre of the Earth, between the site and a satellite that is just rising. The
//! condition holds on no arc of beta, on one, on two, or always.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Max length of an arc, radians: six hours. Longer arcs come in pieces, so that slow motions are
/// nearly linear in each piece.
const LONGEST_RAD: f64 = FRAC_PI_2;

/// Start and end of each arc of beta within a turn, in radians, in order. The starts lie from -pi/2
/// to 3 pi/2; pieces of one arc touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arcs {
    arcs: [(f64, f64); 2],
    count: usize,
}

impl Arcs {
    /// Returns the arcs in which `|middle - width sin(beta)| <= sin(reach)`. `middle` is sin phi
    /// cos i. `width` is cos phi sin i, which is not negative. `reach` lies between 0 and a right
    /// angle.
    pub(super) fn new(middle: f64, width: f64, reach: f64) -> Self {
        let half = reach.sin();
        // The bounds are not divided by the width, which is 0 at the poles and for an equatorial
        // orbit.
        let (low, high) = (middle - half, middle + half);
        let angle = |sine: f64| (sine / width).asin();
        let (arcs, count) = match (low <= -width, high >= width) {
            _ if low > width || high < -width => ([(0.0, 0.0); 2], 0),
            (true, true) => ([(-FRAC_PI_2, 3.0 * FRAC_PI_2), (0.0, 0.0)], 1),
            (true, false) => ([(PI - angle(high), TAU + angle(high)), (0.0, 0.0)], 1),
            (false, true) => ([(angle(low), PI - angle(low)), (0.0, 0.0)], 1),
            (false, false) => ([(angle(low), angle(high)), (PI - angle(high), PI - angle(low))], 2),
        };
        Self { arcs, count }
    }

    /// Returns all pieces from `start` onwards, turn after turn, without end.
    pub(super) fn starting_at(self, start: f64) -> impl Iterator<Item = (f64, f64)> {
        let first_turn = ((start - FRAC_PI_2) / TAU).floor() - 1.0;
        let turns = (0..).map(move |turn: u32| TAU * (first_turn + f64::from(turn)));
        let none = self.count == 0;
        turns
            .take_while(move |_| !none)
            .flat_map(move |turn| {
                self.arcs.into_iter().take(self.count).map(move |(a, b)| (a + turn, b + turn))
            })
            .flat_map(pieces)
            .skip_while(move |(_, end)| *end < start)
    }
}

fn pieces((start, end): (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    let count = ((end - start) / LONGEST_RAD).ceil().max(1.0);
    let length = (end - start) / count;
    (0..count as u32).map(move |index| {
        let start = start + f64::from(index) * length;
        (start, start + length)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_arcs_hold_every_place_in_reach_and_no_other(
            latitude in -FRAC_PI_2..=FRAC_PI_2,
            inclination in 0.0..=PI,
            reach in 0.01..1.5,
            start in -50.0..50.0,
        ) {
            let (middle, width) =
                (latitude.sin() * inclination.cos(), latitude.cos() * inclination.sin());
            let arcs: Vec<_> =
                Arcs::new(middle, width, reach).starting_at(start).take_while(|(a, _)| *a < start + TAU).collect();
            prop_assert!(arcs.iter().all(|(a, b)| b >= a && b - a <= LONGEST_RAD + 1e-9));
            prop_assert!(arcs.windows(2).all(|pair| pair[0].1 <= pair[1].0 + 1e-9));
            for step in 0..720 {
                let beta = start + TAU * f64::from(step) / 720.0;
                let deviation = (middle - width * beta.sin()).abs() - reach.sin();
                let is_covered = arcs.iter().any(|(a, b)| (*a..=*b).contains(&beta));
                prop_assert!(is_covered == (deviation <= 0.0) || deviation.abs() < 1e-6, "{beta} {deviation}");
            }
        }
    }
}
