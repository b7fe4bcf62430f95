//! Events of a station, and origins of commands.

use std::net::SocketAddr;

use serde::{Deserialize, Serialize};

use crate::claim::HolderKind;

/// Origin of a command: the operator, a program, a signal or the station.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CommandOrigin {
    /// The operator, in the window.
    #[default]
    Window,
    /// `azel serve`, when it ends.
    Serve,
    /// Another program of this user, such as `azel stop`.
    Program,
    /// A signal of the operating system.
    Signal,
    /// The station, without a request, such as automatic operation.
    Station,
    /// The program at this end of a connection to an antenna's port.
    Port(SocketAddr),
}

impl CommandOrigin {
    /// Returns `true` for the operator and the programs of this user at the station's own machine.
    pub fn is_on_this_machine(self) -> bool {
        match self {
            Self::Window | Self::Serve | Self::Program | Self::Signal | Self::Station => true,
            // A program at a port may stand in for one on another machine.
            Self::Port(_) => false,
        }
    }
}

impl From<HolderKind> for CommandOrigin {
    fn from(kind: HolderKind) -> Self {
        match kind {
            HolderKind::Window => Self::Window,
            HolderKind::Serve => Self::Serve,
        }
    }
}

/// Event for the client.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// Time at which the station was saved, or the reason why the save failed.
    Saved(Result<jiff::Timestamp, String>),
    /// The station has changed, but not by a save.
    Changed,
    /// The closing is complete: the program may end.
    MayEnd,
}
