//! Stop of endless motions before this computer sleeps: a sleeping computer sends no STOP, and a
//! held jog key stays down.

use std::{
    convert::Infallible,
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

use tokio::sync::mpsc;

/// Max delay of a sleep. `logind` waits for 5 s by default (`InhibitDelayMaxSec`, logind.conf(5)).
const MAX: Duration = Duration::from_secs(3);

/// Interval between attempts to reach a lost bus.
#[cfg(target_os = "linux")]
const AGAIN: Duration = Duration::from_secs(30);

/// Token of a session, alive during a motion that only this session would end.
#[derive(Debug)]
pub(super) struct Awake(
    #[expect(dead_code, reason = "dropping it says all")] mpsc::Sender<Infallible>,
);

#[derive(Debug, Clone, Default)]
pub(super) struct BeforeSleep(Arc<Mutex<Vec<mpsc::Sender<Awake>>>>);

impl BeforeSleep {
    /// Returns the channel of a new session.
    pub(super) fn subscribe(&self) -> mpsc::Receiver<Awake> {
        let (tell, hear) = mpsc::channel(1);
        let mut sessions = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        sessions.retain(|session| !session.is_closed());
        sessions.push(tell);
        hear
    }

    /// Informs all sessions, then waits with a timeout until they have ended every motion that
    /// would not end otherwise.
    pub(super) async fn wait_until_quiet(&self) {
        let (awake, mut all_quiet) = mpsc::channel(1);
        for session in &*self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            // The queue is full: a pending message already makes this session end its motion.
            let _ = session.try_send(Awake(awake.clone()));
        }
        drop(awake);
        if tokio::time::timeout(MAX, all_quiet.recv()).await.is_err() {
            tracing::error!("this computer sleeps before standstill is proved");
        }
    }
}

/// Informs the sessions on `runtime` before each sleep, until the program ends.
#[cfg(target_os = "linux")]
pub(super) fn watch(sessions: BeforeSleep, runtime: tokio::runtime::Handle) -> std::io::Result<()> {
    std::thread::Builder::new().name("azel-sleep".to_owned()).spawn(move || {
        let quiet = || runtime.block_on(sessions.wait_until_quiet());
        let mut was_watched = false;
        loop {
            match logind::system_bus().and_then(|bus| logind::watch(&bus, quiet)) {
                Ok(()) => was_watched = true,
                Err(error) if !was_watched => {
                    tracing::debug!(%error, "nobody tells when this computer goes to sleep");
                    return;
                }
                Err(error) => tracing::debug!(%error, "no bus"),
            }
            tracing::warn!("it is not told any more when this computer goes to sleep; tried again");
            std::thread::sleep(AGAIN);
        }
    })?;
    Ok(())
}

/// Does nothing: Azel receives no sleep announcements on this operating system.
#[cfg(not(target_os = "linux"))]
pub(super) fn watch(_: BeforeSleep, _: tokio::runtime::Handle) -> std::io::Result<()> {
    Ok(())
}

/// Sleep announcements of `systemd-logind`, which waits for the holders of a lock of the kind
/// "delay" (`org.freedesktop.login1(5)`, systemd's "Inhibitor Locks").
#[cfg(target_os = "linux")]
mod logind {
    use zbus::{
        Result,
        blocking::{Connection, Proxy},
        zvariant::OwnedFd,
    };

    const SERVICE: &str = "org.freedesktop.login1";
    const OBJECT: &str = "/org/freedesktop/login1";
    const MANAGER: &str = "org.freedesktop.login1.Manager";

    pub(super) fn system_bus() -> Result<Connection> {
        Connection::system()
    }

    /// Calls `before` ahead of each sleep; returns when the bus is gone.
    pub(super) fn watch(bus: &Connection, before: impl Fn()) -> Result<()> {
        let manager = Proxy::new(bus, SERVICE, OBJECT, MANAGER)?;
        let prepares = manager.receive_signal("PrepareForSleep")?;
        let mut lock = Some(delay(&manager)?);
        for signal in prepares {
            let begins: bool = signal.body().deserialize()?;
            if begins {
                before();
                lock = None;
            } else if lock.is_none() {
                // Without a lock, `logind` does not delay the next sleep, but still announces it.
                lock = delay(&manager).inspect_err(|error| tracing::warn!(%error, "no lock")).ok();
            }
        }
        Ok(())
    }

    fn delay(manager: &Proxy<'_>) -> Result<OwnedFd> {
        manager.call(
            "Inhibit",
            &("sleep", "Azel", "Antennas that are moved by hand are stopped", "delay"),
        )
    }

    #[cfg(test)]
    mod tests {
        use std::{
            io::{ErrorKind, Read as _},
            os::unix::net::UnixStream,
            sync::mpsc,
            thread,
            time::Duration,
        };

        use zbus::{
            Guid, blocking::connection::Builder, object_server::SignalEmitter, zvariant::Fd,
        };

        use super::*;

        const PATIENCE: Duration = Duration::from_secs(20);

        /// Fake manager that hands out locks and passes the other end of each lock to the test.
        struct Manager(mpsc::SyncSender<UnixStream>);

        #[zbus::interface(name = "org.freedesktop.login1.Manager")]
        impl Manager {
            fn inhibit(&self, kind: &str, name: &str, reason: &str, mode: &str) -> Fd<'static> {
                assert_eq!((kind, mode), ("sleep", "delay"));
                assert!(!name.is_empty() && !reason.is_empty());
                let (near, far) = UnixStream::pair().unwrap();
                self.0.send(near).unwrap();
                Fd::from(std::os::fd::OwnedFd::from(far))
            }

            #[zbus(signal)]
            async fn prepare_for_sleep(emitter: &SignalEmitter<'_>, begins: bool) -> Result<()>;
        }

        fn in_thread<T: Send + 'static>(
            name: &str,
            work: impl FnOnce() -> T + Send + 'static,
        ) -> thread::JoinHandle<T> {
            thread::Builder::new().name(name.to_owned()).spawn(work).unwrap()
        }

        fn is_held(lock: &UnixStream) -> bool {
            lock.set_nonblocking(true).unwrap();
            match (&*lock).read(&mut [0]) {
                Ok(0) => false,
                Err(error) if error.kind() == ErrorKind::WouldBlock => true,
                other => panic!("{other:?}"),
            }
        }

        #[test]
        fn the_lock_is_held_until_all_is_quiet_and_taken_again_after_the_sleep() {
            let (near, far) = UnixStream::pair().unwrap();
            let (locks, handed_out) = mpsc::sync_channel(4);
            let serve = move || {
                let builder = Builder::async_io_unix_stream(far).server(Guid::generate())?.p2p();
                builder.serve_at(OBJECT, Manager(locks))?.build()
            };
            let server = in_thread("test-bus", serve);
            let client = Builder::async_io_unix_stream(near).p2p().build().unwrap();
            let server = server.join().unwrap().unwrap();
            let (sender, receiver) = mpsc::sync_channel(4);
            let (go_on, waits) = mpsc::sync_channel::<()>(4);
            let watching = in_thread("test-watch", move || {
                watch(&client, || {
                    sender.send(()).unwrap();
                    waits.recv_timeout(PATIENCE).unwrap();
                })
            });
            let lock = handed_out.recv_timeout(PATIENCE).unwrap();
            assert!(is_held(&lock));
            let emitter = SignalEmitter::new(server.inner(), OBJECT).unwrap();
            let tell = |begins| {
                zbus::block_on(Manager::prepare_for_sleep(&emitter, begins)).unwrap();
            };
            tell(true);
            receiver.recv_timeout(PATIENCE).unwrap();
            assert!(is_held(&lock), "before all is quiet");
            go_on.send(()).unwrap();
            // Wait for the end of the stream.
            lock.set_nonblocking(false).unwrap();
            lock.set_read_timeout(Some(PATIENCE)).unwrap();
            assert_eq!((&lock).read(&mut [0]).unwrap(), 0);
            tell(false);
            assert!(is_held(&handed_out.recv_timeout(PATIENCE).unwrap()));
            drop((emitter, server));
            let _ = watching.join().unwrap();
        }
    }
}

#[cfg(test)]
mod tests {
    use tokio::time::{Instant, sleep, timeout};

    use super::*;
    use crate::{
        contract::driver::{Command, Event, Safety},
        driver::{Debts, session::testing},
    };

    async fn seconds(seconds: f64) {
        sleep(Duration::try_from_secs_f64(seconds).unwrap()).await;
    }

    #[tokio::test(start_paused = true)]
    async fn a_held_jog_is_ended_and_the_sleep_waits_for_proved_standstill() {
        let sleeps = BeforeSleep::default();
        let hear = sleeps.subscribe();
        let (unit, mut handle) = testing::start(Debts::default(), |wires| wires.with_sleep(hear));
        seconds(3.0).await;
        handle.send(Command::Manual).unwrap();
        let hold = || handle.send(Command::Jog { rates_deg_s: [2.0, 0.0] }).unwrap();
        for _ in 0..20 {
            hold();
            seconds(0.1).await;
        }
        assert!(unit.state().is_moving, "{:?}", unit.received());
        let begun = Instant::now();
        timeout(MAX, sleeps.wait_until_quiet()).await.unwrap();
        assert!(begun.elapsed() < MAX, "it did not wait in vain");
        assert!(!unit.state().is_moving);
        // The held key must not move the antenna again after the sleep.
        for _ in 0..10 {
            hold();
            seconds(0.1).await;
        }
        assert!(!unit.state().is_moving);
        let events: Vec<Event> = std::iter::from_fn(|| handle.next_event()).collect();
        assert!(events.contains(&Event::Safety(Safety::EndedForSleep)), "{events:?}");
    }

    #[tokio::test(start_paused = true)]
    async fn an_antenna_that_nobody_moves_puts_off_nothing() {
        let sleeps = BeforeSleep::default();
        let hear = sleeps.subscribe();
        let (_unit, _handle) = testing::start(Debts::default(), |wires| wires.with_sleep(hear));
        seconds(3.0).await;
        let begun = Instant::now();
        sleeps.wait_until_quiet().await;
        assert!(begun.elapsed() < Duration::from_millis(100));
        // A session that is over must not delay the sleep either.
        drop(sleeps.subscribe());
        sleeps.wait_until_quiet().await;
    }
}
