//! Share of the predicted passes that an antenna tracks.

use super::{Compare, PassTrack};
use crate::{
    plan::{MountLimits, Trackability, trackability},
    station::AntennaId,
};

/// A question: the mount, limits and beam of an antenna.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    pub antenna: AntennaId,
    /// Saved limits.
    pub before: MountLimits,
    /// Edited limits.
    pub after: MountLimits,
}

/// Numbers of passes, by how much of each pass the antenna tracks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    pub whole: usize,
    pub in_part: usize,
    /// Passes that the antenna cannot track at all.
    pub not: usize,
    /// Time lost in the partly tracked passes, seconds.
    pub lost_s: f64,
}

impl Tally {
    fn new(limits: MountLimits, ways: &[PassTrack]) -> Self {
        let mut tally = Self::default();
        for way in ways {
            match trackability(&way.samples, limits) {
                Trackability::Whole => tally.whole += 1,
                Trackability::Loses { seconds, .. } => {
                    tally.in_part += 1;
                    tally.lost_s += seconds;
                }
                Trackability::Nothing | Trackability::TooLow => tally.not += 1,
            }
        }
        tally
    }
}

impl Compare for Question {
    type Tally = Tally;
    /// Every sample, as in the list of passes.
    const EVERY: usize = 1;

    fn tallies(&self, ways: &[PassTrack]) -> [Tally; 2] {
        [self.before, self.after].map(|limits| Tally::new(limits, ways))
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::{AzEl, time::add_seconds},
        contract::passes::mount_limits,
        plan::Sample,
        station::{Antenna, Mount},
    };

    /// Returns a track at `elevation_deg` from north over east to south, one degree every 6 s.
    fn way(elevation_deg: f64) -> PassTrack {
        let start: Timestamp = "2026-11-14T12:00:00Z".parse().unwrap();
        let samples = (0..=180).map(|step| Sample {
            time: add_seconds(start, f64::from(step) * 6.0),
            direction: AzEl::from_degrees(f64::from(step), elevation_deg),
        });
        PassTrack { number: 1, samples: samples.collect() }
    }

    #[test]
    fn a_shorter_travel_turns_whole_passes_into_parts_and_tells_the_time_lost() {
        let antenna = Antenna::genius("", "");
        let before = mount_limits(&antenna);
        let Mount::AzEl { azimuth_from_deg, elevation_from_deg, elevation_to_deg, .. } =
            before.mount
        else {
            panic!("an az/el mount")
        };
        let mount = Mount::AzEl {
            azimuth_from_deg,
            azimuth_to_deg: 100.0,
            elevation_from_deg,
            elevation_to_deg,
        };
        let after = MountLimits { mount, ..before };
        let question = Question { antenna: antenna.id, before, after };
        let [before, after] = question.tallies(&[way(20.0), way(60.0)]);
        assert_eq!(before, Tally { whole: 2, ..Tally::default() });
        assert_eq!((after.whole, after.in_part, after.not), (0, 2, 0));
        assert!(after.lost_s > 600.0 && after.lost_s < 1000.0, "{}", after.lost_s);
    }

    #[test]
    fn a_pass_below_the_minimum_elevation_is_not_tracked() {
        let mut antenna = Antenna::genius("", "");
        let before = mount_limits(&antenna);
        antenna.limits.minimum_elevation_deg = 30.0;
        let question = Question { antenna: antenna.id, before, after: mount_limits(&antenna) };
        let [before, after] = question.tallies(&[way(20.0), way(60.0)]);
        assert_eq!((before.whole, after.whole, after.not), (2, 1, 1));
    }
}
