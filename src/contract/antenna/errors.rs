//! Errors between measured and predicted direction over the current track.

use std::{collections::VecDeque, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::astro::{Angle, time::seconds_between};

/// Time for which errors are kept for the profile of a pass, seconds.
const KEPT_S: f64 = 3600.0;
/// Max samples in a chunk; clones share chunks.
const CHUNK: usize = 64;

/// Error of a measured direction against the predicted one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorSample {
    pub time: Timestamp,
    /// Angle between the beam axis and the satellite.
    pub off_beam: Angle,
    /// Measured minus predicted azimuth, the short way round.
    pub azimuth: Angle,
    /// Measured minus predicted elevation.
    pub elevation: Angle,
}

/// The errors of the current track, oldest first. A clone shares all chunks with the original; a
/// push to either one copies only the newest chunk.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    chunks: VecDeque<Arc<Vec<ErrorSample>>>,
}

impl Errors {
    /// Returns the errors, oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &ErrorSample> {
        self.chunks.iter().flat_map(|chunk| chunk.iter())
    }

    /// Returns the newest error.
    pub fn back(&self) -> Option<&ErrorSample> {
        self.chunks.back().and_then(|chunk| chunk.last())
    }

    /// Returns all chunks but the newest, and the samples of the newest chunk.
    pub fn chunks(&self) -> (impl Iterator<Item = &Arc<Vec<ErrorSample>>>, &[ErrorSample]) {
        let whole = self.chunks.iter().take(self.chunks.len().saturating_sub(1));
        (whole, self.chunks.back().map(|newest| &newest[..]).unwrap_or_default())
    }

    /// Creates the errors from whole chunks and the newer samples after them.
    pub fn of_chunks(whole: Vec<Arc<Vec<ErrorSample>>>, newest: Vec<ErrorSample>) -> Self {
        let newest = (!newest.is_empty()).then(|| Arc::new(newest));
        Self { chunks: whole.into_iter().chain(newest).collect() }
    }

    /// Returns the errors at intervals of at least `interval_s`, and all errors for which `is_kept`
    /// returns true.
    #[must_use]
    pub fn thinned(&self, interval_s: f64, is_kept: impl Fn(&ErrorSample) -> bool) -> Self {
        let (mut thinned, mut last) = (Self::default(), None);
        for sample in self.iter() {
            // The absolute difference counts, because the clock may have been set back.
            let is_due =
                last.is_none_or(|last| seconds_between(last, sample.time).abs() >= interval_s);
            if is_due || is_kept(sample) {
                thinned.push(*sample);
                last = Some(sample.time);
            }
        }
        thinned
    }

    /// Adds an error and drops old errors, a chunk at a time.
    pub fn push(&mut self, sample: ErrorSample) {
        match self.chunks.back_mut().filter(|chunk| chunk.len() < CHUNK) {
            Some(chunk) => {
                let chunk = Arc::make_mut(chunk);
                // A copied chunk has no spare capacity. Growing would double it and waste half.
                chunk.reserve_exact(CHUNK - chunk.len());
                chunk.push(sample);
            }
            None => self.chunks.push_back(Arc::new(vec![sample])),
        }
        let is_old = |chunk: &Arc<Vec<ErrorSample>>| {
            chunk.last().is_some_and(|last| seconds_between(last.time, sample.time) > KEPT_S)
        };
        while self.chunks.front().is_some_and(is_old) {
            self.chunks.pop_front();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::time::add_seconds;

    fn sample(second: f64) -> ErrorSample {
        let time = add_seconds(Timestamp::UNIX_EPOCH, second);
        ErrorSample { time, off_beam: Angle::ZERO, azimuth: Angle::ZERO, elevation: Angle::ZERO }
    }

    #[test]
    fn an_hour_is_kept_in_order_and_a_copy_stays_as_it_was() {
        let mut errors = Errors::default();
        assert_eq!(errors.back(), None);
        for second in 0..300 {
            errors.push(sample(f64::from(second)));
        }
        let copy = errors.clone();
        for second in 300..5000 {
            errors.push(sample(f64::from(second)));
        }
        assert_eq!((copy.iter().count(), copy.back().unwrap().time.as_second()), (300, 299));
        let seconds: Vec<i64> = errors.iter().map(|sample| sample.time.as_second()).collect();
        assert!(seconds.is_sorted() && seconds.last() == Some(&4999));
        assert!((3600..3600 + 300).contains(&seconds.len()), "{}", seconds.len());
    }

    #[test]
    fn a_clock_that_was_set_back_thins_no_more_than_before() {
        let mut errors = Errors::default();
        for second in (1000..1100).chain(100..200) {
            errors.push(sample(f64::from(second)));
        }
        assert_eq!(errors.thinned(1.0, |_| false).iter().count(), 200);
    }
}
