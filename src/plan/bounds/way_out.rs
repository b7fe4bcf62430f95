//! The way out of what is forbidden.
//!
//! The nearest edge is no way out where the floor, the end of the travel or another
//! barrier lies behind it. So depth is measured along what an axis can really do:
//! turn one way until the antenna points where it may.

use jiff::Timestamp;

use super::{AzEl, Barrier, Bounds};

/// The finest step of a look along a way, degrees.
const STEP_DEG: f64 = 0.1;
/// An edge is found to this, degrees.
const EDGE_DEG: f64 = 1e-9;
/// A gap that is narrower than this, degrees of the axis, is no way out: what is judged
/// ahead never gets into it.
const GAP_DEG: f64 = 1.0;
/// The stretch over which the speed of an axis in the sky is taken, degrees.
const STRETCH_DEG: f64 = 0.01;
/// No axis turns further to get out, degrees.
const FURTHEST_DEG: f64 = 360.0;

/// What a place on the way is.
enum Place {
    /// No barrier holds.
    Free,
    /// Still inside; neither an edge nor another barrier is within this, degrees.
    Inside(f64),
    /// Inside another barrier than those that it is to leave.
    Barred,
}

impl Bounds {
    /// How far it is to where the antenna may point, by the shortest turn of one axis
    /// that leads there within its travel and through no other barrier; degrees of the
    /// sky, zero outside all barriers. `None` where no such turn does.
    pub fn way_out_deg(&self, axes_deg: [f64; 2], at: Timestamp) -> Option<f64> {
        let suns = self.suns(at);
        let left = self.entered(self.direction(axes_deg), &suns);
        if !left.contains(&true) {
            return Some(0.0);
        }
        let ways = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        let there_are = |(axis, _): &(usize, f64)| *axis == 0 || self.has_elevation;
        let lengths = ways.into_iter().filter(there_are).filter_map(|(axis, way)| {
            let turn_deg = self.turn_out_deg(axes_deg, axis, way, &left, &suns)?;
            Some(turn_deg * self.speed(axes_deg, axis))
        });
        lengths.min_by(f64::total_cmp)
    }

    /// How deep the axes stand below the minimum elevation, and inside of each other
    /// barrier by its nearest edge; degrees, zero outside.
    pub fn depths_deg(&self, axes_deg: [f64; 2], at: Timestamp) -> (f64, Vec<f64>) {
        let (mut below_deg, mut inside_deg) = (0.0, Vec::new());
        let clearances = self.clearances(self.direction(axes_deg), at).into_iter();
        for clearance in clearances.filter(|clearance| !clearance.warns_only) {
            let deep_deg = (-clearance.angle.degrees()).max(0.0);
            if clearance.barrier == Barrier::MinimumElevation {
                below_deg = deep_deg;
            } else {
                inside_deg.push(deep_deg);
            }
        }
        (below_deg, inside_deg)
    }

    /// The barriers that hold at a direction, in their order.
    fn entered(&self, direction: AzEl, suns: &[AzEl]) -> Vec<bool> {
        let each = self.each(direction, suns);
        each.map(|(_, angle, warns_only)| !warns_only && angle.degrees() < 0.0).collect()
    }

    /// By how much the axis turns one way until it is out of what is `left`, degrees.
    fn turn_out_deg(
        &self,
        axes_deg: [f64; 2],
        axis: usize,
        way: f64,
        left: &[bool],
        suns: &[AzEl],
    ) -> Option<f64> {
        let axes_at = |turn_deg: f64| {
            let [first, second] = axes_deg;
            if axis == 0 {
                [first + way * turn_deg, second]
            } else {
                [first, second + way * turn_deg]
            }
        };
        let place = |turn_deg| self.place(axes_at(turn_deg), left, suns);
        let end_deg = self.turn_to_end_deg(axes_deg, axis, way).min(FURTHEST_DEG);
        let (mut inside_deg, mut turn_deg) = (0.0, 0.0);
        loop {
            match place(turn_deg) {
                Place::Inside(_) if turn_deg >= end_deg => return None,
                Place::Inside(step_deg) => {
                    inside_deg = turn_deg;
                    // The edge may lie just before the end of the travel.
                    turn_deg = f64::min(turn_deg + step_deg.max(STEP_DEG), end_deg);
                }
                // The edge may lie just before another barrier, too.
                beyond @ (Place::Free | Place::Barred) => {
                    let (mut beyond, mut beyond_deg) = (beyond, turn_deg);
                    while beyond_deg - inside_deg > EDGE_DEG {
                        let middle_deg = f64::midpoint(inside_deg, beyond_deg);
                        match place(middle_deg) {
                            Place::Inside(_) => inside_deg = middle_deg,
                            nearer => (beyond, beyond_deg) = (nearer, middle_deg),
                        }
                    }
                    let far_deg = beyond_deg + GAP_DEG;
                    let has_room = far_deg <= end_deg && matches!(place(far_deg), Place::Free);
                    return (matches!(beyond, Place::Free) && has_room).then_some(beyond_deg);
                }
            }
        }
    }

    fn place(&self, axes_deg: [f64; 2], left: &[bool], suns: &[AzEl]) -> Place {
        let mut deepest_deg = 0.0;
        let mut room_deg = f64::INFINITY;
        let each = self.each(self.direction(axes_deg), suns).zip(left);
        for ((_, angle, warns_only), is_left) in each {
            let clear_deg = angle.degrees();
            if warns_only {
                continue;
            }
            if *is_left {
                deepest_deg = f64::max(deepest_deg, -clear_deg);
            } else if clear_deg < 0.0 {
                return Place::Barred;
            } else {
                room_deg = f64::min(room_deg, clear_deg);
            }
        }
        if deepest_deg > 0.0 { Place::Inside(deepest_deg.min(room_deg)) } else { Place::Free }
    }

    /// By how much the axis can turn one way within its travel, degrees; an axis beyond
    /// its other end may come back.
    fn turn_to_end_deg(&self, axes_deg: [f64; 2], axis: usize, way: f64) -> f64 {
        let [first, second] = self.mount.travel_deg();
        let ((from_deg, to_deg), at_deg) =
            if axis == 0 { (first, axes_deg[0]) } else { (second, axes_deg[1]) };
        if way > 0.0 { to_deg - at_deg } else { at_deg - from_deg }
    }

    /// How far the direction goes in the sky for each degree of the axis: the same all
    /// the way round.
    fn speed(&self, axes_deg: [f64; 2], axis: usize) -> f64 {
        let [first, second] = axes_deg;
        let on_deg =
            if axis == 0 { [first + STRETCH_DEG, second] } else { [first, second + STRETCH_DEG] };
        let moved = self.direction(axes_deg).separation(self.direction(on_deg));
        moved.degrees() / STRETCH_DEG
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::Angle,
        station::{Antenna, Entered, KeepOut, Mount, Station},
    };

    /// The keep-out reaches below the minimum elevation of 5 degrees.
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
        Bounds::of(&Station { keep_outs: vec![keep_out], ..Station::default() }, &antenna)
    }

    fn way_out_deg(axes_deg: [f64; 2]) -> Option<f64> {
        bounds().way_out_deg(axes_deg, "2026-08-12T10:00:00Z".parse().unwrap())
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
        let at = "2026-08-12T10:00:00Z".parse().unwrap();
        let at_deg = bounds_to(161.08).way_out_deg([155.0, 30.0], at).unwrap();
        assert!((4.0..5.0).contains(&at_deg), "{at_deg}");
        let at_deg = bounds_to(161.02).way_out_deg([155.0, 30.0], at).unwrap();
        assert!(at_deg > 20.0, "too narrow: {at_deg}");
    }

    #[test]
    fn a_gap_before_the_floor_is_a_way_out_where_there_is_room() {
        let mut bounds = bounds();
        // The lower edge is at 2 degrees.
        for (floor_deg, is_open) in [(0.94, true), (0.96, false)] {
            bounds.minimum_elevation = Some(Angle::from_degrees(floor_deg));
            let at_deg = bounds.way_out_deg([130.0, 3.0], "2026-08-12T10:00:00Z".parse().unwrap());
            assert_eq!(at_deg.unwrap() < 1.1, is_open, "{at_deg:?}");
        }
    }

    #[test]
    fn an_antenna_without_an_elevation_axis_gets_out_by_its_azimuth() {
        let bounds = Bounds { has_elevation: false, minimum_elevation: None, ..bounds() };
        let at = "2026-08-12T10:00:00Z".parse().unwrap();
        let at_deg = bounds.way_out_deg([130.0, 58.0], at).unwrap();
        assert!((15.0..17.0).contains(&at_deg), "{at_deg}");
    }

    #[test]
    fn the_nearest_open_edge_is_the_way_out() {
        let at_deg = way_out_deg([130.0, 58.0]).unwrap();
        assert!((2.0..5.0).contains(&at_deg), "{at_deg}");
        assert_eq!(way_out_deg([90.0, 30.0]), Some(0.0));
    }
}
