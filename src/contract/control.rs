//! Control of an antenna: only one party at a time may move it.

use std::net::{IpAddr, SocketAddr};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{astro::AzEl, clock::Instant, driver::TrackProblem};

/// Party that can control an antenna.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Party {
    /// The operator, in the window.
    Window,
    Automatic,
    /// An `azel` command or a signal of the operating system.
    Command,
    /// The program at this end of a connection to the antenna's port.
    Program(SocketAddr),
}

/// Party in control of one antenna, and the clients of the antenna's port.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Control {
    /// Party in control; `None` without a party.
    pub party: Option<Party>,
    /// Time at which the party took control.
    pub start: Option<Timestamp>,
    pub port: PortState,
    /// Programs connected to the port.
    pub clients: Vec<NetworkClient>,
    /// A program that asked to point the antenna, and hung up before the operator had decided.
    pub missed: Option<NetworkClient>,
    /// Place of a client that the operator allowed to point, and that may come back.
    pub expected: Option<Expected>,
}

/// State of a port for other programs.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PortState {
    /// No port is set.
    #[default]
    Closed,
    Listening(SocketAddr),
    /// The operating system refused to open the port, for this reason. Azel retries.
    Failed(String),
}

/// A program that is connected to an antenna's port.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NetworkClient {
    /// Program's end of the connection.
    pub address: SocketAddr,
    /// Name of the program, if the operating system knows it.
    pub program: Option<String>,
    pub connected_at: Timestamp,
    /// The operator allows the program to point the antenna.
    pub is_allowed: bool,
    /// Time of the first command refused for lack of the operator's decision.
    pub asks_since: Option<Timestamp>,
    /// Last line from the program, and its time.
    pub last_line: Option<(String, Instant)>,
    /// Number of stops without effect, because the program was not in control.
    pub ignored_stops: u32,
    /// Number of a command without an answer yet.
    pub pending: Option<u64>,
    /// Answer to the program's last motion command.
    pub answer: Option<Answer>,
}

impl NetworkClient {
    /// Creates a client that has just connected.
    pub fn new(address: SocketAddr, program: Option<String>, now: Timestamp) -> Self {
        Self {
            address,
            program,
            connected_at: now,
            is_allowed: false,
            asks_since: None,
            last_line: None,
            ignored_stops: 0,
            pending: None,
            answer: None,
        }
    }
}

/// Answer to a command of a client.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Number of the command among all commands of the station.
    pub number: u64,
    /// Reason why the command moves nothing; `None` if Azel accepted the command.
    pub problem: Option<TrackProblem>,
}

/// A command of a program that is connected to an antenna's port.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClientCommand {
    /// Motion of the beam to this direction. It replaces any earlier destination.
    Point(AzEl),
    Park,
    /// Turn at these rates of azimuth and elevation, degrees a second. The program has to repeat
    /// it.
    Turn {
        rates_deg_s: [f64; 2],
        /// The command repeats an accepted turn.
        is_repeated: bool,
    },
    /// Stop of the program's own motion, or of an antenna without a party in control. It is not the
    /// operator's STOP.
    Stop,
}

/// A client that may reconnect without a new decision of the operator, because programs such as
/// Gpredict hang up after a refusal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Expected {
    pub address: IpAddr,
    pub end: Instant,
}

impl Control {
    /// Returns the connected client at `address`.
    pub fn client(&self, address: SocketAddr) -> Option<&NetworkClient> {
        self.clients.iter().find(|client| client.address == address)
    }

    /// Returns the client in control; `None` if another party or nobody is in control.
    pub fn client_in_control(&self) -> Option<&NetworkClient> {
        match self.party? {
            Party::Program(address) => self.client(address),
            Party::Window | Party::Automatic | Party::Command => None,
        }
    }
}
