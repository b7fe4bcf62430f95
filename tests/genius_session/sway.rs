//! Changing readings of standing rotators, close to a barrier.

use azel::{
    contract::driver::{Event, Safety},
    controller::rotator_genius::Rotators,
    plan::Bounds,
    protocol::rotator_genius::WholeDegrees,
    sim::{
        Mechanics,
        rotator_genius::{Fault, Options, RotatorOptions},
    },
    station::{Antenna, Station},
};
use tokio::io::AsyncWriteExt as _;

use super::rig::{Rig, antenna, pair};

const LOWEST_DEG: f64 = 3.0;

fn is_forbidden(event: &Event) -> bool {
    matches!(event, Event::Safety(Safety::Forbidden { .. }))
}

/// Starts a pair at this elevation, whose readings vary by noise.
async fn watched(elevation_deg: u16, noise_deg: f64, seed: u64) -> Rig {
    let mut options =
        Options { mechanics: Mechanics { noise_deg, ..Mechanics::default() }, seed, ..pair() };
    options.max_clients = 2;
    options.rotators[1] = RotatorOptions {
        position: WholeDegrees::new(elevation_deg).unwrap(),
        ..RotatorOptions::elevation()
    };
    let mut antenna: Antenna = antenna(Rotators::Pair);
    antenna.limits.minimum_elevation_deg = LOWEST_DEG;
    let mut rig = Rig::start(&options, &antenna);
    rig.until("it is read", 5, |shown| shown.state.measured.is_some()).await;
    rig.handle().keep_within(Bounds::new(&Station::default(), &antenna));
    rig.events();
    rig
}

#[tokio::test(start_paused = true)]
async fn a_reading_that_flickers_is_not_stopped_as_a_motion() {
    for seed in 1..=4 {
        let mut rig = watched(4, 0.6, seed).await;
        let mut angles = std::collections::BTreeSet::new();
        for _ in 0..1_200 {
            rig.seconds(0.5).await;
            angles.extend(rig.axes_deg()[1].map(|angle_deg| angle_deg as i32));
        }
        assert!(angles.len() > 1, "seed {seed}: the readings change");
        let told: Vec<Event> = rig.events().into_iter().filter(is_forbidden).collect();
        assert_eq!(told, [], "seed {seed}: {angles:?}");
        assert_eq!(rig.orders(), [""; 0], "seed {seed}");
    }
}

/// Turns the elevation down from another program. Returns the true elevation when Azel stops the
/// motion, degrees.
async fn stopped_at_deg(rig: &mut Rig) -> f64 {
    let mut other = crate::common::network::link(&rig.control);
    other.write_all(b"|M2").await.unwrap();
    rig.until_event(60, is_forbidden).await;
    rig.rotator(2).angle_deg
}

#[tokio::test(start_paused = true)]
async fn a_rotator_that_sets_out_from_a_flickering_reading_is_stopped_as_soon_as_from_a_still_one()
{
    let mut calm = watched(5, 0.0, 1).await;
    calm.seconds(60.0).await;
    let calm_deg = stopped_at_deg(&mut calm).await;
    for seed in 1..=8 {
        let mut rig = watched(5, 0.6, seed).await;
        rig.seconds(60.0).await;
        let deg = stopped_at_deg(&mut rig).await;
        // The reading may be 0.6 degrees too high.
        assert!(deg > calm_deg - 1.2, "seed {seed}: {deg}, calm {calm_deg}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_rotator_that_turns_while_its_unit_says_that_it_stands_is_stopped_as_soon() {
    let mut honest = watched(30, 0.0, 1).await;
    let honest_deg = stopped_at_deg(&mut honest).await;
    let mut lying = watched(30, 0.0, 1).await;
    lying.control.set_fault(Fault::FalseRest, true);
    lying.seconds(1.0).await;
    let lying_deg = stopped_at_deg(&mut lying).await;
    assert!(lying_deg > honest_deg - 1.2, "{lying_deg}, honest {honest_deg}");
    lying.seconds(10.0).await;
    assert!(lying.rotator(2).angle_deg > LOWEST_DEG - 3.0);
}
