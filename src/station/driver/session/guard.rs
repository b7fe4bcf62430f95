//! Dead-man of a session: stops a manual motion if this process dies.

use std::{io, path::PathBuf, time::Duration};

use crate::{
    clock::Instant,
    driver::{
        Stream,
        dead_man::{BEAT, DeadMan},
        link::Duplicate,
    },
};

/// Duration of the operator's permission to move without a dead-man.
const ALLOWED: Duration = Duration::from_mins(1);

#[derive(Debug)]
pub(super) struct Guard {
    /// Program of the child process.
    program: Option<PathBuf>,
    line: GuardedLink,
    armed: Option<DeadMan>,
    /// `true` if the last attempt to start a child failed.
    is_missing: bool,
    /// End of the operator's permission for manual motions without a dead-man.
    allowed_until: Option<Instant>,
}

/// Link in the form in which a child can write to it.
#[derive(Debug)]
enum GuardedLink {
    Closed,
    /// Link whose far end lives in this process and ends with it.
    InProcess,
    /// Handle for the child, and the STOP bytes in the form of the lowest layer of the link.
    Open {
        link: Duplicate,
        stop: Vec<u8>,
    },
    /// Link without a handle.
    Unavailable,
}

impl Guard {
    pub(super) fn new(program: Option<PathBuf>) -> Self {
        let (line, armed) = (GuardedLink::Closed, None);
        Self { program, line, armed, is_missing: false, allowed_until: None }
    }

    /// Records an open link; `stop` contains the controller's STOP bytes.
    pub(super) fn link_up(&mut self, stream: &dyn Stream, stop: &[u8]) {
        self.line = match stream.duplicate() {
            Ok(None) => GuardedLink::InProcess,
            Ok(Some(link)) => GuardedLink::Open { link, stop: stream.encode(stop) },
            Err(_) => GuardedLink::Unavailable,
        };
    }

    /// Releases the link, but first the child, whose handle would keep the connection open.
    pub(super) fn link_down(&mut self) {
        self.disarm();
        self.line = GuardedLink::Closed;
    }

    fn disarm(&mut self) {
        if let Some(dead_man) = self.armed.take() {
            dead_man.disarm();
        }
    }

    /// Returns `true` if the last attempt to start a child failed.
    pub(super) fn is_missing(&self) -> bool {
        self.is_missing
    }

    /// Arms the dead-man unless it is already armed.
    pub(super) fn ensure_armed(&mut self, now: Instant) -> io::Result<()> {
        if self.armed.is_some() {
            return Ok(());
        }
        let armed = self.arm(now);
        self.is_missing = armed.is_err();
        armed
    }

    /// Allows manual motions without a dead-man for a minute.
    pub(super) fn allow_unguarded(&mut self, now: Instant) {
        self.allowed_until = Some(now + ALLOWED);
    }

    pub(super) fn is_allowed_without(&self, now: Instant) -> bool {
        self.allowed_until.is_some_and(|end| now < end)
    }

    /// Sends a beat, and ends the child when no motion is possible any more. `lives`: the lease
    /// holds, or a halt is under way. Returns `false` if the child has sent STOP.
    pub(super) fn beat(&mut self, may_move: bool, lives: bool, now: Instant) -> bool {
        let Some(dead_man) = &mut self.armed else { return true };
        if !may_move {
            self.disarm();
            return true;
        }
        if lives && !dead_man.beat(now) {
            self.armed = None;
            return false;
        }
        true
    }

    /// Returns the time of the next beat.
    pub(super) fn due(&self) -> Option<Instant> {
        self.armed.as_ref().map(DeadMan::due)
    }

    fn arm(&mut self, now: Instant) -> io::Result<()> {
        let (link, stop) = match &self.line {
            GuardedLink::InProcess => return Ok(()),
            GuardedLink::Open { link, stop } => (copy(link)?, stop),
            GuardedLink::Closed | GuardedLink::Unavailable => {
                return Err(io::ErrorKind::Unsupported.into());
            }
        };
        let program = self.program.as_deref().ok_or(io::ErrorKind::NotFound)?;
        self.armed = Some(DeadMan::arm(program, link, stop, now)?);
        Ok(())
    }
}

#[cfg(unix)]
fn copy(link: &Duplicate) -> io::Result<Duplicate> {
    link.try_clone()
}

#[cfg(not(unix))]
fn copy(link: &Duplicate) -> io::Result<Duplicate> {
    match *link {}
}

// A beat may be late by one iteration of the loop.
const _: () = assert!(BEAT.as_millis() * 3 < 400);
