//! Comparison of the schedule with a greedy schedule: `cargo bench --bench schedule`.
//!
//! The greedy scheduler takes passes by their greatest elevation, the highest first, each on the
//! first antenna that is free. Both schedulers plan weeks of 60 satellites for the demo station's
//! three antennas with their real slews. The value is the seconds that count times the sine of the
//! max elevation. It ignores priorities, because the greedy scheduler knows none. All of this runs
//! on one core. The bench then finds and judges the whole catalogue for a day on each antenna
//! alone. This part runs on all cores, as in the station.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::indexing_slicing)]

use std::time::{Duration, Instant};

use azel::{
    astro::time::add_seconds,
    makes::DemoAddresses,
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes},
    plan::schedule::{
        Candidate, Common, PassPolicy, PlannedAntenna, Reach, Request, Schedule, Sight, Steadiness,
        plan,
    },
    station::{BetweenPasses, ChooseBy, PassLimits, Priority, Station},
};
use jiff::Timestamp;
use rayon::prelude::*;

const START: &str = "2026-08-12T00:00:00Z";
const WEEKS: u64 = 20;
const SATELLITES: usize = 60;

/// Generator of random numbers (Splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % u64::from(end)) as u32
    }
}

fn antennas(station: &Station, from: Timestamp) -> Vec<PlannedAntenna> {
    let planned = station.antennas.iter().map(|antenna| PlannedAntenna {
        id: antenna.id,
        reach: Reach::from_station(station, antenna, None),
        set_up_s: 20.0,
        between_passes: BetweenPasses::Wait,
        free_from: from,
        stands_deg: None,
        off_reason: None,
    });
    planned.collect()
}

/// Returns the site, antennas and search that all passes within `hours` share.
fn asked<'a>(
    station: &Station,
    antennas: &'a [PlannedAntenna],
    hours: f64,
) -> (Common<'a>, PassSearch) {
    let (site, floor) = (station.site, station.elevation_floor());
    let from = antennas[0].free_from;
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor,
        ..PassSearch::new(site, from, add_seconds(from, hours * 3600.0))
    };
    (Common { site, floor, antennas, max_age_s: None }, search)
}

/// Returns the candidates, and the times for finding passes and judging them.
fn candidates(
    station: &Station,
    antennas: &[PlannedAntenna],
    satellites: &[(Elements, Priority)],
    hours: f64,
) -> (Vec<Candidate>, Duration, Duration) {
    let (common, search) = asked(station, antennas, hours);
    let (mut found, limits) = (Vec::new(), PassLimits::default());
    let (mut finding, mut judging) = (Duration::ZERO, Duration::ZERO);
    for (elements, priority) in satellites {
        let Ok(propagator) = Propagator::new(elements) else { continue };
        let start = Instant::now();
        let passes = passes(&propagator, &search, &|| false);
        finding += start.elapsed();
        let start = Instant::now();
        for pass in passes {
            let satellite = (elements, *priority, &propagator);
            found.push(candidate(station, satellite, &pass, &limits, common));
        }
        judging += start.elapsed();
    }
    (found, finding, judging)
}

fn candidate(
    station: &Station,
    (elements, priority, propagator): (&Elements, Priority, &Propagator),
    pass: &Pass,
    limits: &PassLimits,
    common: Common<'_>,
) -> Candidate {
    let mut sight = Sight::new(propagator, station.site, None, pass);
    let wanted = PassPolicy { priority, take: None, limits, by_rule: &|_| None };
    let number = elements.catalog_number();
    Candidate::new(number, 0.0, (pass, propagator), wanted, &mut sight, common)
}

/// Returns the same as [`candidates`], computed on all cores.
fn candidates_at_once(
    station: &Station,
    antennas: &[PlannedAntenna],
    satellites: &[(Elements, Priority)],
    hours: f64,
) -> (Vec<Candidate>, Duration, Duration) {
    let (common, search) = asked(station, antennas, hours);
    let limits = &PassLimits::default();
    let start = Instant::now();
    let found: Vec<_> = satellites
        .par_iter()
        .filter_map(|(elements, priority)| {
            let propagator = Propagator::new(elements).ok()?;
            let passes = passes(&propagator, &search, &|| false);
            Some((elements, *priority, propagator, passes))
        })
        .collect();
    let finding = start.elapsed();
    let start = Instant::now();
    let judged = found.par_iter().flat_map(|(elements, priority, propagator, passes)| {
        let satellite = (*elements, *priority, propagator);
        let judged = passes.par_iter();
        judged.map(move |pass| candidate(station, satellite, pass, limits, common))
    });
    let judged = judged.collect();
    (judged, finding, start.elapsed())
}

fn planned(antennas: &[PlannedAntenna], candidates: &[Candidate]) -> (Schedule, Duration) {
    let start = Instant::now();
    let schedule = plan(&Request {
        antennas,
        candidates,
        choose_by: ChooseBy::Elevation,
        partial: None,
        previous: None,
        steadiness: Steadiness::default(),
        fixed: &[],
    });
    (schedule, start.elapsed())
}

fn worth(schedule: &Schedule) -> i64 {
    schedule.entries.iter().map(|entry| entry.worth).sum()
}

/// Plans the highest pass first, keeps each pass that fits with all kept passes, and returns the
/// total value.
fn greedy(antennas: &[PlannedAntenna], candidates: &[Candidate]) -> i64 {
    let mut order: Vec<&Candidate> = candidates.iter().collect();
    order.sort_by(|a, b| {
        b.max_elevation.degrees().total_cmp(&a.max_elevation.degrees()).then(a.key.cmp(&b.key))
    });
    let mut taken: Vec<Vec<Candidate>> = vec![Vec::new(); antennas.len()];
    let mut total = 0;
    for candidate in order {
        for (antenna, own) in antennas.iter().zip(&mut taken) {
            let near = |it: &&Candidate| {
                let apart_s = it.key.aos.duration_since(candidate.key.aos).as_secs_f64().abs();
                apart_s < 3_600.0
            };
            let mut few: Vec<Candidate> = own.iter().filter(near).cloned().collect();
            few.push(candidate.clone());
            let (all, _) = planned(std::slice::from_ref(antenna), &few);
            if all.entries.len() == few.len() {
                let mine = all.entries.iter().find(|entry| entry.pass == candidate.key);
                total += mine.unwrap().worth;
                own.push(candidate.clone());
                break;
            }
        }
    }
    total
}

fn main() {
    let station = Station::demo(&DemoAddresses::default());
    let start: Timestamp = START.parse().unwrap();
    let catalog = bundled().unwrap();
    let low: Vec<&Elements> =
        catalog.iter().filter(|it| (5_400.0..6_900.0).contains(&it.period_s())).collect();
    let mut random = Random(1);
    let (mut gains, mut slowest) = (Vec::new(), Duration::ZERO);
    for week in 0..WEEKS {
        let from = add_seconds(start, week as f64 * 86_400.0);
        let mut chosen: Vec<(Elements, Priority)> = Vec::new();
        for _ in 0..SATELLITES {
            let it = low[random.below(low.len() as u32) as usize].clone();
            chosen.push((it, Priority::try_from(1 + random.below(5) as i64).unwrap()));
        }
        chosen.sort_by_key(|(it, _)| it.catalog_number());
        chosen.dedup_by_key(|(it, _)| it.catalog_number());
        let antennas = antennas(&station, from);
        let (list, finding, judging) = candidates(&station, &antennas, &chosen, 168.0);
        let (schedule, planning) = planned(&antennas, &list);
        slowest = slowest.max(planning);
        let mut even = list.clone();
        for candidate in &mut even {
            candidate.priority = Priority::default();
        }
        let (best, even_planning) = planned(&antennas, &even);
        let gain = 100.0 * (worth(&best) as f64 / greedy(&antennas, &even) as f64 - 1.0);
        println!(
            "week {week:2}: {} passes, found {finding:.2?}, judged {judging:.2?}, planned \
             {planning:.2?} (taken {}, proved {}), without priorities {even_planning:.2?} (proved \
             {}): {gain:+.1} % over greedy",
            list.len(),
            schedule.entries.len(),
            schedule.is_proved(),
            best.is_proved(),
        );
        gains.push(gain);
    }
    let mean = gains.iter().sum::<f64>() / gains.len() as f64;
    println!("gain over greedy: mean {mean:.1} %, slowest week with priorities {slowest:.2?}");

    let all: Vec<(Elements, Priority)> =
        catalog.iter().map(|it| (it.clone(), Priority::default())).collect();
    for antenna in antennas(&station, start) {
        let one = [antenna];
        let (list, finding, judging) = candidates_at_once(&station, &one, &all, 24.0);
        let (schedule, planning) = planned(&one, &list);
        println!(
            "whole catalogue, a day, one antenna: {} passes, found {finding:.2?}, judged \
             {judging:.2?}, planned {planning:.2?} (taken {}, proved {})",
            list.len(),
            schedule.entries.len(),
            schedule.is_proved(),
        );
    }
}
