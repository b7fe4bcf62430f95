//! The port on which monitoring programs read the station's metrics.

use std::{
    net::{Ipv4Addr, SocketAddr},
    ops::Not,
};

use serde::Serialize;

/// Default port, by custom the one of programs that offer their own metrics to Prometheus.
const DEFAULT_PORT: u16 = 9464;

/// A port that answers `GET /metrics`. Nothing can be changed through it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct MetricsPort {
    pub listen: SocketAddr,
    /// The operator allows an address other than loopback, which every computer of the network can
    /// read without a password.
    #[serde(skip_serializing_if = "<&bool>::not")]
    pub open_to_network: bool,
}

impl Default for MetricsPort {
    fn default() -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, DEFAULT_PORT));
        Self { listen, open_to_network: false }
    }
}

impl MetricsPort {
    /// Returns `true` if the address needs the operator's permission and does not have it.
    pub fn lacks_permission(&self) -> bool {
        !self.listen.ip().is_loopback() && !self.open_to_network
    }
}
