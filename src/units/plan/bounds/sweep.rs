//! Ranges of the axes.

/// Min distance between two samples of a range of positions, degrees.
const SAMPLE_DEG: f64 = 1.0;
/// Max number of steps along an axis if only its range is sampled.
const STEPS_OF_ONE: f64 = 128.0;
/// Max number of steps along each axis if both ranges are sampled.
const STEPS_OF_BOTH: f64 = 16.0;

/// Ranges of both axes, degrees as the mount counts, each from the lower to the
/// upper end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep(pub [(f64, f64); 2]);

impl Sweep {
    /// Returns the ranges that both axes sweep between two positions.
    pub fn new(from_deg: [f64; 2], to_deg: [f64; 2]) -> Self {
        let [(a, b), (c, d)] = [(from_deg[0], to_deg[0]), (from_deg[1], to_deg[1])];
        Self([(a.min(b), a.max(b)), (c.min(d), c.max(d))])
    }

    /// Returns a sweep of the single position `axes_deg`.
    pub fn at_position(axes_deg: [f64; 2]) -> Self {
        Self(axes_deg.map(|deg| (deg, deg)))
    }

    /// Returns the smallest sweep that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let [(a, b), (c, d)] = self.0;
        let [(e, f), (g, h)] = other.0;
        Self([(a.min(e), b.max(f)), (c.min(g), d.max(h))])
    }

    /// Returns the sweep after each axis has turned by `by_deg`.
    #[must_use]
    pub fn turned(self, by_deg: [f64; 2]) -> Self {
        let [(a, b), (c, d)] = self.0;
        Self([(a + by_deg[0], b + by_deg[0]), (c + by_deg[1], d + by_deg[1])])
    }

    pub fn middle(self) -> [f64; 2] {
        self.0.map(|(start, end)| f64::midpoint(start, end))
    }

    pub(super) fn corners(self) -> [[f64; 2]; 4] {
        let [(a, b), (c, d)] = self.0;
        [[a, c], [a, d], [b, c], [b, d]]
    }

    /// Returns the number of sample steps of each axis.
    fn steps(self) -> [f64; 2] {
        let is_range = self.0.map(|(start, end)| start < end);
        let max = if is_range == [true; 2] { STEPS_OF_BOTH } else { STEPS_OF_ONE };
        self.0.map(|(first, last)| ((last - first) / SAMPLE_DEG).ceil().clamp(0.0, max))
    }

    /// Returns the max angle between a direction in the sweep and its nearest sample, degrees.
    pub(super) fn sampled_within_deg(self) -> f64 {
        let widths = self.0.iter().map(|(start, end)| end - start);
        widths.zip(self.steps()).map(|(width, steps)| width / steps.max(1.0) / 2.0).sum()
    }

    /// Returns evenly spaced positions, including both ends of each axis.
    pub(super) fn sampled(self) -> SweepSamples {
        SweepSamples { sweep: self, steps: self.steps().map(|steps| steps as usize) }
    }

    pub(super) fn samples(self) -> impl Iterator<Item = [f64; 2]> {
        let samples = self.sampled();
        let [first, second] = samples.steps.map(|steps| 0..=steps);
        first.flat_map(move |first| {
            second.clone().map(move |second| samples.sample([first, second]))
        })
    }

    /// Returns the max angle between a direction in the sweep and its middle, degrees.
    pub(super) fn radius_deg(self) -> f64 {
        self.0.iter().map(|(start, end)| (end - start) / 2.0).sum()
    }

    /// Cuts the sweep in half across its longer side.
    pub(super) fn halves(self) -> [Self; 2] {
        let [(a, b), (c, d)] = self.0;
        if b - a >= d - c {
            let middle = f64::midpoint(a, b);
            [Self([(a, middle), (c, d)]), Self([(middle, b), (c, d)])]
        } else {
            let middle = f64::midpoint(c, d);
            [Self([(a, b), (c, middle)]), Self([(a, b), (middle, d)])]
        }
    }
}

/// Evenly spaced positions of a sweep.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweepSamples {
    sweep: Sweep,
    /// Number of steps along each axis.
    pub(super) steps: [usize; 2],
}

impl SweepSamples {
    /// Returns the sample after this number of steps along each axis.
    pub(super) fn sample(self, [first, second]: [usize; 2]) -> [f64; 2] {
        let (Sweep([firsts, seconds]), [all_first, all_second]) = (self.sweep, self.steps);
        let place = |(start, end): (f64, f64), step: usize, all: usize| {
            (end - start).mul_add(step as f64 / (all.max(1) as f64), start)
        };
        [place(firsts, first, all_first), place(seconds, second, all_second)]
    }
}
