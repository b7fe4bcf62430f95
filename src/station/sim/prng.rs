//! Repeatable random numbers.

/// Generator `SplitMix64`; the same seed gives the same numbers.
#[derive(Debug, Clone)]
pub(super) struct Prng(u64);

impl Prng {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a random number from `min` to `max`, both included.
    pub(super) fn in_range(&mut self, min: u64, max: u64) -> u64 {
        let span = max.saturating_sub(min).saturating_add(1);
        min.saturating_add(self.next() % span)
    }

    /// Returns a random number, evenly distributed from -1 to 1.
    pub(super) fn even(&mut self) -> f64 {
        self.in_range(0, 2_000_000) as f64 / 1e6 - 1.0
    }

    /// Returns an approximately normal random number with standard deviation 1: the sum of twelve
    /// evenly distributed ones.
    pub(super) fn normal(&mut self) -> f64 {
        let even = |_| self.in_range(0, 1_000_000) as f64 / 1e6;
        (0..12).map(even).sum::<f64>() - 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_repeat_and_stay_between_their_bounds() {
        let draw = |seed| {
            let mut prng = Prng::new(seed);
            (0..200).map(|_| prng.in_range(3, 9)).collect::<Vec<_>>()
        };
        assert_eq!(draw(1), draw(1));
        assert_ne!(draw(1), draw(2));
        for number in 3..=9 {
            assert!(draw(1).contains(&number));
        }
        assert!(draw(1).iter().all(|number| (3..=9).contains(number)));
        assert_eq!(Prng::new(1).in_range(5, 5), 5);
        let mut prng = Prng::new(1);
        let normal: Vec<f64> = (0..2000).map(|_| prng.normal()).collect();
        let mean = normal.iter().sum::<f64>() / 2000.0;
        let square = normal.iter().map(|number| number.powi(2)).sum::<f64>() / 2000.0;
        assert!(mean.abs() < 0.1 && (square - 1.0).abs() < 0.1, "{mean} {square}");
    }
}
