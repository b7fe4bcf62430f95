//! Processor time of each turn of the sessions of three antennas. During a turn, nothing else runs
//! on the driver's thread, not even a STOP of another antenna. To measure:
//!
//! ```text
//! AZEL_HOURS=24 cargo test --release --test azel driver_turns -- --nocapture
//! ```
//!
//! One measurement uses a typical station, the other the max number of keep-outs and corners.

use std::{cell::RefCell, f64::consts::TAU, num::NonZeroU32, rc::Rc, time::Duration};

use azel::{
    astro::{Angle, AzEl, time::add_seconds},
    clock::Clock,
    contract::driver::Command,
    controller::{
        rc2000c::Calibration,
        rotator_genius::{ROTATORS, Rotators},
        satrak::ELEMENT_FILE,
    },
    device::{CountPoint, TrackTarget},
    driver::{AntennaHandle, Debts},
    orbit::{Elements, PassSearch, Propagator, bundled, passes},
    plan::{Bounds, OnBoardPass, ProgramTrack, Target},
    sim::{Control, Unit, rc2000c, rotator_genius, satrak},
    station::{Antenna, Entered, KeepOut, Mount, Station, SunAvoidance},
};
use jiff::Timestamp;
use tokio::task::LocalSet;

use crate::common::{
    mast,
    network::{Network, link},
    rig::indebted_session,
    turns::{Turns, timed},
};

/// Name of the element file on the Satrak.
const FILE: &str = "stations.txt";
/// Catalog numbers of satellites in low orbits.
const NUMBERS: [u32; 6] = [43013, 25544, 37849, 25994, 27424, 49260];
/// Elevation of AOS and LOS, degrees.
const AOS_DEG: f64 = 10.0;
const LOOK: Duration = Duration::from_millis(100);

/// An antenna with its session, and the processor time of its turns.
struct Measured {
    name: &'static str,
    handle: AntennaHandle,
    turns: Rc<RefCell<Turns>>,
}

fn open<U: Unit>(
    name: &'static str,
    antenna: &Antenna,
    control: Control<U>,
    station: &Station,
    clock: &Clock,
) -> Measured {
    let dial = Network::default().dial(move || link(&control));
    let (session, handle) = indebted_session(antenna, dial, clock.clone(), Debts::default());
    handle.keep_within(Bounds::new(station, antenna));
    handle.send(Command::Connect).unwrap();
    let turns = Rc::<RefCell<Turns>>::default();
    let taken = Rc::clone(&turns);
    tokio::task::spawn_local(timed(session.run(), move |turn| taken.borrow_mut().add(turn)));
    Measured { name, handle, turns }
}

/// A pass of one of the satellites.
struct Event {
    elements: Elements,
    aos: Timestamp,
    los: Timestamp,
}

/// Returns all passes within `hours` after `from`, one after the other without overlap.
fn timetable(from: Timestamp, hours: f64) -> Vec<Event> {
    let catalog = bundled().unwrap();
    let site = Station::default().site;
    let mut found = Vec::new();
    for number in NUMBERS {
        let elements = catalog.get(number).unwrap();
        let to = add_seconds(from, hours * 3600.0);
        let aos_elevation = Angle::from_degrees(AOS_DEG);
        let search = PassSearch { aos_elevation, ..PassSearch::new(site, from, to) };
        let propagator = Propagator::new(elements).unwrap();
        found.extend(passes(&propagator, &search, &|| false).into_iter().map(|pass| Event {
            elements: elements.clone(),
            aos: pass.aos.time,
            los: pass.los.time,
        }));
    }
    found.sort_by_key(|event| event.aos);
    let mut free = from;
    found.retain(|event| {
        let is_free = event.aos > add_seconds(free, 180.0);
        if is_free {
            free = event.los;
        }
        is_free
    });
    found
}

fn antennas(from: Timestamp, station: &Station, clock: &Clock) -> [Measured; 3] {
    let catalog = bundled().unwrap();
    let elements = NUMBERS.map(|number| catalog.get(number).unwrap().clone()).to_vec();
    let mut options = satrak::Options::new(station.site, from);
    options.elements.insert(FILE.to_owned(), elements);
    let mut dish = Antenna::satrak("Dish", "in memory");
    dish.connection.put(&ELEMENT_FILE, FILE).unwrap();

    let pair = rotator_genius::Options {
        rotators: [
            rotator_genius::RotatorOptions::default(),
            rotator_genius::RotatorOptions::elevation(),
        ],
        ..rotator_genius::Options::default()
    };
    let mut tower = Antenna::genius("Mast", "in memory");
    tower.connection.put(&ROTATORS, Rotators::Pair).unwrap();

    let point = |counts, degrees| CountPoint { counts, degrees };
    let calibration = Calibration {
        azimuth: vec![point(30, 0.0), point(3630, 400.0)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    let mut horn = Antenna::rc2000c("Horn", "in memory");
    calibration.put_into(&mut horn.connection).unwrap();
    horn.mount = Mount::AzEl {
        azimuth_from_deg: 0.0,
        azimuth_to_deg: 400.0,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    [
        open("Satrak", &dish, satrak::Control::new(&options), station, clock),
        open("Genius", &tower, rotator_genius::Control::new(&pair), station, clock),
        open("RC2000C", &horn, rc2000c::Control::new(&rc2000c::Options::default()), station, clock),
    ]
}

/// Orders all antennas to track one pass.
fn begin(antennas: &[Measured], event: &Event, station: &Station) {
    let target = Target::Satellite(Box::new(event.elements.clone()));
    let track = ProgramTrack::new(target, station.site, vec![(event.aos, event.los)]);
    let pass = OnBoardPass {
        target: TrackTarget {
            catalog_number: event.elements.catalog_number(),
            name: event.elements.name().into(),
            element_file: None,
            start: event.aos,
            end: event.los,
        },
        elements: event.elements.clone(),
        site: station.site,
        is_agreed: true,
    };
    for antenna in antennas {
        let command = match antenna.name {
            "Satrak" => Command::Track(Box::new(pass.clone())),
            _ => Command::ProgramTrack(Box::new(track.clone())),
        };
        antenna.handle.send(command).unwrap();
    }
}

async fn until(antennas: &mut [Measured], clock: &Clock, at: Timestamp) {
    while clock.utc() < at {
        tokio::time::sleep(LOOK).await;
        for antenna in antennas.iter_mut() {
            while antenna.handle.next_event().is_some() {}
        }
    }
}

/// Returns the keep-outs of a typical station: two masts.
fn usual() -> Vec<KeepOut> {
    vec![
        mast(&[(80.0, 0.0), (100.0, 0.0), (100.0, 35.0), (80.0, 35.0)]),
        mast(&[(200.0, 0.0), (215.0, 0.0), (215.0, 25.0), (200.0, 25.0)]),
    ]
}

/// Returns a ring of as many discs as a station may have. Every other disc is hard; the antenna
/// goes round the rest.
fn most() -> Vec<KeepOut> {
    let corners = KeepOut::MAX_CORNERS_IN_ALL / KeepOut::MAX_NUMBER;
    let disc = |number: usize| {
        let corner = |corner: usize| {
            let (sin, cos) = (corner as f64 / corners as f64 * TAU).sin_cos();
            let middle_deg = (number as f64 + 0.5) / KeepOut::MAX_NUMBER as f64 * 360.0;
            (middle_deg + 3.0 * sin, 25.0 + 9.0 * cos)
        };
        let corners: Vec<_> = (0..corners).map(corner).collect();
        let entered = if number.is_multiple_of(2) { Entered::Hard } else { Entered::GoRound };
        KeepOut { name: format!("disc {number}"), entered, ..mast(&corners) }
    };
    (0..KeepOut::MAX_NUMBER).map(disc).collect()
}

/// Previews the ways to directions all round, as a pointer on the sky plot does.
async fn preview(antennas: &mut [Measured], clock: &Clock) {
    for azimuth_deg in (0..360).step_by(15) {
        let to = AzEl::from_degrees(f64::from(azimuth_deg), 30.0);
        for antenna in antennas.iter() {
            antenna.handle.send(Command::Preview(Some(to.into()))).unwrap();
        }
        until(antennas, clock, add_seconds(clock.utc(), 0.2)).await;
    }
    for antenna in antennas {
        antenna.handle.send(Command::Preview(None)).unwrap();
    }
}

async fn day(hours: f64, keep_outs: Vec<KeepOut>) {
    let from: Timestamp = "2026-08-12T11:03:00Z".parse().unwrap();
    let clock = Clock::at_speed(from, NonZeroU32::MIN);
    let number = keep_outs.len();
    let sun_avoidance = Some(SunAvoidance { radius_deg: 5.0, ahead_min: 10.0 });
    let station = Station { keep_outs, sun_avoidance, ..Station::default() };
    let mut antennas = antennas(from, &station, &clock);
    let end = add_seconds(from, hours * 3600.0);
    let timetable = timetable(from, hours);
    for event in &timetable {
        until(&mut antennas, &clock, add_seconds(event.aos, -90.0)).await;
        begin(&antennas, event, &station);
        until(&mut antennas, &clock, add_seconds(event.los, 10.0)).await;
        for antenna in &antennas {
            antenna.handle.send(Command::MoveAway).unwrap();
        }
        until(&mut antennas, &clock, add_seconds(event.los, 20.0)).await;
        preview(&mut antennas, &clock).await;
        for antenna in &antennas {
            antenna.handle.send(Command::Park).unwrap();
        }
    }
    until(&mut antennas, &clock, end).await;
    let passes = timetable.len();
    println!("{hours} hours of three antennas, {number} keep-outs, {passes} passes");
    let mut all = Turns::default();
    for antenna in &antennas {
        let turns = antenna.turns.borrow();
        println!("{:8} {turns}", antenna.name);
        all.add_all(&turns);
    }
    println!("all      {all}");
}

#[test]
fn the_turns_of_three_sessions_are_measured() {
    let hours = std::env::var("AZEL_HOURS").ok().and_then(|hours| hours.parse().ok());
    let mut builder = tokio::runtime::Builder::new_current_thread();
    let runtime = builder.enable_time().start_paused(true).build().unwrap();
    for keep_outs in [usual(), most()] {
        LocalSet::new().block_on(&runtime, day(hours.unwrap_or(0.05), keep_outs));
    }
}
