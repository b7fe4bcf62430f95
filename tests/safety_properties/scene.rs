//! An operator, a session and its unit in a random world.

use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::{
    clock::Instant,
    driver::{AntennaHandle, Command, Dial, Event, Snapshot, Stream},
    plan::Barrier,
    station::KeepOut,
};
use tokio::time::sleep;

use super::{
    line::{Line, carry},
    unit::Unit,
    world::World,
};
use crate::common::{clock::TestClock, dice::Dice, network::Network, rig::session};

/// Interval of looks at the metal.
pub(super) const LOOK: Duration = Duration::from_millis(50);

/// An operator in front of a session, and the metal.
pub(super) struct Scene {
    pub(super) world: World,
    handle: AntennaHandle,
    pub(super) line: Arc<Mutex<Line>>,
    network: Network,
    last_dial: Arc<Mutex<Option<Instant>>>,
    /// All events, with the times at which they were seen.
    pub(super) events: Vec<(Instant, Event)>,
}

impl Scene {
    /// A session that has read its unit and knows its bounds.
    pub(super) async fn start(world: World, dice: &mut Dice) -> Self {
        let line =
            Arc::new(Mutex::new(Line { is_unchecked: world.make.is_unchecked, ..Line::default() }));
        let (network, last_dial) = (Network::default(), Arc::default());
        let dial = dial(&network, &world.unit, &line, &last_dial, dice.next());
        let clock = TestClock::new(world.utc_origin).clock();
        let (session, handle) = session(&world.antenna, dial, clock);
        tokio::spawn(session.run());
        handle.keep_within(world.bounds.clone());
        handle.send(Command::Connect).unwrap();
        let mut scene = Self { world, handle, line, network, last_dial, events: Vec::new() };
        let end = Instant::now() + Duration::from_secs(20);
        while scene.shown().state.measured.is_none() || scene.shown().state.motion_lock.is_none() {
            assert!(Instant::now() < end, "never read: {:?}", scene.shown());
            scene.look().await;
        }
        scene.seconds(1.5).await;
        scene
    }

    pub(super) fn shown(&self) -> Arc<Snapshot> {
        self.handle.snapshot()
    }

    pub(super) fn send(&self, command: Command) {
        // A session that is too busy says so; the operator would press again.
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

    /// Dial of the last link that was opened.
    pub(super) fn last_dial(&self) -> Option<Instant> {
        *self.last_dial.lock().unwrap()
    }

    /// Waits for the time between two looks, and collects the events.
    pub(super) async fn look(&mut self) {
        sleep(LOOK).await;
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

    /// Time of the first event since `since` for which `is_it` holds.
    pub(super) fn told(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> Option<Instant> {
        let mut events = self.events.iter().filter(|(at, _)| *at >= since);
        events.find(|(_, event)| is_it(event)).map(|(at, _)| *at)
    }

    /// Number of events since `since` for which `is_it` holds.
    pub(super) fn count(&self, since: Instant, is_it: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|(at, event)| *at >= since && is_it(event)).count()
    }

    /// Distance of the true direction from the Sun's surroundings, degrees.
    pub(super) fn sun_clearance_deg(&self) -> f64 {
        let utc = self.shown().state.measured.map_or(self.world.utc_origin, |it| it.at);
        let clearances = self.world.bounds.at(utc).clearances(self.world.direction());
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

fn dial(
    network: &Network,
    unit: &Arc<dyn Unit>,
    line: &Arc<Mutex<Line>>,
    last_dial: &Arc<Mutex<Option<Instant>>>,
    seed: u64,
) -> Dial {
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
