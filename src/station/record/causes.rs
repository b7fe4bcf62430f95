//! Common causes of the errors of several passes.

use std::{ops::RangeInclusive, path::Path};

use jiff::Timestamp;

use super::{RecordError, past::PastPasses};
use crate::{
    astro::{Angle, Site, time::apart},
    contract::record::{ExplainedPasses, RecordedPass, RecordedReport},
    orbit::Propagator,
    plan::pass_report::{Evidence, MeasuredPosition, PathSource},
    station::{AntennaId, Mount},
};

/// Max number of passes that are judged together.
const PASSES: u32 = 30;
/// Min time between two used positions, seconds.
const APART_S: f64 = 5.0;

/// Finds the causes of the errors in `antenna`'s newest passes on this mount that end within
/// `span`. Reads the record at `path`. Does not consider other elements, which belong to single
/// passes. Reports without a site belong to an antenna at `site`.
pub fn explain_passes(
    path: &Path,
    antenna: AntennaId,
    mount: Mount,
    site: Site,
    span: &RangeInclusive<Timestamp>,
) -> Result<ExplainedPasses, RecordError> {
    if !path.exists() {
        return Ok(ExplainedPasses { passes: 0, start: None, explanations: Vec::new() });
    }
    let record = PastPasses::open(path, site)?;
    let mut flown: Vec<(Propagator, Site, PathSource, Vec<MeasuredPosition>)> = Vec::new();
    let mut begin = None;
    let mut half_beam_deg = 0.0_f64;
    for RecordedPass { id, report, .. } in record.newest(antenna, span, PASSES)? {
        let Ok(propagator) = Propagator::new(&report.elements) else { continue };
        let site = record.site_of(&report);
        let points = thinned(&report, &record.points(id)?);
        let compared = |flown| report.track.compared(&propagator, site, flown);
        let points: Vec<MeasuredPosition> = points.into_iter().map(compared).collect();
        if !points.is_empty() {
            begin = Some(report.end);
            half_beam_deg = half_beam_deg.max(report.half_beam_deg);
            flown.push((propagator, site, report.track.path_source(site), points));
        }
    }
    let positions = || flown.iter().flat_map(|(_, _, _, points)| points);
    let has_elevation = positions().any(|flown| flown.pointing.elevation.is_some());
    let evidence = flown.iter().fold(
        Evidence::new(mount, has_elevation, Angle::from_degrees(half_beam_deg)),
        |evidence, (propagator, site, source, points)| {
            let measured = points
                .iter()
                .filter_map(|flown| Some((flown.time, flown.direction(has_elevation)?)));
            evidence.with_pass(propagator, *site, *source, measured)
        },
    );
    Ok(ExplainedPasses {
        passes: flown.len(),
        start: begin,
        explanations: evidence.explanations(&[]),
    })
}

/// Returns positions at which the antenna should have been on the satellite.
fn thinned(report: &RecordedReport, points: &[MeasuredPosition]) -> Vec<MeasuredPosition> {
    let is_judged = |point: &&MeasuredPosition| report.report.judges(point.time, report.end);
    apart(points.iter().filter(is_judged).copied(), APART_S, |point| point.time).collect()
}
