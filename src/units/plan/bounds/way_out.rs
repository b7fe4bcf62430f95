//! Way out of the barriers that contain an antenna.
//!
//! The nearest edge is not a way out if the minimum elevation, the end of the travel or another
//! barrier lies behind it. Azel therefore measures depth along a possible turn: one axis turns in
//! one direction until the antenna points in an allowed direction.

use super::{AzEl, BarrierName, Bounds, BoundsAt, Sweep};
use crate::{astro::Angle, station::Mount};

/// Min step along a turn, degrees.
const STEP_DEG: f64 = 0.1;
/// Accuracy of an edge, degrees. Azel compares depths at neighbouring positions.
const EDGE_DEG: f64 = 1e-9;
/// Accuracy of an edge for an antenna without an elevation axis, degrees. Each of its checks costs
/// as much as a hundred others. Azel compares only ways out.
const EDGE_OF_AZIMUTH_DEG: f64 = 0.01;
/// Max gap that does not count as a way out, degrees of the axis: a motion judged ahead never
/// enters it.
const GAP_DEG: f64 = 1.0;
/// Turn over which Azel measures the speed of an axis across the sky, degrees.
const STRETCH_DEG: f64 = 0.01;
/// Max turn of an axis to get out, degrees.
const FURTHEST_DEG: f64 = 360.0;

/// Groups of barriers: those to leave and those not to enter. Each kind has a second group for the
/// minimum elevation of a turn that keeps the elevation.
const LEFT: usize = 0;
const OTHERS: usize = 1;
const LEFT_BELOW: usize = 2;
const ABOVE: usize = 3;

/// Position along a turn.
enum Spot {
    /// Position outside all barriers.
    Free,
    /// Position inside a barrier, with a lower bound of the distance to any edge and other barrier,
    /// degrees.
    Inside(f64),
    /// Position inside a barrier that did not contain the axes at the start.
    Barred,
}

impl BoundsAt<'_> {
    /// Returns the shortest turn of one axis that leads out, within its travel and through no other
    /// barrier, in degrees of the sky; zero outside all barriers. Returns `None` without such a
    /// turn.
    ///
    /// If the position of an axis is a range, the whole range must get out.
    pub fn way_out_deg(&self, place: Sweep) -> Option<f64> {
        let left = self.entered(place);
        if !left.contains(&true) {
            return Some(0.0);
        }
        let mut shortest_deg = None;
        // The azimuth may turn the furthest, so try it last.
        for (axis, way) in [(1, 1.0), (1, -1.0), (0, 1.0), (0, -1.0)] {
            if axis == 1 && !self.bounds.has_elevation {
                continue;
            }
            let turn = self.turn(place, axis, way);
            let max_deg = shortest_deg.map_or(FURTHEST_DEG, |deg: f64| deg / turn.speed);
            let spot = |turn_deg| self.spot(&turn, turn_deg, &left);
            let edge_deg = if self.bounds.has_elevation { EDGE_DEG } else { EDGE_OF_AZIMUTH_DEG };
            if let Some(turn_deg) = turn.out_deg(max_deg, edge_deg, spot) {
                let way_deg = turn_deg * turn.speed;
                shortest_deg = Some(shortest_deg.map_or(way_deg, |deg| deg.min(way_deg)));
            }
        }
        shortest_deg
    }

    /// Returns the turn of the azimuth that leads out through no other barrier, degrees, upwards if
    /// `way` is positive. Returns `None` if no such turn lies within its travel.
    pub fn azimuth_out_deg(&self, place: Sweep, way: f64) -> Option<f64> {
        let left = self.entered(place);
        let turn = self.turn(place, 0, way.signum());
        turn.out_deg(FURTHEST_DEG, EDGE_OF_AZIMUTH_DEG, |turn_deg| {
            self.spot(&turn, turn_deg, &left)
        })
    }

    /// Returns the depth below the minimum elevation, and the depth inside each other barrier to
    /// its nearest edge, degrees; zero outside.
    pub fn depths_deg(&self, place: Sweep) -> (f64, Vec<f64>) {
        let (mut below_deg, mut inside_deg) = (0.0, Vec::new());
        let clearances = self.each_in(place);
        for (barrier, angle, _) in clearances.into_iter().filter(|(_, _, warns_only)| !warns_only) {
            let deep_deg = (-angle.degrees()).max(0.0);
            if let BarrierName::MinimumElevation = barrier {
                below_deg = deep_deg;
            } else {
                inside_deg.push(deep_deg);
            }
        }
        (below_deg, inside_deg)
    }

    /// Returns for each barrier, in order, whether a position in `place` is inside it.
    fn entered(&self, place: Sweep) -> Vec<bool> {
        let clearances = self.each_in(place).into_iter();
        clearances.map(|(_, angle, warns_only)| !warns_only && angle.degrees() < 0.0).collect()
    }

    fn turn(&self, place: Sweep, axis: usize, way: f64) -> Turn {
        let Bounds { mount, .. } = *self.bounds;
        let axes_deg = place.middle();
        let [first, second] = mount.travel_deg();
        let ((from_deg, to_deg), at_deg) =
            if axis == 0 { (first, axes_deg[0]) } else { (second, axes_deg[1]) };
        let end_deg = if way > 0.0 { to_deg - at_deg } else { at_deg - from_deg };
        let stretched = Turn::turned(place, axis, STRETCH_DEG);
        let [here, on] = [place, stretched].map(|sweep| self.aim(sweep.middle()));
        let speed = |here: AzEl, on: AzEl| here.separation(on).degrees() / STRETCH_DEG;
        let fastest = here.directions().zip(on.directions()).map(|(here, on)| speed(here, on));
        Turn {
            start: place,
            axis,
            way,
            end_deg: end_deg.min(FURTHEST_DEG),
            speed: speed(here.axes, on.axes),
            max_speed: fastest.fold(0.0, f64::max) * self.max_beam_turn(),
            keeps_elevation: axis == 0 && matches!(mount, Mount::AzEl { .. }),
        }
    }

    fn spot(&self, turn: &Turn, turn_deg: f64, left: &[bool]) -> Spot {
        let place = Turn::turned(turn.start, turn.axis, turn.way * turn_deg);
        let pairs = self.barriers(self.aim(place.middle())).zip(left);
        let groups: Vec<_> = pairs
            .map(|(barrier, is_left)| {
                // A turn that keeps the elevation never reaches the edge of the minimum elevation.
                let is_level =
                    turn.keeps_elevation && matches!(barrier.name, BarrierName::MinimumElevation);
                let group = match (is_left, is_level) {
                    (true, false) => LEFT,
                    (true, true) => LEFT_BELOW,
                    (false, false) => OTHERS,
                    (false, true) => ABOVE,
                };
                (!barrier.warns_only).then_some(group)
            })
            .collect();
        let minima = self.min_in_groups::<4>(place, &groups).map(Angle::degrees);
        // Test this first: another barrier bars the turn even if it overlaps the barrier to leave.
        if minima[OTHERS].min(minima[ABOVE]) < 0.0 {
            Spot::Barred
        } else if minima[LEFT_BELOW] < 0.0 {
            Spot::Inside(minima[OTHERS])
        } else if minima[LEFT] < 0.0 {
            Spot::Inside((-minima[LEFT]).min(minima[OTHERS]))
        } else {
            Spot::Free
        }
    }
}

/// Turn of one axis in one direction.
struct Turn {
    /// Possible positions of the axes at the start of the turn.
    start: Sweep,
    axis: usize,
    /// Sign of the direction, 1 or -1.
    way: f64,
    /// Max turn within the travel; an axis beyond its opposite end may come back.
    end_deg: f64,
    /// Angle of the axis direction per degree of the axis, degrees, constant throughout the turn.
    speed: f64,
    /// Max angle of the axis direction or the beam per degree of the axis, degrees, throughout the
    /// turn.
    max_speed: f64,
    keeps_elevation: bool,
}

impl Turn {
    fn turned(place: Sweep, axis: usize, by_deg: f64) -> Sweep {
        place.turned(if axis == 0 { [by_deg, 0.0] } else { [0.0, by_deg] })
    }

    /// Returns the turn after which `spot` is free, at most `max_deg` and accurate to `edge_deg`,
    /// degrees.
    fn out_deg(
        &self,
        max_deg: f64,
        edge_deg: f64,
        mut spot: impl FnMut(f64) -> Spot,
    ) -> Option<f64> {
        let last_deg = self.end_deg.min(max_deg);
        let (mut inside_deg, mut turn_deg) = (0.0, 0.0);
        loop {
            match spot(turn_deg) {
                Spot::Inside(_) if turn_deg >= last_deg => return None,
                Spot::Inside(step_deg) => {
                    inside_deg = turn_deg;
                    // At an edge the clearance is zero, and only a minimum step makes progress.
                    let step_deg = (step_deg / self.max_speed).max(STEP_DEG);
                    // The edge may lie just before the end of the travel.
                    turn_deg = f64::min(turn_deg + step_deg, last_deg);
                }
                // The edge may also lie just before another barrier.
                next_spot @ (Spot::Free | Spot::Barred) => {
                    let (mut next_spot, mut beyond_deg) = (next_spot, turn_deg);
                    while beyond_deg - inside_deg > edge_deg {
                        let middle_deg = f64::midpoint(inside_deg, beyond_deg);
                        match spot(middle_deg) {
                            Spot::Inside(_) => inside_deg = middle_deg,
                            nearer => (next_spot, beyond_deg) = (nearer, middle_deg),
                        }
                    }
                    let far_deg = beyond_deg + GAP_DEG;
                    let has_room = far_deg <= self.end_deg && matches!(spot(far_deg), Spot::Free);
                    return (matches!(next_spot, Spot::Free) && has_room).then_some(beyond_deg);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::Angle,
        station::{Antenna, Entered, KeepOut, Station},
    };

    /// Returns bounds with a keep-out that reaches below the minimum elevation of 5 degrees.
    fn bounds() -> Bounds {
        bounds_to(360.0)
    }

    fn bounds_to(azimuth_to_deg: f64) -> Bounds {
        let corners_deg = [(100.0, 2.0), (160.0, 2.0), (160.0, 60.0), (100.0, 60.0)];
        let keep_out = KeepOut {
            name: "roof".to_owned(),
            entered: Entered::Hard,
            reason: String::new(),
            antenna: None,
            margin_deg: 0.0,
            zone: KeepOut::zone_of(&corners_deg).unwrap(),
        };
        let mut antenna = Antenna::genius("Yagi", "memory:1");
        antenna.limits.minimum_elevation_deg = 5.0;
        antenna.beam_width_deg = 0.0;
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: 0.0,
            azimuth_to_deg,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        };
        Bounds::new(&Station { keep_outs: vec![keep_out], ..Station::default() }, &antenna)
    }

    fn morning() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn way_out_deg(axes_deg: [f64; 2]) -> Option<f64> {
        bounds().at_time(morning()).way_out_deg(Sweep::at_position(axes_deg))
    }

    #[test]
    fn the_floor_behind_the_nearest_edge_is_no_way_out() {
        let at_deg = way_out_deg([130.0, 6.0]).unwrap();
        assert!((25.0..31.0).contains(&at_deg), "{at_deg}");
        assert!(way_out_deg([130.0, 5.0]).unwrap() > at_deg, "lower is deeper");
        assert!(way_out_deg([131.0, 6.0]).unwrap() < at_deg, "sideways leads out");
    }

    #[test]
    fn an_edge_before_the_end_of_the_travel_is_a_way_out_where_there_is_room() {
        let at_deg = bounds_to(161.08)
            .at_time(morning())
            .way_out_deg(Sweep::at_position([155.0, 30.0]))
            .unwrap();
        assert!((4.0..5.0).contains(&at_deg), "{at_deg}");
        let at_deg = bounds_to(161.02)
            .at_time(morning())
            .way_out_deg(Sweep::at_position([155.0, 30.0]))
            .unwrap();
        assert!(at_deg > 20.0, "too narrow: {at_deg}");
    }

    #[test]
    fn a_gap_before_the_floor_is_a_way_out_where_there_is_room() {
        let mut bounds = bounds();
        // The lower edge is at 2 degrees.
        for (floor_deg, is_open) in [(0.94, true), (0.96, false)] {
            bounds.minimum_elevation = Some(Angle::from_degrees(floor_deg));
            let at_deg = bounds.at_time(morning()).way_out_deg(Sweep::at_position([130.0, 3.0]));
            assert_eq!(at_deg.unwrap() < 1.1, is_open, "{at_deg:?}");
        }
    }

    #[test]
    fn an_antenna_without_an_elevation_axis_gets_out_by_its_azimuth() {
        let bounds = Bounds { has_elevation: false, minimum_elevation: None, ..bounds() };
        let at_deg =
            bounds.at_time(morning()).way_out_deg(Sweep::at_position([130.0, 58.0])).unwrap();
        assert!((15.0..17.0).contains(&at_deg), "{at_deg}");
    }

    #[test]
    fn the_nearest_open_edge_is_the_way_out() {
        let at_deg = way_out_deg([130.0, 58.0]).unwrap();
        assert!((2.0..5.0).contains(&at_deg), "{at_deg}");
        assert_eq!(way_out_deg([90.0, 30.0]), Some(0.0));
    }

    /// Azel judges a held jog repeatedly, so each check of a direction costs time.
    #[test]
    fn a_way_along_the_floor_is_found_in_few_looks() {
        for axes_deg in [[130.0, 5.0], [130.0, 5.01], [130.0, 4.99]] {
            let bounds = bounds();
            let now = bounds.at_time(morning());
            let left = now.entered(Sweep::at_position(axes_deg));
            let turn = now.turn(Sweep::at_position(axes_deg), 0, 1.0);
            let mut looks = 0;
            let turn_deg = turn.out_deg(FURTHEST_DEG, EDGE_DEG, |turn_deg| {
                looks += 1;
                now.spot(&turn, turn_deg, &left)
            });
            assert_eq!(turn_deg.is_some(), axes_deg[1] >= 5.0, "{axes_deg:?}");
            assert!(looks < 100, "{looks} from {axes_deg:?}");
        }
    }
}
