//! The dead-man: a small process beside this one that stops a unit when this
//! process no longer can.
//!
//! It is started for one motion by hand that would not end by itself, holds a duplicate of the
//! open link, and expects a beat from the session's own loop. Without one it writes STOP.

#[cfg(unix)]
mod child;
#[cfg(unix)]
mod parent;

use std::time::Duration;

#[cfg(unix)]
pub use child::watch_over;
#[cfg(unix)]
pub(super) use parent::DeadMan;

/// Name of the subcommand that runs the child; its argument holds the STOP bytes in
/// hexadecimal digits.
pub const SUBCOMMAND: &str = "dead-man";
/// Without a beat for this long the child stops the unit.
const SILENCE: Duration = Duration::from_millis(400);
/// The session beats at least this often.
pub(super) const BEAT: Duration = Duration::from_millis(100);

/// One byte on the pipe to the child.
#[cfg(unix)]
mod word {
    /// The session is alive and its lease holds.
    pub(super) const BEAT: u8 = b'.';
    /// The motion is over: end without a STOP.
    pub(super) const END: u8 = b'e';
}

/// For systems without handles to give away: [`DeadMan::arm`] always fails.
#[cfg(not(unix))]
#[derive(Debug)]
pub(super) struct DeadMan(std::convert::Infallible);

#[cfg(not(unix))]
impl DeadMan {
    pub(super) fn arm(
        _: &std::path::Path,
        _: super::link::Duplicate,
        _: &[u8],
        _: crate::clock::Instant,
    ) -> std::io::Result<Self> {
        Err(std::io::ErrorKind::Unsupported.into())
    }

    pub(super) fn beat(&mut self, _: crate::clock::Instant) -> bool {
        match self.0 {}
    }

    pub(super) fn due(&self) -> crate::clock::Instant {
        match self.0 {}
    }

    pub(super) fn disarm(self) {
        match self.0 {}
    }
}
