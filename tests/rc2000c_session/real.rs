//! The whole path in real time: through a serial server on TCP, with and without parity of
//! its own, and through a pseudo-terminal.

use std::{sync::Arc, time::Duration};

use azel::{
    clock::Instant,
    contract::driver::{Command, Event, Found, LinkLoss, LinkState},
    device::{MotionRequest, settings::Value},
    driver::{AntennaHandle, dial_line},
    sim::rc2000c::{Control, Options, Quirk, Simulator},
};
use jiff::Timestamp;
use tokio::time::sleep;

use super::rig::{antenna, reading};
use crate::common::{clock::TestClock, rig::session};

const PATIENCE: Duration = Duration::from_secs(30);

/// Returns options of a fast line, because these tests run in real time.
fn options() -> Options {
    Options { latency: Duration::ZERO, baud: 1_000_000, ..Options::default() }
}

struct Fixture {
    handle: AntennaHandle,
    events: Vec<Event>,
}

impl Fixture {
    fn at(address: &str) -> Self {
        let (session, handle) = session(
            &antenna(),
            dial_line(address, 9600, Arc::new(())),
            TestClock::new(Timestamp::UNIX_EPOCH).clock(),
        );
        tokio::spawn(session.run());
        Self { handle, events: Vec::new() }
    }

    fn send(&self, command: Command) {
        self.handle.send(command).unwrap();
    }

    async fn until(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let end = Instant::now() + PATIENCE;
        loop {
            self.events.extend(std::iter::from_fn(|| self.handle.next_event()));
            if is_so(self) {
                return;
            }
            assert!(
                Instant::now() < end,
                "{what}\n{:?}\n{:#?}",
                self.events,
                self.handle.snapshot()
            );
            sleep(Duration::from_millis(10)).await;
        }
    }

    async fn until_event(&mut self, event: Event) {
        self.until(&format!("{event:?}"), |fixture| fixture.events.contains(&event)).await;
        self.events.clear();
    }

    /// Connects, jogs, stops, goes to counts, leaves.
    async fn tour(&mut self, control: &Control) {
        self.send(Command::Connect);
        self.until_event(Event::Connected(Found::Still)).await;
        self.until("the list", |fixture| {
            reading(&fixture.handle.snapshot(), "Stored satellites")
                .is_some_and(|text| text.ends_with("ANIK E2"))
        })
        .await;
        self.send(Command::Manual);
        let before = control.state().el_counts;
        let end = Instant::now() + Duration::from_secs(1);
        while Instant::now() < end {
            self.send(Command::Jog { rates_deg_s: [0.0, 2.0] });
            sleep(Duration::from_millis(100)).await;
        }
        assert!(control.state().el_counts > before + 10);
        self.handle.stop();
        self.until_event(Event::Stopped).await;
        self.send(Command::Manual);
        let values = [("az_counts", Value::Integer(1530)), ("el_counts", Value::Integer(750))];
        let act =
            azel::device::panel::Act { action: "to_counts", values: values.into_iter().collect() };
        self.send(Command::Act(act));
        self.until("there", |_| {
            let state = control.state();
            [state.az_counts, state.el_counts] == [1530, 750] && !state.is_turning
        })
        .await;
        let failed = |event: &Event| matches!(event, Event::Refused(MotionRequest::Action(_), _));
        assert!(!self.events.iter().any(failed), "{:?}", self.events);
        assert_eq!(self.handle.snapshot().state.traffic.damaged, 0);
        self.send(Command::Disconnect);
        self.until("off", |fixture| fixture.handle.snapshot().link == LinkState::Off).await;
    }
}

/// Both tests run at once, because they wait for the line most of the time.
#[tokio::test]
async fn over_a_serial_server_with_and_without_parity_of_its_own() {
    tokio::join!(with_parity(), with_eight_bits_it_is_understood_at_the_second_try());
}

async fn with_parity() {
    let simulator = Simulator::bind(([127, 0, 0, 1], 0).into(), &options()).await.unwrap();
    let address = simulator.local_addr().unwrap().to_string();
    let control = simulator.control();
    tokio::spawn(simulator.run());
    Fixture::at(&address).tour(&control).await;
}

async fn with_eight_bits_it_is_understood_at_the_second_try() {
    let options = Options { quirks: [Quirk::ParityBit].into_iter().collect(), ..options() };
    let simulator = Simulator::bind(([127, 0, 0, 1], 0).into(), &options).await.unwrap();
    let address = simulator.local_addr().unwrap().to_string();
    tokio::spawn(simulator.run());
    let mut fixture = Fixture::at(&address);
    fixture.send(Command::Connect);
    fixture.until_event(Event::LinkLost(LinkLoss::Silent)).await;
    fixture.until_event(Event::Connected(Found::Still)).await;
    let traffic = fixture.handle.snapshot().state.traffic;
    assert_eq!((traffic.damaged, traffic.odd), (0, 0));
}

#[cfg(unix)]
#[tokio::test]
async fn over_a_serial_port() {
    use azel::sim::rc2000c::PtySimulator;

    // Some containers have no pseudo-terminals.
    if !std::path::Path::new("/dev/ptmx").exists() {
        return;
    }
    let simulator = PtySimulator::open(&options()).unwrap();
    let path = simulator.path().to_str().unwrap().to_owned();
    let control = simulator.control();
    let server = tokio::spawn(simulator.run());
    let mut fixture = Fixture::at(&path);
    fixture.tour(&control).await;
    // Connect again, and then pull the cable.
    fixture.send(Command::Connect);
    fixture.until_event(Event::Connected(Found::Still)).await;
    server.abort();
    fixture
        .until("lost", |fixture| matches!(fixture.handle.snapshot().link, LinkState::Lost { .. }))
        .await;
}

#[tokio::test]
async fn a_port_that_is_not_there_is_told_in_words() {
    let mut fixture = Fixture::at("/dev/no-such-port-as-this");
    fixture.send(Command::Connect);
    let reason = LinkLoss::Refused("no such serial port".to_owned());
    fixture.until_event(Event::LinkLost(reason)).await;
}
