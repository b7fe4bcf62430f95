//! Published verification cases of SGP4, against the output of its authors' C++ code.

use azel::{
    astro::time,
    orbit::{ElementsError, PropagationError, Propagator, RefusalReason, read_elements},
};
use glam::DVec3;

const SETS: &str = include_str!("data/SGP4-VER.TLE");
const EXPECTED: &str = include_str!("data/tcppver.out");
/// Tolerance of a position, km. The output is rounded to 1e-8 km and 1e-9 km/s. The rest allows for
/// the order of floating point operations, whose errors build up over 1,844,000 minutes.
const POSITION_TOLERANCE_KM: f64 = 1e-6;
const VELOCITY_TOLERANCE_KM_S: f64 = 2e-9;

/// An expected state.
struct Row {
    minutes: f64,
    position_km: DVec3,
    velocity_km_s: DVec3,
}

/// Returns the expected states of every case, by its number.
fn expected() -> Vec<(String, Vec<Row>)> {
    let mut cases: Vec<(String, Vec<Row>)> = Vec::new();
    for line in EXPECTED.lines().filter(|line| !line.trim().is_empty()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words[1] == "xx" {
            cases.push((words[0].to_owned(), Vec::new()));
            continue;
        }
        let numbers: Vec<f64> = words[..7].iter().map(|word| word.parse().unwrap()).collect();
        cases.last_mut().unwrap().1.push(Row {
            minutes: numbers[0],
            position_km: DVec3::from_slice(&numbers[1..4]),
            velocity_km_s: DVec3::from_slice(&numbers[4..7]),
        });
    }
    cases
}

/// Returns the two lines of every case. The authors made the error cases by hand without adjusting
/// the checksums, so this function corrects them.
fn sets() -> Vec<(String, String)> {
    let lines: Vec<String> =
        SETS.lines().filter(|line| !line.starts_with('#')).map(with_checksum).collect();
    lines.chunks_exact(2).map(|pair| (pair[0].clone(), pair[1].clone())).collect()
}

fn with_checksum(line: &str) -> String {
    let sum: u32 = line[..68]
        .chars()
        .map(|letter| if letter == '-' { 1 } else { letter.to_digit(10).unwrap_or(0) })
        .sum();
    format!("{}{}{}", &line[..68], sum % 10, &line[69..])
}

#[test]
fn every_case_agrees_with_the_authors_code() {
    let (mut worst_km, mut worst_km_s, mut states) = (0.0_f64, 0.0_f64, 0);
    for ((first, second), (number, rows)) in sets().iter().zip(expected()) {
        let report = read_elements(&format!("{first}\n{second}\n"));
        if number == "33333" {
            // The perigee of this case is 84 km from the centre of the Earth. Its rows reach 45,000
            // km where its apogee is 33,400 km from the centre.
            let reason = &report.refused[0].reason;
            let is_through = |error: &_| matches!(error, ElementsError::Perigee(-6400.0..=-6200.0));
            assert!(matches!(reason, RefusalReason::Orbit(error) if is_through(error)), "{reason}");
            continue;
        }
        if number == "33334" {
            // The only row of this case repeats the last state of the case before. Its mean motion
            // of 0.00001 is an error from the start.
            let reason = RefusalReason::Orbit(ElementsError::Decayed);
            assert_eq!(report.refused[0].reason, reason);
            continue;
        }
        assert_eq!(report.refused, [], "{number}");
        let elements = &report.elements[0];
        assert_eq!(elements.catalog_number().to_string(), number.trim_start_matches('0'));
        let propagator = Propagator::new(elements).unwrap();
        let state_at =
            |minutes: f64| propagator.state_at(time::add_seconds(elements.epoch(), minutes * 60.0));
        for row in &rows {
            let state = state_at(row.minutes).unwrap();
            let off_km = state.position_km.distance(row.position_km);
            let off_km_s = state.velocity_km_s.distance(row.velocity_km_s);
            worst_km = worst_km.max(off_km);
            worst_km_s = worst_km_s.max(off_km_s);
            states += 1;
        }
        let limits: Vec<f64> =
            second[69..].split_whitespace().map(|word| word.parse().unwrap()).collect();
        let (stop, step) = (limits[1], limits[2]);
        let last = rows.last().unwrap().minutes;
        if last + step <= stop {
            // The C++ code stops early on an error.
            assert_eq!(state_at(last + step), Err(PropagationError::Decayed), "{number}");
        }
    }
    println!("{states} states, at most {worst_km:e} km and {worst_km_s:e} km/s off");
    assert!(worst_km < POSITION_TOLERANCE_KM, "{worst_km} km");
    assert!(worst_km_s < VELOCITY_TOLERANCE_KM_S, "{worst_km_s} km/s");
}

#[test]
fn the_case_for_another_theory_is_refused() {
    assert_eq!(sets().len(), expected().len() + 1);
    let (first, second) = sets().pop().unwrap();
    let report = read_elements(&format!("{first}\n{second}\n"));
    assert_eq!(report.elements, []);
    let reason = RefusalReason::Orbit(ElementsError::EphemerisType(4));
    assert_eq!(report.refused[0].reason, reason);
}

#[test]
fn the_wrong_checksums_of_the_error_cases_cost_no_other_case() {
    let report = read_elements(SETS);
    assert_eq!(report.elements.len() + report.refused.len(), sets().len());
    for refusal in &report.refused {
        assert!(matches!(refusal.reason, RefusalReason::Checksum { .. }), "{refusal:?}");
    }
    let refused: Vec<_> =
        report.refused.iter().map(|refusal| refusal.object.as_deref().unwrap()).collect();
    assert_eq!(refused, ["33333", "33334", "33335", "20413"]);
}
