//! Statistics of the pointing error.

use serde::{Deserialize, Serialize};

use crate::astro::Angle;

/// Pointing error while tracking, and the number of commands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TrackStats {
    /// Number of sent positions.
    pub commands: u32,
    samples: u32,
    sum_of_squares_deg2: f64,
    worst_deg: f64,
}

impl TrackStats {
    /// Takes the angle between target and measured direction.
    pub fn take(&mut self, deviation: Angle) {
        let off_deg = deviation.degrees().abs();
        self.samples += 1;
        self.sum_of_squares_deg2 += off_deg * off_deg;
        self.worst_deg = self.worst_deg.max(off_deg);
    }

    /// Returns the root mean square error; `None` before the first measurement.
    pub fn rms(&self) -> Option<Angle> {
        let mean_deg2 = self.sum_of_squares_deg2 / f64::from(self.samples);
        (self.samples > 0).then(|| Angle::from_degrees(mean_deg2.sqrt()))
    }

    /// Returns the largest error; `None` before the first measurement.
    pub fn worst(&self) -> Option<Angle> {
        (self.samples > 0).then(|| Angle::from_degrees(self.worst_deg))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_of_the_mean_square_and_the_worst() {
        let mut stats = TrackStats::default();
        assert_eq!((stats.rms(), stats.worst()), (None, None));
        for off_deg in [3.0, -4.0, 0.0, 0.0] {
            stats.take(Angle::from_degrees(off_deg));
        }
        assert!((stats.rms().unwrap().degrees() - 2.5).abs() < 1e-12);
        assert!((stats.worst().unwrap().degrees() - 4.0).abs() < 1e-12);
    }
}
