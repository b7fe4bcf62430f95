//! Unit on a pseudo-terminal, which looks like a serial port.

use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::time::Duration;

use nix::fcntl::{FcntlArg, FdFlag, OFlag, fcntl};
use nix::pty::{OpenptyResult, openpty};
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};
use nix::unistd::ttyname;
use tokio::io::{Join, join};
use tokio::net::unix::pipe::{Receiver, Sender};
use tokio::time::{MissedTickBehavior, interval, sleep};

use super::{Control, Options};
use crate::sim::harness::{self, HEARTBEAT};

/// Pause between the end of one connection and the next.
const RECOVERY: Duration = Duration::from_millis(100);

/// Unit behind a pseudo-terminal, which always carries eight bits without parity. A command may
/// therefore have parity in the eighth bit, and the reply then has it too.
#[derive(Debug)]
pub struct PtySimulator {
    control: Control,
    line: Join<Receiver, Sender>,
    /// Open end of the terminal, so that a client that leaves does not hang up the line.
    _terminal: OwnedFd,
    path: PathBuf,
}

impl PtySimulator {
    /// Starts a unit and opens a pseudo-terminal for it. Must be called inside a tokio runtime with
    /// I/O.
    pub fn open(options: &Options) -> io::Result<Self> {
        let OpenptyResult { master, slave } = openpty(None, None)?;
        let mut attributes = tcgetattr(&slave)?;
        cfmakeraw(&mut attributes);
        tcsetattr(&slave, SetArg::TCSANOW, &attributes)?;
        for end in [master.as_fd(), slave.as_fd()] {
            fcntl(end, FcntlArg::F_SETFD(FdFlag::FD_CLOEXEC))?;
        }
        fcntl(&master, FcntlArg::F_SETFL(OFlag::O_NONBLOCK))?;
        // A pipe's receiver works here: a terminal supports the same waits, reads and writes.
        let reader = Receiver::from_owned_fd_unchecked(master.try_clone()?)?;
        let writer = Sender::from_owned_fd_unchecked(master)?;
        Ok(Self {
            control: Control::new(options),
            line: join(reader, writer),
            path: ttyname(&slave)?,
            _terminal: slave,
        })
    }

    /// Returns the path of the port for a client.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns a handle for watching and disturbing the unit.
    pub fn control(&self) -> Control {
        self.control.clone()
    }

    /// Serves clients that open the port. Dropping the future ends the unit and closes the port.
    pub async fn run(self) {
        let Self { control, mut line, path, .. } = self;
        let serve = async {
            loop {
                let wire = control.wire().answering_as_spoken();
                let result = harness::serve(&control, wire, &mut line).await;
                tracing::info!(target: "azel::sim", ?result, path = %path.display(), "client left");
                sleep(RECOVERY).await;
            }
        };
        let live = async {
            let mut heartbeat = interval(HEARTBEAT);
            heartbeat.set_missed_tick_behavior(MissedTickBehavior::Delay);
            loop {
                heartbeat.tick().await;
                control.live_on();
            }
        };
        tokio::select! {
            () = serve => {}
            () = live => {}
        }
    }
}
