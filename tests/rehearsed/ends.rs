//! Rotators at the ends of their azimuth travel.

use std::{sync::Arc, time::Duration};

use azel::{
    makes::DemoAddresses,
    orbit::bundled,
    rehearsal::{Rehearsal, run},
    sim::Mechanics,
    station::Station,
};

use crate::common::units;

const SENTINEL_6A: u32 = 46_984;
const AQUA: u32 = 27_424;
/// Start times shortly before passes in which the azimuth of the Genius comes close to an end of
/// its travel.
const STARTS: [&str; 3] = ["2026-08-13T05:50:00Z", "2026-08-14T04:15:00Z", "2026-08-14T06:15:00Z"];
/// Max time that a pass may lose while the antenna turns back from an end, seconds.
const MAX_LOST_S: f64 = 5.0;

/// Rehearses a station with one antenna, whose axes come to rest a little past their targets.
fn rehearse(station: &Station, antenna: &str, start: &str, hours: f64, passes: usize) {
    let mechanics = Mechanics {
        dead_time: Duration::from_millis(200),
        coasting: None,
        minimum_run: Duration::from_millis(100),
        noise_deg: 0.02,
        backlash_deg: 0.05,
        sway_deg: 0.2,
    };
    let mut station = station.clone();
    station.antennas.retain(|known| known.name == antenna);
    station.antennas[0].sway_deg += mechanics.sway_deg;
    let what = Rehearsal {
        station,
        elements: Arc::new(bundled().unwrap()),
        start: start.parse().unwrap(),
        hours,
        seed: 7,
        mechanics,
        faults: Vec::new(),
        speed: None,
    };
    let rehearsed = run(&what, &|_| (), &|| false).unwrap();
    assert_eq!(rehearsed.passes.len(), passes, "{rehearsed:?}");
    for pass in rehearsed.passes {
        assert!(pass.lost_s() <= MAX_LOST_S, "{pass:?}");
    }
}

#[test]
fn a_rotator_that_runs_past_its_targets_does_not_wrap_at_an_end_of_its_travel() {
    let station = Station { favourites: [SENTINEL_6A].into(), ..units::station() };
    for start in STARTS {
        rehearse(&station, "Mast", start, 0.2, 1);
    }
}

/// The first pass leaves the travel at one end, where the unit reports no azimuth. The second pass
/// enters the travel at the other end.
#[test]
fn an_axis_that_stands_at_a_limit_sets_out_in_time_for_its_next_pass() {
    let addresses = DemoAddresses { rc2000c: "horn:1".to_owned(), ..DemoAddresses::default() };
    let demo = Station::demo(&addresses);
    let station = Station { favourites: [SENTINEL_6A, AQUA].into(), ..demo };
    rehearse(&station, "RC2000C", "2026-08-12T01:36:00Z", 1.2, 2);
}
