//! An RC2000C with both axes calibrated.

use azel::{
    clock::Instant,
    controller::rc2000c::Calibration,
    device::{CountLine, CountPoint},
    driver::Stream,
    protocol::rc2000c::Frame,
    sim::rc2000c::{Control, Fault, Options},
    station::{Antenna, Mount},
};

use super::Make;
use crate::{
    common::{dice::Dice, network},
    safety_properties::{
        unit::{Lie, Unit, Word},
        world::{World, some_time},
    },
};

pub(super) static MAKE: Make = Make {
    name: "RC2000C",
    random,
    others_jog: None,
    jogs_run_on: false,
    is_unchecked: false,
    doubts_flags: false,
    words_of_a_go_to: 1,
};

/// Unit that reports sensor counts, with the lines that convert them to angles.
struct Counting(Control, [CountLine; 2]);

fn random(dice: &mut Dice) -> World {
    let point = |counts, degrees| CountPoint { counts, degrees };
    let (from_deg, span_deg) = (dice.between(-90.0, 180.0).round(), dice.between(120.0, 420.0));
    let to_deg = from_deg + span_deg.round();
    let calibration = Calibration {
        azimuth: vec![point(30, from_deg), point(3630, to_deg)],
        elevation: vec![point(30, 0.0), point(1830, 90.0)],
    };
    let lines = [&calibration.azimuth, &calibration.elevation]
        .map(|points| CountLine::through(points).unwrap());
    let mut antenna = Antenna::rc2000c("Dish", "in memory");
    calibration.put_into(&mut antenna.connection).unwrap();
    antenna.mount = Mount::AzEl {
        azimuth_from_deg: from_deg,
        azimuth_to_deg: to_deg,
        elevation_from_deg: 0.0,
        elevation_to_deg: 90.0,
    };
    // At 40 counts per second.
    let fastest_deg_s = f64::max(40.0 * (to_deg - from_deg) / 3600.0, 2.0);
    antenna.limits.maximum_rate_deg_s = fastest_deg_s;
    antenna.limits.minimum_elevation_deg = dice.between(0.0, 10.0);
    antenna.beam_width_deg = dice.between(0.1, 3.0);
    let unit = Counting(Control::new(&Options::default()), lines);
    World::new(&MAKE, unit, antenna, some_time(dice), fastest_deg_s, 0.3)
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
}

fn word(frame: &Frame) -> Word {
    match frame.code() {
        b'3' if frame.data().starts_with(b"X") => Word::Stop,
        b'0' | b'1' | b'5' => Word::Question,
        b'2' | b'3' => Word::Motion,
        _ => Word::Other,
    }
}
