//! Summary of a finished track's errors.

use crate::{
    astro::Angle,
    contract::antenna::{ErrorSample, Errors, PastTrack},
};

/// Min number of samples for a summary.
const MIN_POINTS: usize = 5;

/// Interval of kept samples, seconds. A profile shows no more, and samples of ten polls a second
/// would fill megabytes.
const INTERVAL_S: f64 = 1.0;

/// Returns the errors of a finished track; `None` if there are fewer than [`MIN_POINTS`].
pub(super) fn past_track(name: String, errors: &Errors) -> Option<PastTrack> {
    let (first, last) = (*errors.iter().next()?, *errors.back()?);
    let finite = || errors.iter().filter(|error| error.off_beam.is_finite());
    let count = finite().count();
    if count < MIN_POINTS {
        return None;
    }
    let squares: f64 = finite().map(|error| error.off_beam.degrees().powi(2)).sum();
    let by_size =
        |a: &&ErrorSample, b: &&ErrorSample| a.off_beam.degrees().total_cmp(&b.off_beam.degrees());
    let rms = Angle::from_degrees((squares / count as f64).sqrt());
    let worst = *finite().max_by(by_size)?;
    let is_kept = |error: &ErrorSample| [worst.time, last.time].contains(&error.time);
    let errors = errors.thinned(INTERVAL_S, is_kept);
    Some(PastTrack { name, start: first.time, end: last.time, rms, worst, errors })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use jiff::Timestamp;

    use super::*;
    use crate::{astro::time::add_seconds, contract::antenna::PastTracks};

    fn errors(off_beam_deg: &[f64]) -> Errors {
        let mut errors = Errors::default();
        for (second, off_beam_deg) in off_beam_deg.iter().enumerate() {
            errors.push(ErrorSample {
                time: add_seconds(Timestamp::UNIX_EPOCH, second as f64),
                off_beam: Angle::from_degrees(*off_beam_deg),
                azimuth: Angle::ZERO,
                elevation: Angle::ZERO,
            });
        }
        errors
    }

    fn keep(past: &mut PastTracks, name: &str, errors: &Errors) {
        if let Some(track) = past_track(name.to_owned(), errors) {
            past.push(track);
        }
    }

    #[test]
    fn a_track_that_is_over_keeps_a_sample_a_second_and_the_worst() {
        let mut many = Errors::default();
        for tenth in 0..6000 {
            let off_beam_deg = if tenth == 1234 { 0.7 } else { 0.1 };
            many.push(ErrorSample {
                time: add_seconds(Timestamp::UNIX_EPOCH, f64::from(tenth) / 10.0),
                off_beam: Angle::from_degrees(off_beam_deg),
                azimuth: Angle::ZERO,
                elevation: Angle::ZERO,
            });
        }
        let mut past = PastTracks::default();
        keep(&mut past, "NOAA 20", &many);
        let track = past.iter().next().unwrap();
        let times: Vec<Timestamp> = track.errors.iter().map(|error| error.time).collect();
        assert!((600..=602).contains(&times.len()), "{}", times.len());
        assert!(times.contains(&track.worst.time) && times.last() == Some(&track.end));
        assert!((track.worst.off_beam.degrees() - 0.7).abs() < 1e-9);
    }

    #[test]
    fn the_last_tracks_stay_with_their_mean_and_worst_error() {
        let mut past = PastTracks::default();
        keep(&mut past, "SHORT", &errors(&[0.1; 4]));
        assert!(past.is_empty());
        keep(&mut past, "NOAA 20", &errors(&[0.3, 0.4, f64::NAN, 0.0, 0.0, 0.5]));
        let track = Arc::clone(past.iter().next().unwrap());
        assert!((track.rms.degrees() - 0.1_f64.sqrt()).abs() < 1e-9, "{:?}", track.rms);
        assert!((track.worst.off_beam.degrees() - 0.5).abs() < 1e-9);
        assert_eq!((track.start.as_second(), track.end.as_second()), (0, 5));
        for number in 0..20 {
            keep(&mut past, &format!("SAT {number}"), &errors(&[0.1; 9]));
        }
        let names: Vec<_> = past.iter().map(|track| track.name.as_str()).collect();
        assert_eq!((names.len(), names[0]), (8, "SAT 19"));
    }
}
