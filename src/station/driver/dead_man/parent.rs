//! The near end: starts the child and beats.

use std::{io, path::Path, process::Stdio};

use tokio::{
    net::unix::pipe,
    process::{Child, Command},
};

use super::{BEAT, SUBCOMMAND, word};
use crate::{clock::Instant, driver::link::Duplicate};

/// A child that watches. Dropping it without [`Self::disarm`] closes the pipe,
/// and the child stops the unit.
#[derive(Debug)]
pub(in crate::driver) struct DeadMan {
    beats: pipe::Sender,
    child: Child,
    last: Instant,
}

impl DeadMan {
    /// Starts `program` as the child. `stop` is STOP as it leaves the last layer
    /// of the link that `link` duplicates.
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
            // No display, no terminal, and no part in signals to our group.
            .env_clear()
            .process_group(0)
            .stdin(Stdio::from(heard.into_blocking_fd()?))
            .stdout(Stdio::from(link))
            .stderr(Stdio::null())
            .spawn()?;
        Ok(Self { beats, child, last: now })
    }

    /// Tells the child that the session is alive. `false` when the child has
    /// fired or is gone.
    pub(in crate::driver) fn beat(&mut self, now: Instant) -> bool {
        if matches!(self.child.try_wait(), Ok(Some(_))) {
            return false;
        }
        if now < self.due() {
            return true;
        }
        self.last = now;
        // A full pipe: the child does not read, so it does not watch.
        self.beats.try_write(&[word::BEAT]).is_ok()
    }

    /// When the next beat is due.
    pub(in crate::driver) fn due(&self) -> Instant {
        self.last + BEAT / 2
    }

    /// Ends the child without a STOP: what was out is proved to be over, or the
    /// session stops the unit on another link.
    pub(in crate::driver) fn disarm(self) {
        // A child that is gone already needs no word. It is collected by the
        // runtime.
        let _ = self.beats.try_write(&[word::END]);
    }
}
