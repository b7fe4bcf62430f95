//! Many cases with successive seeds.

use std::{future::Future, panic::AssertUnwindSafe};

use crate::common::{
    dice::Dice,
    turns::{self, Turns},
};

/// Runs `case` in paused time with successive seeds, by default `usual` times. `AZEL_CASES` sets
/// another number.
pub(crate) fn for_each_case<Ran: Future<Output = ()>>(
    class: &str,
    usual: u64,
    case: impl Fn(Dice) -> Ran,
) {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("AZEL_SEED").unwrap_or(20_261_122);
    let cases = number("AZEL_CASES").unwrap_or(usual);
    println!("{class}: {cases} cases from seed {seed}");
    turns::take_measured();
    let mut turns = Turns::default();
    let mut slowest = (0.0, seed);
    let mut failed = Vec::new();
    for seed in seed..seed + cases {
        let run = AssertUnwindSafe(|| {
            let mut builder = tokio::runtime::Builder::new_current_thread();
            let runtime = builder.enable_time().start_paused(true).build().unwrap();
            runtime.block_on(case(Dice::new(seed)));
        });
        if std::panic::catch_unwind(run).is_err() {
            println!("{class}: seed {seed} failed");
            failed.push(seed);
            assert!(failed.len() < 10, "{class}: seeds {failed:?} failed");
        }
        let measured = turns::take_measured();
        if measured.longest_ms() > slowest.0 {
            slowest = (measured.longest_ms(), seed);
        }
        turns.add_all(&measured);
    }
    println!("{class}: {turns}, that of seed {}", slowest.1);
    assert!(failed.is_empty(), "{class}: of {cases} cases seeds {failed:?} failed");
}
