//! Tests, from here, of the sources that units use.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    host_keys::DoubtfulKey,
    secret::Secret,
    transfer::{FileProtocol, OldAlgorithm, Peer, UnitView},
};

/// The last test.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SourceTests {
    /// The tested source; `None` before the first test.
    pub order: Option<SourceOrder>,
    pub stage: TestStage,
}

/// Stage of a test.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum TestStage {
    /// No test yet.
    #[default]
    Idle,
    Working,
    /// The operator must decide about the host's key, seen for the first time.
    AsksAboutHostKey(DoubtfulKey),
    /// The file was fetched.
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
    /// The fetch failed.
    Failed {
        /// The reason.
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

/// A source to test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceOrder {
    /// Name of the antenna whose unit will fetch the source.
    pub antenna: String,
    pub source: TestedSource,
    /// Name of the satellite that the unit will look for.
    pub satellite: String,
}

/// A source of elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestedSource {
    /// An `http` or `https` address.
    Web {
        /// As given to the unit.
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

/// A request of a view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestAsk {
    /// Test this source. Ignored while another test is open.
    Begin(Box<SourceOrder>),
    /// The shown key is the right one.
    TrustHostKey,
    /// Forget the known keys of the host that was refused.
    ForgetHostKey,
    /// End the test, or answer its question with no.
    Cancel,
}
