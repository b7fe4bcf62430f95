//! The port on which other programs point an antenna.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use serde::Serialize;

use super::{AntennaId, Station};

/// First port of rotctld; each further rotator uses the next port but one.
const FIRST_PORT: u16 = 4533;

/// A port for programs that speak Hamlib's rotctld protocol. Other programs cannot point an antenna
/// without a port.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct NetworkPort {
    pub antenna: AntennaId,
    /// Address and port to listen on. An address other than loopback opens the antenna to the
    /// network without a password.
    pub listen: SocketAddr,
    /// Addresses whose programs may point the antenna without the operator's decision.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub allowed: Vec<IpAddr>,
}

impl NetworkPort {
    /// Returns `true` if programs on other computers can reach the port.
    pub fn is_open_to_network(&self) -> bool {
        !self.listen.ip().is_loopback()
    }
}

impl Station {
    /// Returns the port of an antenna; `None` if other programs cannot point it.
    pub fn network_port(&self, antenna: AntennaId) -> Option<&NetworkPort> {
        self.network_ports.iter().find(|port| port.antenna == antenna)
    }

    /// Returns a free port on this computer for an antenna.
    pub fn free_port(&self, antenna: AntennaId) -> NetworkPort {
        let is_free =
            |port: &u16| self.network_ports.iter().all(|used| used.listen.port() != *port);
        let port = (FIRST_PORT..).step_by(2).find(is_free).unwrap_or(FIRST_PORT);
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        NetworkPort { antenna, listen, allowed: Vec::new() }
    }

    /// Allows programs at this address to point an antenna.
    pub fn allow_client(&mut self, antenna: AntennaId, address: IpAddr) {
        let port = self.network_ports.iter_mut().find(|port| port.antenna == antenna);
        if let Some(port) = port.filter(|port| !port.allowed.contains(&address)) {
            port.allowed.push(address);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_port_is_on_this_computer_and_free() {
        let mut station = Station::default();
        for (id, listen) in [(1, "127.0.0.1:4533"), (2, "127.0.0.1:4535"), (3, "127.0.0.1:4537")] {
            let port = station.free_port(AntennaId(id));
            assert_eq!(port.listen.to_string(), listen);
            assert!(!port.is_open_to_network());
            station.network_ports.push(port);
        }
        station.network_ports.remove(1);
        assert_eq!(station.free_port(AntennaId(2)).listen.port(), 4535);
    }

    #[test]
    fn an_address_is_allowed_once() {
        let mut station = Station::default();
        let address = "192.168.1.5".parse().unwrap();
        station.allow_client(AntennaId(1), address);
        assert_eq!(station.network_ports, [], "there is no port");
        station.network_ports.push(station.free_port(AntennaId(1)));
        station.allow_client(AntennaId(1), address);
        station.allow_client(AntennaId(1), address);
        assert_eq!(station.network_port(AntennaId(1)).unwrap().allowed, [address]);
    }
}
