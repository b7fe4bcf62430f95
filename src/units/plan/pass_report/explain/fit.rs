//! Single fit: the direction of an antenna with certain causes, and the sizes with the smallest
//! remaining error.

use glam::{DMat4, DVec3, DVec4};
use jiff::Timestamp;

use super::{Cause, Evidence, EvidencePoint, FoundCause, evidence::moved};
use crate::{
    astro::{Angle, AzEl, time::add_seconds},
    orbit::Propagator,
};

/// Max number of rounds of a fit; most fits need three.
const ROUNDS: usize = 8;
/// Initial delays for the fit of a delay, seconds: an error of many seconds is not linear.
const STARTS_S: [f64; 9] = [-30.0, -12.0, -5.0, -2.0, 0.0, 2.0, 5.0, 12.0, 30.0];

/// Family of causes with up to two sizes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Family<'a> {
    Elements(&'a (Timestamp, Propagator)),
    Late,
    Azimuth,
    Elevation,
    Tilt,
    AzimuthScale,
    ElevationScale,
    Site,
}

impl Family<'_> {
    /// All kinds of causes with a fitted size.
    pub(super) const ALL: [Self; 7] = [
        Self::Late,
        Self::Azimuth,
        Self::Elevation,
        Self::Tilt,
        Self::AzimuthScale,
        Self::ElevationScale,
        Self::Site,
    ];

    /// Returns small steps of the sizes, each in its unit, for numerical derivatives.
    fn steps(self) -> &'static [f64] {
        match self {
            Self::Elements(_) => &[],
            Self::Late => &[0.01],
            Self::Tilt => &[1e-3, 1e-3],
            Self::Site => &[0.1, 0.1],
            Self::Azimuth | Self::Elevation | Self::AzimuthScale | Self::ElevationScale => &[1e-3],
        }
    }

    pub(super) fn needs_elevation(self) -> bool {
        matches!(self, Self::Elevation | Self::Tilt | Self::ElevationScale)
    }

    /// Returns the cause with the first of these sizes.
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
            Self::Site => Cause::OtherSite { north_km: first, east_km: second },
        }
    }

    /// Returns the direction of an antenna with this cause that would point at `direction` without
    /// it.
    fn turns(self, direction: AzEl, point: &EvidencePoint<'_>, sizes: &[f64]) -> AzEl {
        let AzEl { azimuth, elevation } = direction;
        let deg = Angle::from_degrees;
        match self.cause(sizes) {
            Cause::AzimuthOffset { offset_deg } => {
                AzEl { azimuth: azimuth + deg(offset_deg), elevation }
            }
            Cause::ElevationOffset { offset_deg } => {
                AzEl { azimuth, elevation: elevation + deg(offset_deg) }
            }
            Cause::Tilt { north_deg, east_deg } => {
                // A point towards which the axis leans is nearer to the axis, so its elevation
                // reads higher.
                let lean = DVec3::new(deg(north_deg).radians(), -deg(east_deg).radians(), 0.0);
                AzEl::from_enu(direction.to_enu() + lean.cross(direction.to_enu()))
            }
            Cause::AzimuthScale { per_mille } => {
                AzEl { azimuth: azimuth + deg(point.azimuth_deg * per_mille / 1000.0), elevation }
            }
            Cause::ElevationScale { per_mille } => AzEl {
                azimuth,
                elevation: elevation + deg(elevation.degrees() * per_mille / 1000.0),
            },
            // These causes move the satellite, not the antenna.
            Cause::Late { .. }
            | Cause::OtherElements { .. }
            | Cause::OtherSite { .. }
            | Cause::Refraction
            | Cause::SlowDrives { .. }
            | Cause::Stuck { .. } => direction,
        }
    }
}

/// Splits the sizes among causes that act together.
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

/// Returns the direction of an antenna with these causes.
fn modelled(families: &[Family<'_>], sizes: DVec4, point: &EvidencePoint<'_>) -> Option<AzEl> {
    let sizes = sizes.to_array();
    let (mut propagator, mut late_s) = (point.propagator, point.clock_late_s);
    let (mut place, mut is_moved) = (point.place, false);
    for (family, own) in sized(families, &sizes) {
        match family {
            Family::Elements((_, other)) => propagator = other,
            Family::Late => late_s += own.first()?,
            Family::Site => place = moved(place, *own.first()?, *own.get(1)?)?,
            Family::Azimuth
            | Family::Elevation
            | Family::Tilt
            | Family::AzimuthScale
            | Family::ElevationScale => continue,
        }
        is_moved = true;
    }
    let mut direction = point.followed;
    if is_moved {
        direction = propagator.look_from(place, add_seconds(point.time, -late_s)).ok()?.direction;
    }
    let turned = sized(families, &sizes)
        .fold(direction, |position, (family, own)| family.turns(position, point, own));
    Some(turned)
}

impl Evidence<'_> {
    /// Fits the sizes of one or two causes by least squares. A tilt and a site have two sizes,
    /// another set of elements none, every other cause one.
    pub(super) fn fitted(&self, first: Family<'_>, second: Option<Family<'_>>) -> FoundCause {
        let families: Vec<Family<'_>> = std::iter::once(first).chain(second).collect();
        let sizes = self.sizes(&families, self.start(&families));
        let fit = self.fit_of(|point| modelled(&families, sizes, point));
        let sizes = sizes.to_array();
        let (own, others) = sizes.split_at(first.steps().len());
        FoundCause {
            cause: first.cause(own),
            partner: second.map(|second| second.cause(others)),
            fit,
        }
    }

    /// Returns the initial sizes of a fit.
    fn start(&self, families: &[Family<'_>]) -> DVec4 {
        let mut places = families
            .iter()
            .flat_map(|family| family.steps().iter().map(move |_| matches!(family, Family::Late)));
        let late = places.position(|is_late| is_late).and_then(|place| DVec4::AXES.get(place));
        let Some(late) = late else { return DVec4::ZERO };
        let sum = |start_s: f64| {
            self.points()
                .filter_map(|point| {
                    let direction = modelled(families, *late * start_s, point)?;
                    let model = direction.to_enu() - point.satellite.to_enu();
                    Some((point.error - model).length_squared())
                })
                .sum::<f64>()
        };
        let starts = STARTS_S.map(|start_s| (start_s, sum(start_s)));
        let best = starts.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b));
        *late * best.map_or(0.0, |(start_s, _)| start_s)
    }

    /// Returns the sizes with the smallest remainder (Gauss-Newton).
    fn sizes(&self, families: &[Family<'_>], start: DVec4) -> DVec4 {
        let mut steps = DVec4::ZERO;
        let all_sizes = families.iter().flat_map(|family| family.steps()).zip(DVec4::AXES);
        all_sizes.for_each(|(step, axis)| steps += axis * *step);
        let is_unused = steps.cmpeq(DVec4::ZERO);
        let unused = DMat4::from_diagonal(DVec4::select(is_unused, DVec4::ONE, DVec4::ZERO));
        let mut sizes = start;
        for _ in 0..ROUNDS {
            if is_unused.all() {
                break;
            }
            let (mut normal, mut right) = (unused, DVec4::ZERO);
            for point in self.points() {
                let model = |sizes: DVec4| {
                    let direction = modelled(families, sizes, point).unwrap_or(point.satellite);
                    direction.to_enu() - point.satellite.to_enu()
                };
                let here = model(sizes);
                let columns = DVec4::AXES.map(|axis| match steps.dot(axis) {
                    0.0 => DVec3::ZERO,
                    step => (model(sizes + axis * step) - here) / step,
                });
                let left = point.error - here;
                for row in [0, 1, 2] {
                    let slopes = DVec4::from_array(columns.map(|column| column[row]));
                    normal += outer(slopes);
                    right += slopes * left[row];
                }
            }
            let change = solved(normal, right);
            sizes += change;
            if change.abs().cmple(steps / 10.0).all() {
                break;
            }
        }
        sizes
    }
}

/// Returns the matrix of the products of all components.
fn outer(vector: DVec4) -> DMat4 {
    DMat4::from_cols(vector * vector.x, vector * vector.y, vector * vector.z, vector * vector.w)
}

/// Solves the equations; returns zero if these positions do not determine a solution.
fn solved(normal: DMat4, right: DVec4) -> DVec4 {
    let diagonal: f64 = (0..4).map(|place| normal.col(place)[place]).product();
    if normal.determinant().abs() <= 1e-12 * diagonal {
        return DVec4::ZERO;
    }
    normal.inverse() * right
}
