//! Drawing a recorded track, in the window and on paper.

use crate::{astro::time::seconds_between, plan::pass_report::TrackPoint};

/// Max time between two joined points, seconds.
const APART_S: f64 = 3.0;
/// Max size of the enlarged worst error in the sky, degrees.
const MAX_DEG: f64 = 12.0;
const ENLARGED: [u16; 4] = [50, 20, 10, 5];

/// Returns the parts of a track, split where measurements are missing.
pub(super) fn pieces(track: &[TrackPoint]) -> impl Iterator<Item = &[TrackPoint]> {
    track.chunk_by(|a, b| seconds_between(a.time, b.time) <= APART_S)
}

pub(super) fn worst(track: &[TrackPoint]) -> Option<&TrackPoint> {
    track.iter().max_by(|a, b| a.error.off_deg.total_cmp(&b.error.off_deg))
}

/// Returns the factor by which the error is enlarged over the sky.
pub(super) fn enlarged(track: &[TrackPoint]) -> u16 {
    let worst_deg = worst(track).map_or(0.0, |worst| worst.error.off_deg);
    let fits = |factor: &u16| worst_deg * f64::from(*factor) <= MAX_DEG;
    ENLARGED.into_iter().find(fits).unwrap_or(1)
}

/// Returns the subtitle of the path over the sky.
pub(super) fn enlargement(factor: u16) -> String {
    match factor {
        1 => "predicted and actual".to_owned(),
        factor => format!("error drawn ×{factor}"),
    }
}

/// Returns half of the height of the error scale, degrees.
pub(super) fn error_top_deg(half_beam_deg: f64, track: &[TrackPoint]) -> f64 {
    /// Min and max of the scale, as multiples of half the beamwidth.
    const MIN_SCALE: f64 = 1.25;
    const MAX_SCALE: f64 = 4.0;
    let worst_deg = worst(track).map_or(0.0, |worst| worst.error.off_deg);
    (1.1 * worst_deg).clamp(MIN_SCALE * half_beam_deg, MAX_SCALE * half_beam_deg)
}

/// Returns the distance between the lines of a scale from minus `top` to `top`.
pub(super) fn nice_step(top: f64) -> f64 {
    let tenth = 10_f64.powf((top / 2.0).log10().floor());
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|factor| factor * tenth)
        .find(|step| top / step >= 2.0)
        .unwrap_or(tenth)
}

/// Returns the number of decimals for a scale whose lines are `step` apart.
pub(super) fn decimals(step: f64) -> usize {
    usize::from(step < 1.0) + usize::from(step < 0.1)
}
