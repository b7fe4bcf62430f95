//! Rehearsals of random antennas with imperfect drives and sensors. Only Azel moves these antennas,
//! so it must report no foreign motion.
//!
//! The long form takes a range of seeds. Each seed rehearses one antenna for an hour:
//!
//! ```text
//! AZEL_SEED=1000 AZEL_CASES=7200 \
//!   cargo test --release --test azel drawn_rehearsals -- --nocapture
//! ```

use std::{
    sync::{Arc, LazyLock},
    time::Duration,
};

use azel::{
    astro::{AzEl, Zone},
    contract::{
        automatic::{DayEvent, Interruption},
        rehearsal::Rehearsed,
    },
    controller::rc2000c::Calibration,
    device::CountPoint,
    makes::DemoAddresses,
    orbit::{Catalog, Elements, ReadReport, bundled},
    rehearsal::{Fault, Rehearsal, run},
    sim::Mechanics,
    station::{Antenna, BetweenPasses, Direction, Entered, KeepOut, Mount, PollRates, Station},
};
use jiff::{Timestamp, ToSpan as _};

use crate::common::dice::Dice;

/// Number of antennas that the short form rehearses, one hour each.
const DEFAULT_CASES: u64 = 24;

/// Elements of satellites in low orbits; an antenna tracks one pass after another.
static ELEMENTS: LazyLock<Arc<Catalog>> = LazyLock::new(|| {
    let all = bundled().unwrap();
    let known = Station::default().favourites;
    let low = all.iter().filter(|elements| elements.mean_motion_rev_day() > 12.0).step_by(400);
    let known = known.numbers().into_iter().filter_map(|number| all.get(number));
    let elements = known.chain(low).cloned().collect();
    let mut catalog = Catalog::default();
    catalog.merge(ReadReport { elements, ..ReadReport::default() }, "draws");
    Arc::new(catalog)
});

/// Draws a log-uniform value.
fn logarithmic(dice: &mut Dice, from: f64, to: f64) -> f64 {
    from * (to / from).powf(dice.between(0.0, 1.0))
}

fn seconds(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap()
}

fn mechanics(dice: &mut Dice) -> Mechanics {
    let share = |dice: &mut Dice, share: f64, max: f64| {
        if dice.chance(share) { dice.between(0.0, max) } else { 0.0 }
    };
    Mechanics {
        dead_time: seconds(share(dice, 0.8, 2.0)),
        coasting: dice.chance(0.7).then(|| seconds(dice.between(0.0, 3.0))),
        minimum_run: seconds(share(dice, 0.5, 0.3)),
        noise_deg: share(dice, 0.7, 0.3),
        backlash_deg: share(dice, 0.3, 0.5),
        sway_deg: share(dice, 0.4, 1.0),
    }
}

/// Draws an azimuth travel: a full circle, an overlap or a sector.
fn azimuths_deg(dice: &mut Dice) -> (f64, f64) {
    let all =
        [(0.0, 360.0), (0.0, 450.0), (0.0, 540.0), (-180.0, 180.0), (-270.0, 270.0), (90.0, 270.0)];
    all[dice.below(all.len())]
}

fn az_el(dice: &mut Dice, (azimuth_from_deg, azimuth_to_deg): (f64, f64)) -> Mount {
    let elevation_to_deg = if dice.chance(0.3) { 180.0 } else { 90.0 };
    Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg: 0.0, elevation_to_deg }
}

/// Gives an RC2000C a calibration whose counts cover the travel of its mount.
fn calibrated(mut antenna: Antenna, dice: &mut Dice) -> Antenna {
    let per_deg = [10.0, 20.0, 50.0][dice.below(3)];
    let points = |(from_deg, to_deg): (f64, f64)| {
        let counts = |deg: f64| (30.0 + (deg - from_deg) * per_deg).round() as u16;
        [from_deg, to_deg].map(|degrees| CountPoint { counts: counts(degrees), degrees }).to_vec()
    };
    let [azimuth, elevation] = antenna.mount.travel_deg().map(points);
    Calibration { azimuth, elevation }.put_into(&mut antenna.connection).unwrap();
    antenna
}

fn antenna(dice: &mut Dice, sway_deg: f64) -> Antenna {
    let address = |port: u16| format!("127.0.0.1:{port}");
    let addresses =
        DemoAddresses { satrak: address(4001), genius: address(9006), rc2000c: address(4002) };
    let mut demo = Station::demo(&addresses).antennas;
    let mut antenna = demo.swap_remove(dice.below(3));
    antenna.sway_deg = antenna.sway_deg.max(sway_deg);
    let rate_deg_s = logarithmic(dice, 0.3, 20.0);
    antenna.limits.maximum_rate_deg_s = rate_deg_s;
    // Most draws leave room for drives that overrun.
    antenna.limits.minimum_elevation_deg = if dice.chance(0.9) { 0.0 } else { 3.0 };
    let mut hz = || dice.between(2.0, 10.0);
    antenna.park = Direction { azimuth_deg: 170.0, elevation_deg: 45.0 };
    antenna.poll = PollRates { idle_hz: hz(), moving_hz: hz() };
    match antenna.connection.spec().key {
        "satrak" => {
            antenna.mount = Mount::Xy {
                lower_axis_azimuth_deg: dice.between(0.0, 180.0),
                travel_from_deg: 5.0,
                travel_to_deg: 175.0,
            };
            antenna
        }
        "genius" => {
            // The unit counts from 0 to 360 degrees.
            let azimuths_deg = [(0.0, 360.0), (90.0, 270.0), (10.0, 350.0)][dice.below(3)];
            antenna.mount = az_el(dice, azimuths_deg);
            antenna
        }
        "rc2000c" => {
            let azimuths_deg = azimuths_deg(dice);
            antenna.mount = az_el(dice, azimuths_deg);
            calibrated(antenna, dice)
        }
        other => unreachable!("{other}"),
    }
}

/// Returns a keep-out margin larger than the overrun of the drives, at most 30 degrees.
fn margin_deg(mechanics: &Mechanics, rate_deg_s: f64) -> f64 {
    let coasting_s = mechanics.coasting.map_or(1.0, |coasting| coasting.as_secs_f64());
    let overrun_deg = rate_deg_s * (coasting_s / 2.0 + mechanics.dead_time.as_secs_f64());
    (1.0 + overrun_deg).min(30.0)
}

/// Draws a keep-out that the antenna must go round, in 3 % of the cases.
fn keep_out(dice: &mut Dice, mechanics: &Mechanics, rate_deg_s: f64) -> Option<KeepOut> {
    let (at_deg, width_deg) = (dice.between(0.0, 330.0), dice.between(3.0, 30.0));
    let top_deg = dice.between(5.0, 40.0);
    let corners = [(at_deg, 0.0), (at_deg + width_deg, 0.0)];
    let top = [(at_deg + width_deg, top_deg), (at_deg, top_deg)];
    let corners = corners.into_iter().chain(top);
    let corners = corners.map(|(azimuth, elevation)| AzEl::from_degrees(azimuth, elevation));
    let zone = Zone::new(corners.collect()).ok()?;
    dice.chance(0.03).then(|| KeepOut {
        name: "Mast".to_owned(),
        reason: String::new(),
        entered: Entered::GoRound,
        antenna: None,
        margin_deg: margin_deg(mechanics, rate_deg_s),
        zone,
    })
}

/// Sets a park position outside the travel or within its own keep-out, and the rule to park between
/// passes.
fn park_out_of_reach(dice: &mut Dice, mechanics: &Mechanics, station: &mut Station) {
    let (is_covered, is_hard) = (dice.chance(0.5), dice.chance(0.5));
    let (azimuth_deg, elevation_deg) = (dice.between(20.0, 340.0), dice.between(0.0, 15.0));
    let Some(antenna) = station.antennas.first_mut() else { return };
    let rate_deg_s = antenna.limits.maximum_rate_deg_s;
    antenna.automatic.between_passes = BetweenPasses::Park;
    let beyond_deg = match antenna.mount {
        Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } => {
            let free_deg = 360.0 - (azimuth_to_deg - azimuth_from_deg);
            (free_deg > 0.0).then_some(azimuth_to_deg + free_deg / 2.0)
        }
        Mount::Xy { lower_axis_azimuth_deg, .. } => Some(lower_axis_azimuth_deg),
    };
    if let Some(beyond_deg) = beyond_deg.filter(|_| !is_covered) {
        antenna.park = Direction { azimuth_deg: beyond_deg.rem_euclid(360.0), elevation_deg: 1.0 };
        return;
    }
    antenna.park = Direction { azimuth_deg, elevation_deg };
    let (left_deg, right_deg, top_deg) =
        (azimuth_deg - 5.0, azimuth_deg + 5.0, elevation_deg + 3.0);
    let corners = [(left_deg, 0.0), (right_deg, 0.0), (right_deg, top_deg), (left_deg, top_deg)];
    station.keep_outs.push(KeepOut {
        name: "Shed".to_owned(),
        reason: String::new(),
        entered: if is_hard { Entered::Hard } else { Entered::GoRound },
        antenna: None,
        margin_deg: margin_deg(mechanics, rate_deg_s),
        zone: KeepOut::zone_of(&corners).unwrap(),
    });
}

fn faults(dice: &mut Dice) -> Vec<Fault> {
    let mut texts = Vec::new();
    if dice.chance(0.3) {
        let (after_min, s) = (dice.between(1.0, 58.0), dice.between(1.0, 30.0));
        texts.push(format!("link-lost,after={after_min},for={s}"));
    }
    if dice.chance(0.3) {
        texts.push(format!("late-replies={}", dice.between(0.0, 300.0)));
    }
    texts.iter().map(|text| text.parse().unwrap()).collect()
}

/// Rehearsal of a random antenna.
struct Draw {
    rehearsal: Rehearsal,
    /// Same rehearsal with a reachable park position, if `rehearsal` has an unreachable one.
    with_usual_park: Option<Rehearsal>,
}

fn draw(seed: u64) -> Draw {
    let dice = &mut Dice::new(seed);
    let mechanics = mechanics(dice);
    let antenna = antenna(dice, mechanics.sway_deg);
    let keep_out = keep_out(dice, &mechanics, antenna.limits.maximum_rate_deg_s);
    let usual_park = antenna.park;
    let mut station = Station {
        antennas: vec![antenna],
        favourites: ELEMENTS.iter().map(Elements::catalog_number).collect(),
        keep_outs: keep_out.into_iter().collect(),
        ..Station::default()
    };
    let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    let minute = i64::try_from(dice.below(3 * 24 * 60)).unwrap();
    let faults = faults(dice);
    // Draw this last: otherwise existing seeds would give other antennas.
    let is_park_out_of_reach = dice.chance(0.3);
    if is_park_out_of_reach {
        park_out_of_reach(dice, &mechanics, &mut station);
    }
    let rehearsal = Rehearsal {
        station,
        elements: Arc::clone(&ELEMENTS),
        start: start + minute.minutes(),
        hours: 1.0,
        seed,
        mechanics,
        faults,
        speed: None,
    };
    let with_usual_park = is_park_out_of_reach.then(|| {
        let mut usual = rehearsal.clone();
        usual.station.antennas[0].park = usual_park;
        usual
    });
    Draw { rehearsal, with_usual_park }
}

/// Counts the suspensions for foreign motion.
fn accusations(rehearsed: &Rehearsed) -> usize {
    let accuses = |what: &DayEvent| {
        let suspended =
            [Interruption::Elsewhere, Interruption::EndedByUnit].map(DayEvent::Suspended);
        suspended.contains(what)
    };
    rehearsed.interruptions.iter().filter(|line| accuses(&line.event)).count()
}

/// Counts the passes that the antenna tracked for any time.
fn tracked(rehearsed: &Rehearsed) -> usize {
    rehearsed.passes.iter().filter(|pass| pass.got_s() > 0.0).count()
}

#[test]
fn untouched_antennas_report_no_foreign_motion() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().unwrap())
    };
    let (first, cases) = (number("AZEL_SEED", 1), number("AZEL_CASES", DEFAULT_CASES));
    let [mut wrong, mut others, mut passes, mut all_tracked] = [0; 4];
    let [mut out_of_reach, mut tracked_without_park, mut tracked_with_park] = [0; 3];
    for seed in first..first + cases {
        let Draw { rehearsal: what, with_usual_park } = draw(seed);
        let rehearsed = run(&what, &|_| (), &|| false).unwrap();
        let antenna = &what.station.antennas[0];
        let accused = accusations(&rehearsed);
        passes += rehearsed.passes.len();
        all_tracked += tracked(&rehearsed);
        wrong += accused;
        others += rehearsed.interruptions.len() - accused;
        for line in &rehearsed.interruptions {
            let lowest_deg = antenna.limits.minimum_elevation_deg;
            println!(
                "seed {seed}: {:?} from {lowest_deg}° elevation, {} keep-outs, at {}: {:?}",
                antenna.name,
                what.station.keep_outs.len(),
                line.time,
                line.event
            );
        }
        if let Some(usual) = with_usual_park {
            let usual = run(&usual, &|_| (), &|| false).unwrap();
            out_of_reach += 1;
            tracked_without_park += tracked(&rehearsed);
            tracked_with_park += tracked(&usual);
            println!(
                "seed {seed}: {:?} cannot go to {:?}: {} of {} passes tracked, else {} of {}",
                antenna.name,
                antenna.park,
                tracked(&rehearsed),
                rehearsed.passes.len(),
                tracked(&usual),
                usual.passes.len()
            );
        }
    }
    println!(
        "seeds {first}..{}: {cases} antenna-hours, {all_tracked} of {passes} passes tracked, \
         {wrong} false accusations, {others} other interruptions; {out_of_reach} park positions out \
         of reach: {tracked_without_park} passes tracked, else {tracked_with_park}",
        first + cases
    );
    assert_eq!(wrong, 0);
    assert!(all_tracked > passes / 4, "{all_tracked} of {passes}");
    // A slow antenna that starts elsewhere may reach other passes.
    let is_alike = tracked_without_park * 10 >= tracked_with_park * 9;
    assert!(is_alike, "{tracked_without_park} {tracked_with_park}");
}

/// The link of this drawn rotator is lost while it turns to 0°. The rotator comes to rest there and
/// reads 360°.
#[test]
fn a_rotator_at_rest_that_reads_the_other_end_has_done_as_told() {
    let rehearsed = run(&draw(100_306).rehearsal, &|_| (), &|| false).unwrap();
    assert_eq!(rehearsed.interruptions, []);
}

/// This drawn antenna stands beside a keep-out while noise and gusts change its readings.
#[test]
fn readings_that_change_beside_a_keep_out_are_no_motion_into_it() {
    let mut rehearsal = draw(100_162).rehearsal;
    // The passes of this seed were drawn without refraction.
    rehearsal.station.site = rehearsal.station.site.airless();
    let rehearsed = run(&rehearsal, &|_| (), &|| false).unwrap();
    assert_eq!(rehearsed.interruptions, []);
}
