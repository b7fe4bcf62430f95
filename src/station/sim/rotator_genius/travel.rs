//! Travel between the limits of a rotator.

/// Travel of a rotator, clockwise from its counter-clockwise to its clockwise limit. This is the
/// natural meaning, and recorded units fit it.
///
/// A place on the travel is in degrees clockwise from the counter-clockwise limit. Equal limits
/// mean a whole turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Travel {
    ccw_deg: f64,
    span_deg: f64,
}

impl Travel {
    pub(super) fn new(cw_deg: f64, ccw_deg: f64) -> Self {
        let span = cw_deg - ccw_deg;
        Self { ccw_deg, span_deg: if span > 0.0 { span } else { span + 360.0 } }
    }

    /// Returns the place of an azimuth or elevation, 0 to 360 degrees.
    pub(super) fn place(&self, angle_deg: f64) -> f64 {
        let clockwise = angle_deg - self.ccw_deg;
        self.nearest(if clockwise < 0.0 { clockwise + 360.0 } else { clockwise })
    }

    /// Returns the place with the direction of `place` that is on the travel or nearest to one of
    /// its ends.
    pub(super) fn nearest(&self, place: f64) -> f64 {
        let max = self.span_deg + (360.0 - self.span_deg) / 2.0;
        if (max - 360.0..=max).contains(&place) {
            return place;
        }
        let clockwise = place.rem_euclid(360.0);
        if clockwise > max { clockwise - 360.0 } else { clockwise }
    }

    /// Returns the azimuth or elevation at a place, 0 to 360 degrees.
    pub(super) fn angle_deg(&self, place: f64) -> f64 {
        let angle = self.ccw_deg + place;
        if (0.0..=360.0).contains(&angle) { angle } else { angle.rem_euclid(360.0) }
    }

    /// Returns `true` if a place is on the travel, in the whole degrees of a status.
    pub(super) fn contains(&self, place: f64) -> bool {
        (0.0..=self.span_deg).contains(&self.nearest(place).round())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_runs_clockwise_over_north_too() {
        for (cw, ccw, in_force, outside) in [
            (359.0, 0.0, vec![0.0, 180.0, 359.0, 359.6], vec![]),
            (350.0, 10.0, vec![10.0, 180.0, 350.0], vec![0.0, 9.0, 351.0, 360.0]),
            (360.0, 0.0, vec![0.0, 180.0, 360.0], vec![]),
            (45.0, 45.0, vec![0.0, 45.0, 225.0], vec![]),
            (30.0, 300.0, vec![300.0, 0.0, 360.0, 30.0], vec![31.0, 180.0, 299.0]),
            (90.0, 0.0, vec![0.0, 90.0], vec![91.0, 180.0, 355.0]),
            (270.0, 90.0, vec![90.0, 180.0, 270.0], vec![0.0, 89.0, 271.0]),
        ] {
            let travel = Travel::new(cw, ccw);
            for angle in in_force {
                assert!(travel.contains(travel.place(angle)), "{cw} {ccw} {angle}");
            }
            for angle in outside {
                assert!(!travel.contains(travel.place(angle)), "{cw} {ccw} {angle}");
            }
        }
    }

    #[test]
    fn a_place_is_an_angle_again() {
        for (cw, ccw) in [(359.0, 0.0), (360.0, 0.0), (30.0, 300.0), (0.0, 0.0)] {
            let travel = Travel::new(cw, ccw);
            for angle in [0.0, 12.5, 180.0, 359.5] {
                let turned = travel.angle_deg(travel.place(angle)) - angle;
                assert!(turned.rem_euclid(360.0) < 1e-9, "{cw} {ccw} {angle} {turned}");
            }
        }
        // On a mount with its stop in the north, both angles are ends.
        let travel = Travel::new(360.0, 0.0);
        assert!(travel.place(360.0) - travel.place(0.0) > 359.0);
        assert!((travel.angle_deg(travel.place(360.0)) - 360.0).abs() < 1e-9);
    }
}
