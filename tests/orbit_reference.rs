//! Directions and passes against Skyfield, for every kind of orbit, and refraction against traced
//! rays.

use std::collections::BTreeMap;

use azel::{
    astro::{Air, Angle, AzEl, Refraction, Site, time},
    orbit::{Pass, PassPoint, PassSearch, Propagator, passes, read_elements},
};
use glam::DVec3;
use jiff::Timestamp;
use serde::Deserialize;

#[derive(Deserialize)]
struct Meta {
    window_start: Timestamp,
    window_end: Timestamp,
    stations: Vec<Station>,
}

#[derive(Deserialize)]
struct Station {
    lat_deg: f64,
    lon_deg: f64,
    alt_m: f64,
}

#[derive(Deserialize)]
struct Set {
    line1: String,
    line2: String,
}

#[derive(Deserialize)]
struct Directions {
    meta: Meta,
    satellites: BTreeMap<String, Set>,
    samples: Vec<Sample>,
}

#[derive(Deserialize)]
struct Sample {
    norad: u32,
    t_s: f64,
    az: f64,
    el: f64,
    range_km: f64,
    range_rate_km_s: f64,
    teme_r_km: [f64; 3],
    teme_v_km_s: [f64; 3],
}

#[derive(Deserialize)]
struct Passes {
    meta: Meta,
    satellites: BTreeMap<String, Set>,
    #[serde(rename = "passes")]
    expected: Vec<Expected>,
}

#[derive(Deserialize)]
struct Expected {
    norad: u32,
    min_el: f64,
    aos_s: f64,
    tca_s: f64,
    los_s: f64,
    az_aos: f64,
    az_los: f64,
    max_el: f64,
    starts_before: bool,
    ends_after: bool,
}

impl Meta {
    fn site(&self) -> Site {
        let Station { lat_deg, lon_deg, alt_m } = self.stations[0];
        Site::new(lat_deg, lon_deg, alt_m).unwrap().airless()
    }
}

fn propagators(sets: &BTreeMap<String, Set>) -> BTreeMap<u32, Propagator> {
    let propagator = |set: &Set| {
        let report = read_elements(&format!("{}\n{}\n", set.line1, set.line2));
        Propagator::new(&report.elements[0]).unwrap()
    };
    sets.iter().map(|(number, set)| (number.parse().unwrap(), propagator(set))).collect()
}

#[test]
fn states_and_directions_agree_with_skyfield() {
    let reference: Directions =
        serde_json::from_str(include_str!("data/reference_azel.json")).unwrap();
    let propagators = propagators(&reference.satellites);
    let site = reference.meta.site();
    let mut worst = [0.0_f64; 5];
    for sample in &reference.samples {
        let at = time::add_seconds(reference.meta.window_start, sample.t_s);
        let propagator = &propagators[&sample.norad];
        let state = propagator.state_at(at).unwrap();
        let look = propagator.look_from(site, at).unwrap();
        let expected = AzEl::from_degrees(sample.az, sample.el);
        let off = [
            state.position_km.distance(DVec3::from_array(sample.teme_r_km)),
            state.velocity_km_s.distance(DVec3::from_array(sample.teme_v_km_s)),
            look.direction.separation(expected).degrees(),
            (look.range_km - sample.range_km).abs(),
            (look.range_rate_km_s - sample.range_rate_km_s).abs(),
        ];
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off);
        }
    }
    println!("position km, velocity km/s, direction deg, range km, range rate km/s: {worst:?}");
    let allowed = [2e-5, 2e-8, 2e-6, 2e-5, 2e-7];
    assert!(worst.iter().zip(allowed).all(|(worst, allowed)| *worst < allowed), "{worst:?}");
}

/// Returns the time error of `point`, seconds. The result is zero if the elevation changes slowly
/// and is right within 0.000 02 degrees, because the time then says little.
fn off_s(propagator: &Propagator, site: Site, point: PassPoint, expected: Timestamp) -> f64 {
    let elevation = |at| propagator.look_from(site, at).unwrap().direction.elevation_deg();
    let rate_deg_s =
        elevation(time::add_seconds(expected, 0.5)) - elevation(time::add_seconds(expected, -0.5));
    let difference_deg = point.direction.elevation_deg() - elevation(expected);
    if rate_deg_s.abs() < 0.002 && difference_deg.abs() < 2e-5 {
        return 0.0;
    }
    time::seconds_between(expected, point.time).abs()
}

#[test]
fn passes_agree_with_skyfield() {
    let reference: Passes =
        serde_json::from_str(include_str!("data/reference_passes.json")).unwrap();
    let Meta { window_start, window_end, .. } = reference.meta;
    let site = reference.meta.site();
    let (mut worst_s, mut worst_tca_s, mut worst_deg) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (number, propagator) in propagators(&reference.satellites) {
        for horizon_deg in [0.0, 10.0] {
            let aos_elevation = Angle::from_degrees(horizon_deg);
            let search =
                PassSearch { aos_elevation, ..PassSearch::new(site, window_start, window_end) };
            let found = passes(&propagator, &search, &|| false);
            let expected: Vec<&Expected> = reference
                .expected
                .iter()
                .filter(|pass| pass.norad == number && (pass.min_el - horizon_deg).abs() < 1e-9)
                .collect();
            assert_eq!(found.len(), expected.len(), "{number} over {horizon_deg}");
            for (found, expected) in found.iter().zip(expected) {
                let Pass { aos, tca, los, starts_before, ends_after } = *found;
                let flags = (expected.starts_before, expected.ends_after);
                assert_eq!((starts_before, ends_after), flags, "{number} {aos:?}");
                let at = |seconds| time::add_seconds(window_start, seconds);
                for (point, seconds, az) in
                    [(aos, expected.aos_s, expected.az_aos), (los, expected.los_s, expected.az_los)]
                {
                    let off = off_s(&propagator, site, point, at(seconds));
                    assert!(off < 0.01, "{number} {point:?} is off by {off} s");
                    worst_s = worst_s.max(off);
                    let turned = point.direction.azimuth - Angle::from_degrees(az);
                    assert!(turned.wrapped_180().abs().degrees() < 0.001, "{number} {point:?}");
                }
                worst_deg =
                    worst_deg.max((found.max_elevation().degrees() - expected.max_el).abs());
                // The top of a long pass is flat, so the test checks its elevation above instead of
                // its time.
                if found.duration_s() < 1800.0 {
                    let off = time::seconds_between(at(expected.tca_s), tca.time).abs();
                    worst_tca_s = worst_tca_s.max(off);
                }
            }
        }
    }
    println!("AOS and LOS {worst_s} s, TCA {worst_tca_s} s, elevation {worst_deg} deg");
    assert!(worst_deg < 1e-4, "{worst_deg}");
    assert!(worst_tca_s < 0.01, "{worst_tca_s}");
}

#[derive(Deserialize)]
struct Ray {
    altitude_m: f64,
    sea_level_n: f64,
    apparent_deg: f64,
    geometric_deg: f64,
    geometric_at_400_km_deg: f64,
}

/// Returns dry air at sea level with this refractivity, by its pressure and temperature.
fn dry_air(sea_level_n: f64) -> Refraction {
    let temperature_c = if sea_level_n > 300.0 { -60.0 } else { 15.0 };
    let pressure_hpa = sea_level_n * (temperature_c + 273.15) / 77.6;
    let air = Air::Measured;
    Refraction { air, pressure_hpa, temperature_c, humidity_percent: 0.0, ..Refraction::default() }
}

#[test]
fn refraction_agrees_with_traced_rays() {
    let mut table =
        csv::Reader::from_reader(include_bytes!("data/reference_refraction.csv").as_slice());
    let (mut rays, mut worst_deg, mut worst_near_deg, mut worst_near_5_deg) =
        (0, 0.0_f64, 0.0_f64, 0.0_f64);
    for ray in table.deserialize() {
        let ray: Ray = ray.unwrap();
        let is_standard = (ray.sea_level_n - 315.0).abs() < 1e-9;
        let air = if is_standard { Refraction::default() } else { dry_air(ray.sea_level_n) };
        let site = Site::new(41.0, 29.0, ray.altitude_m).unwrap().with_refraction(air).unwrap();
        let apparent =
            |geometric_deg| site.apparent(AzEl::from_degrees(120.0, geometric_deg)).elevation_deg();
        let back = site.geometric_elevation(Angle::from_degrees(ray.apparent_deg));
        let off_deg = (apparent(ray.geometric_deg) - ray.apparent_deg).abs();
        let back_off_deg = (back.degrees() - ray.geometric_deg).abs();
        worst_deg = worst_deg.max(off_deg).max(back_off_deg);
        let near_deg = (apparent(ray.geometric_at_400_km_deg) - ray.apparent_deg).abs();
        worst_near_deg = worst_near_deg.max(near_deg);
        if ray.apparent_deg > 4.9 {
            worst_near_5_deg = worst_near_5_deg.max(near_deg);
        }
        rays += 1;
    }
    println!(
        "{rays} rays: {worst_deg} deg; to 400 km {worst_near_deg} deg, from 5 deg up \
         {worst_near_5_deg} deg"
    );
    assert!(rays > 150, "{rays}");
    assert!(worst_deg < 1e-5, "{worst_deg}");
    // The ray from a satellite at 400 km ends where refraction still bends it.
    assert!(
        worst_near_deg < 0.1 && worst_near_5_deg < 0.015,
        "{worst_near_deg} {worst_near_5_deg}"
    );
}
