//! Identity of the events in a calendar. Events keep it with the elements of the next day, a newly
//! measured site or a moved window, and no two events share one.
//!
//! `AZEL_EVENT_STRIDE=1` takes the whole bundled catalog instead of every 16th object:
//! `AZEL_EVENT_STRIDE=1 cargo test --release --test azel pass_event_ids -- --nocapture`.

use std::collections::{BTreeMap, BTreeSet};

use azel::{
    astro::{Angle, HorizonMask, Site, time},
    export::{EventFormat, ExportedPass, PassList, PassQuery, Satellite},
    orbit::{Elements, Pass, PassSearch, bundled, passes_of_all, read_elements, write_omm_json},
};
use jiff::Timestamp;
use serde_json::Value;

use crate::common::dice::Dice;

const STRIDE: usize = 16;
const SEED: u64 = 20_260_812;
/// Gravitational parameter of the Earth, km³/s².
const GRAVITY_KM3_S2: f64 = 398_600.8;

/// A calendar: pass and identity of each event, by satellite.
struct Calendar {
    events: Vec<(u32, Pass, String)>,
}

fn elements() -> Vec<Elements> {
    let stride = std::env::var("AZEL_EVENT_STRIDE").map_or(STRIDE, |text| text.parse().unwrap());
    bundled().unwrap().iter().step_by(stride).cloned().collect()
}

fn query(site: Site, from: Timestamp, hours: f64) -> PassQuery {
    let to = time::add_seconds(from, hours * 3600.0);
    PassQuery { search: PassSearch::new(site, from, to), mask: None }
}

fn start() -> Timestamp {
    "2026-08-12T00:00:00Z".parse().unwrap()
}

fn calendar(elements: &[Elements], query: &PassQuery) -> Calendar {
    let satellites: Vec<Satellite> =
        elements.iter().map(|elements| Satellite::new(elements.clone()).unwrap()).collect();
    let mut found: Vec<(usize, Pass)> =
        passes_of_all(&satellites, &query.search, &|_| {}, &|| false)
            .flat_map(|(index, pass)| {
                let parts = query.parts(&satellites[index].propagator, pass);
                parts.into_iter().map(move |part| (index, part))
            })
            .collect();
    found.sort_by_key(|(_, pass)| pass.aos.time);
    let rows: Vec<ExportedPass<'_>> = found
        .iter()
        .map(|(index, pass)| ExportedPass { satellite: &satellites[*index], pass: *pass })
        .collect();
    let list =
        PassList { query, place: None, carrier_hz: None, alarm_before_s: None, now: start() };
    let mut text = Vec::new();
    list.write(&mut text, EventFormat::Ics, rows.iter().copied()).unwrap();
    let text = String::from_utf8(text).unwrap().replace("\r\n ", "");
    let ids: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("UID:")).collect();
    assert_eq!(ids.len(), rows.len());
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "two events share one");
    let number = |row: &ExportedPass<'_>| row.satellite.elements.catalog_number();
    let events = rows.iter().zip(ids).map(|(row, id)| (number(row), row.pass, id.to_owned()));
    Calendar { events: events.collect() }
}

/// Counts the passes of `before` that are also in `after`, and those of them with the same
/// identity.
fn kept(before: &Calendar, after: &Calendar) -> (usize, usize) {
    let mut by_number: BTreeMap<u32, Vec<(&Pass, &str)>> = BTreeMap::new();
    for (number, pass, id) in &after.events {
        by_number.entry(*number).or_default().push((pass, id));
    }
    let (mut all, mut kept) = (0, 0);
    for (number, pass, id) in &before.events {
        let overlap_s = |other: &Pass| {
            let from = pass.aos.time.max(other.aos.time);
            time::seconds_between(from, pass.los.time.min(other.los.time))
        };
        let others = by_number.get(number).into_iter().flatten();
        let same = others.max_by(|a, b| overlap_s(a.0).total_cmp(&overlap_s(b.0)));
        if let Some((_, after)) = same.filter(|(other, _)| overlap_s(other) > 0.0) {
            all += 1;
            kept += usize::from(id == after);
        }
    }
    (all, kept)
}

/// Returns elements as of the next day: 35 m to 2 km off along the track, with a mean motion that
/// differs by a ten-millionth.
fn renewed(elements: &[Elements]) -> Vec<Elements> {
    let mut text = Vec::new();
    write_omm_json(elements, &mut text).unwrap();
    let mut list: Vec<Value> = serde_json::from_slice(&text).unwrap();
    let mut dice = Dice::new(SEED);
    for object in &mut list {
        let number = |key: &str| object[key].as_f64().unwrap();
        let rate_rad_s = number("MEAN_MOTION") * std::f64::consts::TAU / time::DAY_S;
        let axis_km = (GRAVITY_KM3_S2 / (rate_rad_s * rate_rad_s)).cbrt();
        let sign = |dice: &mut Dice| if dice.chance(0.5) { 1.0 } else { -1.0 };
        let along_km = sign(&mut dice) * dice.between(0.035, 2.0);
        let anomaly_deg = number("MEAN_ANOMALY") + (along_km / axis_km).to_degrees();
        let motion = number("MEAN_MOTION") * (1.0 + sign(&mut dice) * 1e-7);
        object["MEAN_ANOMALY"] = anomaly_deg.rem_euclid(360.0).into();
        object["MEAN_MOTION"] = motion.into();
    }
    let report = read_elements(&Value::from(list).to_string());
    assert_eq!((report.elements.len(), report.refused.len()), (elements.len(), 0));
    report.elements
}

/// Checks that at least 99.9 % of the events keep their identity, and prints the number.
fn check(what: &str, before: &Calendar, after: &Calendar) {
    let (all, kept) = kept(before, after);
    println!("{what}: {kept} of {all} kept their identity (seed {SEED})");
    assert!(all > before.events.len() / 2, "{what}: {all}");
    assert!(kept as f64 >= 0.999 * all as f64, "{what}: {kept} of {all}");
}

#[test]
fn an_event_keeps_its_identity_whatever_moves_a_little() {
    let elements = elements();
    let site = Site::default();
    let before = calendar(&elements, &query(site, start(), 24.0));
    println!("{} objects, {} passes", elements.len(), before.events.len());
    check("elements of the next day", &before, &{
        calendar(&renewed(&elements), &query(site, start(), 24.0))
    });
    // The site moves 10 m to the north-east.
    let moved = Site::new(41.02 + 6.4e-5, 29.17 + 8.4e-5, 100.0).unwrap();
    check("site moved by 10 m", &before, &calendar(&elements, &query(moved, start(), 24.0)));
    let later = query(site, time::add_seconds(start(), 5.0 * 3600.0), 24.0);
    check("window moved by 5 h", &before, &calendar(&elements, &later));
}

#[test]
fn a_stretch_over_a_mask_keeps_its_identity_too() {
    let mask = "0 0\n40 25\n80 0\n120 30\n140 0\n180 10\n200 45\n220 0\n300 20\n340 0\n";
    let mask = HorizonMask::parse(mask).unwrap();
    let elements: Vec<Elements> = elements().into_iter().step_by(4).collect();
    let masked = |hours: f64| {
        let from = time::add_seconds(start(), hours * 3600.0);
        let query = query(Site::default(), from, 24.0);
        PassQuery { mask: Some(mask.clone()), ..query }
    };
    let before = calendar(&elements, &masked(0.0));
    check("masked, window moved", &before, &calendar(&elements, &masked(5.0)));
    let after = calendar(&renewed(&elements), &masked(0.0));
    let (all, kept) = kept(&before, &after);
    println!("masked, elements of the next day: {kept} of {all}");
    // A stretch that just clears a corner comes and goes, which renumbers the later stretches.
    assert!(kept as f64 >= 0.99 * all as f64, "{kept} of {all}");
}

#[test]
fn two_stations_do_not_share_events() {
    let elements: Vec<Elements> = elements().into_iter().step_by(8).collect();
    let here = calendar(&elements, &query(Site::default(), start(), 6.0));
    let ankara = Site::new(39.93, 32.85, 900.0).unwrap();
    let there = calendar(&elements, &query(ankara, start(), 6.0));
    let ids = |calendar: &Calendar| -> BTreeSet<String> {
        calendar.events.iter().map(|(.., id)| id.clone()).collect()
    };
    assert!(!here.events.is_empty() && ids(&here).is_disjoint(&ids(&there)));
}

#[test]
fn a_geostationary_satellite_has_an_identity_without_a_time() {
    let catalog = bundled().unwrap();
    let meteosat = [catalog.get(54_743).unwrap().clone()];
    let ids: BTreeSet<String> = [0.0, 5.0, 100.0]
        .into_iter()
        .flat_map(|hours| {
            let from = time::add_seconds(start(), hours * 3600.0);
            let mut query = query(Site::default(), from, 30.0);
            query.search.aos_elevation = Angle::from_degrees(5.0);
            calendar(&meteosat, &query).events.into_iter().map(|(.., id)| id)
        })
        .collect();
    assert_eq!(ids.len(), 1, "{ids:?}");
    assert!(ids.first().unwrap().contains("-up@"), "{ids:?}");
}
