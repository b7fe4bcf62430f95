//! Edits of corners and skyline points, and conversions between plot and sky.

use egui::Pos2;

use super::draft::{Corner, Skies, ZoneDraft};
use crate::{
    astro::{Angle, AzEl, HorizonMask},
    ui::sky_plot::geometry::Dome,
};

/// Min number of corners of a keep-out.
pub(super) const MIN_CORNERS: usize = crate::astro::MIN_CORNERS;

/// Returns the direction under a point of the plot in degrees, with the azimuth turn nearest to
/// `near_deg`. Points outside the rim are on the horizon.
pub(super) fn position_under(dome: Dome, position: Pos2, near_deg: f64) -> (f64, f64) {
    let offset = position - dome.centre;
    let azimuth_deg = f64::from(offset.x.atan2(-offset.y)).to_degrees();
    let elevation_deg = 90.0 - f64::from(offset.length() / dome.radius) * 90.0;
    (counted_near(azimuth_deg, near_deg), elevation_deg.clamp(0.0, 90.0))
}

/// Returns the azimuth plus the whole turns that bring it nearest to `near_deg`, degrees.
pub(super) fn counted_near(azimuth_deg: f64, near_deg: f64) -> f64 {
    near_deg + Angle::from_degrees(azimuth_deg - near_deg).wrapped_180().degrees()
}

/// Rounds to half a degree if `is_coarse`, otherwise to a tenth.
pub(super) fn snapped((azimuth_deg, elevation_deg): (f64, f64), is_coarse: bool) -> (f64, f64) {
    let parts = if is_coarse { 2.0 } else { 10.0 };
    let round = |value: f64| (value * parts).round() / parts;
    (round(azimuth_deg), round(elevation_deg))
}

/// Resets the coordinate that changed less to its value in `start`.
pub(super) fn along_one_axis(start: (f64, f64), end: (f64, f64)) -> (f64, f64) {
    if (end.0 - start.0).abs() >= (end.1 - start.1).abs() {
        (end.0, start.1)
    } else {
        (start.0, end.1)
    }
}

/// Returns the place of a direction in the plot; a direction below the horizon lies on the rim.
pub(super) fn place(dome: Dome, (azimuth_deg, elevation_deg): (f64, f64)) -> Pos2 {
    let azimuth = Angle::from_degrees(azimuth_deg).radians() as f32;
    dome.point_at(azimuth, elevation_deg.max(0.0) as f32)
}

impl ZoneDraft {
    pub(super) fn put(&mut self, corner: usize, (azimuth_deg, elevation_deg): (f64, f64)) {
        if let Some(corner) = self.corners.get_mut(corner) {
            corner.azimuth.set(azimuth_deg);
            corner.elevation.set(elevation_deg);
        }
    }

    /// Adds a corner in the middle of the edge that begins at `corner`. Returns its index.
    pub(super) fn split(&mut self, corner: usize) -> Option<usize> {
        if self.corners.len() >= crate::astro::MAX_CORNERS {
            return None;
        }
        let middle_point = self.middle(corner)?;
        let (azimuth_deg, elevation_deg) = snapped(middle_point, false);
        self.corners.insert(corner + 1, Corner::added(azimuth_deg, elevation_deg));
        Some(corner + 1)
    }

    /// Returns the middle of the edge that begins at `corner`, degrees.
    pub(super) fn middle(&self, corner: usize) -> Option<(f64, f64)> {
        if let Ok(zone) = self.zone() {
            let middle = zone.middle_of_edge(corner)?;
            return Some((middle.azimuth.degrees(), middle.elevation_deg()));
        }
        let start = self.corners.get(corner)?.point();
        let end = self.corners.get((corner + 1) % self.corners.len())?.point();
        Some((f64::midpoint(start.0, end.0), f64::midpoint(start.1, end.1)))
    }

    /// Removes a corner if enough remain. Returns `true` on success.
    pub(super) fn remove(&mut self, corner: usize) -> bool {
        let can = self.corners.len() > MIN_CORNERS && corner < self.corners.len();
        if can {
            self.corners.remove(corner);
        }
        can
    }

    /// Returns the corner after which a new corner at `position` belongs. This is the begin of the
    /// nearest edge in the plot.
    pub(super) fn nearest_edge(&self, dome: Dome, position: Pos2) -> Option<usize> {
        let places: Vec<Pos2> =
            self.corners.iter().map(|corner| place(dome, corner.point())).collect();
        let edges = places.iter().zip(places.iter().cycle().skip(1)).enumerate();
        let distance = |(_, (start, end)): &(usize, (&Pos2, &Pos2))| {
            let along = **end - **start;
            let share = (position - **start).dot(along) / along.length_sq().max(1e-6);
            position.distance(**start + along * share.clamp(0.0, 1.0))
        };
        edges.min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|(index, _)| index)
    }
}

/// Returns the corners of a box between two directions, the shorter way around.
pub(super) fn rectangle(start: (f64, f64), end: (f64, f64)) -> Option<[(f64, f64); 4]> {
    let to_azimuth = counted_near(end.0, start.0);
    let (left, right) = (start.0.min(to_azimuth), start.0.max(to_azimuth));
    let (low, high) = (start.1.min(end.1), start.1.max(end.1));
    let has_area = right - left >= 1.0 && high - low >= 1.0;
    has_area.then_some([(left, low), (left, high), (right, high), (right, low)])
}

impl Skies {
    /// Returns the points of the skyline; empty if the text contains no mask.
    pub(super) fn skyline(&self) -> Vec<(f64, f64)> {
        let mask = self.read_mask().ok().flatten();
        mask.map(|mask| mask.points_deg().to_vec()).unwrap_or_default()
    }

    /// Replaces the skyline. Returns `false` if the points make no valid mask.
    pub(super) fn set_skyline(&mut self, points: Vec<(f64, f64)>) -> bool {
        if points.is_empty() {
            self.mask.clear();
            return true;
        }
        let wrapped = points
            .into_iter()
            .map(|(azimuth, elevation)| (azimuth.rem_euclid(360.0), elevation.clamp(-90.0, 90.0)));
        let mask = HorizonMask::from_degrees(wrapped);
        if let Ok(mask) = &mask {
            self.mask = mask.to_string();
        }
        mask.is_ok()
    }

    /// Returns the index of the first keep-out around a direction, among the keep-outs that
    /// `is_shown` accepts.
    pub(super) fn zone_at(
        &self,
        direction: AzEl,
        is_shown: impl Fn(&ZoneDraft) -> bool,
    ) -> Option<usize> {
        self.zones.iter().position(|zone| {
            is_shown(zone)
                && zone.zone().is_ok_and(|zone| zone.clearance(direction).radians() < 0.0)
        })
    }
}

/// Initial corners of a new keep-out, degrees: a box in the middle of the south.
pub(super) const FIRST_BOX: [(f64, f64); 4] =
    [(170.0, 0.0), (170.0, 20.0), (190.0, 20.0), (190.0, 0.0)];

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;
    use crate::station::Station;

    const DOME: Dome = Dome { centre: pos2(100.0, 100.0), radius: 90.0 };

    #[test]
    fn a_place_and_its_direction_belong_together() {
        for (azimuth, elevation, near) in
            [(370.0, 20.0, 350.0), (-10.0, 0.0, 0.0), (90.0, 45.0, 80.0)]
        {
            let found = position_under(DOME, place(DOME, (azimuth, elevation)), near);
            assert!((found.0 - azimuth).abs() < 1e-3 && (found.1 - elevation).abs() < 1e-3);
        }
        assert!(position_under(DOME, pos2(500.0, 100.0), 90.0).1.abs() < 1e-9);
        assert_eq!(snapped((10.26, 5.74), true), (10.5, 5.5));
        assert_eq!(along_one_axis((10.0, 5.0), (12.0, 6.0)), (12.0, 5.0));
    }

    #[test]
    fn a_box_goes_the_shorter_way_through_north() {
        let found = rectangle((355.0, 20.0), (10.0, 0.0));
        assert_eq!(found, Some([(355.0, 0.0), (355.0, 20.0), (370.0, 20.0), (370.0, 0.0)]));
        assert_eq!(rectangle((10.0, 5.0), (10.5, 20.0)), None);
    }

    #[test]
    fn corners_are_added_and_removed_and_three_remain() {
        let mut zone = ZoneDraft::added("box".to_owned(), &FIRST_BOX);
        assert_eq!(zone.nearest_edge(DOME, place(DOME, (180.0, 25.0))), Some(1));
        assert_eq!(zone.split(1), Some(2));
        assert_eq!(zone.corners[2].point(), (180.0, 20.0));
        assert!(zone.remove(2) && zone.remove(0));
        assert!(!zone.remove(0));
        assert_eq!(zone.corners.len(), 3);
    }

    #[test]
    fn a_skyline_of_points_becomes_the_text() {
        let mut skies = Skies::new(&Station::default());
        assert!(skies.set_skyline(vec![(370.0, 4.0), (90.0, 2.5)]));
        assert_eq!(skies.skyline(), [(10.0, 4.0), (90.0, 2.5)]);
        assert!(skies.set_skyline(vec![(10.0, 4.0), (370.0, 2.5)]), "a wall");
        let thrice = vec![(10.0, 4.0), (370.0, 2.5), (10.0, 3.0)];
        assert!(!skies.set_skyline(thrice), "one direction three times");
        assert!(skies.set_skyline(Vec::new()) && skies.mask.is_empty());
    }
}
