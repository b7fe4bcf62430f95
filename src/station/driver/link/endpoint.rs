//! Endpoints of addresses. Azel locks the endpoints before a link connects to them.

use std::{
    io,
    net::{SocketAddr, ToSocketAddrs as _},
    sync::Arc,
};

use tokio::{sync::Mutex as AsyncMutex, task::JoinHandle};

use crate::station::{Connection, Link, check_address};

/// Place of a unit, as far as this computer can tell places apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Endpoint {
    Tcp(SocketAddr),
    /// Serial port of this computer, by its device: several paths may lead to the same device.
    Port(String),
}

impl Endpoint {
    /// Returns the name of the place, equal for all spellings of an address.
    pub fn key(&self) -> String {
        let address = match self {
            Self::Port(device) => return format!("port {device}"),
            Self::Tcp(address) => address,
        };
        let (ip, port) = (address.ip().to_canonical(), address.port());
        // A connection to the unspecified address goes to this computer too.
        if ip.is_loopback() || ip.is_unspecified() {
            return format!("tcp loopback {port}");
        }
        // The same link-local address may exist on each interface.
        let scope = match address {
            SocketAddr::V6(address) => address.scope_id(),
            SocketAddr::V4(_) => 0,
        };
        format!("tcp {ip}%{scope} {port}")
    }
}

/// Lock that keeps other processes off the unit of a session until the session has ended.
pub trait UnitLock: Send + Sync {
    /// Locks all `endpoints` of the unit and releases the previous endpoints. Blocks for file
    /// operations. The error names the process that owns a lock.
    fn lock(&self, endpoints: &[Endpoint]) -> io::Result<()>;
}

/// Lock that ignores other processes.
impl UnitLock for () {
    fn lock(&self, _: &[Endpoint]) -> io::Result<()> {
        Ok(())
    }
}

/// Returns the endpoints of a connection that need no name service. Returns `None` for a host name
/// and for a missing serial port: the link resolves these when it connects.
pub fn known_endpoints(connection: &Connection) -> Option<Vec<Endpoint>> {
    let address = connection.address.trim();
    let endpoint = if is_port(connection) {
        Endpoint::Port(device(address).ok()?)
    } else {
        Endpoint::Tcp(address.parse().ok()?)
    };
    Some(vec![endpoint])
}

/// Finds all endpoints of a connection. Blocks for as long as the name service takes.
pub fn endpoints(connection: &Connection) -> io::Result<Vec<Endpoint>> {
    let address = connection.address.trim();
    if is_port(connection) {
        return Ok(vec![Endpoint::Port(device(address)?)]);
    }
    Ok(tcp_addresses(address)?.into_iter().map(Endpoint::Tcp).collect())
}

fn is_port(connection: &Connection) -> bool {
    match connection.spec().link {
        Link::Tcp => false,
        Link::Line { .. } => check_address(&connection.address).is_err(),
    }
}

fn tcp_addresses(address: &str) -> io::Result<Vec<SocketAddr>> {
    let found = address.to_socket_addrs().map_err(|error| {
        let text = format!("the name service has no address of {address} ({error})");
        io::Error::new(error.kind(), text)
    })?;
    let found: Vec<SocketAddr> = found.collect();
    if found.is_empty() {
        let text = format!("the name service has no address of {address}");
        return Err(io::Error::new(io::ErrorKind::NotFound, text));
    }
    Ok(found)
}

/// Returns the device of the serial port at `path`.
#[cfg(unix)]
pub(super) fn device(path: &str) -> io::Result<String> {
    use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _};
    let metadata = std::fs::metadata(path)?;
    Ok(if metadata.file_type().is_char_device() {
        format!("device {}", metadata.rdev())
    } else {
        format!("file {} {}", metadata.dev(), metadata.ino())
    })
}

#[cfg(not(unix))]
pub(super) fn device(path: &str) -> io::Result<String> {
    Ok(path.to_lowercase())
}

/// Lookup of a host that also locks its addresses, on a thread for blocking work. At most one
/// lookup runs at a time, even if it outlasts an attempt to connect.
#[derive(Clone)]
pub(super) struct Lookup {
    address: Arc<str>,
    lock: Arc<dyn UnitLock>,
    running: Arc<AsyncMutex<Option<RunningLookup>>>,
}

type RunningLookup = JoinHandle<io::Result<Vec<SocketAddr>>>;

impl Lookup {
    pub(super) fn new(address: &str, lock: Arc<dyn UnitLock>) -> Self {
        Self { address: address.trim().into(), lock, running: Arc::default() }
    }

    /// Looks up the host, locks all its addresses and returns them.
    pub(super) async fn locked_addresses(&self) -> io::Result<Vec<SocketAddr>> {
        let mut running = self.running.lock().await;
        let lookup = running.get_or_insert_with(|| {
            let (address, lock) = (Arc::clone(&self.address), Arc::clone(&self.lock));
            tokio::task::spawn_blocking(move || {
                let addresses = tcp_addresses(&address)?;
                let endpoints: Vec<Endpoint> =
                    addresses.iter().copied().map(Endpoint::Tcp).collect();
                lock.lock(&endpoints)?;
                Ok(addresses)
            })
        });
        let outcome = lookup.await;
        *running = None;
        outcome.map_err(io::Error::other)?
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::Antenna;

    fn key(address: &str) -> String {
        Endpoint::Tcp(address.parse().unwrap()).key()
    }

    #[test]
    fn all_spellings_of_an_address_have_one_key() {
        let same = ["127.0.0.1:4001", "127.3.2.1:4001", "[::1]:4001", "[::ffff:127.0.0.1]:4001"];
        for address in same {
            assert_eq!(key(address), "tcp loopback 4001");
        }
        assert_eq!(key("0.0.0.0:4001"), key("[::]:4001"));
        assert_eq!(key("10.0.0.5:4001"), key("[::ffff:10.0.0.5]:4001"));
        assert_ne!(key("10.0.0.5:4001"), key("10.0.0.5:4002"));
        assert_ne!(key("[fe80::1%2]:4001"), key("[fe80::1%3]:4001"));
        assert_ne!(key("127.0.0.1:4001"), key("10.0.0.5:4001"));
    }

    #[test]
    fn only_a_name_needs_the_name_service() {
        let endpoints = |address| known_endpoints(&Antenna::satrak("Dish", address).connection);
        let address = "10.0.0.5:4001".parse().unwrap();
        assert_eq!(endpoints(" 10.0.0.5:4001"), Some(vec![Endpoint::Tcp(address)]));
        assert_eq!(endpoints("localhost:4001"), None);
        let port = |address| known_endpoints(&Antenna::rc2000c("Horn", address).connection);
        assert_eq!(port("/dev/no-such-port-as-this"), None);
        assert_eq!(port("10.0.0.5:4001"), Some(vec![Endpoint::Tcp(address)]));
    }

    #[cfg(unix)]
    #[test]
    fn two_links_to_one_device_are_one_endpoint() {
        let folder = tempfile::tempdir().unwrap();
        let links = ["one", "two"].map(|name| folder.path().join(name));
        for link in &links {
            std::os::unix::fs::symlink("/dev/null", link).unwrap();
        }
        let keys = links.map(|link| device(link.to_str().unwrap()).unwrap());
        assert_eq!(keys[0], keys[1]);
        assert_eq!(keys[0], device("/dev/null").unwrap());
        assert_ne!(keys[0], device("/dev/zero").unwrap());
    }

    #[tokio::test]
    async fn a_lock_that_is_taken_yields_no_address() {
        struct FailingLock;
        impl UnitLock for FailingLock {
            fn lock(&self, endpoints: &[Endpoint]) -> io::Result<()> {
                assert!(endpoints.iter().all(|place| place.key() == "tcp loopback 4001"));
                Err(io::Error::other("taken"))
            }
        }
        let lookup = Lookup::new("localhost:4001", Arc::new(FailingLock));
        assert_eq!(lookup.locked_addresses().await.unwrap_err().to_string(), "taken");
        let nowhere = Lookup::new("nowhere.invalid:4001", Arc::new(()));
        let error = nowhere.locked_addresses().await.unwrap_err().to_string();
        assert!(error.starts_with("the name service has no address of nowhere.invalid"), "{error}");
    }
}
