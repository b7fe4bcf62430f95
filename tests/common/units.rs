//! One simulated unit of each make in memory, and waits for the snapshots of their antennas.

use std::{
    sync::{Arc, LazyLock},
    time::Duration,
};

use azel::{
    clock::Clock,
    contract::{
        Command,
        driver::{self, TimeSync},
    },
    controller::satrak::ELEMENT_FILE,
    driver::{Dial, Outside, Stream, UnitLock},
    engine::{
        Client,
        status::{AntennaStatus, LinkStatus},
    },
    orbit::{Elements, bundled},
    sim::{
        rc2000c, rotator_genius,
        satrak::{self, BUNDLED_FILE},
    },
    station::{Antenna, AntennaId, Station},
};
use jiff::Timestamp;
use tokio::time;

/// Elements of the favourites, read once because reading takes long on an accelerated clock.
pub(crate) static FAVOURITES: LazyLock<Vec<Elements>> = LazyLock::new(|| {
    let catalog = bundled().unwrap();
    let favourites = Station::default().favourites.numbers();
    favourites.iter().filter_map(|number| catalog.get(*number).cloned()).collect()
});

/// Time limit of any wait, by tokio's clock. Only live stations run without pausing this clock.
const PATIENCE: Duration = Duration::from_hours(6);
/// Interval between two looks at a snapshot, by tokio's clock.
pub(crate) const LOOK: Duration = Duration::from_millis(50);

pub(crate) fn start() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

/// One unit of each make in memory.
#[derive(Clone)]
pub(crate) struct Units {
    pub(crate) dish: satrak::Control,
    pub(crate) mast: rotator_genius::Control,
    pub(crate) horn: rc2000c::Control,
    /// Synchronisation state of the computer's clock.
    pub(crate) time_sync: fn() -> TimeSync,
}

impl Units {
    pub(crate) fn new(clock: &Clock) -> Self {
        Self::holding(clock, &FAVOURITES)
    }

    /// Creates the units; the Satrak has `elements` in its element file.
    pub(crate) fn holding(clock: &Clock, elements: &[Elements]) -> Self {
        // Load the favourites before reading the start time: loading takes long on a running clock.
        LazyLock::force(&FAVOURITES);
        let start = clock.now().utc;
        let pair = rotator_genius::Options {
            rotators: [
                rotator_genius::RotatorOptions::default(),
                rotator_genius::RotatorOptions::elevation(),
            ],
            ..rotator_genius::Options::default()
        };
        let mut options = satrak::Options::new(Station::default().site, start);
        options.elements.insert(BUNDLED_FILE.to_owned(), elements.to_vec());
        Self {
            dish: satrak::Control::on_clock(&options, clock.clone()),
            mast: rotator_genius::Control::on_clock(&pair, clock.clone()),
            horn: rc2000c::Control::on_clock(&rc2000c::Options::default(), clock.clone()),
            time_sync: || TimeSync::NotKnown,
        }
    }

    fn dial(&self, antenna: &Antenna) -> Dial {
        let (units, name) = (self.clone(), antenna.name.clone());
        Box::new(move || {
            let (near, far) = tokio::io::duplex(4096);
            let (units, name) = (units.clone(), name.clone());
            tokio::spawn(async move {
                match &*name {
                    // Azel names a unit without an antenna by its address.
                    "Dish" | "dish:1" => units.dish.serve(far).await,
                    "Mast" => units.mast.serve(far).await,
                    _ => units.horn.serve(far).await,
                }
            });
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        })
    }

    pub(crate) fn outside(&self, clock: &Clock) -> Outside {
        let units = self.clone();
        let dial = Arc::new(move |antenna: &Antenna, _: Arc<dyn UnitLock>| units.dial(antenna));
        Outside { dial, time_sync: self.time_sync, ..Outside::from(clock.clone()) }
    }

    pub(crate) fn all_stand(&self) -> bool {
        let mast = self.mast.state().rotators;
        !self.dish.state().is_moving
            && !mast.iter().any(|rotator| rotator.is_turning)
            && !self.horn.state().is_turning
    }
}

/// Returns a station with an antenna of each make.
pub(crate) fn station() -> Station {
    let mut station = Station {
        antennas: vec![
            Antenna::satrak("Dish", "dish:1"),
            Antenna::genius("Mast", "mast:1"),
            Antenna::rc2000c("Horn", "horn:1"),
        ],
        ..Station::default()
    };
    for (antenna, id) in station.antennas.iter_mut().zip(1..) {
        antenna.id = AntennaId(id);
    }
    station.antennas[0].connection.put(&ELEMENT_FILE, BUNDLED_FILE).unwrap();
    station
}

pub(crate) async fn until<T>(what: &str, found: impl FnMut() -> Option<T>) -> T {
    until_looking(LOOK, what, found).await
}

/// Waits as [`until`] does, with `pause` between two looks.
pub(crate) async fn until_looking<T>(
    pause: Duration,
    what: &str,
    mut found: impl FnMut() -> Option<T>,
) -> T {
    let end = time::Instant::now() + PATIENCE;
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(time::Instant::now() < end, "waited too long for {what}");
        time::sleep(pause).await;
    }
}

pub(crate) fn antenna(client: &Client, name: &str) -> Option<(AntennaId, AntennaStatus)> {
    let snapshot = client.snapshot();
    let antenna = snapshot.antennas.iter().find(|antenna| antenna.config.name == name)?;
    Some((antenna.id(), AntennaStatus::new(antenna)))
}

/// Waits for the first measured position of the antenna, and connects the antenna if its link is
/// off.
pub(crate) async fn measured(client: &Client, name: &str) -> AntennaId {
    let looked = || {
        let (id, status) = antenna(client, name)?;
        if status.link == LinkStatus::Off {
            let _ = client.send(Command::Antenna(id, driver::Command::Connect));
        }
        status.measured_at.map(|_| id)
    };
    until(name, looked).await
}
