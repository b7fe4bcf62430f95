//! Link tests of units that no antenna has yet. A station in memory runs the tests, and simulated
//! units record the requests that they receive.

use std::{
    io,
    path::Path,
    sync::{Arc, mpsc},
    time::Duration,
};

use azel::{
    clock::Clock,
    contract::{
        Command,
        claim::HolderKind,
        driver::{LinkFault, LinkFinding},
        link_tests::{LinkTest, LinkTestStage},
    },
    controller::SPECS,
    driver::{Dial, Outside, Stream},
    engine::{Handle, Settings},
    protocol::{
        rc2000c::Request as Rc2000cRequest,
        satrak::{Frame as SatrakFrame, Request as SatrakRequest},
    },
    sim::{rc2000c, rotator_genius, satrak},
    station::{self, Antenna, AntennaId, ControllerSpec, Station},
};
use jiff::Timestamp;
use tokio::io::AsyncWriteExt as _;

use crate::common::comes_back;

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_secs(20);

/// One unit of each make in memory, and strangers at the addresses that name them.
#[derive(Clone)]
struct Units {
    dish: satrak::Control,
    mast: rotator_genius::Control,
    horn: rc2000c::Control,
}

impl Units {
    fn new(clock: &Clock) -> Self {
        let site = Station::default().site;
        let gps_lock_after = Duration::ZERO;
        let options = satrak::Options::new(site, Timestamp::UNIX_EPOCH);
        let options = satrak::Options { gps_lock_after, ..options };
        Self {
            dish: satrak::Control::on_clock(&options, clock.clone()),
            mast: rotator_genius::Control::on_clock(
                &rotator_genius::Options::default(),
                clock.clone(),
            ),
            horn: rc2000c::Control::on_clock(&rc2000c::Options::default(), clock.clone()),
        }
    }

    fn dial(&self, antenna: &Antenna) -> Dial {
        let (units, connection) = (self.clone(), antenna.connection.clone());
        Box::new(move || {
            let (near, mut far) = tokio::io::duplex(4096);
            let (units, connection) = (units.clone(), connection.clone());
            let fault = match &*connection.address {
                "refused:1" => Some(io::ErrorKind::ConnectionRefused),
                "far:1" => Some(io::ErrorKind::HostUnreachable),
                "busy:1" => Some(io::ErrorKind::ResourceBusy),
                _ => None,
            };
            if let Some(fault) = fault {
                return Box::pin(async move { Err(fault.into()) });
            }
            tokio::spawn(async move {
                match (&*connection.address, connection.spec().key) {
                    ("closed:1", _) => {}
                    ("silent:1", _) => std::future::pending::<()>().await,
                    ("ssh:22", _) => {
                        far.write_all(b"SSH-2.0-OpenSSH_9.2p1 Debian\r\n").await.unwrap();
                        std::future::pending::<()>().await;
                    }
                    (_, "satrak") => drop(units.dish.serve(far).await),
                    (_, "genius") => drop(units.mast.serve(far).await),
                    (_, "rc2000c") => drop(units.horn.serve(far).await),
                    (_, make) => panic!("no unit of {make} in memory"),
                }
            });
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        })
    }
}

/// Running station on these units.
struct Bench {
    station: Handle,
    units: Units,
    wakes: mpsc::Receiver<()>,
    _folder: tempfile::TempDir,
}

impl Bench {
    fn new(antennas: Vec<Antenna>) -> Self {
        Self::claiming_in(None, antennas)
    }

    /// Starts a station that claims its units in the folder `claims`.
    fn claiming_in(claims: Option<&Path>, antennas: Vec<Antenna>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        station::save(&Station { antennas, ..Station::default() }, &path, SPECS).unwrap();
        let settings = Settings {
            path: Some(path),
            library: Some(folder.path().join("elements")),
            claims: claims.map(|folder| (folder.to_owned().into(), HolderKind::Serve)),
            ..Settings::default()
        };
        let clock = Clock::system();
        let units = Units::new(&clock);
        let served = units.clone();
        let outside = Outside {
            dial: Arc::new(move |antenna, _| served.dial(antenna)),
            ..Outside::from(clock)
        };
        let (woken, wakes) = mpsc::sync_channel(1);
        let wake = Arc::new(move || {
            let _ = woken.try_send(());
        });
        let station = Handle::start(settings, outside, wake).unwrap();
        Self { station, units, wakes, _folder: folder }
    }

    fn test(&mut self, antenna: &Antenna) -> LinkTestStage {
        let command = Command::TestLink(Box::new(antenna.clone()));
        assert!(!command.row().void_after_stop);
        assert!(self.station.client().send(command).is_ok());
        loop {
            self.station.take();
            let tests = Arc::clone(&self.station.snapshot().link_tests);
            let known = tests.iter().find(|test| test.antenna == *antenna);
            if let Some(LinkTest { stage, .. }) = known.map(comes_back)
                && stage != LinkTestStage::Working
            {
                return stage;
            }
            self.wakes.recv_timeout(PATIENCE).expect("news of the test");
        }
    }

    fn finding(&mut self, antenna: &Antenna) -> LinkFinding {
        match self.test(antenna) {
            LinkTestStage::Done { finding, .. } => finding,
            other => panic!("{other:?}"),
        }
    }
}

fn antenna(spec: &'static ControllerSpec, address: &str) -> Antenna {
    Antenna { id: AntennaId(9), ..spec.antenna(spec.short_name, address) }
}

#[test]
fn every_make_is_reached_and_is_sent_nothing_but_questions() {
    let mut bench = Bench::new(Vec::new());
    for spec in SPECS {
        let LinkFinding::Reached { after, state } = bench.finding(&antenna(spec, "unit:1")) else {
            panic!("{spec:?}")
        };
        assert!(after < Duration::from_secs(2), "{spec:?}: {after:?}");
        assert!(state.measured.is_some_and(|measured| !measured.moving()), "{spec:?}");
    }
    let sent = bench.units.dish.received();
    let is_question = |payload: &str| {
        let request = SatrakRequest::parse(&SatrakFrame::from_payload(payload));
        matches!(request, Ok(SatrakRequest::Query(_)))
    };
    assert!(sent.len() > 5, "{sent:?}");
    assert!(sent.iter().all(|(_, payload)| is_question(payload)), "{sent:?}");
    let sent = bench.units.mast.received();
    assert!(!sent.is_empty() && sent.iter().all(|(_, command)| command == "|h"), "{sent:?}");
    let sent = bench.units.horn.received();
    let is_question = |frame| matches!(Rc2000cRequest::parse(frame), Ok(Rc2000cRequest::Query(_)));
    assert!(!sent.is_empty() && sent.iter().all(|(_, frame)| is_question(frame)), "{sent:?}");
}

#[test]
fn a_unit_that_knows_its_place_tells_it() {
    let mut bench = Bench::new(Vec::new());
    let spec = SPECS[0];
    let LinkFinding::Reached { state, .. } = bench.finding(&antenna(spec, "unit:1")) else {
        panic!("not reached")
    };
    let place = state.on_board.place.expect("a place");
    let site = Station::default().site;
    assert!((place.latitude_deg - site.latitude().degrees()).abs() < 0.1, "{place:?}");
}

#[test]
fn what_is_no_unit_is_told_apart() {
    // Test all makes at once, because a silent peer costs the whole timeout.
    std::thread::scope(|scope| {
        for spec in SPECS {
            scope.spawn(move || {
                let mut bench = Bench::new(Vec::new());
                let text = "SSH-2.0-OpenSSH_9.2p1 Debian".to_owned();
                for (address, wanted) in [
                    ("refused:1", LinkFinding::NotOpened(LinkFault::Refused)),
                    ("far:1", LinkFinding::NotOpened(LinkFault::NobodyThere)),
                    ("busy:1", LinkFinding::NotOpened(LinkFault::Busy)),
                    ("closed:1", LinkFinding::Closed),
                    ("silent:1", LinkFinding::Silent),
                    ("ssh:22", LinkFinding::SomethingElse { text }),
                ] {
                    assert_eq!(
                        bench.finding(&antenna(spec, address)),
                        wanted,
                        "{spec:?} {address}"
                    );
                }
            });
        }
    });
}

#[test]
fn a_unit_of_this_station_is_not_dialled_a_second_time() {
    let spec = SPECS[0];
    let mut bench = Bench::new(vec![spec.antenna("Dish", "unit:1")]);
    assert_eq!(bench.test(&antenna(spec, "unit:1")), LinkTestStage::InUse);
}

#[test]
fn a_unit_of_another_azel_is_not_dialled() {
    let claims = tempfile::tempdir().unwrap();
    let spec = SPECS[0];
    // Locks apply to the whole machine, on which other tests run, so these names contain the
    // process id.
    let [one, two] = ["one", "two"].map(|unit| format!("{unit}-{}:1", std::process::id()));
    let holder = Bench::claiming_in(Some(claims.path()), vec![spec.antenna("Dish", &one)]);
    let mut bench = Bench::claiming_in(Some(claims.path()), Vec::new());
    let LinkTestStage::Elsewhere(by) = bench.test(&antenna(spec, &one)) else { panic!("not held") };
    assert!(by.to_string().starts_with("azel serve"), "{by}");
    assert!(bench.units.dish.received().is_empty());
    // After a test, the unit is free for others.
    let LinkTestStage::Done { .. } = bench.test(&antenna(spec, &two)) else { panic!("not tested") };
    let mut other = Bench::claiming_in(Some(claims.path()), Vec::new());
    let LinkTestStage::Done { .. } = other.test(&antenna(spec, &two)) else {
        panic!("still claimed")
    };
    drop(holder);
}
