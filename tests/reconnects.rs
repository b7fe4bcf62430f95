//! Reconnects: a unit that closes the connection a hundred times, also during a jog, leaves no
//! process, handle or connection behind.
//!
//! Several units share the hundred, because a session waits before it dials again.

#![cfg(target_os = "linux")]
// Tests and their helpers may panic.
#![allow(clippy::expect_used, clippy::panic)]

use std::{
    fs,
    path::PathBuf,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use azel::{
    astro::Site,
    clock::Clock,
    contract::driver::{Command, Intent, LinkState},
    driver::{AntennaHandle, Driver},
    plan::Bounds,
    sim::satrak::{Control, Options, Simulator},
    station::Antenna,
};
use jiff::Timestamp;
use tokio::runtime::Runtime;

/// Time limit of any wait in these tests, long enough for a slow machine.
const PATIENCE: Duration = Duration::from_secs(30);
const UNITS: usize = 10;
const ROUNDS: usize = 10;
/// Number of rounds of which one has a held key.
const HELD_EACH: usize = 3;
/// Interval of renewals; a lease lasts 300 ms.
const RENEW: Duration = Duration::from_millis(50);

struct Pair {
    control: Control,
    port: u16,
    handle: AntennaHandle,
}

fn wait_for(what: &str, mut is_so: impl FnMut() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < until, "waited too long for {what}");
        thread::sleep(RENEW);
    }
}

fn pair(units: &Runtime, driver: &Driver, number: usize) -> Pair {
    let options = Options::new(Site::default(), Timestamp::now());
    let simulator =
        units.block_on(Simulator::bind(([127, 0, 0, 1], 0).into(), options)).expect("a port");
    let (control, address) = (simulator.control(), simulator.local_addr().expect("an address"));
    units.spawn(simulator.run());
    let antenna = Antenna::satrak(&format!("Satrak {number}"), &address.to_string());
    let handle =
        driver.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    Pair { control, port: address.port(), handle }
}

impl Pair {
    fn is_up(&self) -> bool {
        let shown = self.handle.snapshot();
        matches!(shown.link, LinkState::Up { .. }) && shown.state.measured.is_some()
    }

    fn send(&self, command: Command) {
        assert!(self.handle.send(command).is_ok(), "the session is too busy");
    }

    fn hold(&self) {
        self.send(Command::Jog { rates_deg_s: [0.5, 0.0] });
    }
}

/// Returns the ids of the dead-men that this process has started, including ended ones that it has
/// not yet collected.
fn dead_men() -> Vec<u32> {
    let ids = fs::read_dir("/proc").expect("/proc").filter_map(|entry| {
        let name = entry.ok()?.file_name();
        name.to_str()?.parse::<u32>().ok()
    });
    let is_ours = |id: &u32| {
        let stat = fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        let words = stat.rsplit_once(") ").map(|(_, rest)| rest.split(' '));
        let parent = words.and_then(|mut words| words.nth(1)?.parse::<u32>().ok());
        parent == Some(std::process::id())
    };
    ids.filter(is_ours).collect()
}

fn handles() -> usize {
    fs::read_dir("/proc/self/fd").expect("/proc").count()
}

/// Returns the number of open connections to `port`.
fn established_at(port: u16) -> usize {
    let local = format!(":{port:04X}");
    let table = fs::read_to_string("/proc/net/tcp").expect("/proc/net/tcp");
    let words = table.lines().map(|line| line.split_ascii_whitespace());
    words
        .filter(|words| {
            let mut words = words.clone();
            words.nth(1).is_some_and(|end| end.ends_with(&local)) && words.nth(1) == Some("01")
        })
        .count()
}

/// Holds a key on every unit until each antenna moves and has a dead-man.
fn hold_all(pairs: &[Pair]) {
    for pair in pairs {
        pair.send(Command::Manual);
    }
    let mut looks = 0;
    wait_for("the jogs", || {
        looks += 1;
        for pair in pairs {
            // On a busy machine, a hold may have run out, and the unit needs a new press.
            if looks % 40 == 0 {
                pair.send(Command::EndJog);
            }
            pair.hold();
        }
        pairs.iter().all(|pair| pair.handle.snapshot().jog.is_some())
            && dead_men().len() >= pairs.len()
    });
}

#[test]
fn a_hundred_lost_connections_leave_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let units = Runtime::new().expect("a runtime");
    let driver = Driver::start(Clock::system(), Arc::new(|| {}))
        .expect("a thread")
        .guarded_by(Some(PathBuf::from(env!("CARGO_BIN_EXE_azel"))))
        .marking_in(Some(folder.path().to_owned()));
    let pairs: Vec<Pair> = (0..UNITS).map(|number| pair(&units, &driver, number)).collect();
    let all_up = || pairs.iter().all(Pair::is_up);
    let all_still = || {
        pairs.iter().all(|pair| !pair.control.state().is_moving)
            && fs::read_dir(folder.path()).expect("the marks").next().is_none()
    };
    wait_for("the first links", all_up);
    // The first hold opens handles that stay open, such as the watch over children.
    hold_all(&pairs);
    for pair in &pairs {
        pair.send(Command::EndJog);
    }
    wait_for("standstill", all_still);
    wait_for("the dead-men to end", || dead_men().is_empty());
    let before = handles();

    for round in 0..ROUNDS {
        let is_held = round % HELD_EACH == 0;
        if is_held {
            hold_all(&pairs);
        }
        for pair in &pairs {
            pair.control.drop_clients();
        }
        wait_for("the loss", || {
            pairs.iter().all(|pair| !matches!(pair.handle.snapshot().link, LinkState::Up { .. }))
        });
        wait_for("the next links", all_up);
        if is_held {
            wait_for("standstill", all_still);
        }
        for pair in &pairs {
            pair.send(Command::EndJog);
            assert_eq!(pair.handle.snapshot().jog, None);
            assert!(established_at(pair.port) <= 1, "a connection is left behind");
        }
    }

    wait_for("the dead-men to end", || dead_men().is_empty());
    wait_for("the handles to close", || handles() <= before);
    for pair in &pairs {
        assert_eq!(established_at(pair.port), 1);
        assert_eq!(pair.handle.snapshot().intent, Intent::Manual);
    }
}
