//! Properties of an axis that Azel learns from its motions, while nobody else moves it.

use std::time::Duration;

use crate::{
    clock::Instant,
    contract::driver::lessons::{AtRest, DeadTime, LENGTHS_DEG, PastEnds, RUNS_PAST_DEG, STARTS},
};

/// Max time from a command until the drive obeys.
pub(super) const DEAD_TIME: Duration = Duration::from_secs(2);
/// Min allowance for an overshoot, seconds at the fastest rate.
const RUNS_S: f64 = 0.45;
/// Max rate of any axis, degrees a second.
pub(super) const FASTEST_DEG_S: f64 = 30.0;
/// Default overshoot past the end of a motion without lessons, seconds at the fastest rate.
const COASTS_S: f64 = 2.7;
/// Min time between two readings for a rate.
pub(super) const RATE_APART: Duration = Duration::from_secs(1);
/// Factor between the max overshoot of a motion and the observed overshoots.
const MARGIN: f64 = 2.5;
/// Min time for which the length of a motion counts; the max time is twice as long.
const WINDOW: Duration = Duration::from_secs(10);
/// Extra dead time allowed for further starts, in addition to a quarter of the longest.
const SPARE: Duration = Duration::from_millis(200);
/// Default noise beyond half a step until the readings have shown less, and max noise, degrees.
const NOISE_DEG: f64 = 0.35;
const MAX_NOISE_DEG: f64 = 1.0;
/// Min number of observed resting places.
const PLACES: u8 = 6;
/// Number of readings of a standing axis that show its noise.
const READINGS: u16 = 20;
/// Factor by which further readings may differ more.
const SPREADS: f64 = 1.3;

/// Overshoot of an axis past the end of its motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RunsPast {
    pub(super) past_ends: PastEnds,
    /// `true` if each motion replaces an unfinished one.
    are_steps: bool,
    /// Overshoot past the current end, degrees.
    past_deg: f64,
    /// Length of the longest motion without a reached end, degrees.
    way_deg: f64,
    /// Length of the longest such motion in this window and in the previous window, degrees.
    left_deg: [f64; 2],
    window_start: Option<Instant>,
    /// `true` if the axis reached an end in this window.
    has_reached: bool,
    /// `true` if Azel sent a motion since the last window that counts.
    was_commanded: bool,
}

impl RunsPast {
    pub(super) fn new(past_ends: PastEnds) -> Self {
        Self { past_ends, ..Self::default() }
    }

    /// Takes a reading; `is_there` is `true` near the end of the motion.
    pub(super) fn look(&mut self, is_there: bool, time: Instant) {
        let left_deg = self.way_deg;
        if is_there {
            self.way_deg = 0.0;
            // Only an axis that comes back has overshot without another motion.
            let (class, past_deg) = (self.class(), std::mem::take(&mut self.past_deg));
            if let Some(seen_deg) = self.past_ends.seen_deg.get_mut(class) {
                *seen_deg = seen_deg.max(past_deg);
            }
        }
        let start = *self.window_start.get_or_insert(time);
        self.has_reached |= is_there;
        if time.saturating_duration_since(start) > WINDOW {
            let class = self.class();
            // An axis that hunts around one end proves its overshoot only once.
            let shows = std::mem::take(&mut self.has_reached) && self.was_commanded;
            if let Some(windows) = self.past_ends.windows.get_mut(class).filter(|_| shows) {
                *windows = windows.saturating_add(1);
                self.was_commanded = false;
            }
            self.window_start = Some(time);
            let [now_deg, _] = self.left_deg;
            self.left_deg = [0.0, now_deg];
        }
        let [now_deg, before_deg] = self.left_deg;
        self.left_deg = [now_deg.max(left_deg), before_deg];
    }

    /// Records an outgoing motion of this length, degrees; `are_steps`: it follows right after
    /// another motion.
    pub(super) fn note_command(&mut self, way_deg: f64, are_steps: bool) {
        (self.are_steps, self.was_commanded) = (are_steps, true);
        // Until the axis reaches the end, it may turn as fast as on a long path.
        self.way_deg = self.way_deg.max(way_deg);
        let [now_deg, before_deg] = self.left_deg;
        self.left_deg = [now_deg.max(self.way_deg), before_deg];
    }

    fn class(&self) -> usize {
        let longest_deg = self.left_deg.into_iter().fold(0.0, f64::max);
        let longest_deg = if self.window_start.is_some() { longest_deg } else { f64::INFINITY };
        let class = LENGTHS_DEG.iter().position(|max| longest_deg <= *max).unwrap_or_default();
        if self.are_steps { class + LENGTHS_DEG.len() } else { class }
    }

    /// Records a rate between two readings, degrees a second.
    pub(super) fn note_rate(&mut self, rate_deg_s: f64) {
        self.past_ends.fastest_deg_s = self.past_ends.fastest_deg_s.max(rate_deg_s);
        self.past_ends.turns = self.past_ends.turns.saturating_add(1);
    }

    /// Returns the max rate of the axis, degrees a second.
    pub(super) fn max_deg_s(&self) -> f64 {
        if self.past_ends.knows_rate() {
            (self.past_ends.fastest_deg_s * 1.3).min(FASTEST_DEG_S)
        } else {
            FASTEST_DEG_S
        }
    }

    /// Records a reading this far past the end, degrees.
    pub(super) fn note_overshoot(&mut self, by_deg: f64) {
        self.past_deg = self.past_deg.max(by_deg);
    }

    /// Forgets the current overshoot after a foreign motion.
    pub(super) fn forget(&mut self) {
        self.past_deg = 0.0;
    }

    /// Returns the max overshoot past the end of the current motion, degrees.
    pub(super) fn max_deg(&self) -> f64 {
        if !self.past_ends.knows_class(self.class()) {
            return self.coasts_deg();
        }
        (self.past_ends.furthest_deg() * MARGIN).max(self.max_deg_s() * RUNS_S).min(RUNS_PAST_DEG)
    }

    /// Returns the max coasting distance from the full rate, degrees.
    pub(super) fn coasts_deg(&self) -> f64 {
        (self.max_deg_s() * COASTS_S).min(RUNS_PAST_DEG)
    }
}

/// Records the time from a command until the axis turned.
pub(super) fn note_start(dead_time: &mut DeadTime, lasted: Duration) {
    dead_time.longest_s = dead_time.longest_s.max(lasted.as_secs_f64());
    dead_time.starts = dead_time.starts.saturating_add(1);
}

/// Returns the max time until the drive obeys a command.
pub(super) fn max_dead_time(dead_time: DeadTime) -> Duration {
    if dead_time.starts < STARTS {
        return DEAD_TIME;
    }
    let longest = Duration::try_from_secs_f64(dead_time.longest_s * 1.25).unwrap_or(DEAD_TIME);
    longest.saturating_add(SPARE).min(DEAD_TIME)
}

/// Spread of the readings of a standing axis.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spread {
    pub(super) at_rest: AtRest,
    /// Lowest and highest reading since the axis stands, degrees, and number of readings.
    now: Option<(f64, f64, u16)>,
    has_turned: bool,
}

impl Spread {
    pub(super) fn new(at_rest: AtRest) -> Self {
        Self { at_rest, ..Self::default() }
    }

    /// Takes a reading of an axis that stands.
    pub(super) fn note_rest(&mut self, deg: f64) {
        let (from_deg, to_deg, readings) = self.now.unwrap_or((deg, deg, 0));
        let (from_deg, to_deg) = (from_deg.min(deg), to_deg.max(deg));
        self.now = Some((from_deg, to_deg, readings + 1));
        if readings + 1 >= READINGS {
            let spread_deg = to_deg - from_deg;
            self.at_rest.widest_deg =
                Some(self.at_rest.widest_deg.map_or(spread_deg, |deg| deg.max(spread_deg)));
            self.now = None;
            if std::mem::take(&mut self.has_turned) {
                self.at_rest.places = self.at_rest.places.saturating_add(1);
            }
        }
    }

    pub(super) fn note_turn(&mut self) {
        (self.now, self.has_turned) = (None, true);
    }

    /// Returns the largest expected difference between two readings of a standing axis, degrees;
    /// `None` until it has been measured.
    pub(super) fn expected_deg(&self) -> Option<f64> {
        self.at_rest.widest_deg.map(|widest_deg| (widest_deg * SPREADS).min(MAX_NOISE_DEG))
    }

    /// Returns the max error of a reading, degrees, for a unit that reports steps of
    /// `resolution_deg`.
    pub(super) fn error_deg(&self, resolution_deg: f64) -> f64 {
        let half_step_deg = resolution_deg / 2.0;
        // At places not yet observed, the noise may reach one more step.
        let step_deg = if self.at_rest.places < PLACES { half_step_deg } else { 0.0 };
        let seen_deg =
            self.at_rest.widest_deg.map(|deg| (deg / 2.0 * SPREADS).max(deg / 2.0 + step_deg));
        let error_deg = seen_deg.unwrap_or(half_step_deg + NOISE_DEG);
        error_deg.clamp(half_step_deg, half_step_deg + MAX_NOISE_DEG) + resolution_deg * 0.05
    }
}
