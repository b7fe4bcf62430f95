//! Faults of a rehearsal at random times.

use azel::{
    astro::time::{add_seconds, seconds_between},
    sim::Mechanics,
};
use jiff::Timestamp;
use std::time::Duration;

use crate::common::dice::Dice;

/// Min drift of the unit's clock over the whole rehearsal, seconds.
const MIN_DRIFT_S: f64 = 1.0;
/// Max share of the rehearsal that an outage or the power cut takes.
const MAX_OUTAGE: f64 = 0.05;

/// A stretch of time.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) from: Timestamp,
    pub(super) to: Timestamp,
}

impl std::fmt::Debug for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} for {:.0} s", self.from, seconds_between(self.from, self.to))
    }
}

impl Span {
    pub(super) fn contains(&self, at: Timestamp) -> bool {
        self.from <= at && at < self.to
    }

    /// Returns the seconds that both spans have in common.
    pub(super) fn overlap_s(&self, other: Self) -> f64 {
        seconds_between(self.from.max(other.from), self.to.min(other.to)).max(0.0)
    }
}

#[derive(Debug)]
pub(super) struct Faults {
    /// Power cut of computer and units.
    pub(super) power_cut: Span,
    /// Link outages, one for each antenna.
    pub(super) outages: [Span; 3],
    /// Wrong clock of the computer, until the time service sets it.
    pub(super) clock: Span,
    pub(super) clock_by_s: f64,
    /// Refusals by the server of elements.
    pub(super) sources: Span,
    pub(super) drift_s_day: f64,
    pub(super) mechanics: Mechanics,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Event {
    PowerCut { is_on: bool },
    Outage { antenna: usize, is_on: bool },
    ClockStep { by_s: f64 },
    Sources { is_on: bool },
}

impl Faults {
    pub(super) fn draw(seed: u64, from: Timestamp, hours: f64) -> Self {
        let dice = &mut Dice::new(seed);
        // Each fault has its own part of the rehearsal.
        let mut within = |[first, last]: [f64; 2], [min_s, max_s]: [f64; 2]| {
            let max_s = max_s.min(MAX_OUTAGE * hours * 3600.0);
            let begin = add_seconds(from, dice.between(first, last) * hours * 3600.0);
            let lasts_s = min_s * (max_s / min_s).powf(dice.between(0.0, 1.0));
            Span { from: begin, to: add_seconds(begin, lasts_s) }
        };
        let outage_s = [10.0, 400.0];
        let outages = [[0.15, 0.25], [0.28, 0.38], [0.42, 0.52]].map(|part| within(part, outage_s));
        let power_cut = within([0.73, 0.8], [120.0, 1800.0]);
        let clock = within([0.57, 0.67], [16.0, 128.0]);
        let days = |days: f64| add_seconds(from, days / 7.0 * hours * 3600.0);
        let sign = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let drift_s_day = dice.between(4.0, 9.0).max(MIN_DRIFT_S * 24.0 / hours);
        let clock_by_s = dice.between(5.0, 90.0);
        let clock_by_s = if dice.chance(0.5) { clock_by_s } else { -clock_by_s };
        Self {
            power_cut,
            outages,
            clock,
            clock_by_s,
            sources: Span { from: days(2.0), to: days(5.0) },
            drift_s_day: sign * drift_s_day,
            mechanics: Mechanics {
                dead_time: Duration::from_millis(200),
                coasting: None,
                minimum_run: Duration::from_millis(100),
                noise_deg: 0.02,
                backlash_deg: 0.05,
                sway_deg: 0.2,
            },
        }
    }

    pub(super) fn events(&self) -> Vec<(Timestamp, Event)> {
        let Self { power_cut, outages, clock, clock_by_s, sources, .. } = self;
        let outages = outages.iter().enumerate().flat_map(|(antenna, outage)| {
            [(outage.from, true), (outage.to, false)]
                .map(|(at, is_on)| (at, Event::Outage { antenna, is_on }))
        });
        let others = [
            (power_cut.from, Event::PowerCut { is_on: true }),
            (power_cut.to, Event::PowerCut { is_on: false }),
            (clock.from, Event::ClockStep { by_s: *clock_by_s }),
            (clock.to, Event::ClockStep { by_s: -clock_by_s }),
            (sources.from, Event::Sources { is_on: true }),
            (sources.to, Event::Sources { is_on: false }),
        ];
        outages.chain(others).collect()
    }

    /// Returns the faults during which an antenna, counted from 0, need not keep the promise.
    pub(super) fn excused(&self, antenna: usize) -> Vec<Span> {
        let outage = self.outages.get(antenna).copied();
        [self.power_cut, self.clock].into_iter().chain(outage).collect()
    }
}
