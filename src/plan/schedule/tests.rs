//! Schedules of real satellites.

use std::time::Instant;

use super::testing::*;
use super::*;

#[test]
fn try_it() {
    let station = three_antennas();
    for (count, hours) in [(60, 24.0), (60, 168.0)] {
        let antennas = planned(&station, noon());
        let satellites = low_satellites(&mut Random::new(1), count);
        let start = Instant::now();
        let list = candidates(&station, &antennas, &satellites, noon(), hours);
        println!("{count} {hours} {} candidates {:?}", list.len(), start.elapsed());
        for partial in [
            None,
            Some(Partial { min_share: 0.6, min_s: 120.0, step_s: 30.0, hand_over: false }),
            Some(Partial { min_share: 0.4, min_s: 120.0, step_s: 60.0, hand_over: true }),
        ] {
            for n in [1, 3] {
                let start = Instant::now();
                let mut req = request(&antennas[..n], &list);
                req.partial = partial;
                let schedule = plan(&req);
                println!(
                    "{n} {partial:?} {} taken {} left {:?}",
                    schedule.entries.len(),
                    schedule.left_out.len(),
                    start.elapsed()
                );
                println!("   {:?}", schedule.worth);
            }
        }
    }
}
