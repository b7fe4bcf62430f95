//! Expected position of an antenna. Its axes start at a measured position and approach the planned
//! path at their maximum rates.

use jiff::Timestamp;

use super::path::Path;
use crate::astro::time::{add_seconds, seconds_between};

/// Max gap between measurements, seconds; the chase restarts after a longer one.
const MAX_GAP_S: f64 = 5.0;
/// Max distance from the path at which an axis counts as arrived, degrees.
const ARRIVED_DEG: f64 = 0.01;
/// Max time for which the chase predicts an arrival, seconds.
const AHEAD_S: u32 = 600;

/// Simulated axes of an antenna that follows its commands, degrees as the mount counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chase {
    axes_deg: [f64; 2],
    updated_at: Timestamp,
}

impl Chase {
    /// Advances `previous` to `time`. Restarts at the measured positions if `previous` is missing
    /// or too old.
    pub(super) fn advanced(
        previous: Option<Self>,
        path: &Path,
        rates_deg_s: [f64; 2],
        (time, measured_deg): (Timestamp, [f64; 2]),
    ) -> Self {
        let elapsed_s = previous.map(|previous| seconds_between(previous.updated_at, time));
        match (previous, elapsed_s) {
            // After a longer gap, the antenna may not have been free to move.
            (Some(previous), Some(elapsed_s)) if (0.0..=MAX_GAP_S).contains(&elapsed_s) => {
                previous.after(path, rates_deg_s, elapsed_s)
            }
            _ => Self { axes_deg: measured_deg, updated_at: time },
        }
    }

    fn after(self, path: &Path, rates_deg_s: [f64; 2], elapsed_s: f64) -> Self {
        let time = add_seconds(self.updated_at, elapsed_s);
        let path_deg = path.positions_deg(time);
        let mut axes_deg = self.axes_deg;
        for ((deg, to_deg), rate_deg_s) in axes_deg.iter_mut().zip(path_deg).zip(rates_deg_s) {
            let max_deg = rate_deg_s.abs() * elapsed_s;
            *deg += (to_deg - *deg).clamp(-max_deg, max_deg);
        }
        Self { axes_deg, updated_at: time }
    }

    /// Returns `true` if both axes are on the path.
    pub(super) fn has_arrived(&self, path: &Path) -> bool {
        let path_deg = path.positions_deg(self.updated_at);
        self.axes_deg.iter().zip(path_deg).all(|(deg, to_deg)| (to_deg - deg).abs() < ARRIVED_DEG)
    }

    /// Predicts, in steps of one second, when the axes meet `is_on_target`. Returns `None` beyond
    /// ten minutes or after the end of the path.
    pub(super) fn reaches(
        self,
        path: &Path,
        rates_deg_s: [f64; 2],
        is_on_target: impl Fn(Timestamp, [f64; 2]) -> bool,
    ) -> Option<Timestamp> {
        let mut chase = self;
        for _ in 0..AHEAD_S {
            // The axes stand after the end of the path, and the target moves away.
            if chase.updated_at > path.end() {
                return None;
            }
            if is_on_target(chase.updated_at, chase.axes_deg) {
                return Some(chase.updated_at);
            }
            chase = chase.after(path, rates_deg_s, 1.0);
        }
        None
    }
}
