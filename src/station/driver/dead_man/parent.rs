//! Session side of the dead-man: starts the child and sends beats.

use std::{io, path::Path, process::Stdio};

use tokio::{
    net::unix::pipe,
    process::{Child, Command},
};

use super::{BEAT, SUBCOMMAND, word};
use crate::{clock::Instant, driver::link::Duplicate};

/// Running child. Dropping this handle without [`Self::disarm`] closes the pipe, and the child
/// stops the unit.
#[derive(Debug)]
pub(in crate::driver) struct DeadMan {
    beats: pipe::Sender,
    child: Child,
    last: Instant,
}

impl DeadMan {
    /// Starts `program` as the child. `stop` contains the STOP bytes on the wire of the link that
    /// `link` duplicates.
    pub(in crate::driver) fn arm(
        program: &Path,
        link: Duplicate,
        stop: &[u8],
        now: Instant,
    ) -> io::Result<Self> {
        let (beats, heard) = pipe::pipe()?;
        let digits =
            stop.iter().fold(String::new(), |digits, byte| digits + &format!("{byte:02x}"));
        let child = Command::new(program)
            .arg(SUBCOMMAND)
            .arg(digits)
            // The child needs no display and no terminal, and must not receive signals to our
            // group.
            .env_clear()
            .process_group(0)
            .stdin(Stdio::from(heard.into_blocking_fd()?))
            .stdout(Stdio::from(link))
            .stderr(Stdio::null())
            .spawn()?;
        Ok(Self { beats, child, last: now })
    }

    /// Sends a beat to the child. Returns `false` if the child has fired or is gone.
    pub(in crate::driver) fn beat(&mut self, now: Instant) -> bool {
        if matches!(self.child.try_wait(), Ok(Some(_))) {
            return false;
        }
        if now < self.due() {
            return true;
        }
        self.last = now;
        // The pipe is full: the child does not read, so it does not watch.
        self.beats.try_write(&[word::BEAT]).is_ok()
    }

    /// Returns the time of the next beat.
    pub(in crate::driver) fn due(&self) -> Instant {
        self.last + BEAT / 2
    }

    /// Ends the child without a STOP: the motion is proved over, or the session stops the unit on
    /// another link.
    pub(in crate::driver) fn disarm(self) {
        // A child that already ended needs no message. The runtime reaps the child.
        let _ = self.beats.try_write(&[word::END]);
    }
}
