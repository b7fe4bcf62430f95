//! Runner of the source tests, on threads of their own.

use std::{io, sync::Arc};

use super::{peer, source};
use crate::{
    clock::Clock,
    contract::{
        source_tests::{SourceOrder, SourceTests, TestAsk, TestStage},
        transfer::{OldAlgorithm, UnitView},
    },
    engine::{
        host_keys::{self, Decision, doubtful},
        uploads::Places,
    },
    job::{Job, Wake},
    transfer::{FetchError, OfferedKey, Transfer, Trust, fetch, what_a_unit_sees},
};

/// File as the unit will read it, and the old algorithms of the connection.
type View = (UnitView, Vec<OldAlgorithm>);

/// Runner of one test at a time.
pub(in crate::engine) struct Runner {
    places: Option<Places>,
    clock: Clock,
    wake: Wake,
    offered: Option<Box<OfferedKey>>,
    transfer: Option<Transfer<Result<View, FetchError>>>,
    deciding: Option<Job<Result<(), String>>>,
}

impl Runner {
    pub(in crate::engine) fn new(places: Option<Places>, clock: Clock, wake: Wake) -> Self {
        Self { places, clock, wake, offered: None, transfer: None, deciding: None }
    }

    /// Carries out a client's request.
    pub(in crate::engine) fn ask(&mut self, ask: TestAsk, shown: &mut SourceTests) {
        match (ask, &shown.stage) {
            (TestAsk::Begin(order), stage) if !stage.is_open() => {
                shown.order = Some(*order);
                self.fetch(shown);
            }
            (TestAsk::TrustHostKey, TestStage::AsksAboutHostKey(_)) => {
                if let Some(offered) = self.offered.take() {
                    self.decide(Decision::Trust(offered), shown);
                }
            }
            (TestAsk::ForgetHostKey, TestStage::Failed { changed_key: Some(_), .. }) => {
                let peer = shown.order.as_ref().and_then(|order| peer(&order.source).cloned());
                if let Some(peer) = peer {
                    self.decide(Decision::Forget(peer), shown);
                }
            }
            (TestAsk::Cancel, TestStage::Working) => {
                if let Some(transfer) = &self.transfer {
                    transfer.cancel();
                }
            }
            (TestAsk::Cancel, TestStage::AsksAboutHostKey(_)) => {
                shown.stage = failed("cancelled".to_owned());
            }
            _ => {}
        }
    }

    /// Collects results of finished jobs.
    pub(in crate::engine) fn poll(&mut self, shown: &mut SourceTests) {
        if let Some(decided) = Job::take(&mut self.deciding) {
            match decided.unwrap_or_else(|broke_off| Err(broke_off.to_string())) {
                Ok(()) => self.fetch(shown),
                Err(text) => shown.stage = failed(text),
            }
        }
        let Some(result) = self.transfer.as_ref().and_then(Transfer::poll) else { return };
        self.transfer = None;
        shown.stage = match result {
            Ok(Ok((view, old_algorithms))) => {
                TestStage::Seen { view: Box::new(view), time: self.clock.utc(), old_algorithms }
            }
            Ok(Err(FetchError::Connect(error))) => {
                let text = error.to_string();
                match doubtful(error) {
                    Ok((_, key)) if key.is_changed() => {
                        TestStage::Failed { text, changed_key: Some(key) }
                    }
                    Ok((offered, key)) => {
                        self.offered = Some(offered);
                        TestStage::AsksAboutHostKey(key)
                    }
                    Err(_) => failed(text),
                }
            }
            Ok(Err(error)) => failed(error.to_string()),
            Err(broken) => failed(broken.to_string()),
        };
    }

    fn fetch(&mut self, shown: &mut SourceTests) {
        let Some(order) = shown.order.clone() else { return };
        let Some(places) = self.places.clone() else {
            shown.stage = failed("this user has no folder for data".to_owned());
            return;
        };
        match start(order, places, Arc::clone(&self.wake)) {
            Ok(transfer) => {
                self.transfer = Some(transfer);
                shown.stage = TestStage::Working;
            }
            Err(error) => shown.stage = failed(format!("no thread for the test: {error}")),
        }
    }

    fn decide(&mut self, decision: Decision, shown: &mut SourceTests) {
        let Some(places) = &self.places else { return };
        let wake = Arc::clone(&self.wake);
        self.deciding = Some(host_keys::decide(&places.known_hosts, decision, wake));
        shown.stage = TestStage::Working;
    }
}

fn start(
    order: SourceOrder,
    places: Places,
    wake: Wake,
) -> io::Result<Transfer<Result<View, FetchError>>> {
    Transfer::start("azel-source-test", wake, move |_, cancel| async move {
        let trust = Trust { known_hosts: places.known_hosts, own_authorities: Vec::new() };
        let fetched = fetch(&source(&order.source), &trust, places.limits, &cancel).await?;
        Ok((what_a_unit_sees(&fetched.bytes, &order.satellite), fetched.old_algorithms))
    })
}

fn failed(text: String) -> TestStage {
    TestStage::Failed { text, changed_key: None }
}

#[cfg(test)]
mod tests;
