//! Pointing model of an antenna, fitted to the passes in its record.

use std::{ops::RangeInclusive, path::Path};

use jiff::Timestamp;

use super::{RecordError, past::PastPasses};
use crate::{
    astro::{PointingModel, Site, Term, time::apart},
    contract::record::{FittedNoise, FittedTerm, Peak, PointingFit},
    plan::{
        pass_report::TrackPoint,
        pointing::{self, CannotFit, Fit, Kind, Point},
    },
    station::AntennaId,
};

/// Min time between two used points of a pass, seconds: within it, the error of a drive changes
/// little.
const APART_S: f64 = 10.0;
/// Max distance from the satellite of a used position, degrees. Positions beyond it belong to a
/// slew or to no track.
const NEAR_DEG: f64 = 10.0;

#[derive(Debug, thiserror::Error)]
pub enum CannotFitPointing {
    #[error("the record cannot be read: {0}")]
    Record(#[from] RecordError),
    #[error("{cannot_fit} in {passes} recorded passes")]
    Points { passes: usize, cannot_fit: CannotFit },
}

/// Fits the model of `antenna`, without the `excluded` terms. Uses `peaks` and the antenna's passes
/// in the record at `path` that end within `span`. Reports without a site belong to an antenna at
/// `site`.
pub fn fit_pointing(
    path: &Path,
    antenna: AntennaId,
    site: Site,
    span: &RangeInclusive<Timestamp>,
    peaks: &[Peak],
    excluded: Vec<Term>,
) -> Result<PointingFit, CannotFitPointing> {
    let peaks: Vec<Point> = peaks.iter().map(|peak| peak.point(site)).collect();
    let mut runs: Vec<Vec<Point>> = Vec::new();
    if path.exists() {
        let record = PastPasses::open(path, site)?;
        for pass in record.newest(antenna, span, u32::MAX)? {
            let run = thinned(&record.led_track(&pass)?, &pass.report.track.pointing_model);
            if !run.is_empty() {
                runs.push(run);
            }
        }
    }
    let terms: Vec<Term> = Term::ALL.into_iter().filter(|term| !excluded.contains(term)).collect();
    let all = runs.iter().map(Vec::as_slice).chain(peaks.chunks(1));
    let fit = pointing::fit(all, &terms)
        .map_err(|cannot_fit| CannotFitPointing::Points { passes: runs.len(), cannot_fit })?;
    Ok(fitted(runs.len(), &fit, excluded))
}

fn thinned(track: &[TrackPoint], flown_with: &PointingModel) -> Vec<Point> {
    let near = track.iter().filter(|point| point.error.off_deg <= NEAR_DEG);
    let point = |point: &TrackPoint| Point {
        kind: Kind::Satellite,
        time: point.time,
        direction: point.satellite,
        // The fit compares with readings of the axes.
        measured: flown_with.reading(point.antenna).unwrap_or(point.antenna),
        weight: 1.0,
    };
    apart(near, APART_S, |point| point.time).map(point).collect()
}

fn fitted(passes: usize, fit: &Fit, excluded: Vec<Term>) -> PointingFit {
    let term = |term: Term| {
        let interval = fit.interval(term);
        let alike = fit.alike.iter().find(|alike| alike.term == term);
        FittedTerm {
            term,
            value: fit.fitted.contains(&term).then(|| fit.model.term(term)),
            half_of_95_percent: interval.map(|interval| interval.half),
            not_told_from: alike.map(|alike| alike.others.clone()).unwrap_or_default(),
        }
    };
    let noise = |found: &pointing::KindNoise| FittedNoise {
        kind: found.kind,
        points: found.points,
        noise_deg: found.noise_deg,
    };
    PointingFit {
        passes,
        noise: fit.noise.iter().map(noise).collect(),
        excluded,
        terms: Term::ALL.map(term).into(),
    }
}
