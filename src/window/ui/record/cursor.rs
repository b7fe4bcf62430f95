//! The cursor: the time at which all drawings of a report are read.

use jiff::Timestamp;

use super::RecordState;
use crate::{
    astro::time::seconds_between, contract::record::OpenedPass, plan::pass_report::TrackPoint,
    ui::recorded_track,
};

/// Max time between the cursor and a point that it reads, seconds.
const NEAR_S: f64 = 2.0;

/// Returns the point of the track at the cursor. Until the operator moves the cursor, this is the
/// point of the worst error.
pub(super) fn point<'a>(opened: &'a OpenedPass, state: &RecordState) -> Option<&'a TrackPoint> {
    if let Some(time) = state.cursor {
        return nearest(&opened.track, time);
    }
    let worst = opened.pass.report.report.worst;
    let track_point = worst.and_then(|worst| nearest(&opened.track, worst.time));
    track_point.or_else(|| recorded_track::worst(&opened.track))
}

fn nearest(track: &[TrackPoint], time: Timestamp) -> Option<&TrackPoint> {
    let apart = |point: &TrackPoint| seconds_between(point.time, time).abs();
    let nearest = track.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    (apart(nearest) <= NEAR_S).then_some(nearest)
}
