//! Dead-man: a small process beside this one that stops a unit when this process no longer can.
//!
//! Azel starts a child for each manual motion that would not end otherwise. The child holds a
//! duplicate of the open link and expects beats from the session's loop. If the beats stop, the
//! child writes STOP.

#[cfg(unix)]
mod child;
#[cfg(unix)]
mod parent;

use std::time::Duration;

#[cfg(unix)]
pub use child::watch_over;
#[cfg(unix)]
pub(super) use parent::DeadMan;

/// Name of the subcommand that runs the child; its argument contains the STOP bytes in hexadecimal
/// digits.
pub const SUBCOMMAND: &str = "dead-man";
/// Time without a beat after which the child stops the unit.
const SILENCE: Duration = Duration::from_millis(400);
/// Max interval between two beats of the session.
pub(super) const BEAT: Duration = Duration::from_millis(100);

/// Bytes on the pipe to the child.
#[cfg(unix)]
mod word {
    /// Beat: the session is alive and its lease holds.
    pub(super) const BEAT: u8 = b'.';
    /// End of the motion: the child ends without a STOP.
    pub(super) const END: u8 = b'e';
}

/// Placeholder for systems that cannot duplicate handles: [`DeadMan::arm`] always fails.
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
