use jiff::SignedDuration;

use super::*;
use crate::{
    makes::DemoAddresses,
    orbit::{Catalog, PassSearch, bundled, passes, read_elements},
    plan::schedule::{Class, Conflict, Entry, LeftOut, LeftOutReason, testing},
    station::Priority,
    ui::page::testing::prints_on_one_sheet,
};

const ISS: u32 = 25_544;
const HOSTILE: &str = "<&\"'>]]>\u{0}\u{1b}[2J\u{202e}\u{ffff} \u{1f6f0}漢字漢字 ";

fn start() -> Timestamp {
    "2026-08-12T07:00:00Z".parse().unwrap()
}

fn hours(count: i64) -> Timestamp {
    start() + SignedDuration::from_hours(count)
}

/// Returns elements and propagators of satellites in low orbits.
fn satellites(catalog: &Catalog, count: usize) -> Vec<(Elements, Propagator)> {
    let low = catalog.iter().filter(|elements| (5_400.0..6_900.0).contains(&elements.period_s()));
    let known_satellites =
        low.filter_map(|elements| Some((elements.clone(), Propagator::new(elements).ok()?)));
    known_satellites.take(count).collect()
}

/// Returns a schedule that takes `used` passes of a day and leaves out `left_out` more. Each
/// left-out pass conflicts with the last entry.
fn schedule(
    station: &Station,
    satellites: &[(Elements, Propagator)],
    (used, left_out): (usize, usize),
) -> Schedule {
    let search = PassSearch::new(station.site, start(), hours(24));
    let mut found = Vec::new();
    for (elements, propagator) in satellites {
        let satellite = elements.catalog_number();
        let own = passes(propagator, &search, &|| false).into_iter();
        found.extend(own.map(|pass| (PassKey { satellite, aos: pass.aos.time }, pass)));
    }
    found.sort_by_key(|(key, _)| (key.aos, key.satellite));
    assert!(found.len() >= used + left_out, "{}", found.len());
    let mut schedule = Schedule::default();
    for (index, (pass, own_pass)) in found.into_iter().take(used + left_out).enumerate() {
        let antenna = station.antennas[index % station.antennas.len()].id;
        let class = Class::Priority(Priority::default());
        if schedule.entries.len() < used {
            schedule.entries.push(Entry {
                late_s: if index % 3 == 0 { 73.0 } else { 0.0 },
                early_s: if index % 4 == 0 { 586.0 } else { 0.0 },
                slew_s: 41.0,
                set_up_s: 12.0,
                spare_s: Some(if index % 5 == 0 { 12.0 } else { 45_296.0 }),
                ..testing::entry(antenna, pass, own_pass.los.time)
            });
        } else {
            let pass_key = schedule.entries.last().map_or(pass, |entry| entry.pass);
            let reason = LeftOutReason::Overlaps(Conflict {
                pass: pass_key,
                class,
                missing_s: 482.0,
                others: vec![],
            });
            let by_antenna = vec![(antenna, reason.clone())];
            schedule.left_out.push(LeftOut { pass, reason, by_antenna });
        }
    }
    schedule
}

fn printed(
    station: &Station,
    schedule: &Schedule,
    satellites: &[(Elements, Propagator)],
) -> String {
    let known_satellites = satellites
        .iter()
        .map(|(elements, propagator)| (elements.catalog_number(), (elements, propagator)))
        .collect();
    HandOverSheet::new(station, schedule, &known_satellites, (start(), hours(48)), start()).html()
}

/// Returns the sheet of the demo station with these numbers of passes taken and left out.
fn sheet(counts: (usize, usize)) -> String {
    let station = Station::demo(&DemoAddresses::default());
    let satellites = satellites(&bundled().unwrap(), 60);
    printed(&station, &schedule(&station, &satellites, counts), &satellites)
}

/// Returns the number of thumbnails: each has one dot.
fn dots(page: &str) -> usize {
    page.matches("class=\"filled\" cx=").count()
}

#[test]
fn one_page_holds_any_number_of_passes_and_counts_the_rest() {
    for used in [0, 1, 20, 21, 45, 60, 100, 200] {
        let page = sheet((used, 30));
        let shown = dots(&page);
        if shown < used {
            assert!(page.contains(&format!(">and {} more in the list<", used - shown)), "{used}");
        }
        assert!(shown == used || shown >= 60, "{shown} of {used}");
        assert!(page.contains(">Handed over by<") && page.contains(">30 passes, "), "{used}");
    }
}

#[test]
fn the_price_of_a_pass_is_what_the_antenna_that_gives_up_least_has_to_drop() {
    let station = Station::demo(&DemoAddresses::default());
    let satellites = satellites(&bundled().unwrap(), 10);
    let mut schedule = schedule(&station, &satellites, (3, 1));
    let class = |number| Class::Priority(Priority::try_from(number).unwrap());
    let first_line = |schedule: &Schedule| {
        let page = printed(&station, schedule, &satellites);
        let mut texts = page.split(['<', '>']);
        texts.find(|text| text.contains(" on ")).map(str::to_owned).unwrap_or_default()
    };
    let name = |other: &Entry| {
        let own =
            satellites.iter().find(|set| set.0.catalog_number() == other.pass.satellite).unwrap();
        format!("{} {}", own.0.label(), format::minute_of_day(other.pass.aos))
    };
    let overlap = |entry: &Entry| {
        let (key, class) = (entry.pass, entry.class);
        let conflict = Conflict { pass: key, class, missing_s: 482.0, others: vec![] };
        (entry.antenna, LeftOutReason::Overlaps(conflict))
    };
    // The price is the lowest priority, then the shortest entry.
    for (entry, number) in schedule.entries.iter_mut().zip([1, 4, 4]) {
        entry.class = class(number);
        entry.counted_s = 100.0 * f64::from(entry.antenna.0);
    }
    let antennas = [0, 1, 2].map(|index: usize| station.antennas[index].name.clone());
    schedule.left_out[0].by_antenna = schedule.entries.iter().map(overlap).collect();
    let [_, second, _] = &schedule.entries[..] else { panic!("three entries") };
    assert_eq!(first_line(&schedule), format!("{} on {}", name(second), antennas[1]));

    schedule.left_out[0].by_antenna[2].1 = LeftOutReason::NotFound;
    assert_eq!(first_line(&schedule), format!("Nothing on {}", antennas[2]));

    schedule.left_out[0].by_antenna.truncate(1);
    assert_eq!(first_line(&schedule), format!("{} on {}", name(&schedule.entries[0]), antennas[0]));

    schedule.left_out[0].by_antenna.clear();
    assert_eq!(first_line(&schedule), "");
}

#[test]
fn an_empty_schedule_says_so() {
    let page = sheet((0, 0));
    assert!(page.contains(">No passes<") && page.contains(">No pass is left out<"), "{page}");
}

#[test]
fn passes_of_one_satellite_that_are_left_out_for_one_reason_are_one_row() {
    let station = Station::demo(&DemoAddresses::default());
    let catalog = bundled().unwrap();
    let elements = catalog.get(ISS).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let satellites = [(elements, propagator)];
    let mut schedule = schedule(&station, &satellites, (0, 5));
    for left in &mut schedule.left_out {
        left.reason = LeftOutReason::OtherAntennas(vec![AntennaId::FIRST]);
        left.by_antenna.clear();
    }
    let page = printed(&station, &schedule, &satellites);
    assert_eq!(page.matches("Your limits or rules allow only Satrak").count(), 1, "{page}");
    assert!(page.contains(" +2<"), "{page}");
}

#[test]
fn names_from_outside_break_nothing() {
    let mut station = Station::demo(&DemoAddresses::default());
    station.name = HOSTILE.repeat(9);
    for antenna in &mut station.antennas {
        antenna.name = HOSTILE.repeat(9);
    }
    let text = serde_json::json!({
        "OBJECT_NAME": HOSTILE.repeat(9), "OBJECT_ID": "1998-067A", "NORAD_CAT_ID": ISS,
        "EPOCH": "2026-08-11T01:21:00", "MEAN_MOTION": 15.5, "ECCENTRICITY": 0.001,
        "INCLINATION": 51.6, "RA_OF_ASC_NODE": 0, "ARG_OF_PERICENTER": 0, "MEAN_ANOMALY": 0,
        "BSTAR": 0
    });
    let elements = read_elements(&text.to_string()).elements.remove(0);
    let propagator = Propagator::new(&elements).unwrap();
    let satellites = [(elements, propagator)];
    for counts in [(5, 0), (2, 3)] {
        let schedule = schedule(&station, &satellites, counts);
        let page = printed(&station, &schedule, &satellites);
        let unseen = |letter: char| letter != '\n' && letter.is_control() || letter == '\u{202e}';
        assert!(!page.contains(unseen), "{page}");
    }
}

#[test]
fn many_antennas_leave_room_for_the_passes() {
    let mut station = Station::demo(&DemoAddresses::default());
    while station.antennas.len() < 20 {
        let mut antenna = station.antennas[0].clone();
        antenna.id = AntennaId(100 + station.antennas.len() as u32);
        station.antennas.push(antenna);
    }
    let satellites = satellites(&bundled().unwrap(), 60);
    let page = printed(&station, &schedule(&station, &satellites, (80, 40)), &satellites);
    assert!(page.contains(">and 12 more<") && dots(&page) > 40, "{}", dots(&page));
}

#[test]
fn elements_that_are_too_old_are_marked() {
    let mut station = Station::demo(&DemoAddresses::default());
    let satellites = satellites(&bundled().unwrap(), 60);
    let schedule = schedule(&station, &satellites, (20, 0));
    let page = printed(&station, &schedule, &satellites);
    assert!(page.contains("oldest first. 0 of ") && !page.contains(" h ×"), "{page}");
    station.scheduling.max_element_age_d = Some(0.5);
    let page = printed(&station, &schedule, &satellites);
    assert!(!page.contains("oldest first. 0 of ") && page.contains(" h ×<"), "{page}");
}

#[test]
fn one_schedule_makes_one_sheet() {
    assert_eq!(sheet((50, 20)), sheet((50, 20)));
}

#[test]
fn a_satellite_whose_elements_are_gone_keeps_its_row() {
    let station = Station::demo(&DemoAddresses::default());
    let satellites = satellites(&bundled().unwrap(), 10);
    let schedule = schedule(&station, &satellites, (3, 3));
    let page = printed(&station, &schedule, &[]);
    let number = schedule.entries[0].pass.satellite;
    assert!(page.contains(&format!(">{number}<")), "{page}");
}

#[test]
#[ignore = "needs Chromium"]
fn chromium_prints_a_sheet_of_any_length_on_one_page() {
    for counts in [(0, 0), (20, 30), (45, 30), (200, 30), (60, 0)] {
        prints_on_one_sheet(&sheet(counts));
    }
}
