//! Time at which an antenna joins a pass from its current position.

use jiff::Timestamp;

use super::{
    PlannedAntenna,
    legs::set_up_ms,
    way::{Span, Way, at_ms, ms},
};
use crate::plan::Sample;

/// Accuracy of the arrival time of an antenna, milliseconds.
const EXACT_MS: i64 = 500;

/// Rest of a pass after the slew of the antenna.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joining {
    /// Arrival time of the antenna.
    pub met: Timestamp,
    /// Time that the antenna needs to get there: its set-up and the slew, seconds.
    pub needs_s: f64,
    /// Delay of the arrival, seconds, from the earliest useful time or from now if that has passed.
    pub late_s: f64,
    /// Seconds that count after the arrival.
    pub left_s: f64,
}

impl PlannedAntenna {
    /// Returns when this antenna is on the pass along `samples`, which are at equal intervals, the
    /// oldest first. The antenna sets out from its position as soon as it is free and set up.
    /// Returns `None` if it arrives after LOS, if no path leads there, or if its position is
    /// unknown.
    pub fn joining(&self, samples: &[Sample]) -> Option<Joining> {
        let (stands_deg, ready_ms) = (self.stands_deg?, self.ready_ms());
        let way = self.reach.rest(samples, stands_deg, (self.free_from, ready_ms))?;
        let (met_ms, leg_ms) = self.met_ms(&way, stands_deg, ready_ms)?;
        let left = Span { from_ms: met_ms, to_ms: way.span().to_ms };
        Some(Joining {
            met: at_ms(met_ms),
            needs_s: (set_up_ms(self) + leg_ms) as f64 / 1000.0,
            late_s: (met_ms - way.span().from_ms) as f64 / 1000.0,
            left_s: way.counted_ms(left) as f64 / 1000.0,
        })
    }

    /// Returns the time at which the antenna is free and set up.
    pub(super) fn ready_ms(&self) -> i64 {
        ms(self.free_from) + set_up_ms(self)
    }

    /// Returns the first counted time at which the axes can be at the positions of `way`, and the
    /// duration of their turn. The axes set out at `ready_ms`.
    pub(super) fn met_ms(
        &self,
        way: &Way,
        stands_deg: [f64; 2],
        ready_ms: i64,
    ) -> Option<(i64, i64)> {
        let mut at_ms = way.next_counted_ms(ready_ms)?;
        loop {
            let to_deg = way.axes_deg(at_ms);
            let mut leg_ms = self.reach.straight_ms(stands_deg, to_deg);
            if ready_ms + leg_ms <= at_ms + EXACT_MS {
                // Search for a path round barriers only now, because a search is slow.
                let Some(round_ms) = self.reach.leg_ms(stands_deg, to_deg, ready_ms) else {
                    at_ms = way.next_stretch_ms(at_ms)?;
                    continue;
                };
                leg_ms = round_ms;
            }
            let missing_ms = ready_ms + leg_ms - at_ms;
            if missing_ms <= EXACT_MS {
                return Some((at_ms, leg_ms));
            }
            // In a second, the leg becomes shorter by at most a second, because `way` keeps to the
            // rates of the axes. So half of the missing time never skips the arrival.
            at_ms = way.next_counted_ms(at_ms + missing_ms / 2)?;
        }
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::{AzEl, time::add_seconds},
        station::{Antenna, BetweenPasses, Entered, KeepOut, Mount, Station},
    };

    const AOS: Timestamp = Timestamp::UNIX_EPOCH;

    /// Returns a pass of 200 s with samples 2 s apart, from one direction to another.
    fn pass(from_deg: (f64, f64), to_deg: (f64, f64)) -> Vec<Sample> {
        let sample = |step: i32| {
            let share = f64::from(step) / 100.0;
            let mixed = |start: f64, end: f64| start + (end - start) * share;
            let direction =
                AzEl::from_degrees(mixed(from_deg.0, to_deg.0), mixed(from_deg.1, to_deg.1));
            Sample { time: add_seconds(AOS, f64::from(step) * 2.0), direction }
        };
        (0..=100).map(sample).collect()
    }

    /// Returns a satellite that stands in the east.
    fn in_the_east() -> Vec<Sample> {
        pass((90.0, 45.0), (90.0, 45.0))
    }

    fn dish(azimuths_deg: (f64, f64), elevation_to_deg: f64) -> Antenna {
        let mut antenna = Antenna::rc2000c("Dish", "");
        antenna.limits.maximum_rate_deg_s = 1.0;
        antenna.limits.minimum_elevation_deg = 5.0;
        antenna.beam_width_deg = 1.0;
        antenna.mount = Mount::AzEl {
            azimuth_from_deg: azimuths_deg.0,
            azimuth_to_deg: azimuths_deg.1,
            elevation_from_deg: 0.0,
            elevation_to_deg,
        };
        antenna
    }

    /// Returns the antenna in a station with these keep-outs, free `free_s` seconds after AOS.
    fn planned(antenna: &Antenna, keep_outs: Vec<KeepOut>, free_s: f64) -> PlannedAntenna {
        let station = Station { keep_outs, ..Station::default() };
        let planned_antenna =
            PlannedAntenna::from_station(&station, antenna, add_seconds(AOS, free_s));
        PlannedAntenna { set_up_s: 0.0, between_passes: BetweenPasses::Wait, ..planned_antenna }
    }

    fn join(
        antenna: &PlannedAntenna,
        stands_deg: [f64; 2],
        samples: &[Sample],
    ) -> Option<(i64, i64)> {
        let antenna = PlannedAntenna { stands_deg: Some(stands_deg), ..antenna.clone() };
        let Joining { met, needs_s, late_s, left_s } = antenna.joining(samples)?;
        let until_met_s = met.duration_since(antenna.free_from).as_secs_f64();
        // Only the pass itself, which may begin later, delays the antenna.
        assert!(needs_s <= until_met_s + 1.0, "{needs_s} {until_met_s}");
        Some((late_s.round() as i64, left_s.round() as i64))
    }

    fn plain(free_s: f64) -> PlannedAntenna {
        planned(&dish((0.0, 360.0), 90.0), Vec::new(), free_s)
    }

    #[test]
    fn the_way_there_is_lost_from_a_pass_under_way() {
        assert_eq!(join(&plain(20.0), [60.0, 45.0], &in_the_east()), Some((30, 150)));
        assert_eq!(join(&plain(20.0), [90.0, 45.0], &in_the_east()), Some((0, 180)));
    }

    #[test]
    fn an_antenna_that_sets_out_before_aos_is_late_by_the_rest_of_its_way() {
        assert_eq!(join(&plain(-20.0), [60.0, 45.0], &in_the_east()), Some((10, 190)));
        assert_eq!(join(&plain(-30.0), [60.0, 45.0], &in_the_east()), Some((0, 200)));
    }

    #[test]
    fn an_antenna_that_is_too_far_does_not_join() {
        assert_eq!(join(&plain(20.0), [330.0, 45.0], &in_the_east()), None);
        assert_eq!(join(&plain(20.0), [90.0, 45.0], &[]), None);
        assert_eq!(plain(20.0).joining(&in_the_east()), None, "it is not known where it stands");
    }

    #[test]
    fn a_unit_is_set_up_before_it_moves() {
        let slow = PlannedAntenna { set_up_s: 25.0, ..plain(20.0) };
        assert_eq!(join(&slow, [60.0, 45.0], &in_the_east()), Some((55, 125)));
        let slow_there = PlannedAntenna { stands_deg: Some([60.0, 45.0]), ..slow.clone() };
        let needs_s = slow_there.joining(&in_the_east()).map(|joining| joining.needs_s.round());
        assert_eq!(needs_s, Some(55.0), "it is not there before");
        assert_eq!(join(&slow, [90.0, 45.0], &in_the_east()), Some((25, 155)));
    }

    #[test]
    fn the_antenna_goes_round_a_keep_out() {
        let corners = [(65.0, 0.0), (75.0, 0.0), (75.0, 70.0), (65.0, 70.0)];
        let mast = |entered| KeepOut {
            name: "Mast".to_owned(),
            reason: String::new(),
            entered,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(&corners).unwrap(),
        };
        let round = planned(&dish((0.0, 360.0), 90.0), vec![mast(Entered::GoRound)], 0.0);
        let (late_s, left_s) = join(&round, [50.0, 45.0], &in_the_east()).unwrap();
        assert!(late_s > 50 && late_s + left_s == 200, "{late_s} {left_s}");
        let warned = planned(&dish((0.0, 360.0), 90.0), vec![mast(Entered::Warn)], 0.0);
        assert_eq!(join(&warned, [50.0, 45.0], &in_the_east()), Some((40, 160)));
        // Time within the keep-out does not count.
        let southern = pass((50.0, 30.0), (100.0, 30.0));
        let hard = planned(&dish((0.0, 360.0), 90.0), vec![mast(Entered::Hard)], 0.0);
        let (late_s, left_s) = join(&hard, [50.0, 30.0], &southern).unwrap();
        assert!(late_s == 0 && left_s < 170, "{late_s} {left_s}");
    }

    #[test]
    fn the_wrap_on_which_the_axis_stands_is_its_way() {
        // The pass turns from 20 down through north to 300, which an axis of 0 to 450 follows only
        // from 380.
        let through_north = pass((380.0, 45.0), (300.0, 45.0));
        let overlap = planned(&dish((0.0, 450.0), 90.0), Vec::new(), 0.0);
        let (late_s, _) = join(&overlap, [380.0, 45.0], &through_north).unwrap();
        assert_eq!(late_s, 0);
        // The axis turns backwards round the whole circle, towards the approaching satellite.
        let (late_s, _) = join(&overlap, [200.0, 45.0], &through_north).unwrap();
        assert!(late_s > 100, "{late_s}");
    }

    #[test]
    fn a_flipped_antenna_joins_flipped() {
        let tipping = planned(&dish((0.0, 360.0), 180.0), Vec::new(), 0.0);
        assert_eq!(join(&tipping, [270.0, 135.0], &in_the_east()), Some((0, 200)));
        assert_eq!(join(&plain(0.0), [270.0, 45.0], &in_the_east()), Some((180, 20)));
    }

    #[test]
    fn below_its_own_minimum_elevation_an_antenna_is_not_late() {
        let rising = pass((90.0, 0.0), (90.0, 50.0));
        assert_eq!(join(&plain(0.0), [90.0, 5.0], &rising).map(|(late_s, _)| late_s), Some(0));
    }
}
