//! Control of an antenna: the one party whose commands may move it.

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
    /// Automatic operation.
    Automatic,
    /// An `azel` command or a signal of the operating system.
    Command,
    /// The program at this end of a connection to the antenna's port.
    Program(SocketAddr),
}

/// The control of one antenna.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Control {
    /// Party in control; `None` if nobody is.
    pub party: Option<Party>,
    /// Time at which it took control.
    pub start: Option<Timestamp>,
    /// Port of the antenna.
    pub port: PortState,
    /// Programs that are connected to it.
    pub clients: Vec<NetworkClient>,
    /// A program that asked to point the antenna, and hung up before the operator had decided.
    pub missed: Option<NetworkClient>,
    /// Place of a client that the operator allowed to point, and that may come back.
    pub expected: Option<Expected>,
}

/// State of an antenna's port.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PortState {
    /// The antenna has none.
    #[default]
    Closed,
    Listening(SocketAddr),
    /// The operating system refuses it, for this reason. Azel tries again.
    Failed(String),
}

/// A program that is connected to an antenna's port.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NetworkClient {
    /// Its end of the connection.
    pub address: SocketAddr,
    /// Name of the program, where the operating system knows it.
    pub program: Option<String>,
    pub connected_at: Timestamp,
    /// The operator allows it to point the antenna.
    pub is_allowed: bool,
    /// First command that was refused because the operator has not decided yet.
    pub asks_since: Option<Timestamp>,
    /// Last line that it sent, and its time.
    pub last_line: Option<(String, Instant)>,
    /// Stops that moved nothing, because it was not in control.
    pub ignored_stops: u32,
    /// Number of a command that is not answered yet.
    pub pending: Option<u64>,
    /// Answer to its last command that asks for a motion.
    pub answer: Option<Answer>,
}

impl NetworkClient {
    /// A program that has just connected.
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
    /// Number of the command among all of the station.
    pub number: u64,
    /// Reason why nothing moves for it; `None` if it was accepted.
    pub problem: Option<TrackProblem>,
}

/// A command of a program that is connected to an antenna's port.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClientCommand {
    /// Point the beam there, from wherever the antenna is on its way to.
    Point(AzEl),
    Park,
    /// Turn at these rates of azimuth and elevation, degrees a second; to be repeated.
    Turn {
        rates_deg_s: [f64; 2],
        /// It repeats a turn that was accepted.
        is_repeated: bool,
    },
    /// End its motion, or that of an antenna that nobody controls. It is no STOP of an operator.
    Stop,
}

/// A client that may come back without a new decision of the operator, because programs such as
/// Gpredict hang up when they are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Expected {
    pub address: IpAddr,
    pub end: Instant,
}

impl Control {
    /// The connected client at `address`.
    pub fn client(&self, address: SocketAddr) -> Option<&NetworkClient> {
        self.clients.iter().find(|client| client.address == address)
    }

    /// The client in control.
    pub fn client_in_control(&self) -> Option<&NetworkClient> {
        match self.party? {
            Party::Program(address) => self.client(address),
            Party::Window | Party::Automatic | Party::Command => None,
        }
    }
}
