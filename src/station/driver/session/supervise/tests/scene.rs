//! Session with a simulated unit; the session may lack a check.

use std::{
    io,
    num::NonZeroU32,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    time::Duration,
};

use jiff::Timestamp;
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream},
    time::sleep,
};

use super::Checks;
use crate::{
    clock::Clock,
    contract::driver::{Command, Event, Intent, Snapshot},
    controller::{
        rotator_genius::{ROTATORS, Rotators},
        satrak::ELEMENT_FILE,
    },
    driver::{
        AntennaHandle, Debts, Dial, Orders, Stream,
        before_sleep::BeforeSleep,
        session::{Session, Wires, testing},
    },
    plan::Bounds,
    protocol::satrak::encode,
    sim::{Control, Unit, rotator_genius, satrak},
    station::{Antenna, KeepOut, Resume, Station},
};

/// Interval between checks.
const LOOK: Duration = Duration::from_millis(20);

/// Buffer size of the link. A stalled link still accepts twice this number of bytes, which is less
/// than any request.
const LINK_BYTES: usize = 4;

/// Carries the bytes of a link to the unit, unless the link is stalled, and the unit's replies
/// back.
async fn relay<U: Unit>(link: DuplexStream, unit: Control<U>, is_stalled: Arc<AtomicBool>) {
    let (near, far) = tokio::io::duplex(4096);
    tokio::spawn(async move { unit.serve(far).await });
    let (mut replies, mut to_unit) = tokio::io::split(near);
    let (mut requests, mut to_session) = tokio::io::split(link);
    tokio::spawn(async move { tokio::io::copy(&mut replies, &mut to_session).await });
    let mut bytes = [0; LINK_BYTES];
    loop {
        while is_stalled.load(Ordering::Relaxed) {
            sleep(LOOK).await;
        }
        match requests.read(&mut bytes).await {
            Ok(count @ 1..) if to_unit.write_all(&bytes[..count]).await.is_ok() => {}
            _ => return,
        }
    }
}

pub(super) struct Scene<U: Unit> {
    pub(super) unit: Control<U>,
    pub(super) handle: AntennaHandle,
    pub(super) sleeps: BeforeSleep,
    antenna: Antenna,
    network_is_off: Arc<AtomicBool>,
    link_is_stalled: Arc<AtomicBool>,
    /// Number of times that the session has read its clock.
    readings: Arc<AtomicUsize>,
}

/// Returns a Satrak 90 s before its pass.
pub(super) fn satrak(checks: Checks) -> Scene<impl Unit<Request = String, Place = [f64; 2]>> {
    satrak_after(-90.0, checks)
}

/// Returns a Satrak `after_s` seconds after the beginning of its pass.
pub(super) fn satrak_after(
    after_s: f64,
    checks: Checks,
) -> Scene<impl Unit<Request = String, Place = [f64; 2], Fault = satrak::Fault>> {
    let (unit, now) = testing::unit(after_s);
    let mut antenna = testing::antenna();
    antenna.connection.put(&ELEMENT_FILE, "stations.txt").unwrap();
    (antenna.resume, antenna.resume_after_s) = (Resume::Continue, 10.0);
    let scene = Scene::new(unit, antenna, now, checks);
    scene.handle.know_orbit(Some(testing::orbit()));
    scene
}

/// Returns a Rotator Genius at an azimuth of 173 degrees and at the horizon.
pub(super) fn genius(
    checks: Checks,
) -> Scene<impl Unit<Request = String, Fault = rotator_genius::Fault>> {
    use rotator_genius::{Control, Options, RotatorOptions};
    let rotators = [RotatorOptions::default(), RotatorOptions::elevation()];
    let unit = Control::new(&Options { rotators, ..Options::default() });
    let mut antenna = Antenna::genius("Mast", "in memory");
    antenna.connection.put(&ROTATORS, Rotators::Pair).unwrap();
    Scene::new(unit, antenna, testing::START, checks)
}

impl<U: Unit> Scene<U> {
    fn new(unit: Control<U>, antenna: Antenna, now: Timestamp, checks: Checks) -> Self {
        let (network_is_off, readings) =
            (Arc::<AtomicBool>::default(), Arc::<AtomicUsize>::default());
        let link_is_stalled = Arc::<AtomicBool>::default();
        let (serve, is_off) = (unit.clone(), Arc::clone(&network_is_off));
        let stalls = Arc::clone(&link_is_stalled);
        let dial: Dial = Box::new(move || {
            if is_off.load(Ordering::Relaxed) {
                return Box::pin(async { Err(io::ErrorKind::ConnectionRefused.into()) });
            }
            let (near, far) = tokio::io::duplex(LINK_BYTES);
            tokio::spawn(relay(far, serve.clone(), Arc::clone(&stalls)));
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        });
        let (true_clock, count) = (Clock::at_speed(now, NonZeroU32::MIN), Arc::clone(&readings));
        let clock = Clock::new(move || {
            count.fetch_add(1, Ordering::Relaxed);
            true_clock.utc()
        });
        let (bounds, sleeps) = (Bounds::of_antenna(&antenna), BeforeSleep::default());
        let steady = clock.now().steady;
        let (wires, handle) =
            Wires::new(&antenna, bounds, steady, Arc::new(|| {}), &Orders::default());
        let wires = wires.with_sleep(sleeps.subscribe());
        let controller = antenna.controller();
        let session =
            Session::with_wires(controller, &antenna, dial, clock, wires, Debts::default());
        tokio::spawn(session.with_checks(checks).run());
        Self { unit, handle, sleeps, antenna, network_is_off, link_is_stalled, readings }
    }

    pub(super) fn send(&self, command: Command) {
        self.handle.send(command).unwrap();
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.snapshot()
    }

    pub(super) async fn seconds(&self, seconds: f64) {
        sleep(Duration::try_from_secs_f64(seconds).unwrap()).await;
    }

    /// Returns `true` once a snapshot meets the condition within `within_s` seconds.
    pub(super) async fn shows(&self, within_s: f64, is_so: impl Fn(&Snapshot) -> bool) -> bool {
        let end = tokio::time::Instant::now() + Duration::try_from_secs_f64(within_s).unwrap();
        while !is_so(&self.shown()) {
            if tokio::time::Instant::now() >= end {
                return false;
            }
            sleep(LOOK).await;
        }
        true
    }

    /// Waits for the first reading of the unit.
    pub(super) async fn read(self) -> Self {
        assert!(self.shows(10.0, |shown| shown.state.measured.is_some()).await, "it is not read");
        self.seconds(8.0).await;
        self
    }

    /// Returns `true` once a matching event arrives within `within_s` seconds.
    pub(super) async fn tells(
        &mut self,
        within_s: f64,
        is_expected: impl Fn(&Event) -> bool,
    ) -> bool {
        let end = tokio::time::Instant::now() + Duration::try_from_secs_f64(within_s).unwrap();
        loop {
            while let Some(event) = self.handle.next_event() {
                if is_expected(&event) {
                    return true;
                }
            }
            if tokio::time::Instant::now() >= end {
                return false;
            }
            sleep(LOOK).await;
        }
    }

    /// Switches the network off or on; the antenna continues.
    pub(super) fn set_off(&self, is_off: bool) {
        self.network_is_off.store(is_off, Ordering::Relaxed);
        if is_off {
            self.unit.drop_clients();
        }
    }

    /// Stalls the link so that it accepts no bytes, or ends the stall.
    pub(super) fn stall(&self, is_stalled: bool) {
        self.link_is_stalled.store(is_stalled, Ordering::Relaxed);
    }

    /// Adds a mast with these corners in azimuth and elevation, degrees.
    pub(super) fn put_mast(&self, corners_deg: &[(f64, f64)]) {
        let mast = KeepOut {
            name: "mast".to_owned(),
            reason: String::new(),
            entered: crate::station::Entered::Hard,
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(corners_deg).unwrap(),
        };
        let station = Station { keep_outs: vec![mast], ..Station::default() };
        self.handle.keep_within(Bounds::new(&station, &self.antenna));
    }

    pub(super) fn readings(&self) -> usize {
        self.readings.load(Ordering::Relaxed)
    }

    /// Starts the on-board track of the pass. Returns `true` once the unit tracks.
    pub(super) async fn tracks(&self) -> bool {
        self.send(Command::Track(Box::new(testing::pass())));
        self.shows(60.0, |shown| shown.intent == Intent::Track && !shown.pending).await
    }

    /// Starts the stored pass of the unit like another program.
    pub(super) async fn starts_by_itself(&self) {
        self.tracks().await;
        self.send(Command::Standby);
        self.seconds(5.0).await;
        let (mut near, far) = tokio::io::duplex(4096);
        let unit = self.unit.clone();
        tokio::spawn(async move { unit.serve(far).await });
        near.write_all(&encode("TRACK=,1")).await.unwrap();
        self.seconds(1.0).await;
    }
}

impl<U: Unit<Request = String>> Scene<U> {
    /// Returns the number of requests with this beginning.
    pub(super) fn sent(&self, start: &str) -> usize {
        let received = self.unit.received();
        received.iter().filter(|(_, request)| request.starts_with(start)).count()
    }
}
