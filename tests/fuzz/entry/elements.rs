//! Fuzzing of element files: the entry reads a file, writes it in every form, reads it again and
//! searches for passes of its objects.

use azel::{
    astro::{HorizonMask, Site, time},
    orbit::{
        Elements, LookAngles, Pass, PassSearch, Propagator, ReadReport, clear_stretches,
        passes_and_effort, read_element_bytes, write_omm_csv, write_omm_json, write_tle,
    },
};
use jiff::{SignedDuration, Timestamp};

/// Max number of objects of a file that get a pass search.
const MAX_OBJECTS: usize = 4;
/// Max number of passes a day. Passes come once or twice a revolution, which takes over an hour.
const MAX_PASSES: usize = 40;
/// Max number of states computed for a day of one object; the worst of the catalog needs some
/// hundreds.
const MAX_EFFORT: u64 = 50_000;

/// Tolerance at the horizon, degrees: within it, up and down are both right.
const LEVEL_DEG: f64 = 1e-3;

pub(crate) fn run(bytes: &[u8]) {
    let report = read_element_bytes(bytes);
    assert!(report.elements.len() + report.refused.len() <= bytes.len());
    for refused in &report.refused {
        assert!(!refused.reason.to_string().is_empty());
    }
    comes_back(&report.elements);
    for elements in report.elements.iter().take(MAX_OBJECTS) {
        two_days(elements);
    }
}

/// Checks that OMM keeps every bit, and that a TLE keeps every value after one trip.
fn comes_back(elements: &[Elements]) {
    let written = |write: &dyn Fn(&mut Vec<u8>)| {
        let mut out = Vec::new();
        write(&mut out);
        (read_element_bytes(&out), out)
    };
    let json = written(&|out| write_omm_json(elements, out).expect("memory takes everything"));
    let csv = written(&|out| write_omm_csv(elements, out).expect("memory takes everything"));
    for (ReadReport { elements: again, refused, .. }, _) in [json, csv] {
        assert_eq!(refused, []);
        assert_eq!(again, elements);
    }
    let tle = |elements: &[Elements]| {
        written(&|out| drop(write_tle(elements, out).expect("memory takes everything")))
    };
    let (carried, text) = tle(elements);
    assert_eq!(carried.refused, [], "{}", String::from_utf8_lossy(&text));
    let (again, _) = tle(&carried.elements);
    assert_eq!(again.elements, carried.elements);
}

/// Checks the day of the epoch, and one fixed day for all objects.
fn two_days(elements: &Elements) {
    let site = Site::new(41.02, 29.17, 100.0).expect("a place");
    let propagator = Propagator::new(elements).expect("it was read");
    let fixed = Timestamp::from_second(1_786_492_800).expect("a time");
    for from in [elements.epoch(), fixed] {
        day(&propagator, site, from);
    }
}

fn day(propagator: &Propagator, site: Site, from: Timestamp) {
    let to = from + SignedDuration::from_hours(24);
    let search = PassSearch::new(site, from, to);
    let (found, effort) = passes_and_effort(propagator, &search, &|| false);
    assert!(found.len() < MAX_PASSES, "{} passes", found.len());
    assert!(effort < MAX_EFFORT, "{effort} states");
    in_order(&found, from, to);
    if !flies(propagator, from) {
        return;
    }
    seen_when_up(propagator, &search, &found);
    let mask = HorizonMask::from_degrees([(0.0, 3.0), (90.0, 12.5), (91.0, -2.0), (250.0, 40.0)])
        .expect("a mask");
    for pass in &found {
        let highest = pass.max_elevation();
        let points = [pass.aos, pass.tca, pass.los];
        assert!(points.iter().all(|point| point.direction.elevation <= highest), "{pass:?}");
        matches_the_sky(propagator, site, pass);
        let clear = clear_stretches(propagator, site, &mask, pass);
        in_order(&clear, pass.aos.time, pass.los.time);
    }
}

fn in_order(found: &[Pass], from: Timestamp, to: Timestamp) {
    let mut before = from;
    for pass in found {
        let times = [before, pass.aos.time, pass.tca.time, pass.los.time, to];
        assert!(times.is_sorted(), "{times:?}");
        before = pass.los.time;
        for point in [pass.aos, pass.tca, pass.los] {
            let (azimuth, elevation) = (point.direction.azimuth, point.direction.elevation);
            assert!((0.0..=360.0).contains(&azimuth.degrees()), "{pass:?}");
            assert!((-90.0..=90.0).contains(&elevation.degrees()), "{pass:?}");
        }
        assert!(pass.duration_s().is_finite());
    }
}

/// Returns `true` if the position changes of this day match the velocities. Years from the epoch,
/// the drag terms may move a satellite against its velocity, and no pass is right or wrong.
fn flies(propagator: &Propagator, from: Timestamp) -> bool {
    const SHARE: f64 = 0.01;
    let second = SignedDuration::from_secs(1);
    (0..24 * 60).step_by(60).map(|minute| from + SignedDuration::from_mins(minute)).all(|at| {
        let states = [at - second, at, at + second].map(|at| propagator.state_at(at));
        let [Ok(before), Ok(state), Ok(after)] = states else { return true };
        let rate = (after.position_km - before.position_km) / 2.0;
        (rate - state.velocity_km_s).length() <= SHARE * state.velocity_km_s.length()
    })
}

/// Checks that the satellite is up within its passes and down between them.
fn seen_when_up(propagator: &Propagator, search: &PassSearch, found: &[Pass]) {
    for minute in (0..24 * 60).step_by(10) {
        let at = search.start + SignedDuration::from_mins(minute);
        let Ok(look) = propagator.look_from(search.site.airless(), at) else {
            // A satellite that decayed after its epoch stays down. Before the epoch, the search
            // ends here too.
            break;
        };
        let elevation_deg = look.direction.elevation.degrees();
        let is_within = found.iter().any(|pass| (pass.aos.time..=pass.los.time).contains(&at));
        let is_level = elevation_deg.abs() < LEVEL_DEG;
        assert!(is_level || is_within == (elevation_deg > 0.0), "{elevation_deg} degrees at {at}");
    }
}

/// Checks that search and propagator agree on the culmination.
fn matches_the_sky(propagator: &Propagator, site: Site, pass: &Pass) {
    let at = pass.tca.time;
    let Ok(look) = propagator.look_from(site.airless(), at) else {
        // A millisecond earlier or later the object may have decayed.
        let near = [-1.0, 1.0].map(|offset_s| time::add_seconds(at, offset_s));
        assert!(near.iter().any(|at| propagator.look_from(site, *at).is_ok()), "{pass:?}");
        return;
    };
    let LookAngles { direction, range_km, range_rate_km_s } = look;
    assert!(range_km.is_finite() && range_rate_km_s.is_finite(), "{look:?}");
    let apart = direction.separation(pass.tca.direction).degrees();
    assert!(apart < 0.05, "{apart} degrees apart: {look:?} {pass:?}");
}
