//! Properties of an axis, learned from its motions.

use serde::{Deserialize, Serialize};

/// Max assumed overrun of an axis past the end of a motion, degrees.
pub const RUNS_PAST_DEG: f64 = 60.0;

/// Min number of observation windows, or of turns, before the measured figures count.
pub const ENOUGH: u8 = 8;

/// Upper limits of the length classes of motions, degrees. An axis runs further past the end of a
/// longer motion, because it turns faster.
pub const LENGTHS_DEG: [f64; 4] = [1.0, 4.0, 16.0, f64::INFINITY];

/// Number of classes of motions: each length class, once for motions after a rest and once for
/// motions right after another motion.
pub const CLASSES: usize = LENGTHS_DEG.len() * 2;

/// Min number of starts before the dead time counts.
pub const STARTS: u8 = 3;

/// Properties of one axis, learned from its motions.
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

    /// Returns the max dead time: from a command until the axis turns, seconds; `None` until it is
    /// known.
    pub fn dead_time_s(&self) -> Option<f64> {
        (self.dead_time.starts >= STARTS).then_some(self.dead_time.longest_s)
    }

    /// Returns the largest rate between two readings, degrees a second; `None` until it is known.
    pub fn max_rate_deg_s(&self) -> Option<f64> {
        self.past_ends.knows_rate().then_some(self.past_ends.fastest_deg_s)
    }

    /// Returns the max overrun past the end of a motion, degrees; `None` until it is known. The
    /// axis coasts, and its drive runs for a minimum time.
    pub fn runs_past_deg(&self) -> Option<f64> {
        let is_known = self.past_ends.windows.iter().any(|windows| *windows >= ENOUGH);
        is_known.then(|| self.past_ends.furthest_deg())
    }

    /// Returns the max difference between readings of the standing axis, degrees; `None` until it
    /// is known.
    pub fn spread_deg(&self) -> Option<f64> {
        self.at_rest.widest_deg
    }
}

/// Overruns of an axis past the ends of its motions, by length class.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct PastEnds {
    /// Max overrun past the end, by class, degrees.
    pub seen_deg: [f64; CLASSES],
    /// Number of windows in which Azel watched the end of a motion, by class.
    pub windows: [u8; CLASSES],
    /// Max measured rate, degrees a second.
    pub fastest_deg_s: f64,
    /// Number of pairs of readings between which the axis has turned.
    pub turns: u8,
}

impl PastEnds {
    /// Returns `true` once the axis has turned often enough for its rate to count.
    pub fn knows_rate(&self) -> bool {
        self.turns >= ENOUGH
    }

    /// Returns `true` once Azel has watched enough ends of motions of the lengths of `class` or
    /// longer. An axis runs no further past the end of a shorter motion.
    pub fn knows_class(&self, class: usize) -> bool {
        let last = if class < LENGTHS_DEG.len() { LENGTHS_DEG.len() } else { CLASSES };
        let windows = self.windows.get(class..last).unwrap_or_default();
        windows.iter().fold(0, |sum: u8, windows| sum.saturating_add(*windows)) >= ENOUGH
    }

    /// Returns the max overrun past the end of any motion, degrees.
    pub fn furthest_deg(&self) -> f64 {
        let seen_deg = self.seen_deg.into_iter().filter(|deg| *deg <= RUNS_PAST_DEG / 2.0);
        seen_deg.fold(0.0, f64::max)
    }
}

/// Time from a command to a standing axis until the axis turns.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct DeadTime {
    /// Max measured dead time, seconds.
    pub longest_s: f64,
    /// Number of measured starts.
    pub starts: u8,
}

/// Differences between readings of a standing axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct AtRest {
    /// Max measured difference, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub widest_deg: Option<f64>,
    /// Number of positions at which the axis stood.
    pub places: u8,
}
