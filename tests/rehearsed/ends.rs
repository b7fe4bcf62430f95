//! A rotator whose azimuth travel is a whole turn, and that comes to rest a little past its targets.

use std::{sync::Arc, time::Duration};

use azel::{
    orbit::bundled,
    rehearsal::{Rehearsal, run},
    sim::Mechanics,
    station::Station,
};

use crate::common::units;

const SENTINEL_6A: u32 = 46_984;
/// Shortly before passes in which the azimuth comes close to an end of the travel.
const STARTS: [&str; 3] =
    ["2026-08-13T05:50:00Z", "2026-08-14T04:15:00Z", "2026-08-14T06:15:00Z"];
/// A pass may lose this while the antenna turns back from an end, seconds.
const MAX_LOST_S: f64 = 5.0;

#[test]
fn a_rotator_that_runs_past_its_targets_does_not_wrap_at_an_end_of_its_travel() {
    let mechanics = Mechanics {
        dead_time: Duration::from_millis(200),
        coasting: None,
        minimum_run: Duration::from_millis(100),
        noise_deg: 0.02,
        backlash_deg: 0.05,
        sway_deg: 0.2,
    };
    let mut station = Station { favourites: [SENTINEL_6A].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name == "Mast");
    station.antennas[0].sway_deg += mechanics.sway_deg;
    for start in STARTS {
        let what = Rehearsal {
            station: station.clone(),
            elements: Arc::new(bundled().unwrap()),
            from: start.parse().unwrap(),
            hours: 0.2,
            seed: 7,
            mechanics,
            faults: Vec::new(),
            speed: None,
        };
        let rehearsed = run(&what, &|_| (), &|| false).unwrap();
        assert_eq!(rehearsed.passes.len(), 1, "{rehearsed:?}");
        for pass in rehearsed.passes {
            assert!(pass.lost_s() <= MAX_LOST_S, "{pass:?}");
        }
    }
}
