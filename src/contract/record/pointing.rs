//! Pointing model, fitted to recorded passes.

use serde::{Deserialize, Serialize};

use crate::{astro::Term, plan::pointing::Kind, station::AntennaId};

/// Best-fitting model. Azel applies none of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointingFit {
    /// Number of passes with at least one usable point.
    pub passes: usize,
    pub noise: Vec<FittedNoise>,
    /// Terms that were excluded from the fit; their value is zero.
    #[serde(rename = "without", default, skip_serializing_if = "Vec::is_empty")]
    pub excluded: Vec<Term>,
    /// One entry for each term, in the order of [`Term::ALL`].
    pub terms: Vec<FittedTerm>,
}

/// Noise of the points of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FittedNoise {
    #[serde(rename = "of")]
    pub kind: Kind,
    pub points: usize,
    /// Standard deviation of one axis, degrees.
    pub noise_deg: f64,
}

/// Fitted term: the reading of the axes minus the direction of the beam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedTerm {
    pub term: Term,
    /// Degrees; for the scale, degrees a degree. `None` if the points cannot determine the term, or
    /// if the fit excluded it.
    pub value: Option<f64>,
    /// Half the width of the 95 % confidence interval. `None` also if the value contains a part of
    /// undetermined terms.
    pub half_of_95_percent: Option<f64>,
    /// Terms that the points cannot separate from this term.
    pub not_told_from: Vec<Term>,
}

/// Fit to the record of an antenna. The fit changes nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointingFitted {
    pub antenna: AntennaId,
    /// Fit, or the reason why there is none; `None` while Azel computes it.
    pub found: Option<Result<PointingFit, String>>,
}
