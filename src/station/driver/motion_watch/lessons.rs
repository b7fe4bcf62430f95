//! Properties of an axis that are learned from its motions, as long as nobody else moves it.

use std::time::Duration;

use crate::{
    clock::Instant,
    contract::driver::lessons::{AtRest, DeadTime, LENGTHS_DEG, PastEnds, RUNS_PAST_DEG, STARTS},
};

/// Longest time from a command until the drive obeys it.
pub(super) const DEAD_TIME: Duration = Duration::from_secs(2);
/// A drive may run for so long at least, seconds.
const RUNS_S: f64 = 0.45;
/// No axis turns faster, degrees a second.
pub(super) const FASTEST_DEG_S: f64 = 30.0;
/// Without lessons: seconds at the fastest rate that an axis runs past the end of a motion.
const COASTS_S: f64 = 2.7;
/// A rate is taken between readings this far apart at least.
pub(super) const RATE_APART: Duration = Duration::from_secs(1);
/// A motion may run past its end by this many times as much as those before.
const MARGIN: f64 = 2.5;
/// The length of a motion counts for as long as this, and up to twice as long.
const WINDOW: Duration = Duration::from_secs(10);
/// Further starts may take this much longer, besides a quarter.
const SPARE: Duration = Duration::from_millis(200);
/// Noise beyond half a step is no more than this until the readings have shown less, and at most,
/// degrees.
const NOISE_DEG: f64 = 0.35;
const MAX_NOISE_DEG: f64 = 1.0;
/// Places at which it must have been seen to stand.
const PLACES: u8 = 6;
/// Readings of a standing axis that show its noise.
const READINGS: u16 = 20;
/// Further readings may differ by this many times as much.
const SPREADS: f64 = 1.3;

/// How far an axis runs past the end of its motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RunsPast {
    pub(super) known: PastEnds,
    /// Each motion replaces the one before on its way.
    are_steps: bool,
    /// How far it has run past the present end, degrees.
    past_deg: f64,
    /// Length of the longest motion whose end was not reached yet, degrees.
    way_deg: f64,
    /// The longest such way in this window and in the one before, degrees.
    left_deg: [f64; 2],
    since: Option<Instant>,
    /// An end was reached in this window.
    has_reached: bool,
    /// A motion went out since the last window that counts.
    was_commanded: bool,
}

impl RunsPast {
    pub(super) fn new(known: PastEnds) -> Self {
        Self { known, ..Self::default() }
    }

    /// Takes a reading; `is_there`: near the end of the motion.
    pub(super) fn look(&mut self, is_there: bool, at: Instant) {
        let left_deg = self.way_deg;
        if is_there {
            self.way_deg = 0.0;
            // Only an axis that comes back has run past the end by itself.
            let (class, past_deg) = (self.class(), std::mem::take(&mut self.past_deg));
            if let Some(seen_deg) = self.known.seen_deg.get_mut(class) {
                *seen_deg = seen_deg.max(past_deg);
            }
        }
        let since = *self.since.get_or_insert(at);
        self.has_reached |= is_there;
        if at.saturating_duration_since(since) > WINDOW {
            let class = self.class();
            // An axis that hunts about one end shows only once how far it runs past an end.
            let shows = std::mem::take(&mut self.has_reached) && self.was_commanded;
            if let Some(windows) = self.known.windows.get_mut(class).filter(|_| shows) {
                *windows = windows.saturating_add(1);
                self.was_commanded = false;
            }
            self.since = Some(at);
            let [now_deg, _] = self.left_deg;
            self.left_deg = [0.0, now_deg];
        }
        let [now_deg, before_deg] = self.left_deg;
        self.left_deg = [now_deg.max(left_deg), before_deg];
    }

    /// A motion of this length goes out; `are_steps`: right after another one.
    pub(super) fn commanded(&mut self, way_deg: f64, are_steps: bool) {
        (self.are_steps, self.was_commanded) = (are_steps, true);
        // As long as the end was not reached, the axis may turn as fast as it does on a long way.
        self.way_deg = self.way_deg.max(way_deg);
        let [now_deg, before_deg] = self.left_deg;
        self.left_deg = [now_deg.max(self.way_deg), before_deg];
    }

    fn class(&self) -> usize {
        let longest_deg = self.left_deg.into_iter().fold(0.0, f64::max);
        let longest_deg = if self.since.is_some() { longest_deg } else { f64::INFINITY };
        let class = LENGTHS_DEG.iter().position(|most| longest_deg <= *most).unwrap_or_default();
        if self.are_steps { class + LENGTHS_DEG.len() } else { class }
    }

    /// The axis has turned at this rate between two readings, degrees a second.
    pub(super) fn turned(&mut self, rate_deg_s: f64) {
        self.known.fastest_deg_s = self.known.fastest_deg_s.max(rate_deg_s);
        self.known.turns = self.known.turns.saturating_add(1);
    }

    /// The fastest that it turns, degrees a second.
    pub(super) fn most_deg_s(&self) -> f64 {
        if self.known.knows_rate() {
            (self.known.fastest_deg_s * 1.3).min(FASTEST_DEG_S)
        } else {
            FASTEST_DEG_S
        }
    }

    /// The axis was read this far past the end, degrees.
    pub(super) fn past(&mut self, by_deg: f64) {
        self.past_deg = self.past_deg.max(by_deg);
    }

    /// Somebody else has moved the axis.
    pub(super) fn forget(&mut self) {
        self.past_deg = 0.0;
    }

    /// How far it may run past the end of the present motion, degrees.
    pub(super) fn most_deg(&self) -> f64 {
        if !self.known.knows_class(self.class()) {
            return self.coasts_deg();
        }
        (self.known.furthest_deg() * MARGIN).max(self.most_deg_s() * RUNS_S).min(RUNS_PAST_DEG)
    }

    /// How far it may coast from its full rate, degrees.
    pub(super) fn coasts_deg(&self) -> f64 {
        (self.most_deg_s() * COASTS_S).min(RUNS_PAST_DEG)
    }
}

/// Takes in that a command needed so long until the axis turned.
pub(super) fn note_start(known: &mut DeadTime, lasted: Duration) {
    known.longest_s = known.longest_s.max(lasted.as_secs_f64());
    known.starts = known.starts.saturating_add(1);
}

/// Longest time until a command is obeyed.
pub(super) fn max_dead_time(known: DeadTime) -> Duration {
    if known.starts < STARTS {
        return DEAD_TIME;
    }
    let longest = Duration::try_from_secs_f64(known.longest_s * 1.25).unwrap_or(DEAD_TIME);
    longest.saturating_add(SPARE).min(DEAD_TIME)
}

/// By how much readings of a standing axis differ.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spread {
    pub(super) known: AtRest,
    /// Lowest and highest reading since it stands, degrees, and their number.
    now: Option<(f64, f64, u16)>,
    has_turned: bool,
}

impl Spread {
    pub(super) fn new(known: AtRest) -> Self {
        Self { known, ..Self::default() }
    }

    /// Takes a reading of an axis that stands.
    pub(super) fn stands(&mut self, deg: f64) {
        let (from_deg, to_deg, readings) = self.now.unwrap_or((deg, deg, 0));
        let (from_deg, to_deg) = (from_deg.min(deg), to_deg.max(deg));
        self.now = Some((from_deg, to_deg, readings + 1));
        if readings + 1 >= READINGS {
            let spread_deg = to_deg - from_deg;
            self.known.widest_deg =
                Some(self.known.widest_deg.map_or(spread_deg, |deg| deg.max(spread_deg)));
            self.now = None;
            if std::mem::take(&mut self.has_turned) {
                self.known.places = self.known.places.saturating_add(1);
            }
        }
    }

    pub(super) fn turns(&mut self) {
        (self.now, self.has_turned) = (None, true);
    }

    /// Returns the largest expected difference between two readings of a standing axis, degrees; `None`
    /// until it has been measured.
    pub(super) fn expected_deg(&self) -> Option<f64> {
        self.known.widest_deg.map(|widest_deg| (widest_deg * SPREADS).min(MAX_NOISE_DEG))
    }

    /// Largest error of a reading, degrees, where the unit reports steps of `resolution_deg`.
    pub(super) fn error_deg(&self, resolution_deg: f64) -> f64 {
        let half_step_deg = resolution_deg / 2.0;
        // Elsewhere the noise may reach one more step.
        let step_deg = if self.known.places < PLACES { half_step_deg } else { 0.0 };
        let seen_deg =
            self.known.widest_deg.map(|deg| (deg / 2.0 * SPREADS).max(deg / 2.0 + step_deg));
        let error_deg = seen_deg.unwrap_or(half_step_deg + NOISE_DEG);
        error_deg.clamp(half_step_deg, half_step_deg + MAX_NOISE_DEG) + resolution_deg * 0.05
    }
}
