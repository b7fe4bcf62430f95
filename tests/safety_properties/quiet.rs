//! Ordinary hours without a fault, in which every stop, refusal and alarm is false.
//!
//! ```text
//! AZEL_CASES=5000 cargo test --release --test azel -- --nocapture quiet
//! ```
//!
//! The tests print the number of false ones and the simulated hours of one antenna for each kind of
//! run.

use std::{cell::RefCell, collections::BTreeMap, rc::Rc, time::Duration};

use azel::{
    astro::{AzEl, time::seconds_between},
    clock::Instant,
    contract::driver::{Command, Event},
    plan::{Bounds, ProgramTrack, Target},
    station::Mount,
};
use jiff::Timestamp;
use tokio::time::sleep;

use super::{
    cases::for_each_case,
    deeds::Deed,
    judge::Judge,
    makes::MAKES,
    scene::Scene,
    unit::Word,
    world::{Overhead, Wish, World},
};
use crate::common::dice::Dice;

/// Hours for which the test accepts one false stop.
const HOURS_PER_FALSE_STOP: f64 = 1000.0;
const LOOK: Duration = Duration::from_millis(500);

/// Activity in an ordinary run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Antenna at rest.
    Rest,
    /// Azel's track of a satellite around its culmination.
    Culmination,
    WholePass,
    /// Track by the unit.
    OnBoard,
    Geostationary,
    /// Go-tos, park and jogs, one after the other.
    Moves,
}

const KINDS: [Kind; 6] = [
    Kind::Rest,
    Kind::Culmination,
    Kind::WholePass,
    Kind::OnBoard,
    Kind::Geostationary,
    Kind::Moves,
];

/// Hours and false stops of each kind.
type Tally = Rc<RefCell<BTreeMap<(Kind, &'static str), (f64, Vec<String>)>>>;

/// Returns `true` if the event must not occur without a fault. A unit within `near_deg` of its aim
/// has arrived.
fn is_false(event: &Event, near_deg: f64) -> bool {
    match event {
        Event::EndedShort { aim, position: at } => {
            aim.separation(*at).is_none_or(|off| off.degrees() <= near_deg)
        }
        Event::Connected(_)
        | Event::Tracking(_)
        | Event::TrackingEnded { completed: true }
        | Event::Awaits { .. }
        | Event::ProgramTracks(_)
        | Event::ProgramTrackOver { .. }
        | Event::Arrived(_)
        | Event::Stopped => false,
        Event::LinkLost(_)
        | Event::StartedByItself
        | Event::Back { .. }
        | Event::NotSent(_)
        | Event::Refused(..)
        | Event::OffsetRefused(_)
        | Event::OffsetNotTaken(_)
        | Event::Unanswered(_)
        | Event::CannotTrack(..)
        | Event::WouldMiss { .. }
        | Event::TrackingEnded { completed: false }
        | Event::CannotProgramTrack(..)
        | Event::JogLeaseOver
        | Event::JogPositionOld
        | Event::Safety(_)
        | Event::StopNotConfirmed
        | Event::StopRefused(_)
        | Event::AutoTrackStillOn
        | Event::AutoStaysOn
        | Event::AutoTrackNotKnown
        | Event::LockOutUnproved => true,
    }
}

/// Returns `true` if the mount reaches every direction above the minimum elevation.
fn reaches_all(world: &World) -> bool {
    let [(first_from, first_to), (second_from, second_to)] = world.antenna.mount.travel_deg();
    match world.antenna.mount {
        Mount::Xy { .. } => first_from < 8.0 && second_to > 172.0,
        Mount::AzEl { .. } => first_to - first_from >= 359.0 && second_from <= 0.0,
    }
}

/// Draws a world of any make, each with the same chance.
fn world(dice: &mut Dice, kind: Kind) -> World {
    let make = if kind == Kind::OnBoard { "Satrak" } else { MAKES[dice.below(MAKES.len())].name };
    let is_high = kind == Kind::Culmination;
    let overflight = if is_high { Overhead::Culmination } else { Overhead::Satellite };
    let wish = Wish { overflight, make: Some(make), ..Wish::default() };
    loop {
        let mut world = World::random(dice, &wish);
        match (make, &mut world.antenna.mount) {
            ("Satrak", Mount::Xy { travel_from_deg, travel_to_deg, .. }) => {
                (*travel_from_deg, *travel_to_deg) = (5.0, 175.0);
            }
            // A Genius takes no other azimuths.
            ("Genius", Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. }) => {
                (*azimuth_from_deg, *azimuth_to_deg) = (0.0, 360.0);
            }
            _ => {}
        }
        world.bounds = Bounds::new(&world.station, &world.antenna);
        if reaches_all(&world) {
            return world;
        }
    }
}

struct Run {
    scene: Scene,
    dice: Dice,
    loses_readings: bool,
    next_loss: Instant,
}

impl Run {
    async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            if self.loses_readings && Instant::now() >= self.next_loss {
                self.scene.trouble(|line| line.loses_next_reading = true);
                let pause_s = self.dice.between(10.0, 120.0);
                self.next_loss += Duration::try_from_secs_f64(pause_s).unwrap();
            }
            sleep(LOOK).await;
            self.scene.collect();
        }
    }

    async fn until_utc_is(&mut self, at: Timestamp) {
        let left_s = seconds_between(self.scene.clock.utc(), at);
        self.seconds(left_s.max(0.0)).await;
    }

    async fn moves(&mut self) {
        for _ in 0..12 {
            let deed = Deed::any_by_hand(&mut self.dice, &self.scene.world);
            let mut judge = Judge::new(&self.scene, String::new());
            deed.begin(&mut self.scene, &mut judge).await;
            if deed.is_jog() {
                deed.go_on(&mut self.scene, &judge, self.dice.between(0.5, 6.0)).await;
                deed.let_go(&self.scene);
                self.seconds(10.0).await;
            } else {
                self.seconds(240.0).await;
            }
        }
    }
}

async fn ordinary(mut dice: Dice, tally: Tally) {
    let seed = dice.seed();
    let kind = KINDS[dice.below(KINDS.len())];
    let world = world(&mut dice, kind);
    let (make, overflight) = (world.make, world.overflight.unwrap());
    let trouble = dice.below(4);
    if trouble == 1 {
        world.unit.add_noise();
    }
    let mut scene = Scene::start(world, &mut dice).await;
    if trouble == 2 {
        scene.trouble(|line| line.late_ms = 300.0);
    }
    if kind == Kind::OnBoard {
        scene.until_placed().await;
    }
    let began = Instant::now();
    let mut run = Run { scene, dice, loses_readings: trouble == 3, next_loss: began };
    match kind {
        Kind::Rest => run.seconds(3600.0).await,
        Kind::Culmination | Kind::WholePass => {
            let track = overflight.program_track();
            run.scene.send(Command::ProgramTrack(Box::new(track)));
            let is_whole = kind == Kind::WholePass;
            let end = if is_whole { overflight.los } else { overflight.culmination };
            run.until_utc_is(end).await;
            run.seconds(if is_whole { 20.0 } else { 150.0 }).await;
        }
        Kind::OnBoard => {
            let mut judge = Judge::new(&run.scene, String::new());
            Deed::OnBoard.begin(&mut run.scene, &mut judge).await;
            run.until_utc_is(overflight.los).await;
        }
        Kind::Geostationary => {
            let (az_deg, el_deg) = (run.dice.between(100.0, 260.0), run.dice.between(10.0, 60.0));
            let target = Target::Fixed(AzEl::from_degrees(az_deg, el_deg));
            let site = run.scene.world.station.site;
            let track = ProgramTrack::new(target, site, Vec::new());
            run.scene.send(Command::ProgramTrack(Box::new(track)));
            run.seconds(3600.0).await;
        }
        Kind::Moves => run.moves().await,
    }
    let scene = run.scene;
    let near_deg = scene.world.coarse_deg / 2.0;
    let events =
        scene.events.iter().filter(|(at, event)| *at >= began && is_false(event, near_deg));
    let mut wrong: Vec<String> = events.map(|(_, event)| format!("{event:?}")).collect();
    let stops =
        scene.world.words_since(began).iter().filter(|(_, word)| *word == Word::Stop).count();
    // A jog ends with a STOP, and so does a pass that the unit tracks.
    if wrong.is_empty() && stops > 0 && !matches!(kind, Kind::Moves | Kind::OnBoard) {
        wrong.push(format!("{stops} STOPs"));
    }
    let hours = (Instant::now() - began).as_secs_f64() / 3600.0;
    for text in &wrong {
        println!("seed {seed}, {kind:?} {} trouble {trouble}: {text}", make.name);
    }
    let mut tally = tally.borrow_mut();
    let (sum, all) = tally.entry((kind, make.name)).or_default();
    *sum += hours;
    all.extend(wrong);
}

#[test]
fn an_ordinary_day_has_no_false_stop() {
    let tally = Tally::default();
    for_each_case("ordinary hours", 10, |dice| ordinary(dice, Rc::clone(&tally)));
    let tally = tally.borrow();
    for ((kind, make), (hours, wrong)) in tally.iter() {
        println!("{make:8} {kind:?}: {} false in {hours:.1} antenna-hours", wrong.len());
    }
    let hours: f64 = tally.values().map(|(hours, _)| hours).sum();
    let number = tally.values().map(|(_, wrong)| wrong.len()).sum::<usize>();
    println!("{number} false stops, refusals and alarms in {hours:.1} antenna-hours");
    let accepted = (hours / HOURS_PER_FALSE_STOP).floor();
    assert!(number as f64 <= accepted, "{number} in {hours:.1} antenna-hours");
}

/// Checks a track that loses the reply to its first order. A unit may take one order for each axis.
async fn loses_its_first_reply(mut dice: Dice) {
    let world = world(&mut dice, Kind::Geostationary);
    let mut scene = Scene::start(world, &mut dice).await;
    let deed = Deed::Point(dice.between(30.0, 330.0), dice.between(20.0, 70.0));
    let case = format!("{} {deed:?}", scene.world.make.name);
    let mut judge = Judge::new(&scene, case);
    let began = Instant::now();
    scene.trouble(|line| line.loses_next = true);
    deed.begin(&mut scene, &mut judge).await;
    deed.go_on(&mut scene, &judge, 150.0).await;
    let Deed::Point(az_deg, el_deg) = deed else { return };
    let off = scene.world.direction().separation(AzEl::from_degrees(az_deg, el_deg));
    let near_deg = scene.world.coarse_deg + 1.0;
    assert!(off.degrees() <= near_deg, "{off:?} off: {judge}\n{}", scene.report());
    let wrong = scene.told(began, |event| is_false(event, 0.0));
    assert!(wrong.is_none(), "{judge}\n{}", scene.report());
}

#[test]
fn a_lost_reply_to_its_first_order_ends_no_track() {
    for_each_case("the first reply is lost", 6, loses_its_first_reply);
}
