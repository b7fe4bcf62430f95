//! Tests, from this computer, of the sources that units use.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    host_keys::DoubtfulKey,
    secret::Secret,
    transfer::{FileProtocol, OldAlgorithm, Peer, UnitView},
};

/// Last test of a source.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SourceTests {
    /// The tested source; `None` before the first test.
    pub order: Option<SourceOrder>,
    pub stage: TestStage,
}

/// Progress of a test of a source.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum TestStage {
    /// No test yet.
    #[default]
    Idle,
    Working,
    /// The operator must decide about the host's key, seen for the first time.
    AsksAboutHostKey(DoubtfulKey),
    /// The fetch succeeded.
    Seen {
        /// The file as the unit will see it.
        view: Box<UnitView>,
        /// Time of the fetch.
        #[serde(rename = "at")]
        time: Timestamp,
        /// Old algorithms of the SSH connection.
        #[serde(default)]
        old_algorithms: Vec<OldAlgorithm>,
    },
    Failed {
        /// Reason for the failure.
        text: String,
        /// The host key that was refused.
        changed_key: Option<DoubtfulKey>,
    },
}

impl TestStage {
    /// Returns `true` while a test is under way or waits for an answer.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Working | Self::AsksAboutHostKey(_))
    }
}

/// Request to test a source, with its antenna and satellite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceOrder {
    /// Name of the antenna whose unit will fetch the source.
    pub antenna: String,
    pub source: TestedSource,
    /// Name of the satellite that the unit will look for.
    pub satellite: String,
}

/// A source of elements that can be tested.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestedSource {
    /// An `http` or `https` address.
    Web {
        /// Address as given to the unit.
        url: String,
    },
    /// A file on a server.
    Server {
        peer: Peer,
        protocol: FileProtocol,
        /// User name on the server.
        user: String,
        password: Secret,
        /// Path of the file.
        file: String,
    },
}

/// Request of a view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestAsk {
    /// Start of the test of this source. Azel ignores it while another test is open.
    Begin(Box<SourceOrder>),
    /// Confirmation that the shown key is right.
    TrustHostKey,
    /// Deletion of the known keys of the host that was refused.
    ForgetHostKey,
    /// End of the test, or the answer no to its question.
    Cancel,
}
