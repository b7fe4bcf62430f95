//! Whole stations in memory: simulators instead of units and a clock for each station,
//! side by side in one process.

use std::{
    num::NonZeroU32,
    sync::{Arc, mpsc},
    thread,
    time::{Duration, Instant},
};

use azel::{
    astro::time::seconds_between,
    cli::serve::{Ended, Wake, until_the_end},
    clock::Clock,
    driver::{self, Dial, Outside, Stream},
    engine::{
        Client, Command, Handle, Settings, Snapshot,
        alarms::AlarmKind,
        status::{AntennaStatus, LinkStatus},
    },
    orbit::{PassSearch, Propagator, bundled, passes},
    plan::{ProgramTrack, Target},
    sim::{rc2000c, rotator_genius, satrak},
    station::{self, Antenna, AntennaId, Notices, Station},
};
use jiff::{Timestamp, ToSpan as _};

/// Longer than any step here takes, in real time.
const PATIENCE: Duration = Duration::from_mins(1);
/// Interval of looks, in real time.
const LOOK: Duration = Duration::from_millis(20);
/// Speed, in multiples of real time.
const FAST: NonZeroU32 = NonZeroU32::new(200).unwrap();

fn start() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

/// One unit of each make in memory.
#[derive(Clone)]
struct Units {
    dish: satrak::Control,
    mast: rotator_genius::Control,
    horn: rc2000c::Control,
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
        let options = satrak::Options::new(Station::default().site, start);
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
                    "Dish" => units.dish.serve(far).await,
                    "Mast" => units.mast.serve(far).await,
                    _ => units.horn.serve(far).await,
                }
            });
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        })
    }

    fn all_stand(&self) -> bool {
        let mast = self.mast.state().rotators;
        !self.dish.state().is_moving
            && !mast.iter().any(|rotator| rotator.is_turning)
            && !self.horn.state().is_turning
    }
}

/// A station in memory.
struct Scene {
    units: Units,
    station: Handle,
    end: mpsc::SyncSender<Wake>,
    woken: mpsc::Receiver<Wake>,
    _folder: tempfile::TempDir,
}

impl Scene {
    fn at_speed(speed: NonZeroU32) -> Self {
        Self::with(start(), speed, Notices::default())
    }

    fn with(start: Timestamp, speed: NonZeroU32, notices: Notices) -> Self {
        let clock = Clock::at_speed(start, speed);
        let units = Units::new(&clock, start);
        let station = Station {
            antennas: vec![
                Antenna::satrak("Dish", "dish:1"),
                Antenna::genius("Mast", "mast:1"),
                Antenna::rc2000c("Horn", "horn:1"),
            ],
            notices,
            ..Station::default()
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        station::save(&station, &path).unwrap();
        let settings = Settings {
            path: Some(path),
            library: Some(folder.path().join("elements")),
            ..Settings::default()
        };
        let dialled = units.clone();
        let outside =
            Outside { clock, dial: Arc::new(move |antenna: &Antenna| dialled.dial(antenna)) };
        let (end, woken) = mpsc::sync_channel(1);
        let by_station = end.clone();
        let wake = Arc::new(move || {
            let _ = by_station.try_send(Wake::Station);
        });
        let station = Handle::start(settings, outside, wake).unwrap();
        Self { units, station, end, woken, _folder: folder }
    }

    fn client(&self) -> Client {
        self.station.client().clone()
    }
}

fn until<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let end = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(Instant::now() < end, "waited too long for {what}");
        thread::sleep(LOOK);
    }
}

fn antenna(client: &Client, name: &str) -> Option<(AntennaId, AntennaStatus)> {
    let snapshot = client.snapshot();
    let antenna = snapshot.antennas.iter().find(|antenna| antenna.config.name == name)?;
    Some((antenna.id(), AntennaStatus::of(antenna)))
}

/// Waits until the antenna has been measured; connects an RC2000C for it.
fn measured(client: &Client, name: &str) -> AntennaId {
    until(name, || {
        let (id, status) = antenna(client, name)?;
        if status.link == LinkStatus::Off {
            let _ = client.send(Command::Antenna(id, driver::Command::Connect));
        }
        status.measured_at.map(|_| id)
    })
}

fn passed_s(client: &Client) -> f64 {
    seconds_between(start(), client.now().utc)
}

/// Sends `command` until the antenna is seen to move: at this speed a busy computer may
/// act on it too late.
fn move_by(client: &Client, name: &str, command: &driver::Command) {
    let id = measured(client, name);
    until("motion", || {
        let _ = client.send(Command::Antenna(id, command.clone()));
        let moves = antenna(client, name)?.1.moves;
        (moves == Some(true)).then_some(())
    });
}

#[test]
fn two_stations_live_in_one_process_one_of_them_at_200_times_real_time() {
    let (real, fast) = (Scene::at_speed(NonZeroU32::MIN), Scene::at_speed(FAST));
    let (here, there) = (real.client(), fast.client());
    for name in ["Dish", "Mast", "Horn"] {
        measured(&here, name);
        measured(&there, name);
    }
    let before = here.now().steady;
    let went = there.now().steady;
    let sun = ProgramTrack {
        target: Target::Sun,
        site: there.snapshot().station.site,
        passes: Vec::new(),
    };
    move_by(&there, "Mast", &driver::Command::ProgramTrack(Box::new(sun)));
    until("ten minutes", || ((there.now().steady - went).as_secs() > 600).then_some(()));
    assert!((here.now().steady - before).as_secs() < 60, "{:?}", here.now().steady - before);
    assert!(passed_s(&there) > 600.0);
    assert!(antenna(&here, "Mast").unwrap().1.tracks.is_none(), "they share nothing");
    assert!(real.units.all_stand());
    there.stop_all();
    until("standstill", || fast.units.all_stand().then_some(()));
}

#[test]
fn a_marked_pass_is_reminded_of_and_its_alarm_ends_when_an_antenna_takes_it() {
    const ISS: u32 = 25_544;
    let station = Station::default();
    let propagator = Propagator::new(bundled().unwrap().get(ISS).unwrap()).unwrap();
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let aos = passes(&propagator, &search, &|| false)[0].aos.time;
    let notices = Notices { reminder_min: 10.0, reminders: [ISS].into(), ..Notices::default() };
    let scene = Scene::with(aos - 5.minutes(), NonZeroU32::new(30).unwrap(), notices);
    let client = scene.client();
    let is_raised = || {
        let snapshot = client.snapshot();
        let mut standing = snapshot.alarms.list().iter().filter(|alarm| !alarm.is_over());
        standing.any(|alarm| matches!(alarm.kind, AlarmKind::NoAntennaFor { .. }))
    };
    let reminder = until("the reminder", || client.snapshot().reminders.first().cloned());
    assert!(seconds_between(reminder.aos(), aos).abs() < 1.0, "{reminder:?}");
    assert_eq!((reminder.pass.0, &*reminder.name), (ISS, "ISS"));
    until("the alarm", || is_raised().then_some(()));
    assert!(seconds_between(client.snapshot().at.utc, aos) <= 30.0);
    let mast = measured(&client, "Mast");
    until("its end", || {
        let pass = reminder.pass;
        let _ = client.send(Command::ProgramTrackPass { antenna: mast, pass });
        (!is_raised()).then_some(())
    });
    assert!(client.snapshot().at.utc < reminder.los, "not by LOS");
    until("the track", || antenna(&client, "Mast")?.1.tracks);
}

/// Serializes every snapshot that it gets of a station until the station ends; returns
/// their number.
fn write_down(mut client: Client) -> usize {
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    let mut count = 0;
    while runtime.block_on(client.changed()) {
        let snapshot = client.snapshot();
        let text = serde_json::to_string(&*snapshot).unwrap();
        let back: Snapshot = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
        // Only the catalog and the pass lists leave anything out.
        let shown = |of: &Snapshot| {
            let of = (
                (&of.at, &of.time_sync, &of.station, &of.sources),
                (&of.antennas, &of.alarms, &of.reminders),
            );
            format!("{of:?}")
        };
        assert_eq!(shown(&back), shown(&snapshot));
        count += 1;
    }
    count
}

/// Switches one of nine kinds of trouble.
fn trouble(kind: u32, units: &Units, is_on: bool) {
    use rc2000c::Fault as Line;
    use rotator_genius::Fault as Socket;
    use satrak::Fault;
    match kind % 9 {
        0 => units.dish.set_fault(Fault::Silence, is_on),
        1 => units.dish.set_fault(Fault::Garbage, is_on),
        2 => units.dish.set_fault(Fault::HangUp, is_on),
        3 => units.mast.set_fault(Socket::DropReply, is_on),
        4 => units.mast.set_fault(Socket::Split, is_on),
        5 => units.mast.drop_clients(),
        6 => units.horn.set_fault(Line::BitError, is_on),
        7 => units.horn.set_fault(Line::Truncate, is_on),
        _ => units.horn.drop_clients(),
    }
}

/// An hour of a station without a window, in the main loop of the program.
#[test]
fn a_served_station_lives_an_hour_with_trouble_on_the_lines() {
    let scene = Scene::at_speed(FAST);
    let (client, units, end) = (scene.client(), scene.units.clone(), scene.end.clone());
    let witness = scene.client();
    let written = thread::Builder::new().name("writes".to_owned()).spawn(|| write_down(witness));
    let driving = thread::Builder::new().name("drives".to_owned()).spawn(move || {
        let site = client.snapshot().station.site;
        let sun = || ProgramTrack { target: Target::Sun, site, passes: Vec::new() };
        move_by(&client, "Mast", &driver::Command::ProgramTrack(Box::new(sun())));
        measured(&client, "Horn");
        let mut count = 0;
        while passed_s(&client) < 3600.0 {
            trouble(count, &units, true);
            let from = client.now().steady;
            until("20 s", || ((client.now().steady - from).as_secs() >= 20).then_some(()));
            trouble(count, &units, false);
            let from = client.now().steady;
            until("30 s", || ((client.now().steady - from).as_secs() >= 30).then_some(()));
            count += 1;
        }
        println!("an hour with {count} troubles");
        for name in ["Dish", "Mast", "Horn"] {
            until("the link after all that", || {
                let (id, status) = antenna(&client, name)?;
                if status.link == LinkStatus::Off {
                    let _ = client.send(Command::Antenna(id, driver::Command::Connect));
                }
                (status.link == LinkStatus::Up).then_some(())
            });
        }
        end.send(Wake::End).unwrap();
    });
    let Scene { station, woken, units, .. } = scene;
    let mut lines = 0_u32;
    let Ended { not_proved, broke_down } = until_the_end(station, &woken, &mut |_| lines += 1);
    driving.unwrap().join().unwrap();
    let written = written.unwrap().join().unwrap();
    assert!(written > 100, "{written} snapshots were written down");
    assert!(!broke_down);
    assert_eq!(not_proved, [""; 0]);
    assert!(units.all_stand());
    assert!(lines > 10, "{lines} lines of an hour with trouble");
}
