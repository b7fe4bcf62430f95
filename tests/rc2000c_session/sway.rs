//! Readings of a standing antenna that change by noise, beside a keep-out.

use azel::{
    contract::driver::{Event, Safety},
    plan::Bounds,
    sim::{Mechanics, rc2000c::Options},
    station::{Antenna, Station},
};

use super::rig::{Rig, antenna};

#[tokio::test(start_paused = true)]
async fn noise_beside_a_keep_out_is_not_stopped_as_a_motion() {
    for seed in 1..=4 {
        let mechanics = Mechanics { noise_deg: 0.3, ..Mechanics::default() };
        let options = Options { mechanics, seed, ..Options::default() };
        let narrow = Antenna { beam_width_deg: 1.0, ..antenna() };
        let mut rig = Rig::connected(&options, &narrow).await;
        let azimuth_deg = rig.shown().state.measured.unwrap().axes[0].angle_deg.unwrap();
        // The beam and the margin of a mast 3 degrees away begin about 1.5 degrees from here.
        let (near_deg, far_deg) = (azimuth_deg + 3.0, azimuth_deg + 13.0);
        let corners = [(near_deg, -5.0), (far_deg, -5.0), (far_deg, 85.0), (near_deg, 85.0)];
        let mast = crate::common::mast(&corners);
        let station = Station { keep_outs: vec![mast], ..Station::default() };
        rig.handle().keep_within(Bounds::new(&station, &narrow));
        rig.seconds(600.0).await;
        assert_eq!(rig.shown().breach, None, "seed {seed}: it stands outside");
        let is_forbidden = |event: &Event| matches!(event, Event::Safety(Safety::Forbidden { .. }));
        let told: Vec<Event> = rig.events().into_iter().filter(is_forbidden).collect();
        assert_eq!(told, [], "seed {seed}");
    }
}
