//! The dead-man: stops a motion by hand if this process dies.

use std::{io, path::PathBuf, time::Duration};

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, Refusal, Safety},
    driver::{
        Stream,
        dead_man::{BEAT, DeadMan},
        link::Duplicate,
    },
};

/// How long the operator's permission stands in for a dead-man.
const ALLOWED: Duration = Duration::from_mins(1);

#[derive(Debug)]
pub(super) struct Guard {
    /// Program of the child process.
    program: Option<PathBuf>,
    line: GuardedLink,
    armed: Option<DeadMan>,
    /// No child could be had the last time one was needed.
    pub(super) is_missing: bool,
    /// Until then the operator allows motions by hand without one.
    allowed_until: Option<Instant>,
}

/// The link, as a child can write to it.
#[derive(Debug)]
enum GuardedLink {
    Closed,
    /// Its far end lives in this process and ends with it.
    InProcess,
    /// A handle for the child, and the STOP bytes as they leave the lowest layer of the link.
    Open {
        link: Duplicate,
        stop: Vec<u8>,
    },
    /// No handle can be had.
    Unavailable,
}

impl Guard {
    pub(super) fn new(program: Option<PathBuf>) -> Self {
        let (line, armed) = (GuardedLink::Closed, None);
        Self { program, line, armed, is_missing: false, allowed_until: None }
    }

    /// A link is open; `stop` holds the controller's STOP bytes.
    pub(super) fn link_up(&mut self, stream: &dyn Stream, stop: &[u8]) {
        self.line = match stream.duplicate() {
            Ok(None) => GuardedLink::InProcess,
            Ok(Some(link)) => GuardedLink::Open { link, stop: stream.on_wire(stop) },
            Err(_) => GuardedLink::Unavailable,
        };
    }

    /// The link is let go: first the child, whose handle would keep the connection open.
    pub(super) fn link_down(&mut self) {
        self.disarm();
        self.line = GuardedLink::Closed;
    }

    fn disarm(&mut self) {
        if let Some(dead_man) = self.armed.take() {
            dead_man.disarm();
        }
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

impl Session {
    /// Arms the dead-man before a motion that only a STOP would end.
    pub(super) fn arm_dead_man(&mut self, now: Moment) -> Result<(), Refusal> {
        if self.setup.can().ends_jogs || self.guard.armed.is_some() {
            return Ok(());
        }
        let armed = self.guard.arm(now.steady);
        self.guard.is_missing = armed.is_err();
        let Err(error) = armed else { return Ok(()) };
        tracing::error!(antenna = self.setup.name(), %error, "no dead-man");
        let is_allowed = self.guard.allowed_until.is_some_and(|until| now.steady < until);
        if is_allowed { Ok(()) } else { Err(Refusal::Unguarded) }
    }

    /// The operator allows motions by hand without a dead-man, for a minute.
    pub(super) fn allow_unguarded(&mut self, now: Moment) {
        self.guard.allowed_until = Some(now.steady + ALLOWED);
    }

    /// Beats while the lease holds or a halt is under way, and ends the child when nothing can
    /// move any more.
    pub(super) fn beat(&mut self, now: Moment) {
        let Some(dead_man) = &mut self.guard.armed else { return };
        if self.key.held().is_none() && !self.stop.is_under_way() {
            return self.guard.disarm();
        }
        let lease_holds = self.key.held().is_some_and(|jog| now.steady < jog.until);
        if (lease_holds || self.stop.is_under_way()) && !dead_man.beat(now.steady) {
            self.guard.armed = None;
            self.halt(now);
            self.tell(Event::Safety(Safety::DeadManFired));
        }
    }

    pub(super) fn beat_due(&self) -> Option<Instant> {
        self.guard.armed.as_ref().map(DeadMan::due)
    }
}

// A beat may be late by one turn of the loop.
const _: () = assert!(BEAT.as_millis() * 3 < 400);
