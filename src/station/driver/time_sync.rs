//! Check whether a time service keeps the computer's clock correct.

use crate::contract::driver::TimeSync;

/// Queries the operating system. May take some seconds.
#[cfg(target_os = "linux")]
pub fn time_sync() -> TimeSync {
    systemd::system_bus().and_then(|bus| systemd::ask(&bus)).unwrap_or_else(|error| {
        tracing::debug!(%error, "whether the clock is synchronised is not known");
        TimeSync::NotKnown
    })
}

/// Reports an unknown state, because this operating system offers no query.
#[cfg(not(target_os = "linux"))]
pub fn time_sync() -> TimeSync {
    TimeSync::NotKnown
}

/// Query of `systemd-timedated`, which reads the state of the kernel's clock. It covers every time
/// service: systemd's own, chrony or ntpd (`org.freedesktop.timedate1(5)`).
#[cfg(target_os = "linux")]
mod systemd {
    use std::time::Duration;

    use zbus::{
        Result,
        blocking::{Connection, connection::Builder},
        zvariant::OwnedValue,
    };

    use crate::contract::driver::TimeSync;

    const SERVICE: &str = "org.freedesktop.timedate1";
    const OBJECT: &str = "/org/freedesktop/timedate1";
    const PROPERTIES: &str = "org.freedesktop.DBus.Properties";
    /// Max wait for the reply, because the query starts the service.
    const PATIENCE: Duration = Duration::from_secs(10);

    pub(super) fn system_bus() -> Result<Connection> {
        Builder::system()?.method_timeout(PATIENCE).build()
    }

    pub(super) fn ask(bus: &Connection) -> Result<TimeSync> {
        let property = (SERVICE, "NTPSynchronized");
        let reply = bus.call_method(Some(SERVICE), OBJECT, Some(PROPERTIES), "Get", &property)?;
        let value: OwnedValue = reply.body().deserialize()?;
        let synchronised = bool::try_from(value)?;
        Ok(if synchronised { TimeSync::Synchronised } else { TimeSync::NotSynchronised })
    }

    #[cfg(test)]
    mod tests {
        use std::{os::unix::net::UnixStream, thread};

        use zbus::{Guid, object_server::Interface};

        use super::*;

        struct TimeService(bool);

        #[zbus::interface(name = "org.freedesktop.timedate1")]
        impl TimeService {
            #[zbus(property, name = "NTPSynchronized")]
            fn synchronized(&self) -> bool {
                self.0
            }
        }

        struct AnotherService;

        #[zbus::interface(name = "org.example.another")]
        impl AnotherService {}

        fn ask_service(service: impl Interface) -> Result<TimeSync> {
            let (near, far) = UnixStream::pair()?;
            let serve = move || {
                let builder = Builder::async_io_unix_stream(far).server(Guid::generate())?.p2p();
                builder.serve_at(OBJECT, service)?.build()
            };
            let server = thread::Builder::new().name("test-bus".to_owned()).spawn(serve)?;
            let client = Builder::async_io_unix_stream(near).p2p().method_timeout(PATIENCE);
            let client = client.build()?;
            let _server = server.join().expect("the server does not panic")?;
            ask(&client)
        }

        #[test]
        fn the_service_says_how_the_clock_is_kept() {
            assert_eq!(ask_service(TimeService(true)).unwrap(), TimeSync::Synchronised);
            assert_eq!(ask_service(TimeService(false)).unwrap(), TimeSync::NotSynchronised);
        }

        #[test]
        fn a_bus_without_the_service_tells_nothing() {
            assert!(ask_service(AnotherService).is_err());
        }
    }
}
