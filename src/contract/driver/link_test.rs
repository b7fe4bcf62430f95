//! Outcomes of a test of a link.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::device::AntennaState;

/// Outcome of a test of a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum LinkFinding {
    /// A unit of the make answered.
    Reached {
        /// Time from the first question to the first reply.
        after: Duration,
        /// State with everything that the unit reported.
        state: Box<AntennaState>,
    },
    /// The link opened, but no data arrived.
    Silent,
    /// The far end closed the link without sending data.
    Closed,
    /// The received data is no reply of the make.
    SomethingElse {
        /// The first printable characters, on one line.
        text: String,
    },
    NotOpened(LinkFault),
}

/// Reason why a link could not be opened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinkFault {
    /// The host exists, but nothing listens on the port.
    Refused,
    /// The host does not answer.
    NobodyThere,
    NoSuchPort,
    NotPermitted,
    /// Another program uses the serial port.
    Busy,
    /// Other error, in the words of the operating system.
    Other(String),
}
