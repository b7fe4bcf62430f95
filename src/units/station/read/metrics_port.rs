//! Reading of the port for metrics. An unreadable port stays closed.

use toml::Value;

use super::TableFields;
use crate::station::MetricsPort;

impl TableFields<'_> {
    /// Reads the port for metrics; `None` if the file sets none or the entry cannot be used.
    #[expect(clippy::redundant_closure_for_method_calls, reason = "a path names one lifetime")]
    pub(super) fn metrics_port(&mut self) -> Option<MetricsPort> {
        const KEY: &str = "metrics";
        let Value::Table(table) = self.table.remove(KEY)? else {
            self.invalid(KEY, "must be a table");
            return None;
        };
        // A note on the whole table keeps all of it in the file.
        let port = self.entry(KEY, table, |fields| fields.metrics_table());
        port.map_err(|reason| self.invalid(KEY, reason)).ok()
    }

    fn metrics_table(&mut self) -> Result<MetricsPort, &'static str> {
        let default = MetricsPort::default();
        let open_to_network = match self.table.remove("open_to_network") {
            None => false,
            Some(Value::Boolean(is_open)) => is_open,
            Some(_) => {
                self.invalid("open_to_network", "must be true or false");
                false
            }
        };
        let listen = match self.table.remove("listen") {
            None => Some(default.listen),
            Some(value) => value.as_str().and_then(|text| text.parse().ok()),
        };
        let listen =
            listen.ok_or("listen must be an address and a port, such as 127.0.0.1:9464")?;
        let port = MetricsPort { listen, open_to_network };
        if port.lacks_permission() {
            return Err("other computers can reach listen: add open_to_network = true");
        }
        Ok(port)
    }
}
