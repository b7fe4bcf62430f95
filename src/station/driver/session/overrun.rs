//! Overrun of the axes after a STOP.

use std::collections::VecDeque;

use crate::{clock::Instant, contract::driver::StoppingWay, device::Measured};

/// Measured overrun: how long the axes continue after a STOP.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Overrun {
    /// Position before the STOP, its rates, and the send time of the STOP.
    before: Option<(Measured, [f64; 2], Instant)>,
    /// Overruns of the last STOPs, seconds.
    last_s: VecDeque<f64>,
    /// Total number of measured STOPs.
    stops: u32,
}

/// Number of measured STOPs that replace the default overrun.
const ENOUGH: usize = StoppingWay::ENOUGH as usize;
/// Min share of the fastest rate at which Azel learns the overrun from a jog. Slower overruns
/// disappear in the noise of the readings.
const TELLING_SHARE: f64 = 0.5;

impl Overrun {
    /// Records an outgoing STOP.
    pub(super) fn begin(&mut self, before: Option<(Measured, [f64; 2])>, now: Instant) {
        self.before = before.map(|(look, rates)| (look, rates, now));
    }

    /// Measures the overrun of axes that now stand. Returns the longest overrun of the last STOPs,
    /// seconds, once enough STOPs are measured. Scales each overrun to the fastest rate, because
    /// drives that brake evenly overrun longer at higher rates.
    pub(super) fn end(&mut self, rest: &Measured, fastest_deg_s: f64) -> Option<f64> {
        let (before, rates, stop) = self.before.take()?;
        let to_stop_s = stop.saturating_duration_since(before.requested).as_secs_f64();
        let axes = before.axes.iter().zip(&rest.axes).zip(rates);
        let overrun_s = axes
            .filter(|(_, rate)| rate.abs() >= fastest_deg_s * TELLING_SHARE)
            .filter_map(|((before, rest), rate)| {
                let turned_deg = rest.angle_deg? - before.angle_deg?;
                let overrun_s = turned_deg / rate - to_stop_s;
                Some(overrun_s * (fastest_deg_s / rate.abs()).max(1.0))
            })
            .max_by(f64::total_cmp)?;
        if self.last_s.len() >= ENOUGH {
            self.last_s.pop_front();
        }
        self.last_s.push_back(overrun_s.clamp(0.0, 10.0));
        self.stops = self.stops.saturating_add(1);
        let worst_s = self.last_s.iter().copied().fold(0.0, f64::max);
        (self.last_s.len() >= ENOUGH).then_some(worst_s)
    }

    /// Returns the stopping way, with the overrun that the gate assumes.
    pub(super) fn stopping_way(&self, overrun_s: f64) -> StoppingWay {
        let is_learned = self.last_s.len() >= ENOUGH;
        StoppingWay { overrun_s, stops: self.stops, is_learned }
    }
}
