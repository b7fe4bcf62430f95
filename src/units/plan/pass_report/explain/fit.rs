//! One fit: where an antenna with certain causes points, and the sizes that leave least of the
//! error.

use glam::{DMat3, DVec3};
use jiff::Timestamp;

use super::{Cause, Evidence, Point};
use crate::{
    astro::{
        Angle, AzEl,
        time::{add_seconds, seconds_between},
        xy_mount,
    },
    orbit::Propagator,
    station::Mount,
};

/// Most rounds of a fit; most need three.
const ROUNDS: usize = 8;
/// Slowest and fastest drive that is looked for, degrees per second.
const RATES_DEG_S: (f64, f64) = (0.05, 20.0);

/// A family of causes with up to two sizes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Family<'a> {
    Elements(&'a (Timestamp, Propagator)),
    Late,
    Azimuth,
    Elevation,
    Tilt,
    AzimuthScale,
    ElevationScale,
}

/// One or two causes with the sizes that fit best.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub cause: Cause,
    pub with: Option<Cause>,
    /// Sum of the squares of what is left.
    pub left: f64,
}

impl Family<'_> {
    /// Those whose size is fitted.
    pub(super) const ALL: [Self; 6] = [
        Self::Late,
        Self::Azimuth,
        Self::Elevation,
        Self::Tilt,
        Self::AzimuthScale,
        Self::ElevationScale,
    ];

    /// Small steps of its sizes.
    fn steps(self) -> &'static [f64] {
        match self {
            Self::Elements(_) => &[],
            Self::Late => &[0.01],
            Self::Tilt => &[1e-3, 1e-3],
            _ => &[1e-3],
        }
    }

    pub(super) fn needs_elevation(self) -> bool {
        matches!(self, Self::Elevation | Self::Tilt | Self::ElevationScale)
    }

    /// The cause of the first of these sizes.
    fn cause(self, sizes: &[f64]) -> Cause {
        let [first, second] = [0, 1].map(|place| sizes.get(place).copied().unwrap_or_default());
        match self {
            Self::Elements((epoch, _)) => Cause::OtherElements { epoch: *epoch },
            Self::Late => Cause::Late { late_s: first },
            Self::Azimuth => Cause::AzimuthOffset { offset_deg: first },
            Self::Elevation => Cause::ElevationOffset { offset_deg: first },
            Self::Tilt => Cause::Tilt { north_deg: first, east_deg: second },
            Self::AzimuthScale => Cause::AzimuthScale { per_mille: first },
            Self::ElevationScale => Cause::ElevationScale { per_mille: first },
        }
    }

    /// Where an antenna points that would point at `at` without this cause.
    fn turns(self, at: AzEl, point: &Point<'_>, sizes: &[f64]) -> AzEl {
        let AzEl { azimuth, elevation } = at;
        let deg = Angle::from_degrees;
        match self.cause(sizes) {
            Cause::AzimuthOffset { offset_deg } => {
                AzEl { azimuth: azimuth + deg(offset_deg), elevation }
            }
            Cause::ElevationOffset { offset_deg } => {
                AzEl { azimuth, elevation: elevation + deg(offset_deg) }
            }
            Cause::Tilt { north_deg, east_deg } => {
                // What the axis leans towards is nearer to the axis, and so is read higher.
                let lean = DVec3::new(deg(north_deg).radians(), -deg(east_deg).radians(), 0.0);
                AzEl::from_enu(at.to_enu() + lean.cross(at.to_enu()))
            }
            Cause::AzimuthScale { per_mille } => {
                AzEl { azimuth: azimuth + deg(point.azimuth_deg * per_mille / 1000.0), elevation }
            }
            Cause::ElevationScale { per_mille } => AzEl {
                azimuth,
                elevation: elevation + deg(elevation.degrees() * per_mille / 1000.0),
            },
            // These move the satellite, not the antenna.
            Cause::Late { .. } | Cause::OtherElements { .. } | Cause::SlowDrives { .. } => at,
        }
    }
}

/// Causes that act together, each with its sizes.
fn sized<'a>(
    families: &'a [Family<'a>],
    mut sizes: &'a [f64],
) -> impl Iterator<Item = (Family<'a>, &'a [f64])> {
    families.iter().map(move |family| {
        let (own, others) = sizes.split_at_checked(family.steps().len()).unwrap_or_default();
        sizes = others;
        (*family, own)
    })
}

/// Direction in which an antenna with these causes points.
fn modelled(families: &[Family<'_>], sizes: DVec3, point: &Point<'_>) -> Option<AzEl> {
    let sizes = sizes.to_array();
    let (mut followed, mut late_s) = (None, None);
    for (family, own) in sized(families, &sizes) {
        match family {
            Family::Elements((_, other)) => followed = Some(other),
            Family::Late => late_s = own.first(),
            _ => (),
        }
    }
    let mut at = point.satellite;
    if followed.is_some() || late_s.is_some() {
        let time = add_seconds(point.time, -late_s.copied().unwrap_or_default());
        at = followed.unwrap_or(point.propagator).look_from(point.site, time).ok()?.direction;
    }
    let turned = sized(families, &sizes).fold(at, |at, (family, own)| family.turns(at, point, own));
    Some(turned)
}

impl Evidence<'_> {
    /// Fits the sizes of one or two causes by least squares (Gauss-Newton). A tilt has two sizes,
    /// another set of elements none, every other cause one.
    pub(super) fn fitted(&self, first: Family<'_>, second: Option<Family<'_>>) -> Found {
        let families: Vec<Family<'_>> = std::iter::once(first).chain(second).collect();
        let mut steps = DVec3::ZERO;
        let each = families.iter().flat_map(|family| family.steps()).zip(DVec3::AXES);
        each.for_each(|(step, axis)| steps += axis * *step);
        let unused =
            DMat3::from_diagonal(DVec3::select(steps.cmpeq(DVec3::ZERO), DVec3::ONE, DVec3::ZERO));
        let mut sizes = DVec3::ZERO;
        for _ in 0..ROUNDS {
            if steps == DVec3::ZERO {
                break;
            }
            let (mut normal, mut right) = (unused, DVec3::ZERO);
            for point in self.points() {
                let model = |sizes: DVec3| {
                    let direction = modelled(&families, sizes, point).unwrap_or(point.satellite);
                    direction.to_enu() - point.satellite.to_enu()
                };
                let here = model(sizes);
                let [x, y, z] = DVec3::AXES.map(|axis| match steps.dot(axis) {
                    0.0 => DVec3::ZERO,
                    step => (model(sizes + axis * step) - here) / step,
                });
                let rows = DMat3::from_cols(x, y, z).transpose();
                normal += rows * rows.transpose();
                right += rows * (point.error - here);
            }
            let change = solved(normal, right);
            sizes += change;
            if change.abs().cmple(steps / 10.0).all() {
                break;
            }
        }
        let left = self.sum(|point| modelled(&families, sizes, point));
        let sizes = sizes.to_array();
        let (own, others) = sizes.split_at(first.steps().len());
        Found { cause: first.cause(own), with: second.map(|of| of.cause(others)), left }
    }

    /// The rate of drives that explains most.
    pub(super) fn slow_drives(&self) -> Found {
        let (mut low, mut high) = (RATES_DEG_S.0.ln(), RATES_DEG_S.1.ln());
        // Coarse, because the sum has flat parts; then between the neighbours of the best.
        let count = 40;
        let at = |step: u32, low: f64, high: f64| {
            low + (high - low) * f64::from(step) / f64::from(count)
        };
        for _ in 0..3 {
            let sums = (0..=count).map(|step| (step, self.sum_of_slow(at(step, low, high).exp())));
            let best = sums.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(step, _)| step);
            let around = (best.saturating_sub(1), (best + 1).min(count));
            (low, high) = (at(around.0, low, high), at(around.1, low, high));
        }
        let rate_deg_s = f64::midpoint(low, high).exp();
        let left = self.sum_of_slow(rate_deg_s);
        Found { cause: Cause::SlowDrives { rate_deg_s }, with: None, left }
    }

    /// Sum of the squares that are left beside an antenna whose axes follow the satellite at this
    /// rate at most.
    fn sum_of_slow(&self, rate_deg_s: f64) -> f64 {
        self.passes.iter().map(|points| sum_of_slow(points, self.mount, rate_deg_s)).sum()
    }
}

/// Angles of the axes that point at `direction`, degrees as the mount counts. `azimuth_deg`: its
/// azimuth, continued over north.
fn axes_deg(mount: Mount, direction: AzEl, azimuth_deg: f64) -> [f64; 2] {
    match mount {
        Mount::AzEl { .. } => [azimuth_deg, direction.elevation_deg()],
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
            let axes = xy_mount::axes_from_azel(direction, lower_axis);
            [axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0)
        }
    }
}

fn sum_of_slow(points: &[Point<'_>], mount: Mount, rate_deg_s: f64) -> f64 {
    let mut before: Option<(Timestamp, [f64; 2])> = None;
    let mut sum = 0.0;
    for point in points {
        let Point { time, satellite, azimuth_deg, measured, .. } = *point;
        let at_deg = match before {
            None => {
                let off = (measured.azimuth - satellite.azimuth).wrapped_180();
                axes_deg(mount, measured, azimuth_deg + off.degrees())
            }
            Some((before, [first, second])) => {
                let most = rate_deg_s * seconds_between(before, time);
                let turned = |from: f64, to: f64| from + (to - from).clamp(-most, most);
                let [to_first, to_second] = axes_deg(mount, satellite, azimuth_deg);
                [turned(first, to_first), turned(second, to_second)]
            }
        };
        before = Some((time, at_deg));
        let model = mount.direction(at_deg).to_enu() - satellite.to_enu();
        sum += (point.error - model).length_squared();
    }
    sum
}

/// Solution of the equations; zero where these positions do not settle it.
fn solved(normal: DMat3, right: DVec3) -> DVec3 {
    let [x, y, z] = [normal.x_axis.x, normal.y_axis.y, normal.z_axis.z];
    if normal.determinant().abs() <= 1e-12 * x * y * z {
        return DVec3::ZERO;
    }
    normal.inverse() * right
}
