//! A session with a simulated Satrak.

use std::sync::Arc;

use azel::{
    clock::Instant,
    driver::Stream,
    plan::on_board::KnownOrbit,
    sim::satrak::{Control, Options},
    station::{Antenna, LockOut},
};
use jiff::Timestamp;

pub(super) use super::scene::{antenna, iss, options, track, twin};
use super::scene::{orbit, session};
use crate::common::{network, rig};

pub(super) type Rig = rig::Rig<Control>;

impl Rig {
    /// Starts a session that is not connected yet.
    pub(super) fn start(options: &Options, antenna: &Antenna) -> Self {
        Self::start_locked_out(options, antenna, None)
    }

    /// Starts a session whose unit may be locked out already.
    pub(super) fn start_locked_out(
        options: &Options,
        antenna: &Antenna,
        lock_out: Option<LockOut>,
    ) -> Self {
        let control = Control::new(options);
        Self::start_over(control, options.utc_origin, antenna, lock_out, network::link)
    }

    /// Starts a session with a unit that runs already, over links made by `link`.
    pub(super) fn start_over(
        control: Control,
        utc_origin: Timestamp,
        antenna: &Antenna,
        lock_out: Option<LockOut>,
        link: impl FnMut(&Control) -> Box<dyn Stream> + Send + 'static,
    ) -> Self {
        Self::over(control, utc_origin, link, |dial, clock| {
            let (session, handle) = session(antenna, dial, clock);
            handle.know_orbit(Some(orbit(25_544)));
            (session.with_lock_out(lock_out), handle)
        })
    }

    /// Starts a session and waits until it has read its unit, at standstill.
    pub(super) async fn connected(options: &Options, antenna: &Antenna) -> Self {
        let mut rig = Self::start(options, antenna);
        rig.until("all is read", 5, |shown| shown.state.on_board.offsets.is_some()).await;
        rig.events();
        rig
    }

    /// Starts a session with the default unit and antenna.
    pub(crate) async fn usual() -> Self {
        Self::connected(&options(), &antenna()).await
    }

    /// Sets the orbit by which the session judges the unit's own program.
    pub(super) fn know_orbit(&self, orbit: Option<Arc<KnownOrbit>>) {
        self.handle().know_orbit(orbit);
    }

    /// Returns the payloads that the unit received, without questions.
    pub(super) fn orders(&self) -> Vec<String> {
        self.payloads().into_iter().filter(|payload| payload.contains('=')).collect()
    }

    /// Returns all payloads that the unit received.
    pub(super) fn payloads(&self) -> Vec<String> {
        self.control.received().into_iter().map(|(_, payload)| payload).collect()
    }

    /// Returns the received payloads with this word.
    pub(super) fn sent(&self, word: &str) -> Vec<String> {
        self.payloads().into_iter().filter(|payload| payload.starts_with(word)).collect()
    }

    /// Returns the times at which the unit received payloads with this word.
    pub(super) fn times(&self, word: &str) -> Vec<Instant> {
        let received = self.control.received().into_iter();
        received.filter(|(_, payload)| payload.starts_with(word)).map(|(at, _)| at).collect()
    }
}
