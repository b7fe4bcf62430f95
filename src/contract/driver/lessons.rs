//! Properties of an axis that its motions have shown.

use serde::{Deserialize, Serialize};

/// An axis may run this far past the end of a motion until it has been seen to do better, degrees.
pub const RUNS_PAST_DEG: f64 = 60.0;

/// Number of windows after which what was seen in them counts.
pub const ENOUGH: u8 = 8;

/// Motions count together up to these lengths, degrees: an axis runs further past the end of a longer
/// one, because it turns faster.
pub const LENGTHS_DEG: [f64; 4] = [1.0, 4.0, 16.0, f64::INFINITY];

/// Number of classes of motions: each length, after a window without and with a further one.
pub const CLASSES: usize = LENGTHS_DEG.len() * 2;

/// Number of starts after which the dead time counts.
pub const STARTS: u8 = 3;

/// Properties of one axis that its motions have shown.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct AxisLessons {
    pub past_ends: PastEnds,
    pub dead_time: DeadTime,
    pub at_rest: AtRest,
}

impl AxisLessons {
    /// Returns `true` if an axis can have such properties. A file may have been edited or damaged.
    pub fn is_plausible(&self) -> bool {
        let PastEnds { seen_deg, fastest_deg_s, .. } = self.past_ends;
        let angles_deg = seen_deg.into_iter().chain(self.at_rest.widest_deg);
        let mut all = angles_deg.chain([fastest_deg_s, self.dead_time.longest_s]);
        all.all(|figure| figure.is_finite() && figure >= 0.0)
    }

    /// Returns the longest time from a command until the axis turns, seconds; `None` until it is known.
    pub fn dead_time_s(&self) -> Option<f64> {
        (self.dead_time.starts >= STARTS).then_some(self.dead_time.longest_s)
    }

    /// Returns the largest rate between two readings, degrees a second; `None` until it is known.
    pub fn max_rate_deg_s(&self) -> Option<f64> {
        self.past_ends.knows_rate().then_some(self.past_ends.fastest_deg_s)
    }

    /// Returns how far the axis has run past the end of a motion, by coasting and because its drive
    /// runs for a minimum time, degrees; `None` until it is known.
    pub fn runs_past_deg(&self) -> Option<f64> {
        let is_known = self.past_ends.windows.iter().any(|windows| *windows >= ENOUGH);
        is_known.then(|| self.past_ends.furthest_deg())
    }

    /// Returns the largest difference between readings of the standing axis, degrees; `None` until it
    /// is known.
    pub fn spread_deg(&self) -> Option<f64> {
        self.at_rest.widest_deg
    }
}

/// How far an axis has run past the ends of its motions, by their lengths.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct PastEnds {
    /// The furthest that it has run past the end, by class, degrees.
    pub seen_deg: [f64; CLASSES],
    /// Number of windows in which the end of a motion was watched.
    pub windows: [u8; CLASSES],
    /// The fastest turn that was seen, degrees a second.
    pub fastest_deg_s: f64,
    /// Number of readings between which the axis has turned.
    pub turns: u8,
}

impl PastEnds {
    /// Returns `true` once the axis has turned often enough for its rate to count.
    pub fn knows_rate(&self) -> bool {
        self.turns >= ENOUGH
    }

    /// Returns `true` once enough ends of motions were watched that are as long as those of `class`, or
    /// longer: an axis runs no further past the end of a shorter motion.
    pub fn knows_class(&self, class: usize) -> bool {
        let last = if class < LENGTHS_DEG.len() { LENGTHS_DEG.len() } else { CLASSES };
        let windows = self.windows.get(class..last).unwrap_or_default();
        windows.iter().fold(0, |sum: u8, windows| sum.saturating_add(*windows)) >= ENOUGH
    }

    /// The furthest that it was seen to run past the end of any motion, degrees.
    pub fn furthest_deg(&self) -> f64 {
        let seen_deg = self.seen_deg.into_iter().filter(|deg| *deg <= RUNS_PAST_DEG / 2.0);
        seen_deg.fold(0.0, f64::max)
    }
}

/// The time from a command to a standing axis until it turns.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct DeadTime {
    /// The longest that was seen, seconds.
    pub longest_s: f64,
    /// Number of starts in which it was seen.
    pub starts: u8,
}

/// By how much readings of a standing axis have differed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct AtRest {
    /// The largest difference that was seen, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub widest_deg: Option<f64>,
    /// Number of places where the axis stood.
    pub places: u8,
}
