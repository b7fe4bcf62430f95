//! Stretches of a pass that clear a horizon mask, compared with samples every tenth of a
//! second.

use azel::{
    astro::{HorizonMask, Site, time},
    orbit::{Pass, PassSearch, Propagator, bundled, clear_stretches, passes},
};
use jiff::Timestamp;

fn site() -> Site {
    Site::new(41.02, 29.17, 100.0).unwrap()
}

fn start() -> Timestamp {
    "2026-08-12T00:00:00Z".parse().unwrap()
}

fn propagator(number: u32) -> Propagator {
    Propagator::new(bundled().unwrap().get(number).unwrap()).unwrap()
}

fn clearance_deg(propagator: &Propagator, mask: &HorizonMask, at: Timestamp) -> f64 {
    let direction = propagator.look_from(site().airless(), at).unwrap().direction;
    direction.elevation_deg() - mask.elevation_at(direction.azimuth).degrees()
}

/// Returns a low mask with steep walls from 0.02 to 1 degree wide.
fn walls() -> HorizonMask {
    let mut points = Vec::new();
    for index in 0..36 {
        let azimuth = f64::from(index) * 10.0 + 3.0;
        let width = [0.02, 0.2, 1.0][index as usize % 3];
        let height = 5.0 + f64::from(index % 7) * 12.0;
        points.extend([
            (azimuth, 1.0),
            (azimuth + 0.001, height),
            (azimuth + width, height),
            (azimuth + width + 0.001, 1.0),
        ]);
    }
    HorizonMask::from_degrees(points).unwrap()
}

fn check(propagator: &Propagator, mask: &HorizonMask, pass: &Pass, grid_s: f64) -> usize {
    let stretches = clear_stretches(propagator, site(), mask, pass);
    for pair in stretches.windows(2) {
        assert!(pair[0].los.time < pair[1].aos.time);
    }
    for index in 0..(pass.duration_s() / grid_s) as usize {
        let at = time::add_seconds(pass.aos.time, index as f64 * grid_s);
        let is_within =
            stretches.iter().any(|stretch| (stretch.aos.time..=stretch.los.time).contains(&at));
        let clear_deg = clearance_deg(propagator, mask, at);
        // At steep walls, a millisecond changes the clearance by some hundredths of a degree.
        let near =
            |offset_s| clearance_deg(propagator, mask, time::add_seconds(at, offset_s)) > 0.0;
        let is_edge = near(-1e-3) != near(1e-3) || clear_deg.abs() < 1e-4;
        assert!(is_within == (clear_deg >= 0.0) || is_edge, "{clear_deg} at {at}: {stretches:?}");
    }
    for stretch in &stretches {
        let top_deg = stretch.max_elevation().degrees();
        assert!(stretch.aos.time <= stretch.tca.time && stretch.tca.time <= stretch.los.time);
        assert_eq!(stretch.starts_before, pass.starts_before && stretch.aos == pass.aos);
        assert_eq!(stretch.ends_after, pass.ends_after && stretch.los == pass.los);
        for share in 0..=200 {
            let at_s = stretch.duration_s() * f64::from(share) / 200.0;
            let at = time::add_seconds(stretch.aos.time, at_s);
            let look = propagator.look_from(site().airless(), at).unwrap();
            assert!(look.direction.elevation_deg() <= top_deg + 1e-4, "{stretch:?} at {at}");
        }
    }
    stretches.len()
}

#[test]
fn every_wall_cuts_a_pass_where_it_stands() {
    let mask = walls();
    for number in [25_544, 43_013] {
        let propagator = propagator(number);
        let search = PassSearch::new(site(), start(), time::add_seconds(start(), 86_400.0));
        let found = passes(&propagator, &search, &|| false);
        let cuts: usize =
            found.iter().take(4).map(|pass| check(&propagator, &mask, pass, 0.1)).sum();
        assert!(cuts > 20, "{cuts}");
    }
}

#[test]
fn a_satellite_that_hardly_moves_stands_behind_a_wall_or_not() {
    let satellite = propagator(54_743);
    let search = PassSearch::new(site(), start(), time::add_seconds(start(), 86_400.0));
    let pass = passes(&satellite, &search, &|| false)[0];
    assert!(pass.starts_before && pass.ends_after);
    let top_deg = pass.max_elevation().degrees();
    for (level_deg, expected) in [(top_deg - 5.0, 1), (top_deg + 0.1, 0)] {
        let mask = HorizonMask::from_degrees([(0.0, level_deg)]).unwrap();
        assert_eq!(check(&satellite, &mask, &pass, 60.0), expected);
    }
    // A level that the satellite crosses up and down once a day.
    let mask = HorizonMask::from_degrees([(0.0, top_deg - 0.02)]).unwrap();
    assert!(check(&satellite, &mask, &pass, 60.0) >= 1);
}

#[test]
fn a_mask_below_the_pass_leaves_it_as_it_is() {
    let iss = propagator(25_544);
    let search = PassSearch::new(site(), start(), time::add_seconds(start(), 86_400.0));
    for pass in passes(&iss, &search, &|| false) {
        for level_deg in [0.0, -3.0] {
            let mask = HorizonMask::from_degrees([(0.0, level_deg)]).unwrap();
            assert_eq!(clear_stretches(&iss, site(), &mask, &pass), [pass]);
        }
    }
}
