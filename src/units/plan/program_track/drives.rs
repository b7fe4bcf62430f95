//! Drives of an antenna: the positions that point in a direction, and the commands for them.

use crate::{
    astro::{
        Angle, AzEl,
        xy_mount::{self, AxisAngles},
    },
    plan::{
        Sample,
        az_el::{AzElAxes, Flip, FlipChoice, Planned, Start},
        detour::AxisLimits,
        rate_limited::rate_limited,
    },
    station::{MotionLimits, Mount},
};

const ZENITH_DEG: f64 = 90.0;
/// Min distance of a command from the end of the travel of an X/Y mount, or from its minimum
/// elevation, degrees. The mount receives a rounded direction, and refuses a direction beyond the
/// end.
const BESIDE_END_DEG: f64 = 0.01;

/// Abilities of the drives for position commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drives {
    pub mount: Mount,
    pub limits: MotionLimits,
    /// Rate of each axis, degrees per second: the allowed rate until the real one is measured.
    pub rates_deg_s: [f64; 2],
    /// Step between commandable positions, degrees; 0 if all positions are commandable.
    pub step_deg: f64,
    /// Max difference between the commanded position and the position at rest, degrees.
    pub arrives_within_deg: f64,
    /// `false` for a rotator without elevation.
    pub has_elevation: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Position of an azimuth axis, which may exceed a full turn; `None` leaves the axis in place.
    pub azimuth: Option<Angle>,
    /// Position of an elevation axis, beyond 90 degrees when flipped; `None` leaves the axis in
    /// place.
    pub elevation: Option<Angle>,
}

impl Drives {
    /// Returns the positions of both axes along `samples`, which are `step_s` seconds apart, with
    /// the flip of `choice` on an elevation-over-azimuth mount. If a direction is out of travel,
    /// the axes wait as near to it as possible.
    pub(super) fn along(
        &self,
        samples: &[Sample],
        step_s: f64,
        start: Start,
        choice: FlipChoice,
    ) -> Planned {
        match (self.mount, choice) {
            (Mount::Xy { lower_axis_azimuth_deg, .. }, _) => {
                let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
                self.along_crossed(samples, step_s, start, lower_axis)
            }
            (Mount::AzEl { .. }, FlipChoice::Keep(flip)) => {
                self.az_el().along(samples, step_s, start, flip)
            }
            (Mount::AzEl { .. }, FlipChoice::Prefer(flip)) => {
                self.az_el().best(samples, step_s, start, flip)
            }
        }
    }

    fn along_crossed(
        &self,
        samples: &[Sample],
        step_s: f64,
        start: Start,
        lower_axis: Angle,
    ) -> Planned {
        let (lowest_deg, highest_deg) = self.elevations_deg();
        let axes = samples.iter().map(|Sample { direction, .. }| {
            // Clip the direction first, because the minimum elevation lies askew to both axes.
            let elevation_deg = direction.elevation_deg().min(highest_deg).max(lowest_deg);
            let reachable = AzEl { elevation: Angle::from_degrees(elevation_deg), ..*direction };
            let axes = xy_mount::axes_from_azel(reachable, lower_axis);
            self.within_travel([axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0))
        });
        let (lower, upper): (Vec<f64>, Vec<f64>) =
            axes.map(|[lower, upper]| (lower, upper)).unzip();
        let turned = |deg: f64| deg.to_radians().sin_cos();
        let target_at =
            |axis: &[f64], index: usize| turned(axis.get(index).copied().unwrap_or(90.0));
        let cost_of = |(to_sin, to_cos): (f64, f64), (sin, cos): (f64, f64)| {
            1.0 - (cos * to_cos + sin * to_sin)
        };
        let [lower_max_deg, upper_max_deg] = self.rates_deg_s.map(|rate| rate * step_s);
        let lower_cost = |index: usize| {
            // The further the upper axis is tipped, the less the lower axis matters.
            let ((sin, _), target) = (target_at(&upper, index), target_at(&lower, index));
            move |position: &(f64, f64)| sin.powi(2) * cost_of(target, *position)
        };
        let upper_cost = |index: usize| {
            let aim = target_at(&upper, index);
            move |position: &(f64, f64)| cost_of(aim, *position)
        };
        let departure =
            |index: usize, targets: &[f64]| start.departure(index, targets, self.rates_deg_s);
        let axes_deg = [
            rate_limited(&lower, lower_max_deg, departure(0, &lower), turned, lower_cost),
            rate_limited(&upper, upper_max_deg, departure(1, &upper), turned, upper_cost),
        ];
        Planned { flip: Flip::None, axes_deg, slews: Vec::new(), goes_round: false }
    }

    fn az_el(&self) -> AzElAxes {
        let [azimuth_deg, _] = self.mount.travel_deg();
        AzElAxes {
            azimuth_deg,
            elevation_deg: self.has_elevation.then(|| self.elevations_deg()),
            rates_deg_s: self.rates_deg_s,
        }
    }

    /// Returns the commandable position of an axis, 0 or 1, nearest to `position_deg`.
    pub(super) fn tellable_deg(&self, axis: usize, position_deg: f64) -> f64 {
        let (from_deg, to_deg) =
            self.mount.travel_deg().get(axis).copied().unwrap_or((f64::MIN, f64::MAX));
        let (from_deg, to_deg) = match (self.mount, axis) {
            (Mount::AzEl { .. }, 1) => self.elevations_deg(),
            _ => (from_deg, to_deg),
        };
        // An X/Y mount receives a direction, in which no axis has a step.
        if matches!(self.mount, Mount::Xy { .. }) {
            let (from_deg, to_deg) = beside_ends((from_deg, to_deg));
            return position_deg.max(from_deg).min(to_deg);
        }
        if self.step_deg <= 0.0 {
            return position_deg.clamp(from_deg, to_deg);
        }
        let (first, last) = ((from_deg / self.step_deg).ceil(), (to_deg / self.step_deg).floor());
        // The travel is shorter than one step, so no step lies within it.
        if first > last {
            return position_deg.clamp(from_deg, to_deg);
        }
        (position_deg / self.step_deg).round().clamp(first, last) * self.step_deg
    }

    /// Returns the command that brings the axes to these positions. `None` leaves an axis of an
    /// az/el mount in place.
    pub(super) fn set_point(&self, [first, second]: [Option<f64>; 2]) -> SetPoint {
        match self.mount {
            Mount::Xy { lower_axis_azimuth_deg, .. } => {
                let [lower, upper] =
                    [first, second].map(|axis| Angle::from_degrees(axis.unwrap_or(90.0) - 90.0));
                let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
                let direction = xy_mount::azel_from_axes(AxisAngles { lower, upper }, lower_axis);
                let (lowest_deg, highest_deg) = self.elevations_deg();
                let lowest_deg = highest_deg.min(lowest_deg + BESIDE_END_DEG);
                let elevation = direction.elevation_deg().clamp(lowest_deg, highest_deg);
                SetPoint {
                    azimuth: Some(direction.azimuth),
                    elevation: Some(Angle::from_degrees(elevation)),
                }
            }
            Mount::AzEl { .. } => SetPoint {
                azimuth: first.map(Angle::from_degrees),
                elevation: second.filter(|_| self.has_elevation).map(Angle::from_degrees),
            },
        }
    }

    /// Returns the limits of the axes for a detour.
    pub(in crate::plan) fn axis_limits(&self) -> AxisLimits {
        let [first, second] = self.mount.travel_deg();
        let second =
            if matches!(self.mount, Mount::AzEl { .. }) { self.elevations_deg() } else { second };
        AxisLimits::new([first, second], self.rates_deg_s, self.step_deg + self.arrives_within_deg)
    }

    /// Returns `true` if Azel can command one axis without the other.
    pub(super) fn takes_single_axes(&self) -> bool {
        matches!(self.mount, Mount::AzEl { .. })
    }

    /// Returns `true` if `direction` is not below the minimum elevation.
    pub fn may_reach(&self, direction: AzEl) -> bool {
        !self.has_elevation || direction.elevation_deg() >= self.elevations_deg().0
    }

    /// Returns the ends of the elevation axis above the minimum elevation, on both sides of the
    /// zenith if the mount can flip.
    fn elevations_deg(&self) -> (f64, f64) {
        let floor_deg = self.limits.minimum_elevation_deg;
        let (lowest_deg, highest_deg) = match self.mount {
            Mount::Xy { .. } => (floor_deg, ZENITH_DEG),
            Mount::AzEl { elevation_from_deg, elevation_to_deg, .. } => {
                (floor_deg.max(elevation_from_deg), elevation_to_deg.min(180.0 - floor_deg))
            }
        };
        (lowest_deg, highest_deg.max(lowest_deg))
    }

    /// Clips the positions of an X/Y mount to its travel.
    fn within_travel(&self, axes_deg: [f64; 2]) -> [f64; 2] {
        let [(a, b), (c, d)] = self.mount.travel_deg().map(beside_ends);
        let [first, second] = axes_deg;
        [first.max(a).min(b), second.max(c).min(d)]
    }
}

/// Returns the travel of a crossed axis that a direction can command, degrees.
fn beside_ends((from_deg, to_deg): (f64, f64)) -> (f64, f64) {
    (from_deg + BESIDE_END_DEG, to_deg - BESIDE_END_DEG)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::Antenna;

    #[test]
    fn a_crossed_mount_at_the_end_of_its_reach_can_be_told_its_direction_in_thousandths() {
        let mut antenna = Antenna::satrak("", "");
        let ends_deg = (22.5, 151.3);
        if let Mount::Xy { travel_from_deg, travel_to_deg, .. } = &mut antenna.mount {
            (*travel_from_deg, *travel_to_deg) = ends_deg;
        }
        antenna.limits.minimum_elevation_deg = 5.964_4;
        let drives = drives(&antenna, 0.0);
        let thousandths = |angle: Angle| (angle.degrees() * 1000.0).round() / 1000.0;
        for azimuth_deg in 0..360 {
            let axes_deg = positions(&drives, sample_of(f64::from(azimuth_deg), 5.0));
            let told_deg = [0, 1].map(|axis| drives.tellable_deg(axis, axes_deg[axis]));
            let point = drives.set_point(told_deg.map(Some));
            let [azimuth, elevation] = [point.azimuth, point.elevation].map(Option::unwrap);
            let sent = sample_of(thousandths(azimuth), thousandths(elevation));
            assert!(sent.direction.elevation_deg() >= 5.964_4, "at {azimuth_deg}");
            let Mount::Xy { lower_axis_azimuth_deg, .. } = antenna.mount else { panic!() };
            let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
            let axes = xy_mount::axes_from_azel(sent.direction, lower_axis);
            for deg in [axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0) {
                assert!((ends_deg.0..=ends_deg.1).contains(&deg), "{deg} at {azimuth_deg}");
            }
        }
    }

    fn drives(antenna: &Antenna, step_deg: f64) -> Drives {
        Drives {
            mount: antenna.mount,
            limits: antenna.limits,
            rates_deg_s: [antenna.limits.maximum_rate_deg_s; 2],
            step_deg,
            arrives_within_deg: 0.0,
            has_elevation: true,
        }
    }

    fn sample_of(azimuth_deg: f64, elevation_deg: f64) -> Sample {
        let direction = AzEl::from_degrees(azimuth_deg, elevation_deg);
        Sample { time: jiff::Timestamp::UNIX_EPOCH, direction }
    }

    fn positions(drives: &Drives, sample: Sample) -> [f64; 2] {
        let planned = drives.along(&[sample], 1.0, Start::default(), FlipChoice::Keep(Flip::None));
        planned.axes_deg.map(|axis| axis[0])
    }

    #[test]
    fn a_set_point_points_where_the_axes_do_on_either_mount() {
        for antenna in [Antenna::satrak("", ""), Antenna::rc2000c("", "")] {
            let drives = drives(&antenna, 0.0);
            let sample = sample_of(213.0, 41.0);
            let [first, second] = positions(&drives, sample);
            let point = drives.set_point([Some(first), Some(second)]);
            let direction =
                AzEl { azimuth: point.azimuth.unwrap(), elevation: point.elevation.unwrap() };
            assert!(direction.separation(sample.direction).degrees() < 1e-9);
        }
    }

    #[test]
    fn below_the_floor_the_elevation_waits_at_it() {
        for antenna in [Antenna::satrak("", ""), Antenna::rc2000c("", "")] {
            let drives = drives(&antenna, 0.0);
            let [first, second] = positions(&drives, sample_of(90.0, 1.0));
            let point = drives.set_point([Some(first), Some(second)]);
            // A crossed axis stays off its end, and off the floor.
            assert!((0.0..0.02).contains(&(point.elevation.unwrap().degrees() - 5.0)));
            assert!((point.azimuth.unwrap().degrees() - 90.0).abs() < 1e-9);
            assert!(!drives.may_reach(AzEl::from_degrees(90.0, 1.0)));
        }
    }

    /// Returns an antenna whose elevation travels over the zenith.
    fn tipping() -> Antenna {
        let mut antenna = Antenna::genius("", "");
        if let Mount::AzEl { elevation_to_deg, .. } = &mut antenna.mount {
            *elevation_to_deg = 180.0;
        }
        antenna
    }

    #[test]
    fn whole_steps_stay_within_the_travel() {
        let drives = drives(&tipping(), 1.0);
        assert_eq!(drives.tellable_deg(0, 359.7).to_bits(), 360.0_f64.to_bits());
        assert_eq!(drives.tellable_deg(0, 360.7).to_bits(), 360.0_f64.to_bits());
        assert_eq!(drives.tellable_deg(0, 12.4).to_bits(), 12.0_f64.to_bits());
        assert_eq!(drives.tellable_deg(1, 181.0).to_bits(), 180.0_f64.to_bits());
    }

    #[test]
    fn on_either_side_of_the_zenith_the_antenna_points_high_enough() {
        let mut drives = drives(&tipping(), 1.0);
        drives.limits.minimum_elevation_deg = 7.5;
        assert_eq!(drives.tellable_deg(1, 3.0).to_bits(), 8.0_f64.to_bits());
        assert_eq!(drives.tellable_deg(1, 178.0).to_bits(), 172.0_f64.to_bits());
        if let Mount::AzEl { elevation_to_deg, .. } = &mut drives.mount {
            *elevation_to_deg = 90.0;
        }
        assert_eq!(drives.tellable_deg(1, 178.0).to_bits(), 90.0_f64.to_bits());
    }
}
