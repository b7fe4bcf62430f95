//! Real rate of an axis, measured during long slews.

use crate::{clock::Instant, station::ranges};

/// Distance from the start and the end of a slew within which an axis may be slower, degrees.
const RAMP_DEG: f64 = 5.0;
/// Min distance that yields a rate, degrees: long enough to make the rounding of a sensor to whole
/// degrees insignificant.
const MIN_WAY_DEG: f64 = 20.0;
/// Min number of positions that yield a rate.
const MIN_READINGS: usize = 8;
/// Max number of stored positions, for an axis that never arrives.
const MAX_READINGS: usize = 4096;

/// Measurement of the current slew.
#[derive(Debug, Clone, Default)]
pub(super) struct SlewRate {
    slew: Option<Slew>,
}

#[derive(Debug, Clone)]
struct Slew {
    from_deg: f64,
    to_deg: f64,
    /// Times and positions at full rate.
    readings: Vec<(Instant, f64)>,
}

impl SlewRate {
    /// Takes the position of the axis at `instant` on its way to `to_deg`, degrees as the mount
    /// counts. Returns the full rate, degrees per second, if a long slew has just ended.
    pub(super) fn take(
        &mut self,
        instant: Instant,
        position_deg: Option<f64>,
        to_deg: Option<f64>,
    ) -> Option<f64> {
        let (Some(position_deg), Some(to_deg)) = (position_deg, to_deg) else {
            return self.slew.take().and_then(|slew| slew.rate_deg_s());
        };
        match &mut self.slew {
            // Compare bits, because any change of the target, however small, is a new command.
            Some(slew) if slew.to_deg.to_bits() == to_deg.to_bits() => {
                slew.take(instant, position_deg)
            }
            slew => {
                let next = Slew { from_deg: position_deg, to_deg, readings: Vec::new() };
                slew.replace(next).and_then(|ended| ended.rate_deg_s())
            }
        }
    }
}

impl Slew {
    fn take(&mut self, instant: Instant, position_deg: f64) -> Option<f64> {
        let way = (self.to_deg - self.from_deg).signum();
        // An axis ramps up and down; only the stretch at full rate counts.
        if (position_deg - self.from_deg) * way < RAMP_DEG {
            return None;
        }
        if (self.to_deg - position_deg) * way >= RAMP_DEG {
            if self.readings.len() < MAX_READINGS {
                self.readings.push((instant, position_deg));
            }
            return None;
        }
        let rate_deg_s = self.rate_deg_s();
        // One slew yields one rate: without readings, its end yields no second one.
        self.readings.clear();
        rate_deg_s
    }

    /// Returns the mean of the middle half of the rates, each measured over a quarter of the path.
    /// This omits late positions and moments of standstill.
    fn rate_deg_s(&self) -> Option<f64> {
        let (_, first_deg) = self.readings.first()?;
        let (_, last_deg) = self.readings.last()?;
        let is_long = (last_deg - first_deg).abs() >= MIN_WAY_DEG;
        if !is_long || self.readings.len() < MIN_READINGS {
            return None;
        }
        let after = self.readings.iter().skip(self.readings.len() / 4);
        let pairs = self.readings.iter().zip(after);
        let rate = |((start, from_deg), (end, to_deg)): (&(Instant, f64), &(Instant, f64))| {
            (to_deg - from_deg).abs() / end.saturating_duration_since(*start).as_secs_f64()
        };
        let mut rates: Vec<f64> = pairs.map(rate).collect();
        rates.sort_by(f64::total_cmp);
        let middle = rates.get(rates.len() / 4..rates.len() - rates.len() / 4)?;
        let rate_deg_s = middle.iter().sum::<f64>() / middle.len() as f64;
        // A faulty sensor must not teach a rate that the station file would refuse.
        ranges::MAXIMUM_RATE_DEG_S.contains(&rate_deg_s).then_some(rate_deg_s)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// Returns the rate learned from an axis that turns from 10 to `to_deg` at `rate_deg_s`. The
    /// unit measures its position every `each_s`; `reported` computes the reported value from the
    /// second and the position.
    fn learned(
        to_deg: f64,
        rate_deg_s: f64,
        each_s: f64,
        reported: impl Fn(f64, f64) -> f64,
    ) -> Option<f64> {
        let mut rate = SlewRate::default();
        let start = Instant::now();
        let way_deg: f64 = to_deg - 10.0;
        let readings = ((way_deg.abs() / rate_deg_s + 5.0) / each_s) as u32;
        let found = (0..readings).filter_map(|reading| {
            let second = f64::from(reading) * each_s;
            // The axis sets out after a second.
            let turned_deg = (rate_deg_s * (second - 1.0).max(0.0)).min(way_deg.abs());
            let position_deg = reported(second, 10.0 + turned_deg.copysign(way_deg));
            rate.take(
                start + Duration::try_from_secs_f64(second).unwrap(),
                Some(position_deg),
                Some(to_deg),
            )
        });
        let found: Vec<f64> = found.collect();
        assert!(found.len() < 2, "{found:?}");
        found.first().copied()
    }

    fn assert_near(found: Option<f64>, rate_deg_s: f64, share: f64) {
        let error = found.map(|found| (found / rate_deg_s - 1.0).abs());
        assert!(error.is_some_and(|deviation| deviation < share), "{found:?} for {rate_deg_s}");
    }

    #[test]
    fn the_rate_of_a_long_slew_is_learned_either_way_round() {
        for rate_deg_s in [0.3, 2.0, 6.0] {
            for to_deg in [70.0, -200.0] {
                assert_near(
                    learned(to_deg, rate_deg_s, 0.25, |_, degrees| degrees),
                    rate_deg_s,
                    1e-6,
                );
            }
        }
    }

    #[test]
    fn whole_degrees_are_enough() {
        for rate_deg_s in [0.7, 1.9, 3.3, 4.0, 5.7] {
            for to_deg in [45.0, 100.0] {
                let found = learned(to_deg, rate_deg_s, 0.25, |_, degrees| degrees.round());
                assert_near(found, rate_deg_s, 0.04);
            }
        }
    }

    #[test]
    fn a_few_late_positions_do_no_harm() {
        let late = |second: f64, degrees: f64| {
            if (second / 0.25).round() as i64 % 9 == 0 { degrees - 3.0 } else { degrees }
        };
        assert_near(learned(100.0, 4.0, 0.25, late), 4.0, 0.02);
    }

    #[test]
    fn a_short_slew_and_one_that_is_slowed_down_near_its_end_teach_nothing_wrong() {
        assert_eq!(learned(35.0, 4.0, 0.25, |_, degrees| degrees), None);
        assert_eq!(learned(100.0, 25.0, 0.5, |_, degrees| degrees), None, "too few positions");
        let slow =
            |second: f64, degrees: f64| if degrees > 96.0 { 96.0 + second / 99.0 } else { degrees };
        assert_near(learned(100.0, 4.0, 0.25, slow), 4.0, 1e-6);
    }

    #[test]
    fn a_slew_that_is_called_off_counts_as_far_as_it_went() {
        let mut rate = SlewRate::default();
        let start = Instant::now();
        let time = |second: u32| start + Duration::from_secs(second.into());
        for second in 0..20 {
            assert_eq!(rate.take(time(second), Some(f64::from(second) * 2.0), Some(180.0)), None);
        }
        assert_eq!(rate.take(time(20), Some(40.0), Some(30.0)), Some(2.0));
        assert_eq!(rate.take(time(21), None, Some(30.0)), None);
    }
}
