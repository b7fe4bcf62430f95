//! "Test from here": fetches the source that a unit is told to use, from this
//! computer, and looks at it as the unit will. One at a time.

mod desk;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub(super) use desk::Desk;

use super::host_keys::DoubtfulKey;
use crate::secret::Secret;
use crate::transfer::{ElementSource, FileProtocol, Peer, UnitView};

/// What is shown of the last test.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SourceTests {
    /// What was tested; `None` before the first time.
    pub order: Option<SourceOrder>,
    /// Where it stands.
    pub stage: TestStage,
}

/// Where a test stands.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum TestStage {
    /// There is none.
    #[default]
    Idle,
    /// The file is being fetched.
    Working,
    /// The operator has to decide about the host's key, seen for the first time.
    AsksAboutHostKey(DoubtfulKey),
    /// The file is here.
    Seen {
        /// What the unit will make of it.
        view: Box<UnitView>,
        /// When it was fetched.
        at: Timestamp,
    },
    /// Nothing came.
    Failed {
        /// Why.
        text: String,
        /// The key of the host that was refused.
        changed_key: Option<DoubtfulKey>,
    },
}

impl TestStage {
    /// Something is under way, or waits for an answer.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Working | Self::AsksAboutHostKey(_))
    }
}

/// What is to be tested.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceOrder {
    /// Name of the antenna whose unit will fetch it.
    pub antenna: String,
    /// Where it is.
    pub source: TestedSource,
    /// The name of the satellite that the unit will look for.
    pub satellite: String,
}

/// Where elements are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestedSource {
    /// An `http` or `https` address.
    Web {
        /// As the unit is told.
        url: String,
    },
    /// A file on a server.
    Server {
        /// The server.
        peer: Peer,
        /// How it is spoken to.
        protocol: FileProtocol,
        /// The user there.
        user: String,
        /// The user's password.
        password: Secret,
        /// The file.
        file: String,
    },
}

impl TestedSource {
    fn source(&self) -> ElementSource {
        match self.clone() {
            Self::Web { url } => ElementSource::Web { url },
            Self::Server { peer, protocol, user, password, file } => {
                let password = password.inner().clone();
                ElementSource::Server { peer, protocol, user, password, file }
            }
        }
    }

    /// The host whose key may be asked about.
    fn peer(&self) -> Option<&Peer> {
        match self {
            Self::Web { .. } => None,
            Self::Server { peer, .. } => Some(peer),
        }
    }
}

/// What a view asks for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum TestAsk {
    /// Test this. While another test is open, nothing happens.
    Begin(Box<SourceOrder>),
    /// The key that was shown is the right one.
    TrustHostKey,
    /// The known keys of the host that was refused are to be forgotten.
    ForgetHostKey,
    /// Nobody wants it any more.
    Cancel,
}
