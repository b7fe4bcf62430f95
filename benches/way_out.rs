//! Cost of judging a jog out of a keep-out, for each key repeat and each reading: `cargo bench
//! --bench way_out`.
//!
//! One judgement tests 21 positions, half a degree apart, against three keep-outs and the Sun for
//! an hour ahead.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::{hint::black_box, time::Instant};

use azel::{
    plan::{Bounds, Sweep},
    station::{Antenna, Entered, KeepOut, Station, SunAvoidance},
};

/// Number of runs; the shortest counts.
const RUNS: usize = 50;
const LOOKS: u32 = 21;

fn keep_out(name: &str, entered: Entered, corners_deg: [(f64, f64); 4]) -> KeepOut {
    KeepOut {
        name: name.to_owned(),
        reason: String::new(),
        entered,
        antenna: None,
        margin_deg: 2.0,
        zone: KeepOut::zone_of(&corners_deg).unwrap(),
    }
}

fn main() {
    let chimney = [(160.0, -5.0), (190.0, -5.0), (190.0, 24.0), (160.0, 30.0)];
    let neighbour = [(300.0, 0.0), (340.0, 0.0), (340.0, 12.0), (300.0, 12.0)];
    let mast = [(60.0, -5.0), (66.0, -5.0), (66.0, 50.0), (60.0, 50.0)];
    let station = Station {
        keep_outs: vec![
            keep_out("chimney", Entered::Hard, chimney),
            keep_out("neighbour", Entered::Warn, neighbour),
            keep_out("mast", Entered::GoRound, mast),
        ],
        sun_avoidance: Some(SunAvoidance { radius_deg: 10.0, ahead_min: 60.0 }),
        ..Station::default()
    };
    let bounds = Bounds::new(&station, &Antenna::genius("Yagi", "memory:1"));
    let utc = "2026-08-12T10:00:00Z".parse().unwrap();
    for (name, from_deg, by_deg) in [
        ("up from the floor", [173.0, 0.0], [0.0, 0.5]),
        ("along the floor", [165.0, 0.0], [-0.5, 0.0]),
        ("below the floor", [165.0, -0.5], [-0.5, 0.0]),
        ("high up", [173.0, 25.0], [0.0, 0.5]),
    ] {
        let judged_ms = (0..RUNS).map(|_| {
            let started = Instant::now();
            let now = bounds.at_time(utc);
            for look in 0..LOOKS {
                let ahead = f64::from(look);
                let axes_deg = [from_deg[0] + ahead * by_deg[0], from_deg[1] + ahead * by_deg[1]];
                black_box(now.way_out_deg(black_box(Sweep::at_position(axes_deg))));
            }
            started.elapsed().as_secs_f64() * 1e3
        });
        println!("{name:<20} {:8.3} ms", judged_ms.min_by(f64::total_cmp).unwrap());
    }
}
