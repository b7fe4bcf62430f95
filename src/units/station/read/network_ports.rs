//! Reading of the ports of the antennas. An unreadable port stays closed.

use std::net::IpAddr;

use toml::Value;

use super::{TableFields, catalog_number};
use crate::station::{AntennaId, NetworkPort};

impl TableFields<'_> {
    /// Reads the ports of these antennas, at most one for each antenna.
    pub(super) fn network_ports(&mut self, antennas: &[AntennaId]) -> Vec<NetworkPort> {
        let mut ports: Vec<NetworkPort> = Vec::new();
        self.list("rotctld", |fields| {
            let port = fields.network_port(antennas)?;
            let is_taken =
                |other: &NetworkPort| other.antenna == port.antenna || other.listen == port.listen;
            if ports.iter().any(is_taken) {
                fields.invalid("listen", "another entry has this antenna or this port");
                return None;
            }
            ports.push(port.clone());
            Some(port)
        })
    }

    fn network_port(&mut self, antennas: &[AntennaId]) -> Option<NetworkPort> {
        let allowed = self.addresses("allowed");
        let antenna = self.table.remove("antenna").as_ref().and_then(catalog_number);
        let antenna = antenna.map(AntennaId).filter(|id| antennas.contains(id));
        if antenna.is_none() {
            self.invalid("antenna", "must be the id of an antenna");
        }
        let listen = self.text("listen", "").parse();
        if listen.is_err() {
            self.invalid("listen", "must be an address and a port, such as 127.0.0.1:4533");
        }
        Some(NetworkPort { antenna: antenna?, listen: listen.ok()?, allowed })
    }

    /// Reads the allowed addresses. An unreadable address is not allowed.
    fn addresses(&mut self, key: &str) -> Vec<IpAddr> {
        let values = match self.table.remove(key) {
            None => return Vec::new(),
            Some(Value::Array(values)) => values,
            Some(_) => {
                self.invalid(key, "must be a list of addresses");
                return Vec::new();
            }
        };
        let addresses = values.iter().enumerate().filter_map(|(index, value)| {
            let address = value.as_str().and_then(|text| text.parse().ok());
            if address.is_none() {
                let place = format!("{key}[{index}]");
                self.invalid(&place, "must be an address such as 192.168.1.5");
            }
            address
        });
        addresses.collect()
    }
}
