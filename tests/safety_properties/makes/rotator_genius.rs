//! A Rotator Genius with an azimuth and an elevation rotator.

use azel::{
    clock::Instant,
    controller::rotator_genius::{ROTATORS, Rotators},
    driver::Stream,
    protocol::rotator_genius::WholeDegrees,
    sim::rotator_genius::{Control, Fault, Options, RotatorOptions},
    sim::{InMemory as _, Misreading, Trouble},
    station::{Antenna, Mount},
};

use jiff::Timestamp;

use super::Make;
use crate::{
    common::{dice::Dice, network},
    safety_properties::{
        unit::{Lie, Unit, Word, holds},
        world::World,
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
    tracks_on_board: false,
    ignores_deg: 15.0,
    waits_for_word: false,
    // The unit takes one command for each axis.
    words_of_a_go_to: 2,
};

fn random(dice: &mut Dice, utc_origin: Timestamp) -> World {
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
    World::new(&MAKE, Control::new(&options), antenna, utc_origin, 4.0, 2.6)
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

    fn add_noise(&self) {
        let misreading = Misreading { noise_deg: 0.5, ..Misreading::default() };
        self.set_trouble(Trouble::Misreads(misreading), true);
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

    fn holds_order(&self, bytes: &[u8]) -> bool {
        bytes != b"|h"
    }

    fn is_reading(&self, reply: &[u8]) -> bool {
        is_status(reply)
    }

    fn without_angle(&self, reply: &[u8], axis: usize, text: usize) -> Vec<u8> {
        let mut reply = reply.to_vec();
        if is_status(&reply) {
            let from = HEADER_BYTES + axis * ROTATOR_BYTES;
            reply[from..from + 3].copy_from_slice(NO_ANGLE[text % NO_ANGLE.len()]);
        }
        reply
    }

    fn falsified(&self, reply: &[u8], dice: &mut Dice) -> Vec<u8> {
        let mut reply = reply.to_vec();
        if is_status(&reply) {
            let rotator = HEADER_BYTES + dice.below(2) * ROTATOR_BYTES;
            // Change limits, offset, target and start, but not the position, its kind and its
            // motion.
            let from = rotator + [3, 6, 11, 15, 18][dice.below(5)];
            reply[from..from + 3].copy_from_slice(ODD[dice.below(ODD.len())]);
        }
        reply
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

/// Number of bytes of a status before the rotators.
const HEADER_BYTES: usize = 4;
const ROTATOR_BYTES: usize = 34;
/// Texts in place of an angle.
const NO_ANGLE: [&[u8; 3]; 4] = [b"999", b"   ", b"NaN", b"361"];
/// Figures that a faulty unit might report.
const ODD: [&[u8; 3]; 8] = [b"999", b"  0", b"359", b"360", b" -1", b"   ", b"NaN", b"180"];

/// Returns `true` if a reply is one whole status.
fn is_status(reply: &[u8]) -> bool {
    reply.starts_with(b"|h") && reply.len() == HEADER_BYTES + 2 * ROTATOR_BYTES
}
