//! Passes that simulated units track without a fault and with one, and the causes that their
//! reports name. The long form takes a range of seeds. Each seed gives one pass of either kind:
//!
//! ```text
//! AZEL_SEED=1 AZEL_CASES=1000 \
//!   cargo test --release --test azel rehearsed::explained -- --nocapture
//! ```

use std::{collections::BTreeMap, num::NonZeroU32, time::Duration};

use azel::{
    astro::{PointingModel, Site},
    clock::Clock,
    contract::{Command, record::RecordedReport},
    orbit::{Catalog, Elements, Pass, PassSearch, Propagator, bundled, passes},
    record::RowKind,
    sim::{
        InMemory, Mechanics, Misreading, Trouble, rc2000c, rotator_genius,
        satrak::{self, BUNDLED_FILE},
    },
    station::Station,
};
use jiff::{Timestamp, ToSpan as _};
use tokio::time::sleep;

use super::{recorded::reports, rehearsal::calibrated, scene::Scene};
use crate::common::{
    dice::Dice,
    units::{self, Units, antenna, measured, start, until, until_looking},
};

const SEED: u64 = 1;
const CASES: u64 = 6;

/// Faults, each with the causes that name it.
const FAULTS: [(&str, &[&str]); 13] = [
    ("site", &["other_site"]),
    ("clock", &["late"]),
    ("lag", &["late"]),
    ("azimuth offset", &["azimuth_offset"]),
    ("elevation offset", &["elevation_offset"]),
    ("tilt", &["tilt"]),
    ("elevation scale", &["elevation_scale"]),
    ("old elements", &["other_elements"]),
    ("stuck axis", &["stuck", "no_effect"]),
    ("slow axis", &["slow_drives", "no_effect"]),
    ("slow drives", &["slow_drives", "no_effect"]),
    ("stop", &["stopped"]),
    ("link loss", &["link_lost", "not_measured"]),
];

/// A pass, and the elements that predict it.
struct Flight {
    elements: Elements,
    pass: Pass,
}

impl Flight {
    /// Returns elements of a second before. They put the satellite `by_deg` further along its orbit
    /// and turn its plane by half as much.
    fn older(&self, by_deg: f64) -> Elements {
        let mut written = serde_json::to_value(&self.elements).unwrap();
        let epoch: Timestamp = serde_json::from_value(written["epoch"].clone()).unwrap();
        written["epoch"] = serde_json::to_value(epoch - 1.second()).unwrap();
        let moved_deg = written["mean_motion_rev_day"].as_f64().unwrap() * 360.0 / 86_400.0;
        for (name, change) in [("mean_anomaly_deg", by_deg - moved_deg), ("node_deg", by_deg / 2.0)]
        {
            let changed = (written[name].as_f64().unwrap() + change).rem_euclid(360.0);
            written[name] = changed.into();
        }
        serde_json::from_value(written).unwrap()
    }
}

/// Draws a pass of one of the favourites that rises above 20 degrees.
fn flight(catalog: &Catalog, dice: &mut Dice) -> Flight {
    let station = Station::default();
    let favourites = station.favourites.numbers();
    loop {
        let number = favourites[dice.below(favourites.len())];
        let Some(elements) = catalog.get(number) else { continue };
        let Ok(propagator) = Propagator::new(elements) else { continue };
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            floor: azel::astro::Angle::from_degrees(20.0),
            ..PassSearch::new(station.site, start(), start() + 48.hours())
        };
        let found = passes(&propagator, &search, &|| false);
        let is_whole = |pass: &&Pass| !pass.starts_before && pass.duration_s() < 700.0;
        let short: Vec<&Pass> = found.iter().filter(is_whole).collect();
        let place = dice.below(short.len().max(1));
        if let Some(pass) = short.get(place) {
            return Flight { elements: elements.clone(), pass: **pass };
        }
    }
}

/// Draws imperfections that an antenna may have without a fault.
fn mechanics(dice: &mut Dice) -> Mechanics {
    Mechanics {
        dead_time: Duration::from_millis(dice.below(200) as u64),
        noise_deg: dice.between(0.005, 0.05),
        sway_deg: if dice.chance(0.5) { dice.between(0.0, 0.1) } else { 0.0 },
        ..Mechanics::default()
    }
}

/// Antenna of one make, and the errors of its unit.
struct Case {
    name: &'static str,
    half_beam_deg: f64,
    mechanics: Mechanics,
    /// Site in a Satrak.
    site: Site,
    /// Elements in a Satrak, if they differ from those of the station.
    old: Option<Elements>,
    /// The trouble, and the share of the pass after which it begins.
    trouble: Option<(Trouble, f64)>,
    is_stopped: bool,
}

impl Case {
    fn without_fault(name: &'static str, half_beam_deg: f64, mechanics: Mechanics) -> Self {
        let site = Station::default().site.airless();
        let (old, trouble, is_stopped) = (None, None, false);
        Self { name, half_beam_deg, mechanics, site, old, trouble, is_stopped }
    }

    /// Returns the root mean square error of both axes without a fault, degrees. A Genius turns by
    /// whole degrees, and an RC2000C stops and starts.
    fn noise_deg(&self) -> f64 {
        let Mechanics { noise_deg, sway_deg, .. } = self.mechanics;
        let steps_deg = match self.name {
            "Mast" => 0.8,
            "Horn" => 0.16,
            _ => 0.0,
        };
        (2.0 * (noise_deg.powi(2) / 3.0 + sway_deg.powi(2) / 8.0)).sqrt() + steps_deg
    }

    fn drawn(fault: &str, flight: &Flight, dice: &mut Dice) -> Self {
        let any = ["Dish", "Mast", "Horn"][dice.below(3)];
        let name = match fault {
            "stuck axis" | "slow axis" | "slow drives" | "stop" | "link loss" => any,
            _ => "Dish",
        };
        let mut case = Self::without_fault(name, 0.0, mechanics(dice));
        case.half_beam_deg = (3.0 * case.noise_deg()).max(0.2);
        let mut signed = |size: f64| {
            let size = size * dice.between(1.5, 5.0);
            if dice.chance(0.5) { size } else { -size }
        };
        let off_deg = signed(case.half_beam_deg);
        let other_deg = signed(case.half_beam_deg);
        let none = PointingModel::default();
        let misreads =
            |model| Some((Trouble::Misreads(Misreading { model, noise_deg: 0.0 }), -1.0));
        match fault {
            "site" => {
                let here = case.site;
                let latitude_deg = here.latitude().degrees() + 0.15 * off_deg;
                let longitude_deg = here.longitude().degrees() + 0.2 * other_deg;
                let there = Site::new(latitude_deg, longitude_deg, here.altitude_m()).unwrap();
                case.site = there.airless();
            }
            "clock" => {
                let late = Duration::from_millis((off_deg.abs() * 2500.0) as u64);
                case.trouble = Some((Trouble::ClockLate(late), -1.0));
            }
            "lag" => {
                let late = Duration::from_millis((off_deg.abs() * 2500.0) as u64);
                case.trouble = Some((Trouble::TrackLate(late), -1.0));
            }
            "azimuth offset" => {
                case.trouble = misreads(PointingModel { azimuth_offset_deg: off_deg, ..none });
            }
            "elevation offset" => {
                case.trouble = misreads(PointingModel { elevation_offset_deg: off_deg, ..none });
            }
            "tilt" => {
                let (tilt_north_deg, tilt_east_deg) = (off_deg, other_deg);
                case.trouble = misreads(PointingModel { tilt_north_deg, tilt_east_deg, ..none });
            }
            "elevation scale" => {
                let elevation_scale = off_deg / 30.0;
                case.trouble = misreads(PointingModel { elevation_scale, ..none });
            }
            "old elements" => case.old = Some(flight.older(0.15 * off_deg)),
            "stuck axis" => {
                let mut shares = [1.0; 2];
                shares[dice.below(2)] = 0.0;
                case.trouble = Some((Trouble::SlowDrives(shares), dice.between(0.0, 0.7)));
            }
            "slow axis" => {
                let mut shares = [1.0; 2];
                shares[dice.below(2)] = 0.01 * 30_f64.powf(dice.between(0.0, 1.0));
                case.trouble = Some((Trouble::SlowDrives(shares), 0.0));
            }
            "slow drives" => {
                let share = 0.01 * 30_f64.powf(dice.between(0.0, 1.0));
                case.trouble = Some((Trouble::SlowDrives([share; 2]), 0.0));
            }
            "stop" => case.is_stopped = true,
            "link loss" => case.trouble = Some((Trouble::Silence, dice.between(0.1, 0.5))),
            fault => panic!("{fault}"),
        }
        case
    }

    /// Lets the antenna track the pass and returns its report; `None` if the antenna never starts to
    /// track.
    async fn report(&self, flight: &Flight, seed: u64) -> Option<RecordedReport> {
        let number = flight.elements.catalog_number();
        let station = Station { favourites: [number].into(), ..units::station() };
        let mut station = calibrated(station);
        station.antennas.retain(|antenna| antenna.name == self.name);
        // Without air, a unit that leaves refraction out makes no error.
        station.site = station.site.airless();
        let antenna_of = &mut station.antennas[0];
        antenna_of.beam_width_deg = 2.0 * self.half_beam_deg;
        antenna_of.sway_deg = antenna_of.sway_deg.max(self.mechanics.sway_deg);
        // A unit that misreads its angles may follow a rising satellite from the horizon.
        antenna_of.limits.minimum_elevation_deg = 0.0;
        let aos = flight.pass.aos.time;
        let start = aos - 4.minutes();
        let clock = Clock::at_speed(start, NonZeroU32::MIN);
        let scene = Scene::with_units(self.units(&clock, seed), clock, &station, self.old.as_ref());
        let client = scene.client();
        let id = measured(&client, self.name).await;
        if let Some((trouble, after)) = &self.trouble
            && *after < 0.0
        {
            assert!(self.set_trouble(&scene.units, *trouble, true));
        }
        let key = until("the pass", || {
            let lists = client.snapshot().pass_lists.clone();
            let listed = lists.favourites.passes.iter().find(|it| it.number() == number)?.key();
            Some(listed)
        })
        .await;
        // Azel refuses the track until it knows the faults of the unit.
        let begun = until_looking(Duration::from_secs(20), "the track", || {
            let tracks = antenna(&client, self.name)?.1.tracks.is_some();
            if !tracks && client.now().utc < aos {
                client.send(Command::Track { antenna: id, pass: key, is_agreed: true }).unwrap();
            }
            (tracks || client.now().utc > aos + 5.minutes()).then_some(tracks)
        });
        if !begun.await {
            return None;
        }
        let seconds = |share: f64| (share * flight.pass.duration_s()) as i64;
        let reached = |at: Timestamp| {
            let client = client.clone();
            async move {
                let look = Duration::from_secs(1);
                until_looking(look, "the time", || (client.now().utc >= at).then_some(())).await;
            }
        };
        if self.is_stopped {
            reached(aos + seconds(0.4).seconds()).await;
            client.stop(id);
        }
        if let Some((trouble, after)) = &self.trouble
            && *after >= 0.0
        {
            reached(aos + seconds(*after).seconds()).await;
            assert!(self.set_trouble(&scene.units, *trouble, true));
            if matches!(trouble, Trouble::Silence) {
                sleep(Duration::from_secs(90)).await;
                assert!(self.set_trouble(&scene.units, *trouble, false));
            }
        }
        let [row] = &reports(&scene).await[..] else { panic!("one report of {:?}", RowKind::Pass) };
        Some(serde_json::from_value(row.data["report"].clone()).unwrap())
    }

    fn units(&self, clock: &Clock, seed: u64) -> Units {
        let mut units = Units::new(clock);
        let mut options = satrak::Options::new(self.site, clock.now().utc);
        let held = self.old.clone().map_or_else(|| units::FAVOURITES.to_vec(), |old| vec![old]);
        options.elements.insert(BUNDLED_FILE.to_owned(), held);
        (options.mechanics, options.seed) = (self.mechanics, seed);
        units.dish = satrak::Control::on_clock(&options, clock.clone());
        let pair = rotator_genius::Options {
            rotators: [
                rotator_genius::RotatorOptions::default(),
                rotator_genius::RotatorOptions::elevation(),
            ],
            mechanics: self.mechanics,
            seed,
            ..rotator_genius::Options::default()
        };
        units.mast = rotator_genius::Control::on_clock(&pair, clock.clone());
        let axes = rc2000c::Options { mechanics: self.mechanics, seed, ..Default::default() };
        units.horn = rc2000c::Control::on_clock(&axes, clock.clone());
        units
    }

    fn set_trouble(&self, units: &Units, trouble: Trouble, is_on: bool) -> bool {
        let unit: &dyn InMemory = match self.name {
            "Dish" => &units.dish,
            "Mast" => &units.mast,
            _ => &units.horn,
        };
        unit.set_trouble(trouble, is_on)
    }
}

/// Returns the seconds lost to each cause.
fn lost_s(report: &RecordedReport) -> BTreeMap<String, f64> {
    let mut lost_s = BTreeMap::new();
    for lost in &report.report.losses {
        *lost_s.entry(format!("{:?}", lost.cause)).or_default() += lost.seconds();
    }
    lost_s
}

/// Returns the causes of the error, and the outside causes that took time of the pass from the
/// antenna.
fn named(report: &RecordedReport) -> Vec<String> {
    let kind = |value: serde_json::Value| value.as_str().unwrap().to_owned();
    let lost =
        report.report.losses.iter().map(|lost| kind(serde_json::to_value(lost.cause).unwrap()));
    let is_from_outside = |cause: &String| {
        ["stopped", "no_effect", "link_lost", "not_measured"].contains(&cause.as_str())
    };
    let causes = report
        .causes
        .iter()
        .flat_map(azel::plan::pass_report::Explanation::causes)
        .map(|cause| kind(serde_json::to_value(cause).unwrap()["cause"].clone()));
    causes.chain(lost.filter(is_from_outside)).collect()
}

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().unwrap())
}

#[tokio::test(start_paused = true)]
async fn no_cause_is_named_in_the_report_of_a_pass_without_a_fault() {
    let (seed, cases) = (number("AZEL_SEED", SEED), number("AZEL_CASES", CASES));
    let catalog = bundled().unwrap();
    let (mut untracked, mut spoilt, mut wrong) = (0, 0, 0);
    for case in seed..seed + cases {
        let mut dice = Dice::new(case);
        let flight = flight(&catalog, &mut dice);
        let name = ["Dish", "Mast", "Horn"][dice.below(3)];
        let half_beam_deg = 0.2 * 50_f64.powf(dice.between(0.0, 1.0));
        let antenna = Case::without_fault(name, half_beam_deg, mechanics(&mut dice));
        let Some(report) = antenna.report(&flight, case).await else {
            println!("case {case}, {name}: not tracked");
            untracked += 1;
            continue;
        };
        // An RC2000C shows no azimuth at its limit.
        let named = named(&report).into_iter().filter(|name| name != "not_measured");
        let named: Vec<String> = named.collect();
        spoilt += u32::from(report.report.verdict != azel::plan::pass_report::PassVerdict::Good);
        if !named.is_empty() {
            wrong += 1;
            println!(
                "case {case}, {name} {half_beam_deg:.2} {:?}: {named:?} {:?} {:?}",
                antenna.mechanics, report.causes, report.report
            );
        }
    }
    println!(
        "seeds {seed} to {}: {untracked} not tracked, {spoilt} spoilt, {wrong} named",
        seed + cases - 1
    );
    assert_eq!(wrong, 0);
}

#[tokio::test(start_paused = true)]
async fn the_fault_of_a_simulated_unit_is_named_in_the_report_of_its_pass() {
    let (seed, cases) = (number("AZEL_SEED", SEED), number("AZEL_CASES", CASES));
    let catalog = bundled().unwrap();
    // Counts by fault: cases, cases without a track or a spoilt pass, cases with the fault named,
    // and cases with it named alone.
    let mut table = BTreeMap::<&str, [u32; 4]>::new();
    for case in seed..seed + cases {
        let mut dice = Dice::new(case);
        let (fault, names) = FAULTS[(case % FAULTS.len() as u64) as usize];
        let flight = flight(&catalog, &mut dice);
        let antenna = Case::drawn(fault, &flight, &mut dice);
        let row = table.entry(fault).or_default();
        row[0] += 1;
        let Some(report) = antenna.report(&flight, case).await else {
            println!("case {case}, {fault} of {}: not tracked", antenna.name);
            row[1] += 1;
            continue;
        };
        let error_deg = report.report.rms.map_or(0.0, |rms| rms.off_deg);
        let is_from_outside = ["stop", "link loss"].contains(&fault);
        let is_good = report.report.verdict == azel::plan::pass_report::PassVerdict::Good;
        if is_good || !is_from_outside && error_deg <= 3.0 * antenna.noise_deg() {
            row[1] += 1;
            continue;
        }
        let named = named(&report);
        let is_named = named.iter().any(|name| names.contains(&name.as_str()));
        row[2] += u32::from(is_named);
        row[3] += u32::from(is_named && named.len() == 1);
        assert!(report.causes.len() <= 3, "{named:?}");
        if !is_named {
            println!(
                "case {case}, {fault} of {} {:.2}, {:?} {:?}: {:?} {:?}",
                antenna.name,
                antenna.half_beam_deg,
                antenna.mechanics,
                antenna.trouble,
                report.causes,
                lost_s(&report)
            );
        }
    }
    println!("seeds {seed} to {}: fault, cases, too small, named, alone", seed + cases - 1);
    for (name, row) in &table {
        println!("{name:16} {row:?}");
    }
    let total = |place: usize| table.values().map(|row| f64::from(row[place])).sum::<f64>();
    let counted = total(0) - total(1);
    assert!(counted >= 0.5 * total(0), "{counted} of {} spoil the pass", total(0));
    assert!(total(2) >= 0.95 * counted, "{} of {counted}", total(2));
}
