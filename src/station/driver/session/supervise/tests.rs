//! Proof that every check of [`Session::supervise`] is necessary. Each check has a scenario with a
//! simulated unit that succeeds only with the check.
//!
//! [`Session::supervise`]: crate::driver::session::Session::supervise

mod scenarios;
mod scene;

use std::{collections::BTreeSet, future::Future, pin::Pin};

use super::CHECKS;
use crate::driver::session::Session;
use scenarios::start_after_halt;

/// Set of checks that a session runs.
#[derive(Debug, Clone, Copy)]
enum Checks {
    All,
    Without(&'static str),
    /// All checks, with these two exchanged.
    Exchanged([&'static str; 2]),
}

/// Test that returns `true` if its scenario succeeds.
type Scenario = fn(Checks) -> Pin<Box<dyn Future<Output = bool>>>;

impl Session {
    fn with_checks(self, choice: Checks) -> Self {
        let place = |name: &str| CHECKS.iter().position(|check| check.name == name).unwrap();
        let mut checks = CHECKS.to_vec();
        match choice {
            Checks::All => {}
            Checks::Without(name) => drop(checks.remove(place(name))),
            Checks::Exchanged([one, other]) => checks.swap(place(one), place(other)),
        }
        Self { checks: Box::leak(checks.into_boxed_slice()), ..self }
    }
}

/// Builds a list of scenarios, each with the name of its check.
macro_rules! scenarios {
    ($($check:ident,)*) => {
        [$((stringify!($check), |checks| Box::pin(scenarios::$check(checks))),)*]
    };
}

const TABLE: &[(&str, Scenario)] = &scenarios![
    watch_judging,
    take_events,
    report_found,
    watch_likeness,
    watch_program,
    watch_hands,
    resolve_doubt,
    watch_jog,
    watch_effect,
    watch_step,
    watch_halt,
    let_sleep,
    watch_rest,
    watch_place,
    watch_offsets,
    watch_bounds,
    watch_standstill,
    watch_lock_out,
    watch_auto_track,
    watch_unit_offsets,
    forget_old_stop,
    start_queued,
    watch_slew,
    watch_tracking,
    watch_on_board,
    watch_pointing,
    watch_silence,
];

#[test]
fn every_check_has_its_scenario_and_a_name_of_its_own() {
    let names: Vec<&str> = CHECKS.iter().map(|check| check.name).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "two share a name");
    let scenarios: Vec<&str> = TABLE.iter().map(|(name, _)| *name).collect();
    assert_eq!(scenarios, names);
}

#[tokio::test(start_paused = true)]
async fn a_scenario_ends_as_it_should_only_with_its_check() {
    let mut faults = Vec::new();
    for (name, scenario) in TABLE {
        let (present, absent) =
            (scenario(Checks::All).await, scenario(Checks::Without(name)).await);
        if (present, absent) != (true, false) {
            faults.push(format!("{name}: with it {present}, without it {absent}"));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// A motion that waits for standstill begins in the same pass that proves standstill: the checks
/// above it have ended all other motions.
#[tokio::test(start_paused = true)]
async fn what_begins_comes_after_what_ends() {
    let at_once = start_after_halt(Checks::All).await;
    let later = start_after_halt(Checks::Exchanged(["watch_halt", "start_queued"])).await;
    assert!(at_once < later, "{at_once:?} {later:?}");
}
