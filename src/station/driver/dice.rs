//! Repeatable random numbers for tests.

use proptest::{
    prelude::Rng as _,
    test_runner::{RngAlgorithm, TestRng},
};

pub(super) struct Dice(TestRng);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
    }

    pub(super) fn draw(&mut self, min: f64, max: f64) -> f64 {
        min + (max - min) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.draw(0.0, 1.0) < share
    }

    pub(super) fn below(&mut self, end: usize) -> usize {
        self.draw(0.0, end as f64) as usize
    }
}
