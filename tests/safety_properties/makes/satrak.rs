//! A Satrak on an X/Y mount.

use azel::{
    astro::Angle,
    clock::Instant,
    driver::Stream,
    protocol::satrak::encode,
    sim::satrak::{Control, Fault, Options},
    station::{Antenna, Mount, Station},
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
    name: "Satrak",
    random,
    others_jog: Some(|axis, rate_deg_s| {
        let rate = format!("{rate_deg_s:.2}");
        let rates = if axis == 0 { [rate.as_str(), "0"] } else { ["0", rate.as_str()] };
        encode(&format!("MOVE=,{},{}", rates[0], rates[1]))
    }),
    jogs_run_on: true,
    is_unchecked: false,
    doubts_flags: false,
    words_of_a_go_to: 1,
};

fn random(dice: &mut Dice) -> World {
    let utc_origin = some_time(dice);
    let station = Station::default();
    let lower_axis_deg = dice.between(0.0, 180.0);
    let options = Options {
        lower_axis: Angle::from_degrees(lower_axis_deg),
        seed: dice.next(),
        max_clients: 2,
        ..Options::new(station.site, utc_origin)
    };
    let mut antenna = Antenna::satrak("Dish", "in memory");
    antenna.mount = Mount::Xy {
        lower_axis_azimuth_deg: lower_axis_deg,
        travel_from_deg: dice.between(5.0, 30.0),
        travel_to_deg: dice.between(150.0, 175.0),
    };
    antenna.limits.maximum_rate_deg_s = dice.between(0.5, 5.0);
    antenna.limits.minimum_elevation_deg = dice.between(0.0, 15.0);
    antenna.beam_width_deg = dice.between(0.1, 3.0);
    World::new(&MAKE, Control::new(&options), antenna, utc_origin, 5.0, 0.15)
}

impl Unit for Control {
    fn axes_deg(&self) -> [f64; 2] {
        self.state().metal_deg
    }

    fn is_turning(&self) -> bool {
        self.state().is_moving
    }

    fn place(&self, axes_deg: [f64; 2]) -> bool {
        Control::place(self, axes_deg);
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
        holds(bytes, b"STOP=") || holds(bytes, b"STOP =")
    }
}

fn word(text: &str) -> Word {
    const MOTIONS: [&str; 4] = ["GOTO=", "MOVE=", "STEP=", "TRACK="];
    if text.starts_with("STOP=") || text.starts_with("TRACK=,0") {
        Word::Stop
    } else if !text.contains('=') {
        Word::Question
    } else if MOTIONS.iter().any(|word| text.starts_with(word)) {
        Word::Motion
    } else {
        Word::Other
    }
}
