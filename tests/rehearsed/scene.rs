//! A station in memory with one simulated unit of each make.

use std::{
    fs,
    num::NonZeroU32,
    path::Path,
    sync::{Arc, LazyLock, mpsc},
    thread,
    time::{Duration, Instant},
};

use azel::{
    astro::time::seconds_between,
    cli::serve::Wake,
    clock::Clock,
    controller::satrak::ELEMENT_FILE,
    driver::{self, Dial, Outside, Stream},
    engine::{
        Client, Command, Handle, Settings,
        automatic::{DayEvent, Flown, Operation},
        status::{AntennaStatus, LinkStatus},
    },
    orbit::{Elements, bundled},
    sim::{rc2000c, rotator_genius, satrak, satrak::BUNDLED_FILE},
    station::{self, Antenna, AntennaId, Station},
};
use jiff::Timestamp;

/// Elements of the favourites. To read them takes long by a clock at speed.
static FAVOURITES: LazyLock<Vec<Elements>> = LazyLock::new(|| {
    let catalog = bundled().unwrap();
    let favourites = Station::default().favourites.numbers();
    favourites.iter().filter_map(|number| catalog.get(*number).cloned()).collect()
});

/// Longer than any step here takes, in real time.
pub(super) const PATIENCE: Duration = Duration::from_mins(1);
/// Interval of looks, in real time.
pub(super) const LOOK: Duration = Duration::from_millis(20);
/// Speed, in multiples of real time.
pub(super) const FAST: NonZeroU32 = NonZeroU32::new(200).unwrap();

pub(super) fn start() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

/// One unit of each make in memory.
#[derive(Clone)]
pub(super) struct Units {
    pub(super) dish: satrak::Control,
    pub(super) mast: rotator_genius::Control,
    pub(super) horn: rc2000c::Control,
}

impl Units {
    fn new(clock: &Clock, start: Timestamp) -> Self {
        let pair = rotator_genius::Options {
            rotators: [
                rotator_genius::RotatorOptions::default(),
                rotator_genius::RotatorOptions::elevation(),
            ],
            ..rotator_genius::Options::default()
        };
        let mut options = satrak::Options::new(Station::default().site, start);
        options.elements.insert(BUNDLED_FILE.to_owned(), FAVOURITES.clone());
        Self {
            dish: satrak::Control::on_clock(&options, clock.clone()),
            mast: rotator_genius::Control::on_clock(&pair, clock.clone()),
            horn: rc2000c::Control::on_clock(&rc2000c::Options::default(), clock.clone()),
        }
    }

    fn dial(&self, antenna: &Antenna) -> Dial {
        let (units, name) = (self.clone(), antenna.name.clone());
        Box::new(move || {
            let (near, far) = tokio::io::duplex(4096);
            let (units, name) = (units.clone(), name.clone());
            tokio::spawn(async move {
                match &*name {
                    // A unit without an antenna is called by its address.
                    "Dish" | "dish:1" => units.dish.serve(far).await,
                    "Mast" => units.mast.serve(far).await,
                    _ => units.horn.serve(far).await,
                }
            });
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        })
    }

    pub(super) fn all_stand(&self) -> bool {
        let mast = self.mast.state().rotators;
        !self.dish.state().is_moving
            && !mast.iter().any(|rotator| rotator.is_turning)
            && !self.horn.state().is_turning
    }
}

/// A station with an antenna of each make.
pub(super) fn station() -> Station {
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

/// A station in memory.
pub(super) struct Scene {
    pub(super) units: Units,
    pub(super) station: Handle,
    pub(super) end: mpsc::SyncSender<Wake>,
    pub(super) woken: mpsc::Receiver<Wake>,
    clock: Clock,
    folder: tempfile::TempDir,
    has_marks: bool,
    has_record: bool,
}

impl Scene {
    pub(super) fn at_speed(speed: NonZeroU32) -> Self {
        Self::with(start(), speed, &station())
    }

    pub(super) fn with(start: Timestamp, speed: NonZeroU32, station: &Station) -> Self {
        Self::made(start, speed, station, [false; 2])
    }

    /// One that is recorded. At a high speed, the film of some thousand pictures a second would
    /// leave the sessions no processor.
    pub(super) fn recorded(start: Timestamp, speed: NonZeroU32, station: &Station) -> Self {
        Self::made(start, speed, station, [false, true])
    }

    /// One that keeps records of what is owed to units.
    pub(super) fn marking(start: Timestamp, speed: NonZeroU32, station: &Station) -> Self {
        Self::made(start, speed, station, [true, false])
    }

    fn made(
        start: Timestamp,
        speed: NonZeroU32,
        station: &Station,
        [has_marks, has_record]: [bool; 2],
    ) -> Self {
        LazyLock::force(&FAVOURITES);
        let clock = Clock::at_speed(start, speed);
        let units = Units::new(&clock, start);
        let folder = tempfile::tempdir().unwrap();
        station::save(station, &folder.path().join("station.toml")).unwrap();
        Self::begin(units, clock, folder, [has_marks, has_record])
    }

    fn begin(
        units: Units,
        clock: Clock,
        folder: tempfile::TempDir,
        [has_marks, has_record]: [bool; 2],
    ) -> Self {
        let settings = Settings {
            path: Some(folder.path().join("station.toml")),
            library: Some(folder.path().join("elements")),
            records: has_record.then(|| folder.path().join("records")),
            marks: has_marks.then(|| folder.path().join("marks")),
            ..Settings::default()
        };
        let dialled = units.clone();
        let dial = Arc::new(move |antenna: &Antenna| dialled.dial(antenna));
        let outside = Outside { clock: clock.clone(), dial };
        let (end, woken) = mpsc::sync_channel(1);
        let by_station = end.clone();
        let wake = Arc::new(move || {
            let _ = by_station.try_send(Wake::Station);
        });
        let station = Handle::start(settings, outside, wake).unwrap();
        Self { units, station, end, woken, clock, folder, has_marks, has_record }
    }

    /// The station ends as it should, or as in a crash, and is started again; the units go on.
    pub(super) fn started_again(self, is_crash: bool) -> Self {
        let Self { units, station, clock, folder, has_marks, has_record, .. } = self;
        let left = folder.path().join("station.automatic.toml");
        let while_running = fs::read(&left).unwrap();
        drop(station);
        if is_crash {
            fs::write(&left, while_running).unwrap();
        }
        Self::begin(units, clock, folder, [has_marks, has_record])
    }

    pub(super) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn client(&self) -> Client {
        self.station.client().clone()
    }
}

pub(super) fn until<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let end = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(Instant::now() < end, "waited too long for {what}");
        thread::sleep(LOOK);
    }
}

pub(super) fn antenna(client: &Client, name: &str) -> Option<(AntennaId, AntennaStatus)> {
    let snapshot = client.snapshot();
    let antenna = snapshot.antennas.iter().find(|antenna| antenna.config.name == name)?;
    Some((antenna.id(), AntennaStatus::of(antenna)))
}

/// Waits until the antenna has been measured; connects an RC2000C for it.
pub(super) fn measured(client: &Client, name: &str) -> AntennaId {
    until(name, || {
        let (id, status) = antenna(client, name)?;
        if status.link == LinkStatus::Off {
            let _ = client.send(Command::Antenna(id, driver::Command::Connect));
        }
        status.measured_at.map(|_| id)
    })
}

pub(super) fn passed_s(client: &Client) -> f64 {
    seconds_between(start(), client.now().utc)
}

/// Sends `command` until the antenna is seen to move: at this speed a busy computer may
/// act on it too late.
pub(super) fn move_by(client: &Client, name: &str, command: &driver::Command) {
    let id = measured(client, name);
    until("motion", || {
        let _ = client.send(Command::Antenna(id, command.clone()));
        let moves = antenna(client, name)?.1.moves;
        (moves == Some(true)).then_some(())
    });
}

pub(super) fn operation(client: &Client, antenna: AntennaId) -> Operation {
    let snapshot = client.snapshot();
    snapshot.antennas.iter().find(|of| of.id() == antenna).unwrap().operation.clone()
}

pub(super) fn set_automatic(client: &Client, antenna: AntennaId, is_on: bool) {
    until("automatic operation", || {
        let _ = client.send(Command::SetAutomatic { antenna, is_on });
        (operation(client, antenna).is_on() == is_on).then_some(())
    });
}

/// The passes of the schedule that are over, with what became of them.
pub(super) fn flown(client: &Client) -> Vec<(AntennaId, Flown)> {
    let day = Arc::clone(&client.snapshot().day);
    let flown = day.iter().filter_map(|line| match &line.what {
        DayEvent::Flown(flown) => Some((line.antenna, flown.clone())),
        _ => None,
    });
    flown.collect()
}
