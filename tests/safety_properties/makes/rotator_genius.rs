//! A Rotator Genius with an azimuth and an elevation rotator.

use azel::{
    clock::Instant,
    controller::rotator_genius::{ROTATORS, Rotators},
    driver::Stream,
    protocol::rotator_genius::WholeDegrees,
    sim::rotator_genius::{Control, Fault, Options, RotatorOptions},
    station::{Antenna, Mount},
};

use super::Make;
use crate::{
    common::{dice::Dice, network},
    safety_properties::{
        unit::{Lie, Unit, Word, holds},
        world::{World, some_time},
    },
};

pub(super) static MAKE: Make = Make {
    name: "Genius",
    random,
    others_jog: Some(|axis, rate_deg_s| {
        let way = if rate_deg_s > 0.0 { 'P' } else { 'M' };
        format!("|{way}{}", axis + 1).into_bytes()
    }),
    jogs_run_on: true,
    is_unchecked: true,
    doubts_flags: true,
    // One axis after the other.
    words_of_a_go_to: 2,
};

fn random(dice: &mut Dice) -> World {
    let highest_deg = if dice.chance(0.3) { 180.0 } else { 90.0 };
    let options = Options {
        rotators: [
            RotatorOptions::default(),
            RotatorOptions {
                limit_cw: WholeDegrees::nearest(highest_deg).unwrap(),
                ..RotatorOptions::elevation()
            },
        ],
        max_clients: 2,
        seed: dice.next(),
        ..Options::default()
    };
    let mut antenna = Antenna::genius("Mast", "in memory");
    antenna.connection.put(&ROTATORS, Rotators::Pair).unwrap();
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: dice.between(0.0, 40.0).round(),
        azimuth_to_deg: dice.between(320.0, 450.0).round(),
        elevation_from_deg: 0.0,
        elevation_to_deg: highest_deg,
    };
    antenna.beam_width_deg = dice.between(1.0, 20.0);
    antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
    World::new(&MAKE, Control::new(&options), antenna, some_time(dice), 4.0, 2.6)
}

impl Unit for Control {
    fn axes_deg(&self) -> [f64; 2] {
        self.state().rotators.map(|rotator| rotator.angle_deg)
    }

    fn is_turning(&self) -> bool {
        self.state().rotators.iter().any(|rotator| rotator.is_turning)
    }

    fn as_counted(&self, [azimuth_deg, elevation_deg]: [f64; 2]) -> [f64; 2] {
        [azimuth_deg.rem_euclid(360.0), elevation_deg]
    }

    fn place(&self, axes_deg: [f64; 2]) -> bool {
        Control::place(self, axes_deg.map(|deg| WholeDegrees::nearest(deg).unwrap()));
        true
    }

    fn tell(&self, lie: Lie) {
        let fault = match lie {
            Lie::FrozenAngles => Fault::FrozenAngles,
            Lie::FalseRest => Fault::FalseRest,
        };
        self.set_fault(fault, true);
    }

    fn link(&self) -> Box<dyn Stream> {
        network::link(self)
    }

    fn drop_clients(&self) {
        Control::drop_clients(self);
    }

    fn words(&self) -> Vec<(Instant, Word)> {
        self.received().into_iter().map(|(at, text)| (at, word(&text))).collect()
    }

    fn holds_stop(&self, bytes: &[u8]) -> bool {
        holds(bytes, b"|S")
    }
}

fn word(text: &str) -> Word {
    match text {
        "|S" => Word::Stop,
        "|h" => Word::Question,
        _ if ["|A", "|P", "|M"].iter().any(|word| text.starts_with(word)) => Word::Motion,
        _ => Word::Other,
    }
}
