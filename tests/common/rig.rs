//! A session and a simulated unit, joined by an in-memory stream.

use std::{sync::Arc, time::Duration};

use azel::{
    clock::{Clock, Instant},
    contract::driver::{Command, Event, LinkState, Snapshot, WireLog},
    driver::{AntennaHandle, Debts, Dial, Session, Stream},
    sim::{Control, Unit},
    station::Antenna,
};
use jiff::Timestamp;
use tokio::time::sleep;

use super::{
    clock::TestClock,
    comes_back,
    network::{self, Network},
};

/// Default interval at which the operator looks at the snapshot.
const LOOK: Duration = Duration::from_millis(10);

/// Creates a session with the controller of `antenna`, and its handle.
pub(crate) fn session(antenna: &Antenna, dial: Dial, clock: Clock) -> (Session, AntennaHandle) {
    indebted_session(antenna, dial, clock, Debts::default())
}

/// Creates a session as [`session`] does, with records of owed STOPs in `debts`.
pub(crate) fn indebted_session(
    antenna: &Antenna,
    dial: Dial,
    clock: Clock,
    debts: Debts,
) -> (Session, AntennaHandle) {
    Session::new(antenna.controller(), antenna, dial, clock, Arc::new(|| {}), debts)
}

/// Operator in front of a running session. The tests of each make add the start of their unit and
/// session, and the record of received commands.
pub(crate) struct Rig<C> {
    pub(crate) control: C,
    pub(crate) clock: TestClock,
    handle: Option<AntennaHandle>,
    session: tokio::task::JoinHandle<()>,
    events: Vec<Event>,
    network: Network,
    pub(crate) started: Instant,
    look: Duration,
}

impl<U: Unit> Rig<Control<U>> {
    /// Runs the session made by `session` from `utc_origin` on, over links that the unit
    /// serves.
    pub(crate) fn new(
        control: Control<U>,
        utc_origin: Timestamp,
        session: impl FnOnce(Dial, Clock) -> (Session, AntennaHandle),
    ) -> Self {
        Self::over(control, utc_origin, network::link, session)
    }

    /// Runs a session as [`Self::new`] does, with links made by `link`.
    pub(crate) fn over(
        control: Control<U>,
        utc_origin: Timestamp,
        mut link: impl FnMut(&Control<U>) -> Box<dyn Stream> + Send + 'static,
        session: impl FnOnce(Dial, Clock) -> (Session, AntennaHandle),
    ) -> Self {
        let (clock, network) = (TestClock::new(utc_origin), Network::default());
        let unit = control.clone();
        let (session, handle) = session(network.dial(move || link(&unit)), clock.clock());
        Self {
            control,
            clock,
            handle: Some(handle),
            session: tokio::spawn(session.run()),
            events: Vec::new(),
            network,
            started: Instant::now(),
            look: LOOK,
        }
    }

    /// Sets the interval at which the operator looks.
    pub(crate) fn looking_every(self, look: Duration) -> Self {
        Self { look, ..self }
    }

    pub(crate) fn handle(&self) -> &AntennaHandle {
        self.handle.as_ref().unwrap()
    }

    pub(crate) fn shown(&self) -> Arc<Snapshot> {
        self.handle().snapshot()
    }

    pub(crate) fn wire(&self) -> &WireLog {
        self.handle().wire()
    }

    pub(crate) fn send(&self, command: Command) {
        // JSON cannot represent NaN, and the gate refuses NaN.
        if !format!("{command:?}").contains("NaN") {
            comes_back(&command);
        }
        self.handle().send(command).unwrap();
    }

    pub(crate) fn stop(&self) {
        self.handle().stop();
    }

    /// Drops the handle, as a closed window does, and waits for the end of the session.
    pub(crate) async fn drop_handle(&mut self) {
        drop(self.handle.take());
        (&mut self.session).await.unwrap();
        // Give the unit time to read the last bytes of the session.
        sleep(LOOK).await;
    }

    /// Switches the unit's network on or off; a moving antenna keeps moving.
    pub(crate) fn set_off(&self, is_off: bool) {
        self.network.set_off(is_off);
        if is_off {
            self.control.drop_clients();
        }
    }

    pub(crate) fn dials(&self) -> Vec<Instant> {
        self.network.dials()
    }

    fn collect(&mut self) {
        if let Some(handle) = &mut self.handle {
            while let Some(event) = handle.next_event() {
                comes_back(&event);
                comes_back(&*handle.snapshot());
                self.events.push(event);
            }
        }
    }

    /// Returns the events since the last call, without those that [`Self::until_event`] took.
    pub(crate) fn events(&mut self) -> Vec<Event> {
        self.collect();
        std::mem::take(&mut self.events)
    }

    pub(crate) async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            sleep(self.look.min(end - Instant::now())).await;
            self.collect();
        }
    }

    /// Waits at most `limit_s` seconds until the snapshot fulfils the condition.
    pub(crate) async fn until(
        &mut self,
        what: &str,
        limit_s: u64,
        is_so: impl Fn(&Snapshot) -> bool,
    ) {
        let end = Instant::now() + Duration::from_secs(limit_s);
        while !is_so(&self.shown()) {
            assert!(Instant::now() < end, "not within {limit_s} s: {what}\n{}", self.report());
            sleep(self.look).await;
            self.collect();
        }
    }

    /// Waits at most `limit_s` seconds for a matching event and takes the first one. All other
    /// events stay.
    pub(crate) async fn until_event(
        &mut self,
        limit_s: u64,
        is_it: impl Fn(&Event) -> bool,
    ) -> Event {
        let end = Instant::now() + Duration::from_secs(limit_s);
        loop {
            self.collect();
            if let Some(at) = self.events.iter().position(&is_it) {
                return self.events.remove(at);
            }
            assert!(Instant::now() < end, "no such event\n{}", self.report());
            sleep(self.look).await;
        }
    }

    pub(crate) async fn until_up(&mut self, limit_s: u64) {
        self.until("up", limit_s, |shown| matches!(shown.link, LinkState::Up { .. })).await;
    }

    /// Holds a jog key down, which repeats its command every 0.1 s.
    pub(crate) async fn hold(&mut self, rates_deg_s: [f64; 2], seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.send(Command::Jog { rates_deg_s });
            self.seconds(0.1).await;
        }
    }

    fn report(&self) -> String {
        let received = self.control.received();
        let last = received.iter().skip(received.len().saturating_sub(40));
        let lines: Vec<String> =
            last.map(|(at, request)| format!("{:?} {request:?}", *at - self.started)).collect();
        format!("{:#?}\nevents {:?}\n{}", self.shown(), self.events, lines.join("\n"))
    }
}
