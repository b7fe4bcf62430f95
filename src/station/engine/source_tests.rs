//! "Test from here": fetches, on this computer, the source that a unit is to use, and reads it like
//! the unit. One test runs at a time.

mod runner;

use crate::{
    contract::{source_tests::TestedSource, transfer::Peer},
    transfer::ElementSource,
};
pub(super) use runner::Runner;

fn source(tested: &TestedSource) -> ElementSource {
    match tested.clone() {
        TestedSource::Web { url } => ElementSource::Web { url },
        TestedSource::Server { peer, protocol, user, password, file } => {
            let password = password.inner().clone();
            ElementSource::Server { peer, protocol, user, password, file }
        }
    }
}

/// Returns the host whose key may need a decision.
fn peer(tested: &TestedSource) -> Option<&Peer> {
    match tested {
        TestedSource::Web { .. } => None,
        TestedSource::Server { peer, .. } => Some(peer),
    }
}
