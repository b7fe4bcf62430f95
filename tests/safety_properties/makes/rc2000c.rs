//! An RC2000C with both axes calibrated.

use azel::{
    clock::Instant,
    controller::rc2000c::Calibration,
    device::{CountLine, CountPoint},
    driver::Stream,
    protocol::rc2000c::Frame,
    sim::rc2000c::{Control, Fault, Options},
    sim::{InMemory as _, Misreading, Trouble},
    station::{Antenna, Mount},
};

use jiff::Timestamp;

use super::Make;
use crate::{
    common::{dice::Dice, network},
    safety_properties::{
        unit::{Lie, Unit, Word},
        world::World,
    },
};

pub(super) static MAKE: Make = Make {
    name: "RC2000C",
    random,
    others_jog: None,
    jogs_run_on: false,
    is_unchecked: false,
    doubts_flags: false,
    tracks_on_board: false,
    ignores_deg: 0.0,
    waits_for_word: true,
    words_of_a_go_to: 1,
};

/// Unit that reports sensor counts, with the lines that convert them to angles.
struct Counting(Control, [CountLine; 2]);

fn random(dice: &mut Dice, utc_origin: Timestamp) -> World {
    let point = |counts, degrees| CountPoint { counts, degrees };
    let (from_deg, span_deg) = (dice.between(-90.0, 180.0).round(), dice.between(120.0, 420.0));
    let to_deg = from_deg + span_deg.round();
    let calibration = Calibration {
        azimuth: vec![point(30, from_deg), point(3630, to_deg)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    let lines = [&calibration.azimuth, &calibration.elevation]
        .map(|points| CountLine::from_points(points).unwrap());
    let mut antenna = Antenna::rc2000c("Dish", "in memory");
    calibration.put_into(&mut antenna.connection).unwrap();
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: from_deg,
        azimuth_to_deg: to_deg,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    // The axes turn by 40 counts per second.
    let fastest_deg_s = f64::max(40.0 * (to_deg - from_deg) / 3600.0, 2.0);
    antenna.limits.maximum_rate_deg_s = fastest_deg_s;
    antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
    antenna.beam_width_deg = dice.between(0.1, 3.0);
    let unit = Counting(Control::new(&Options::default()), lines);
    World::new(&MAKE, unit, antenna, utc_origin, fastest_deg_s, 0.3)
}

impl Unit for Counting {
    fn axes_deg(&self) -> [f64; 2] {
        let Self(control, [azimuth, elevation]) = self;
        let state = control.state();
        [azimuth.degrees(state.az_counts), elevation.degrees(state.el_counts)]
    }

    fn is_turning(&self) -> bool {
        self.0.state().is_turning
    }

    fn place(&self, axes_deg: [f64; 2]) -> bool {
        let Self(control, lines) = self;
        let counts = [lines[0].counts(axes_deg[0]), lines[1].counts(axes_deg[1])];
        let [Some(azimuth), Some(elevation)] = counts else { return false };
        control.place([azimuth, elevation]);
        true
    }

    fn tell(&self, lie: Lie) {
        let fault = match lie {
            Lie::FrozenAngles => Fault::FrozenAngles,
            Lie::FalseRest => Fault::FalseRest,
        };
        self.0.set_fault(fault, true);
    }

    fn add_noise(&self) {
        let misreading = Misreading { noise_deg: 0.025, ..Misreading::default() };
        self.0.set_trouble(Trouble::Misreads(misreading), true);
    }

    fn link(&self) -> Box<dyn Stream> {
        network::link(&self.0)
    }

    fn drop_clients(&self) {
        self.0.drop_clients();
    }

    fn words(&self) -> Vec<(Instant, Word)> {
        self.0.received().into_iter().map(|(at, frame)| (at, word(&frame))).collect()
    }

    fn holds_stop(&self, bytes: &[u8]) -> bool {
        // The code follows the start and the address.
        bytes.get(2..4) == Some(b"3X")
    }

    fn holds_order(&self, bytes: &[u8]) -> bool {
        !matches!(bytes.get(2), Some(b'0' | b'1' | b'5'))
    }

    fn is_reading(&self, reply: &[u8]) -> bool {
        is_status(reply)
    }

    fn without_angle(&self, reply: &[u8], axis: usize, text: usize) -> Vec<u8> {
        let mut reply = reply.to_vec();
        if is_status(&reply) {
            let from = AZIMUTH_AT + axis * POSITION_BYTES;
            reply[from..from + POSITION_BYTES].copy_from_slice(NO_ANGLE[text % NO_ANGLE.len()]);
            seal(&mut reply);
        }
        reply
    }

    fn falsified(&self, reply: &[u8], dice: &mut Dice) -> Vec<u8> {
        let mut reply = reply.to_vec();
        if is_status(&reply) {
            // Change the name of the satellite, or the feed.
            let at = if dice.chance(0.5) { 3 + dice.below(11) } else { 24 + dice.below(3) };
            reply[at] = b' ' + dice.below(95) as u8;
            seal(&mut reply);
        }
        reply
    }
}

fn word(frame: &Frame) -> Word {
    match frame.code() {
        b'3' if frame.data().starts_with(b"X") => Word::Stop,
        b'0' | b'1' | b'5' => Word::Question,
        b'2' | b'3' => Word::Motion,
        _ => Word::Other,
    }
}

/// Index of the first byte of the azimuth in a status.
const AZIMUTH_AT: usize = 14;
const POSITION_BYTES: usize = 5;
/// Texts in place of an angle.
const NO_ANGLE: [&[u8; 5]; 4] = [b"     ", b"ERROR", b"-----", b"  NaN"];

/// Returns `true` if a reply is one whole status.
fn is_status(reply: &[u8]) -> bool {
    reply.first() == Some(&0x06) && reply.get(2) == Some(&b'1') && reply.len() > 30
}

/// Makes the checksum correct: exclusive or of all bytes before it.
fn seal(reply: &mut [u8]) {
    if let Some((sum, bytes)) = reply.split_last_mut() {
        *sum = bytes.iter().fold(0, |sum, byte| sum ^ byte);
    }
}
