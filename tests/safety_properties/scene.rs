//! An operator, a session and its unit in a random world.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Snapshot},
    driver::{AntennaHandle, Debts, Dial, Stream},
    plan::{Barrier, on_board::KnownOrbit},
    station::KeepOut,
};
use tokio::{task::JoinHandle, time::sleep};

use super::{
    line::{Line, carry},
    unit::Unit,
    world::World,
};
use crate::common::{
    clock::TestClock, dice::Dice, network::Network, rig::indebted_session, turns::measured,
};

/// Interval between two looks at the true positions.
pub(super) const LOOK: Duration = Duration::from_millis(50);

/// Operator in front of a session, and the simulated unit.
pub(super) struct Scene {
    pub(super) world: World,
    pub(super) clock: TestClock,
    handle: AntennaHandle,
    session: JoinHandle<()>,
    /// Folder of the records of owed STOPs.
    marks: Option<PathBuf>,
    /// Seed of the troubles of the next session's line.
    seed: u64,
    pub(super) line: Arc<Mutex<Line>>,
    network: Network,
    last_dial: Arc<Mutex<Option<Instant>>>,
    /// All events, with the times at which the test saw them.
    pub(super) events: Vec<(Instant, Event)>,
}

impl Scene {
    /// Starts a session and waits until it has read its unit.
    pub(super) async fn start(world: World, dice: &mut Dice) -> Self {
        let mut scene = Self::begin(world, dice, None, Line::default());
        scene.until_read().await;
        scene
    }

    /// Starts a session with its marks in this folder, over a line with these troubles.
    pub(super) fn begin(
        world: World,
        dice: &mut Dice,
        marks: Option<PathBuf>,
        mut line: Line,
    ) -> Self {
        line.is_unchecked = world.make.is_unchecked;
        let line = Arc::new(Mutex::new(line));
        let (network, last_dial) = (Network::default(), Arc::default());
        let clock = TestClock::new(world.utc_origin);
        let seed = dice.next();
        let ends = (&network, &line, &last_dial);
        let (handle, session) = open(&world, ends, &clock, marks.clone(), seed);
        let events = Vec::new();
        let seed = seed.wrapping_add(1);
        Self { world, clock, handle, session, marks, seed, line, network, last_dial, events }
    }

    /// Waits until the session has read the unit.
    pub(super) async fn until_read(&mut self) {
        let end = Instant::now() + Duration::from_secs(20);
        while self.shown().state.measured.is_none() || self.shown().state.motion_lock.is_none() {
            assert!(Instant::now() < end, "never read: {:?}", self.shown());
            self.look().await;
        }
        self.seconds(1.5).await;
    }

    /// Waits until the session has read the place, the clock and the offsets of the unit.
    pub(super) async fn until_placed(&mut self) {
        let end = Instant::now() + Duration::from_secs(90);
        let is_read = |shown: &Snapshot| {
            let on_board = &shown.state.on_board;
            on_board.place.is_some() && on_board.clock.is_some() && on_board.offsets.is_some()
        };
        while !is_read(&self.shown()) {
            assert!(Instant::now() < end, "never read: {:?}", self.shown());
            self.look().await;
        }
    }

    /// Ends the session at once, as the end of its process would. The unit keeps running.
    pub(super) async fn kill(&mut self) {
        self.session.abort();
        while !self.session.is_finished() {
            tokio::task::yield_now().await;
        }
        self.world.unit.drop_clients();
    }

    /// Starts a new session of the same unit, as a start of the program does.
    pub(super) fn restart(&mut self) {
        let ends = (&self.network, &self.line, &self.last_dial);
        self.seed = self.seed.wrapping_add(1);
        (self.handle, self.session) =
            open(&self.world, ends, &self.clock, self.marks.clone(), self.seed);
    }

    /// Returns `true` if the line has been cut.
    pub(super) fn was_cut(&self) -> bool {
        self.line.lock().unwrap().was_cut
    }

    /// Returns `true` if the session has ended. A session ends only if a test kills it or it breaks
    /// down.
    pub(super) fn has_ended(&self) -> bool {
        self.session.is_finished()
    }

    /// Sets the orbit by which the session judges the unit's own program.
    pub(super) fn know_orbit(&self, orbit: Arc<KnownOrbit>) {
        self.handle.know_orbit(Some(orbit));
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.snapshot()
    }

    pub(super) fn send(&self, command: Command) {
        // Ignore the refusal by a busy session, because the operator would press again.
        drop(self.handle.send(command));
    }

    pub(super) fn stop(&self) {
        self.handle.stop();
    }

    pub(super) fn trouble(&self, change: impl FnOnce(&mut Line)) {
        change(&mut self.line.lock().unwrap());
    }

    /// Switches the network off or on.
    pub(super) fn set_off(&self, is_off: bool) {
        self.network.set_off(is_off);
        if is_off {
            self.world.unit.drop_clients();
        }
    }

    /// Returns the time at which the last link was dialled.
    pub(super) fn last_dial(&self) -> Option<Instant> {
        *self.last_dial.lock().unwrap()
    }

    /// Waits for the time between two looks, and collects the events.
    pub(super) async fn look(&mut self) {
        sleep(LOOK).await;
        self.collect();
    }

    pub(super) fn collect(&mut self) {
        let now = Instant::now();
        while let Some(event) = self.handle.next_event() {
            self.events.push((now, event));
        }
    }

    pub(super) async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            self.look().await;
        }
    }

    /// Returns the time of the first event since `since` that `is_it` accepts.
    pub(super) fn told(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> Option<Instant> {
        let mut events = self.events.iter().filter(|(at, _)| *at >= since);
        events.find(|(_, event)| is_it(event)).map(|(at, _)| *at)
    }

    /// Counts the events since `since` that `is_it` accepts.
    pub(super) fn count(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|(at, event)| *at >= since && is_it(event)).count()
    }

    /// Returns the distance of the true direction from the Sun's surroundings, degrees.
    pub(super) fn sun_clearance_deg(&self) -> f64 {
        let utc = self.shown().state.measured.map_or(self.world.utc_origin, |it| it.time);
        let clearances = self.world.bounds.at_time(utc).clearances(self.world.direction());
        let sun = clearances.into_iter().find(|clearance| clearance.barrier == Barrier::Sun);
        sun.map_or(f64::INFINITY, |clearance| clearance.angle.degrees())
    }

    pub(super) fn report(&self) -> String {
        let World { unit, station, antenna, .. } = &self.world;
        let corners: Vec<_> = station
            .keep_outs
            .iter()
            .map(|zone| (KeepOut::corners_deg(&zone.zone), zone.margin_deg))
            .collect();
        let (mount, sun) = (&antenna.mount, &station.sun_avoidance);
        format!(
            "axes {:?} {:?}\n{mount:?} {:?} beam {}\nzones {corners:?}\nsun {sun:?}\nshown {:?} {:?}\n{:?}",
            unit.axes_deg(),
            self.world.direction(),
            antenna.limits,
            antenna.beam_width_deg,
            self.shown().intent,
            self.shown().state.measured,
            self.events
        )
    }
}

type Ends<'a> = (&'a Network, &'a Arc<Mutex<Line>>, &'a Arc<Mutex<Option<Instant>>>);

/// Starts a session that knows its bounds, and connects it.
fn open(
    world: &World,
    ends: Ends<'_>,
    clock: &TestClock,
    marks: Option<PathBuf>,
    seed: u64,
) -> (AntennaHandle, JoinHandle<()>) {
    let debts = Debts::marked_in(marks);
    let dial = dial(&world.unit, ends, seed);
    let (session, handle) = indebted_session(&world.antenna, dial, clock.clock(), debts);
    let session = tokio::spawn(measured(session.run()));
    handle.keep_within(world.bounds.clone());
    handle.send(Command::Connect).unwrap();
    (handle, session)
}

fn dial(unit: &Arc<dyn Unit>, (network, line, last_dial): Ends<'_>, seed: u64) -> Dial {
    let (unit, line, last_dial) = (Arc::clone(unit), Arc::clone(line), Arc::clone(last_dial));
    let mut dice = Dice::new(seed);
    network.dial(move || {
        *last_dial.lock().unwrap() = Some(Instant::now());
        let (near, here) = tokio::io::duplex(4096);
        let (line, dice) = (Arc::clone(&line), Dice::new(dice.next()));
        tokio::spawn(carry(here, unit.link(), line, dice, Arc::clone(&unit)));
        Box::new(near) as Box<dyn Stream>
    })
}
