//! Advance judgement of the path to a direction.

use super::{Gate, Moment, Motion, NoRoute};
use crate::{
    contract::driver::{Intent, Refusal, Way},
    device::Pointing,
};

/// Distance between two points of a path, degrees of the axis that turns further.
const STEP_DEG: f64 = 2.0;

impl Gate {
    /// Returns the path of a motion to `target` from the current position, or the reason to refuse
    /// it.
    pub(in crate::driver) fn way_to(&self, target: Pointing, now: Moment) -> Result<Way, Refusal> {
        let Pointing { azimuth, elevation } = target;
        let motion = self.nearest(Motion::Position { azimuth, elevation })?;
        let route = self.route(motion, Intent::Position, now).map_err(NoRoute::refusal)?;
        let is_round_a_corner = route.second.is_some();
        let legs = std::iter::once(route.first).chain(route.second);
        let ends: Option<Vec<_>> = legs.map(|leg| self.ends(leg, now)).collect();
        let Some(ends) = ends.filter(|ends| !ends.is_empty()) else {
            let arrives_s = self.seconds_of_one_axis(motion);
            return Ok(Way { path: Vec::new(), arrives_s, is_round_a_corner });
        };
        let start = ends.iter().take(1).map(|(from_deg, _)| *from_deg);
        let turns_deg: Vec<[f64; 2]> =
            start.chain(ends.iter().map(|(_, to_deg)| *to_deg)).collect();
        let limits = self.axis_limits();
        let legs = turns_deg.windows(2).filter_map(|pair| <&[[f64; 2]; 2]>::try_from(pair).ok());
        let arrives_s = legs.clone().map(|[start, end]| limits.seconds(*start, *end)).sum();
        let points = legs.flat_map(|[start, end]| turn_positions(*start, *end));
        let path = points.map(|axes_deg| self.bounds.direction(axes_deg)).collect();
        Ok(Way { path, arrives_s: Some(arrives_s), is_round_a_corner })
    }

    /// Returns the duration for a rotator with only a known azimuth, seconds.
    fn seconds_of_one_axis(&self, motion: Motion) -> Option<f64> {
        let Motion::Position { azimuth, .. } = self.controller.as_sent(motion) else { return None };
        let at_deg = self.state().measured?.axes[0].angle_deg?;
        let is_alone = !self.variant.capabilities.has_elevation();
        let turn_deg = azimuth.filter(|_| is_alone)?.degrees() - at_deg;
        Some(turn_deg.abs() / self.limits.maximum_rate_deg_s)
    }
}

/// Yields positions of two axes that start together and turn at one rate.
fn turn_positions(from_deg: [f64; 2], to_deg: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let [first, second] = [to_deg[0] - from_deg[0], to_deg[1] - from_deg[1]];
    let whole_deg = first.abs().max(second.abs());
    // A constant limits the points, because the driver thread computes them.
    let parts = (whole_deg / STEP_DEG).ceil().clamp(1.0, 1000.0) as u32;
    (0..=parts).map(move |part| {
        let turned_deg = whole_deg * f64::from(part) / f64::from(parts);
        let moved = |turn: f64| turn.abs().min(turned_deg).copysign(turn);
        [from_deg[0] + moved(first), from_deg[1] + moved(second)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_with_less_to_turn_arrives_first() {
        let places: Vec<_> = turn_positions([10.0, 40.0], [18.0, 37.0]).collect();
        assert_eq!(places, [[10.0, 40.0], [12.0, 38.0], [14.0, 37.0], [16.0, 37.0], [18.0, 37.0]]);
        assert_eq!(turn_positions([10.0, 40.0], [10.0, 40.0]).last(), Some([10.0, 40.0]));
    }
}
