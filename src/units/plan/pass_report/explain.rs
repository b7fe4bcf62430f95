//! Explanations of the pointing error of one pass or of several. Azel fits each cause alone by
//! least squares on the sphere, and with a second cause if no single one suffices. Azel names a
//! cause only if the antenna would have kept the satellite in its beam without it.

mod drives;
mod evidence;
mod fit;
#[cfg(test)]
mod tests;

use std::mem::discriminant;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use self::evidence::{Evidence, PathSource};
use self::{evidence::EvidencePoint, fit::Family};
use crate::{astro::Angle, orbit::Propagator};

/// Min number of positions for an explanation.
const MIN_POSITIONS: usize = 20;
/// Min share of the mean square error without noise that a cause must explain.
const MIN_SHARE: f64 = 0.85;
/// Max share of the mean square error, noise included, that a cause may leave.
const MAX_LEFT: f64 = 0.5;
/// Max share of the positions that would be outside the beam without the cause.
const MAX_OUTSIDE: f64 = 0.05;
/// Max difference between the sums of squares of two indistinguishable causes, in variances of the
/// noise. One in a hundred exceeds it by chance (chi-squared, two degrees of freedom).
const ALIKE: f64 = 9.2;
/// Min improvement of the sum of squares that is not chance, in variances of the noise. The value
/// is high because Azel takes the best of several causes.
const SURE: f64 = 30.0;
/// Min reduction of the remaining error by a second cause, as a share of the error.
const MIN_SECOND: f64 = 0.03;
/// Min share of the mean square error for naming a known difference.
const MIN_KNOWN: f64 = 0.01;
/// Max number of indistinguishable causes in an explanation.
const MAX_CANDIDATES: usize = 3;

/// Axis of a mount, by the kind of mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    Azimuth,
    Elevation,
    /// Lower axis of an X/Y mount.
    X,
    /// Upper axis of an X/Y mount.
    Y,
}

/// Cause of a pointing error, with its size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "cause")]
pub enum Cause {
    /// Late antenna: it points at an earlier place of the satellite, because of a late clock of the
    /// unit or slow transmission. Negative: early.
    Late {
        late_s: f64,
    },
    /// Azimuth error: measured minus true.
    AzimuthOffset {
        offset_deg: f64,
    },
    ElevationOffset {
        offset_deg: f64,
    },
    /// Lean of the azimuth axis to the north and to the east.
    Tilt {
        north_deg: f64,
        east_deg: f64,
    },
    /// Azimuth scale error, parts per thousand.
    AzimuthScale {
        per_mille: f64,
    },
    ElevationScale {
        per_mille: f64,
    },
    /// Other place: the unit computes its track for a place this far from the site.
    OtherSite {
        north_km: f64,
        east_km: f64,
    },
    /// Missing refraction: the unit ignores that the satellite appears higher.
    Refraction,
    /// Other elements that the antenna follows.
    OtherElements {
        epoch: Timestamp,
    },
    /// Max rate of a slow axis; `axis` is `None` for both.
    SlowDrives {
        rate_deg_s: f64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<Axis>,
    },
    /// Axis that stands since `start`; `axis` is `None` for both.
    Stuck {
        #[serde(rename = "since")]
        start: Timestamp,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<Axis>,
    },
}

impl Cause {
    fn is_same_kind(&self, other: &Self) -> bool {
        discriminant(self) == discriminant(other)
    }

    /// Returns `false` for a size that no antenna has.
    fn is_possible(&self) -> bool {
        match *self {
            Self::Late { late_s } => late_s.abs() <= 60.0,
            Self::AzimuthOffset { offset_deg } => offset_deg.abs() <= 180.0,
            Self::ElevationOffset { offset_deg } => offset_deg.abs() <= 90.0,
            // A larger tilt is visible from afar.
            Self::Tilt { north_deg, east_deg } => north_deg.hypot(east_deg) <= 10.0,
            Self::AzimuthScale { per_mille } | Self::ElevationScale { per_mille } => {
                per_mille.abs() <= 100.0
            }
            // At a larger distance, the satellite rises at another time.
            Self::OtherSite { north_km, east_km } => north_km.hypot(east_km) <= 500.0,
            Self::Refraction
            | Self::OtherElements { .. }
            | Self::SlowDrives { .. }
            | Self::Stuck { .. } => true,
        }
    }
}

/// Explanation of the error by a cause.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    #[serde(flatten)]
    pub cause: Cause,
    /// Second cause that acts together with the first; `None` if the first acts alone.
    #[serde(rename = "with", default, skip_serializing_if = "Option::is_none")]
    pub partner: Option<Cause>,
    /// Root mean square of the remaining error, degrees.
    pub left_deg: f64,
    /// Explained share of the mean square error without noise, 0 to 1.
    pub share: f64,
}

impl Explanation {
    /// Yields the cause and its partner, if any.
    pub fn causes(&self) -> impl Iterator<Item = &Cause> {
        std::iter::once(&self.cause).chain(&self.partner)
    }
}

/// Causes of an error during a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explained {
    /// Best cause, or up to three causes that the positions so far cannot distinguish, the best
    /// first.
    pub causes: Vec<Explanation>,
    /// Error, root mean square, degrees.
    pub error_deg: f64,
}

/// Min size of the explained error, as a share of a new error with the same cause.
const COMPARABLE_SHARE: f64 = 0.7;

impl Explained {
    /// Returns `true` if this explanation covers an error of `deviation`. The explanation of a
    /// smaller earlier error may not apply, but the error of a standing axis grows.
    pub fn can_make(&self, deviation: Angle) -> bool {
        let stands = |explanation: &Explanation| {
            explanation.causes().any(|cause| matches!(cause, Cause::Stuck { .. }))
        };
        self.error_deg >= COMPARABLE_SHARE * deviation.degrees() || self.causes.iter().any(stands)
    }
}

/// One or two causes with their best sizes.
#[derive(Debug, Clone, Copy)]
struct FoundCause {
    cause: Cause,
    partner: Option<Cause>,
    fit: CauseFit,
}

/// Remaining error of a model of the antenna.
#[derive(Debug, Clone, Copy)]
struct CauseFit {
    /// Sum of the remaining squares.
    left: f64,
    /// Variance of the remaining error of one of the two angles of a position, times the number of
    /// correlated positions.
    variance: f64,
    /// Share of the positions that remain outside the beam.
    outside: f64,
}

impl FoundCause {
    fn is_possible(&self) -> bool {
        self.cause.is_possible() && self.partner.is_none_or(|partner| partner.is_possible())
    }
}

impl Evidence<'_> {
    /// Returns the cause of the error, or up to three causes that these positions cannot
    /// distinguish, the best first; empty without an explanation. Includes two causes together only
    /// if they explain clearly more than any single one. `others`: other elements of the satellite
    /// with their epochs.
    pub fn explanations(&self, others: &[(Timestamp, Propagator)]) -> Vec<Explanation> {
        let whole = self.fit_of(|point| Some(point.satellite));
        if self.points().count() < MIN_POSITIONS || whole.left <= 0.0 {
            return Vec::new();
        }
        let fit = self.fit_of(|point| Some(point.followed));
        if !self.only_drives
            && self.is_explained(fit, whole.left)
            && let Some(cause) = self.known_cause(fit, whole.left)
        {
            let found = FoundCause { cause, partner: None, fit };
            return self.shown(&[found], whole.left);
        }
        let mut singles = if self.only_drives { Vec::new() } else { self.singles(others) };
        singles.sort_by(|(_, a), (_, b)| a.fit.left.total_cmp(&b.fit.left));
        let mut found: Vec<FoundCause> = singles.iter().map(|(_, found)| *found).collect();
        found.extend(self.slow_drives());
        found.extend(self.stuck());
        found.retain(|found| found.is_possible() && self.is_explained(found.fit, whole.left));
        let single = found.iter().fold(f64::INFINITY, |best, found| best.min(found.fit.left));
        let is_less = |left: f64| {
            single.is_infinite() || single.sqrt() - left.sqrt() > MIN_SECOND * whole.left.sqrt()
        };
        if is_less(self.noise().min(single)) {
            let pairs = self.pairs(&singles, whole.left);
            let best = pairs.iter().min_by(|a, b| a.fit.left.total_cmp(&b.fit.left));
            if let Some(best) = best
                && is_less(best.fit.left)
                && single - best.fit.left > SURE * best.fit.variance
            {
                found = pairs;
            }
        }
        found.sort_by(|a, b| a.fit.left.total_cmp(&b.fit.left));
        let Some(best) = found.first().copied() else { return Vec::new() };
        found.retain(|found| found.fit.left - best.fit.left <= ALIKE * best.fit.variance);
        let named = found.into_iter().map(|found| self.beside_known(found, whole.left));
        self.shown(&named.collect::<Vec<_>>(), whole.left)
    }

    /// Returns the causes of an error of at least `min_deg`, root mean square. `others` as for
    /// [`Self::explanations`].
    pub fn explained(&self, min_deg: f64, others: &[(Timestamp, Propagator)]) -> Option<Explained> {
        let whole = self.fit_of(|point| Some(point.satellite));
        let error_deg = self.rms_deg(whole.left);
        if error_deg < min_deg {
            return None;
        }
        let causes = self.explanations(others);
        (!causes.is_empty()).then_some(Explained { causes, error_deg })
    }

    /// Returns `true` if the antenna would have kept the satellite in its beam without the error
    /// that `fit` removes. That error must be more than chance.
    fn is_explained(&self, fit: CauseFit, whole: f64) -> bool {
        whole - fit.left > SURE * fit.variance
            && self.share(fit.left, whole) >= MIN_SHARE
            && fit.left <= MAX_LEFT * whole
            && fit.outside <= MAX_OUTSIDE
    }

    /// Returns the explained share of the error without noise.
    fn share(&self, left: f64, whole: f64) -> f64 {
        (whole - left) / (whole - self.noise().min(left))
    }

    /// Returns the best sizes of each cause that may act alone.
    fn singles<'b>(&self, others: &'b [(Timestamp, Propagator)]) -> Vec<(Family<'b>, FoundCause)> {
        let is_open = |family: &Family<'_>| {
            let is_of_unit = matches!(family, Family::Site | Family::Elements(_));
            let is_site_open = !matches!(family, Family::Site) || self.is_site_open();
            (self.has_elevation || !family.needs_elevation())
                && (self.is_of_unit() || !is_of_unit)
                && is_site_open
        };
        let families = Family::ALL.into_iter().chain(others.iter().map(Family::Elements));
        let open = families.filter(is_open);
        open.map(|family| (family, self.fitted(family, None))).collect()
    }

    /// Returns pairs of causes that are both necessary. `singles`: explanation by each single
    /// cause, the best first.
    fn pairs(&self, singles: &[(Family<'_>, FoundCause)], whole: f64) -> Vec<FoundCause> {
        let is_set = |family: &Family<'_>| matches!(family, Family::Elements(_));
        // An antenna follows one set of elements, so pair only the set that explains most alone.
        let set = singles.iter().find(|(family, _)| is_set(family));
        let rest = singles.iter().filter(|(family, _)| !is_set(family));
        let singles: Vec<&(Family<'_>, FoundCause)> = set.into_iter().chain(rest).collect();
        let pairs = singles.iter().enumerate().flat_map(|(place, first)| {
            singles.iter().skip(place + 1).map(move |second| (*first, *second))
        });
        let fitted_pair = |((first, alone), (second, other)): (
            &(Family<'_>, FoundCause),
            &(Family<'_>, FoundCause),
        )| {
            let found = self.fitted(*first, Some(*second));
            let alone_left = alone.fit.left.min(other.fit.left);
            let is_needed = alone_left - found.fit.left > SURE * found.fit.variance;
            let is_named = is_needed && self.is_explained(found.fit, whole);
            (is_named && found.is_possible()).then_some(found)
        };
        pairs.filter_map(fitted_pair).collect()
    }

    /// Returns `found` with the known difference of the unit added, if it makes a part of the
    /// error.
    fn beside_known(&self, found: FoundCause, whole: f64) -> FoundCause {
        match (self.known_cause(found.fit, whole), found.cause) {
            (None, _) => found,
            (Some(Cause::Late { late_s: known_s }), Cause::Late { late_s }) => {
                FoundCause { cause: Cause::Late { late_s: known_s + late_s }, ..found }
            }
            (Some(known_cause), cause) => {
                FoundCause { cause: known_cause, partner: Some(cause), ..found }
            }
        }
    }

    fn shown(&self, found: &[FoundCause], whole: f64) -> Vec<Explanation> {
        let mut shown: Vec<Explanation> = Vec::new();
        for FoundCause { cause, partner, fit } in found.iter().copied() {
            let explanation = Explanation {
                cause,
                partner,
                left_deg: self.rms_deg(fit.left),
                share: self.share(fit.left, whole),
            };
            // Show only the best of several other sets.
            let is_same = |shown: &Explanation| {
                shown.cause.is_same_kind(&cause)
                    && matches!((shown.partner, partner), (None, None))
                    && matches!(cause, Cause::OtherElements { .. })
            };
            if shown.len() < MAX_CANDIDATES && !shown.iter().any(is_same) {
                shown.push(explanation);
            }
        }
        shown
    }
}
