//! Outcomes of a test of a link.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::device::AntennaState;

/// Outcome of a test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkFinding {
    /// A unit of the make answered.
    Reached {
        /// Time from the first question to the first reply.
        after: Duration,
        /// All that the unit said.
        state: Box<AntennaState>,
    },
    /// The link opened, and nothing came.
    Silent,
    /// The far end closed the link and said nothing.
    Closed,
    /// Something came that is no reply of the make.
    SomethingElse {
        /// The first printable characters, on one line.
        text: String,
    },
    NotOpened(LinkFault),
}

/// Why a link could not be opened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkFault {
    /// The host is there, and nothing listens on the port.
    Refused,
    /// The host does not answer.
    NobodyThere,
    NoSuchPort,
    NotPermitted,
    /// Another program uses the serial port.
    Busy,
    /// In the words of the operating system.
    Other(String),
}
