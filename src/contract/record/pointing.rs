//! A pointing model, fitted to recorded passes.

use serde::{Deserialize, Serialize};

use crate::{astro::Term, plan::pointing::Kind, station::AntennaId};

/// The model that fits best. Nothing of it is applied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointingFit {
    /// Number of passes with a point that counts.
    pub passes: usize,
    pub noise: Vec<FittedNoise>,
    /// Terms that were left out of the fit. They are zero.
    #[serde(rename = "without", default, skip_serializing_if = "Vec::is_empty")]
    pub excluded: Vec<Term>,
    /// One a term, in the order of [`Term::ALL`].
    pub terms: Vec<FittedTerm>,
}

/// Points of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FittedNoise {
    #[serde(rename = "of")]
    pub kind: Kind,
    pub points: usize,
    /// Standard deviation of one axis, degrees.
    pub noise_deg: f64,
}

/// By how much the axes read more than the direction in which the beam points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedTerm {
    pub term: Term,
    /// Degrees; for the scale, degrees a degree. `None` where the points cannot tell it, and where
    /// it was left out of the fit.
    pub value: Option<f64>,
    /// Half of the width of the interval that holds it in at least 95 of 100 cases; `None` also where the
    /// value holds a part of terms that the points cannot tell.
    pub half_of_95_percent: Option<f64>,
    /// Terms that the points cannot tell it from.
    pub not_told_from: Vec<Term>,
}

/// A fit to the record of an antenna. It changes nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointingFitted {
    pub antenna: AntennaId,
    /// Or why there is none. `None` while it is worked out.
    pub found: Option<Result<PointingFit, String>>,
}
