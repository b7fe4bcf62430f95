//! Station with 60 satellites and three antennas that nobody touches. Its faults are a power cut,
//! an outage of each link, a clock step, failing sources, a drifting unit clock, gusts and
//! imperfect drives. The test takes an hour, in which each fault weighs more. This command
//! rehearses a week and prints the resident memory of each hour:
//!
//! ```text
//! AZEL_SEED=1 AZEL_HOURS=168 cargo test --release --test azel rehearsed::week -- --nocapture
//! ```

mod faults;
mod ground_station;
mod source;
mod tally;

use std::time::Duration;

use azel::{
    astro::time::{add_seconds, seconds_between},
    contract::{
        Command,
        automatic::{OffBecause, Operation},
    },
    engine::Client,
    station::AntennaId,
};
use jiff::Timestamp;

use self::{faults::Faults, ground_station::GroundStation, tally::Tally};
use crate::common::units::{measured, until};

/// Min share of the promised time outside the faults that the antennas spend in beam.
const MIN_SHARE: f64 = 0.995;
/// Time after which the operator looks after an antenna whose automatic operation is off, seconds.
const OPERATOR_COMES_S: f64 = 900.0;
/// Time until the station has its first plan and the links are up, seconds.
const LEAD_S: f64 = 120.0;
/// Min share in the short form, where the recovery from each fault takes a larger part.
const MIN_SHORT_SHARE: f64 = 0.8;
/// Max growth of the resident memory after the first day, in which logs and plans fill, as a share.
const MAX_GROWTH: f64 = 0.05;
/// Min length of the long form, hours. Other tests share the memory with the short form.
const LONG_H: f64 = 72.0;
const DAY_H: usize = 24;

fn begin() -> Timestamp {
    "2026-08-12T00:00:00Z".parse().unwrap()
}

#[tokio::test(start_paused = true)]
async fn a_station_keeps_its_promise_through_faults_without_the_operator() {
    let number = |name: &str, default: f64| {
        std::env::var(name).map_or(default, |text| text.parse().unwrap())
    };
    let (seed, hours) = (number("AZEL_SEED", 1.0) as u64, number("AZEL_HOURS", 1.0));
    let from = begin();
    let faults = Faults::draw(seed, from, hours);
    let mut week = Week {
        station: GroundStation::new(add_seconds(from, -LEAD_S), seed, &faults),
        tally: Tally::new(from, &faults),
        operator: Operator::default(),
        memory_kib: Vec::new(),
    };
    week.station.start();
    week.switch_on().await;
    week.run(&faults, add_seconds(from, hours * 3600.0)).await;
    let is_over = week.tally.is_over();
    week.tally.print_passes();
    println!("seed {seed}, {hours} h: {faults:#?}");
    println!("{} requests to the source", week.station.source.requests());
    let total = week.tally.print_totals();
    week.operator.print();
    let growth = week.print_memory();
    assert!(is_over, "a pass was not reported");
    assert_eq!(week.operator.touches.len(), 0);
    let is_long = hours >= LONG_H;
    let min_share = if is_long { MIN_SHARE } else { MIN_SHORT_SHARE };
    assert!(total.share() >= min_share, "{}", total.share());
    assert!(!is_long || growth <= MAX_GROWTH, "{growth}");
}

struct Week {
    station: GroundStation,
    tally: Tally,
    operator: Operator,
    /// Resident memory at the end of each hour, KiB.
    memory_kib: Vec<u64>,
}

impl Week {
    /// Switches automatic operation on once, as the operator does.
    async fn switch_on(&mut self) {
        let client = self.station.client();
        for name in self.station.names() {
            measured(&client, &name).await;
        }
        until("the schedule", || client.snapshot().schedule.made_at).await;
        for antenna in self.station.antennas() {
            super::scene::set_automatic(&client, antenna, true).await;
        }
    }

    async fn run(&mut self, faults: &Faults, to: Timestamp) {
        let mut events = faults.events();
        events.sort_by_key(|(at, _)| *at);
        for (at, event) in events {
            self.run_until(at).await;
            match event {
                faults::Event::PowerCut { is_on: true } => {
                    self.tally.expect(&self.station.client().snapshot(), faults.power_cut.to);
                    self.station.cut_power().await;
                }
                faults::Event::PowerCut { is_on: false } => self.station.restore_power(),
                faults::Event::Outage { antenna, is_on } => self.station.set_down(antenna, is_on),
                faults::Event::ClockStep { by_s } => self.station.step_clock(by_s),
                faults::Event::Sources { is_on } => self.station.source.set_failing(is_on),
            }
        }
        self.run_until(to).await;
        // Azel tracks passes that have begun to their end.
        self.tally.take_no_more();
        let last = self.tally.last_end();
        self.run_until(add_seconds(last, 30.0)).await;
    }

    /// Runs until the true time is `at`.
    async fn run_until(&mut self, at: Timestamp) {
        let mut client = self.station.is_running().then(|| self.station.client());
        while self.station.true_time() < at {
            if let Some(client) = &mut client {
                // A station that has ended publishes nothing more.
                let _ = tokio::time::timeout(Duration::from_secs(1), client.changed()).await;
                self.tally.look(&client.snapshot(), self.station.true_time());
                self.operator.look(client, self.station.true_time());
            } else {
                tokio::time::sleep(Duration::from_secs(1)).await;
            }
            let passed_h = seconds_between(begin(), self.station.true_time()) / 3600.0;
            if passed_h >= (self.memory_kib.len() + 1) as f64 {
                self.memory_kib.push(resident_kib());
            }
        }
    }

    /// Prints the resident memory and its largest growth. Returns the growth after the first day.
    fn print_memory(&self) -> f64 {
        let megabytes: Vec<u64> = self.memory_kib.iter().map(|kib| kib / 1024).collect();
        println!("resident memory at the end of each hour, MiB: {megabytes:?}");
        let growth_after = |hours: usize| {
            let after = self.memory_kib.get(hours.saturating_sub(1)..).unwrap_or_default();
            let first = after.first().copied().unwrap_or(1) as f64;
            after.iter().max().map_or(0.0, |max| *max as f64 / first - 1.0)
        };
        for (name, hours) in [("hour", 1), ("day", DAY_H)] {
            println!("growth after the first {name}: {:.1} %", 100.0 * growth_after(hours));
        }
        growth_after(DAY_H)
    }
}

fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
    line.trim().trim_end_matches("kB").trim().parse().unwrap_or_default()
}

/// Operator who intervenes only if automatic operation does not come back; the test counts each
/// time.
#[derive(Default)]
struct Operator {
    /// Antennas whose automatic operation is off, with the time and the reason.
    idle: Vec<(AntennaId, Timestamp, Operation)>,
    touches: Vec<(AntennaId, Timestamp, Operation)>,
    /// Tracks that waited for an answer.
    questions: Vec<(AntennaId, Timestamp)>,
    asking: Vec<AntennaId>,
}

impl Operator {
    fn look(&mut self, client: &Client, now: Timestamp) {
        for antenna in &client.snapshot().antennas {
            let id = antenna.id();
            let track = antenna.snapshot.program_track.as_ref();
            if !track.is_some_and(|track| track.awaits_operator) {
                self.asking.retain(|asking| *asking != id);
            } else if !self.asking.contains(&id) {
                self.asking.push(id);
                self.questions.push((id, now));
            }
            if antenna.operation.is_on() {
                self.idle.retain(|(idle, ..)| *idle != id);
                continue;
            }
            let idle = self.idle.iter().find(|(idle, ..)| *idle == id);
            let Some((_, since, _)) = idle else {
                self.idle.push((id, now, antenna.operation.clone()));
                continue;
            };
            // After a start, automatic operation is off until the unit has rested.
            let is_start = antenna.operation == Operation::Off(OffBecause::NotSwitchedOn);
            if is_start && seconds_between(*since, now) < OPERATOR_COMES_S {
                continue;
            }
            self.touches.push((id, now, antenna.operation.clone()));
            self.idle.retain(|(idle, ..)| *idle != id);
            let command = match antenna.operation {
                Operation::Suspended { .. } => Command::GoOn(id),
                Operation::On(_) | Operation::Off(_) => {
                    Command::SetAutomatic { antenna: id, is_on: true }
                }
            };
            // The operator sends the command again if Azel refused it.
            let _ = client.send(command);
        }
    }

    fn print(&self) {
        println!("{} touches needed, {} questions", self.touches.len(), self.questions.len());
        for (antenna, at, operation) in &self.touches {
            println!("  touch: antenna {} at {at}: {operation:?}", antenna.0);
        }
        for (antenna, at) in &self.questions {
            println!("  question: antenna {} at {at}", antenna.0);
        }
    }
}
