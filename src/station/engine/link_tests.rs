//! Tests of links to units that may not be part of the station yet. A test asks the unit and hangs
//! up.

use std::sync::Arc;

use super::Engine;
use crate::{
    contract::{
        driver::{LinkFault, LinkFinding, Unit},
        link_tests::{LinkTest, LinkTestStage},
    },
    driver::{Outside, UnitLock, test_link},
    job::{Job, Wake},
    station::{Antenna, AntennaId},
};

/// Max number of stored tests.
const MAX_TESTS: usize = 16;

/// Runner of the tests, each on its own thread.
pub(super) struct Runner {
    outside: Outside,
    wake: Wake,
    under_way: Vec<(AntennaId, Option<Job<LinkFinding>>)>,
}

impl Runner {
    pub(super) fn new(outside: Outside, wake: Wake) -> Self {
        Self { outside, wake, under_way: Vec::new() }
    }

    /// Starts a test. `lock` keeps other programs off the unit until the test ends.
    fn begin(&mut self, antenna: &Antenna, lock: Arc<dyn UnitLock>) {
        let (config, outside) = (antenna.clone(), self.outside.clone());
        let work = move |_: &(dyn Fn() -> bool + Sync)| {
            let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
            let Ok(runtime) = runtime else { return not_begun() };
            let finding = runtime.block_on(test_link(&config, &outside, lock));
            // Do not wait for a port that does not open or a name that is not found.
            runtime.shutdown_background();
            finding
        };
        let job = Job::start("azel-link-test", Arc::clone(&self.wake), work);
        self.under_way.push((antenna.id, Some(job)));
    }

    /// Collects the outcomes of finished tests.
    pub(super) fn poll(&mut self, shown: &mut [LinkTest]) {
        let time = self.outside.clock.utc();
        for (id, job) in &mut self.under_way {
            let Some(end) = Job::take(job) else { continue };
            let finding = end.unwrap_or_else(|broke_off| {
                LinkFinding::NotOpened(LinkFault::Other(broke_off.to_string()))
            });
            if let Some(test) = shown.iter_mut().find(|test| test.antenna.id == *id) {
                test.stage = LinkTestStage::Done { finding, time };
            }
        }
        self.under_way.retain(|(_, job)| job.is_some());
    }
}

fn not_begun() -> LinkFinding {
    let text = "this computer is too busy for the test";
    LinkFinding::NotOpened(LinkFault::Other(text.to_owned()))
}

impl Engine {
    /// Tests the link of an antenna, which need not belong to the station. Runs one test of an
    /// antenna at a time.
    pub(super) fn test_link(&mut self, antenna: Antenna) {
        let tests = &self.link_tests;
        let place = tests.iter().position(|test| test.antenna.id == antenna.id);
        let link_test = place.and_then(|place| tests.get(place));
        if link_test.is_some_and(|link_test| link_test.stage == LinkTestStage::Working) {
            return;
        }
        let unit = Unit::new(&antenna);
        let is_ours = self
            .antennas
            .iter()
            .any(|other| other.shown.held_by.is_none() && Unit::new(&other.shown.config) == unit);
        let stage = if is_ours {
            LinkTestStage::InUse
        } else {
            match self.claim_unit(&antenna, None) {
                Ok(claim) => {
                    self.link_test_runner.begin(&antenna, Arc::new(claim));
                    LinkTestStage::Working
                }
                Err(elsewhere) => LinkTestStage::Elsewhere(elsewhere.holder),
            }
        };
        if let Some(place) = place {
            self.link_tests.remove(place);
        } else if self.link_tests.len() >= MAX_TESTS {
            self.link_tests.remove(0);
        }
        self.link_tests.push(LinkTest { antenna, stage });
    }
}
