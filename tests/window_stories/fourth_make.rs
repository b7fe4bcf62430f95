//! A make of controller that the library does not know: described and driven
//! here, it is read from the station file, set up in the form and moved.

use std::{
    collections::VecDeque,
    io::{BufRead as _, BufReader, Write as _},
    net::TcpListener,
    sync::{Arc, mpsc},
    thread,
    time::{Duration, Instant},
};

use azel::{
    app::View,
    astro::{Angle, AzEl},
    controller::{
        AntennaState, Axis, AxisMotion, Capabilities, Device, Extent, Happening, JogSpeeds, Make,
        Measured, Moment, Motion, Moves, Pointing, Question, TrackTarget, WireLine, aimed,
        panel::Act,
        satrak,
        settings::{Change, Group},
    },
    driver::{AntennaHandle, Clock, Command, Driver, Snapshot, StopState},
    makes,
    station::{
        self, Antenna, Choice, Connection, Holds, Kind, Link, Setting, Station, Table, Usual, Value,
    },
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::{
    preferences::{saved, write},
    rig::{self, SIZES, asked, says, settle},
};

static KIND: Kind = Kind {
    key: "lever",
    name: "Lever",
    link: Link::Tcp,
    usual_address: "lever.example:1",
    usual: Usual { beam_width_deg: 7.0, ..satrak::KIND.usual },
    settings: &[&CODE, &GEAR, &SHAFTS],
    makes: &[&MAKE],
    make: |_| &MAKE,
    open: |antenna| Box::new(Lever::of(&antenna.connection)),
};

static CODE: Setting = Setting {
    key: "code",
    table: None,
    label: "Access code",
    holds: Holds::Text,
    usual: Value::Text(String::new()),
    note: |value| (*value == Value::Text(String::new())).then_some("It takes no orders so."),
};

static GEAR: Setting = Setting {
    key: "gear",
    table: Some(DRIVE),
    label: "Gear",
    holds: Holds::OneOf(&[
        Choice { value: Value::Word("low"), name: "Low gear" },
        Choice { value: Value::Word("high"), name: "High gear" },
    ]),
    usual: Value::Word("low"),
    note: |_| None,
};

static SHAFTS: Setting = Setting {
    key: "shafts",
    table: Some(DRIVE),
    label: "Shafts",
    holds: Holds::Whole(1..=4),
    usual: Value::Whole(2),
    note: |_| None,
};

const DRIVE: Table = Table { key: "drive", title: "Drive" };

static MAKE: Make = Make {
    key: "lever",
    name: "Archimedes Lever",
    closed_note: None,
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 1.0,
        position_step_deg: 0.0,
        has_elevation: true,
        jog: JogSpeeds::AnyRate,
        jogs_one_axis: false,
        steps: false,
        ends_jogs: false,
        waits_for_word: false,
        stop_note: None,
    },
    groups: &[],
    actions: &[],
};

/// Speaks in lines: a code, `P?` answered with a place, `G` and a place, `S`.
struct Lever {
    greeting: String,
    state: AntennaState,
    orders: VecDeque<String>,
    heard: Vec<u8>,
    /// When the place was asked for that was not told yet.
    asked: Option<Instant>,
    next_poll: Option<Instant>,
}

const PERIOD: Duration = Duration::from_millis(50);

impl Lever {
    fn of(connection: &Connection) -> Self {
        let (code, gear) = (connection.text(&CODE), connection.text(&GEAR));
        Self {
            greeting: format!("C {code} {gear} {}\n", connection.whole(&SHAFTS)),
            state: AntennaState::default(),
            orders: VecDeque::new(),
            heard: Vec::new(),
            asked: None,
            next_poll: None,
        }
    }
}

impl Device for Lever {
    fn capabilities(&self) -> Capabilities {
        MAKE.capabilities
    }

    fn link_up(&mut self, now: Moment) {
        self.state.link_since = Some(now.steady);
        self.orders = [self.greeting.clone()].into();
        self.next_poll = Some(now.steady);
    }

    fn link_down(&mut self, _: Moment) {
        (self.asked, self.next_poll) = (None, None);
    }

    fn sent(&mut self, _: &[u8], _: Moment) {}

    fn next_wire_line(&mut self) -> Option<WireLine> {
        None
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.heard.extend_from_slice(bytes);
        while let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = self.heard.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line);
            let place: Vec<f64> =
                line.split(' ').filter_map(|word| word.trim().parse().ok()).collect();
            let (&[azimuth, elevation], Some(asked)) = (&place[..], self.asked.take()) else {
                continue;
            };
            let axis = |angle_deg| Axis {
                angle_deg: Some(angle_deg),
                motion: AxisMotion::Still,
                plus_limit: false,
                minus_limit: false,
            };
            self.state.measured = Some(Measured {
                at: now.utc,
                asked,
                received: now.steady,
                pointing: AzEl::from_degrees(azimuth, elevation).into(),
                axes: [axis(azimuth), axis(elevation)],
            });
            self.state.motion_lock = Some(false);
            self.state.traffic.replies += 1;
            self.state.traffic.last_reply = Some(now.steady);
        }
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        if let Some(order) = self.orders.pop_front() {
            return Some(order.into_bytes());
        }
        self.next_poll.filter(|due| *due <= now.steady && self.asked.is_none())?;
        self.next_poll = Some(now.steady + PERIOD);
        self.asked = Some(now.steady);
        Some(b"P?\n".to_vec())
    }

    fn due(&self, now: Moment) -> Instant {
        let next = now.steady + PERIOD;
        if self.orders.is_empty() {
            self.next_poll.unwrap_or(next).max(now.steady)
        } else {
            now.steady
        }
    }

    fn halt(&mut self, _: Extent, _: Moment) -> Vec<u8> {
        self.orders.clear();
        b"S\n".to_vec()
    }

    fn prepare(&mut self, _: TrackTarget) {}

    fn groups(&self) -> &'static [&'static Group] {
        MAKE.groups
    }

    fn read_group(&mut self, _: &str) {}

    fn settle(&mut self, _: Change, _: Moment) {}

    fn ask(&mut self, _: Question) {}

    fn disable_auto(&mut self) {}

    fn motion_under_way(&self) -> bool {
        !self.orders.is_empty()
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_happening(&mut self) -> Option<Happening> {
        None
    }

    fn patience(&self) -> Duration {
        Duration::from_secs(5)
    }

    fn poll_period(&self) -> Duration {
        PERIOD
    }
}

impl Moves for Lever {
    fn start(&mut self, motion: Motion) {
        let Motion::Position { azimuth, elevation } = motion else { return };
        let measured = self.state.measured.map(|measured| measured.pointing);
        let aim = aimed(azimuth, elevation, measured);
        if let Some(AzEl { azimuth, elevation }) = aim.direction() {
            self.orders.push_back(format!("G {} {}\n", azimuth.degrees(), elevation.degrees()));
        }
    }

    fn act(&mut self, _: Act) {}
}

/// A unit that is at once where it is sent; the lines that it hears, questions
/// left out.
fn unit() -> (String, mpsc::Receiver<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let (tell, heard) = mpsc::sync_channel(64);
    let serve = move || {
        let (mut stream, _) = listener.accept().unwrap();
        let lines = BufReader::new(stream.try_clone().unwrap()).lines();
        let mut place = "10 20".to_owned();
        for line in lines.map_while(Result::ok) {
            if line == "P?" {
                writeln!(stream, "P {place}").unwrap();
                continue;
            }
            if let Some(aim) = line.strip_prefix("G ") {
                aim.clone_into(&mut place);
            }
            // Whoever listened may have seen enough.
            let _ = tell.try_send(line);
        }
    };
    thread::Builder::new().name("lever".to_owned()).spawn(serve).unwrap();
    (address, heard)
}

fn all_kinds() -> Vec<&'static Kind> {
    let mut kinds = makes::kinds();
    kinds.push(&KIND);
    kinds
}

fn at(shown: &Snapshot, azimuth_deg: f64, elevation_deg: f64) -> bool {
    let there = Pointing::from(AzEl::from_degrees(azimuth_deg, elevation_deg));
    let measured = shown.state.measured.map(|measured| measured.pointing);
    let off = measured.and_then(|measured| measured.separation(there));
    off.is_some_and(|off| off.degrees() < 0.01)
}

#[test]
fn its_antenna_is_read_from_the_station_file_and_comes_back_as_it_was_saved() {
    const TEXT: &str = "[[antenna]]\n[antenna.connection]\ncontroller = 'lever'\n\
        address = 'tower:7'\ncode = 'eureka'\nlength = 3\n\
        [antenna.connection.drive]\ngear = 'reverse'\nshafts = 4\noil = true\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    std::fs::write(&path, TEXT).unwrap();
    let loaded = station::load(&path, &all_kinds()).unwrap();
    let notes: Vec<&str> = loaded.notes.iter().map(|note| &*note.place).collect();
    assert_eq!(
        notes,
        [
            "antenna[0].connection.drive.gear",
            "antenna[0].connection.drive.oil",
            "antenna[0].connection.length"
        ]
    );
    let [antenna] = &loaded.station.antennas[..] else { panic!("{:?}", loaded.station) };
    let connection = &antenna.connection;
    assert_eq!((&*antenna.name, antenna.beam_width_deg.round()), ("Lever", 7.0));
    assert_eq!((connection.text(&CODE), connection.text(&GEAR)), ("eureka", "low"));
    assert_eq!(connection.whole(&SHAFTS), 4);

    let mut station = loaded.station.clone();
    station.antennas[0].connection.put(&GEAR, Value::Word("high")).unwrap();
    station::save(&station, &path).unwrap();
    let again = station::load(&path, &all_kinds()).unwrap();
    assert_eq!((again.station, again.notes), (station, Vec::new()));

    let known = station::load(&path, &makes::kinds()).unwrap();
    assert_eq!(known.station.antennas, [], "without its kind it is not known");
}

#[test]
fn its_own_settings_are_fields_of_the_form() {
    for size in SIZES {
        let antenna = KIND.antenna("Lever", KIND.usual_address);
        let mut model = crate::makes::model(antenna.clone(), rig::quiet());
        (model.view, model.station.antennas) = (View::Preferences, vec![antenna]);
        let mut window = rig::window(size, model);
        assert!(says(&window, "Antenna 1: Archimedes Lever"));
        assert!(says(&window, "It takes no orders so.") && says(&window, "Drive"));
        write(&mut window, "Address of the Lever", "tower:8");
        write(&mut window, "Access code", "eureka");
        assert!(!says(&window, "It takes no orders so."));
        let gear = window.get_by_role_and_label(Role::RadioButton, "High gear");
        gear.scroll_to_me();
        settle(&mut window);
        window.get_by_role_and_label(Role::RadioButton, "High gear").click();
        settle(&mut window);
        write(&mut window, "Shafts", "5");
        assert!(says(&window, "Shafts must be a whole number from 1 to 4."));
        write(&mut window, "Shafts", "3");
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        let station: Station = saved(asked(&mut window));
        let connection = &station.antennas[0].connection;
        assert_eq!((&*connection.address, connection.text(&CODE)), ("tower:8", "eureka"));
        assert_eq!((connection.text(&GEAR), connection.whole(&SHAFTS)), ("high", 3));
    }
}

#[test]
fn it_is_told_its_settings_read_sent_and_stopped_and_shown() {
    let (address, heard) = unit();
    let mut antenna: Antenna = KIND.antenna("Lever", &address);
    antenna.connection.put(&CODE, "eureka").unwrap();
    let (woke, woken) = mpsc::sync_channel(1);
    let wake = Arc::new(move || {
        let _ = woke.try_send(());
    });
    let driver = Driver::start(Clock::new(jiff::Timestamp::now), wake).unwrap();
    let handle: AntennaHandle = driver.open(&antenna);
    let until = |is_so: &dyn Fn(&Snapshot) -> bool| {
        while !is_so(&handle.snapshot()) {
            woken.recv_timeout(Duration::from_secs(20)).unwrap();
        }
    };
    let next = || heard.recv_timeout(Duration::from_secs(20)).unwrap();
    until(&|shown| at(shown, 10.0, 20.0));
    handle
        .send(Command::Position {
            azimuth: Some(Angle::from_degrees(200.0)),
            elevation: Some(Angle::from_degrees(40.0)),
        })
        .unwrap();
    until(&|shown| at(shown, 200.0, 40.0));
    handle.stop();
    until(&|shown| matches!(shown.stop, StopState::Stopped { .. }));
    assert_eq!([next(), next(), next()], ["C eureka low 2", "G 200 40", "S"]);

    let mut shown = crate::makes::model(antenna, Snapshot::clone(&handle.snapshot()));
    shown.view = View::Operate;
    let window = rig::window(SIZES[0], shown);
    assert!(says(&window, "200.00"), "the card shows where it is");
}
