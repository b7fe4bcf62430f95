//! Automatic operation of a station before its first turn.

use std::{num::NonZeroU32, sync::Arc};

use jiff::Timestamp;
use tokio::sync::mpsc;

use super::*;
use crate::{
    clock::Clock,
    contract::CommandOrigin,
    controller::SPECS,
    driver::{Dial, Outside, UnitLock},
    engine::{Outbox, Settings},
    station::{self, Antenna as Config, Station},
};

/// Returns a station whose antenna is on at the start, after a run that ended in order. No unit
/// answers.
pub(in crate::engine) fn station(folder: &std::path::Path) -> (Engine, PathBuf) {
    let mut config = Config::satrak("Dish", "dish:1");
    config.id = AntennaId(1);
    config.automatic.is_on_at_start = true;
    let station = Station { antennas: vec![config], ..Station::default() };
    let path = folder.join("station.toml");
    station::save(&station, &path, SPECS).unwrap();
    let left = path.with_extension(at_start::EXTENSION);
    std::fs::write(&left, "is_orderly = true").unwrap();
    let settings = Settings { path: Some(path), ..Settings::default() };
    let dial = Arc::new(|_: &Config, _: Arc<dyn UnitLock>| -> Dial {
        Box::new(|| Box::pin(std::future::pending()))
    });
    let clock = Clock::at_speed(Timestamp::UNIX_EPOCH, NonZeroU32::MIN);
    let (events, _) = mpsc::channel(1);
    let (requests, _) = mpsc::channel(1);
    let outbox = Outbox { events, wake: Arc::new(|| {}) };
    let outside = Outside { dial, ..Outside::from(clock) };
    let (engine, _) = Engine::new(&settings, outside, outbox, requests.downgrade()).unwrap();
    (engine, left)
}

#[test]
fn a_stop_before_the_first_turn_keeps_it_off_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let (mut engine, left) = station(folder.path());
    assert!(engine.antennas[0].shown.operation.is_on());
    engine.note_stop(&Stopped {
        instant: engine.steady,
        origin: CommandOrigin::Window,
        antennas: Vec::new(),
        elsewhere: Vec::new(),
        tracked: Vec::new(),
        is_for_all: true,
        newest_session: engine.sessions,
    });
    assert!(!LastRun::load(&left).switched_off.is_empty());
    engine.end_automatic();
    assert!(!LastRun::load(&left).allows(AntennaId(1)));
}
