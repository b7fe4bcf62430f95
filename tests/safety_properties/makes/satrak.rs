//! A Satrak on an X/Y mount.

use std::collections::BTreeMap;

use azel::{
    astro::Angle,
    clock::Instant,
    controller::satrak::ELEMENT_FILE,
    driver::Stream,
    protocol::satrak::encode,
    sim::satrak::{Control, Fault, Options},
    sim::{InMemory as _, Misreading, Trouble},
    station::{Antenna, Mount, Station},
};

use jiff::Timestamp;

use super::Make;
use crate::{
    common::{dice::Dice, network},
    safety_properties::{
        sky,
        unit::{Lie, Unit, Word, holds},
        world::World,
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
    tracks_on_board: true,
    ignores_deg: 0.0,
    waits_for_word: false,
    words_of_a_go_to: 1,
};

/// Name of the element file on the unit.
const FILE: &str = "stations.txt";

fn random(dice: &mut Dice, utc_origin: Timestamp) -> World {
    let station = Station::default();
    let lower_axis_deg = dice.between(0.0, 180.0);
    let minimum_elevation_deg = dice.between(0.0, 15.0);
    let options = Options {
        lower_axis: Angle::from_degrees(lower_axis_deg),
        seed: dice.next(),
        max_clients: 2,
        elements: BTreeMap::from([(FILE.to_owned(), sky::all_elements().to_vec())]),
        minimum_elevation_deg,
        ..Options::new(station.site, utc_origin)
    };
    let mut antenna = Antenna::satrak("Dish", "in memory");
    antenna.mount = Mount::Xy {
        lower_axis_azimuth_deg: lower_axis_deg,
        travel_from_deg: dice.between(5.0, 30.0),
        travel_to_deg: dice.between(150.0, 175.0),
    };
    antenna.limits.maximum_rate_deg_s = dice.between(0.5, 5.0);
    antenna.limits.minimum_elevation_deg = minimum_elevation_deg;
    antenna.connection.put(&ELEMENT_FILE, FILE).unwrap();
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

    fn add_noise(&self) {
        // The axes of the mount near its poles turn up to ten times further than the direction on
        // the sky. More noise would look like a swaying antenna.
        let misreading = Misreading { noise_deg: 0.0025, ..Misreading::default() };
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
        holds(bytes, b"STOP=") || holds(bytes, b"STOP =")
    }

    fn holds_order(&self, bytes: &[u8]) -> bool {
        bytes.contains(&b'=')
    }

    fn is_reading(&self, reply: &[u8]) -> bool {
        payload(reply).is_some_and(|payload| payload.starts_with("STATUS?"))
    }

    fn without_angle(&self, reply: &[u8], axis: usize, text: usize) -> Vec<u8> {
        without_angle(reply, axis, text).unwrap_or_else(|| reply.to_vec())
    }

    fn falsified(&self, reply: &[u8], dice: &mut Dice) -> Vec<u8> {
        falsified(reply, dice).unwrap_or_else(|| reply.to_vec())
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

/// Texts in place of an angle.
const NO_ANGLE: [&str; 6] = ["", "NaN", "inf", "-", "1e999", "---"];
/// Figures that a faulty unit might report.
const ODD: [&str; 14] = [
    "0",
    "1",
    "-1",
    "255",
    "65535",
    "-32768",
    "4294967296",
    "99999999999999999999",
    "1e308",
    "NaN",
    "-inf",
    "",
    "0.0000001",
    "360.01",
];
/// Number of values in a status, the first of which is a flag.
const STATUS_VALUES: usize = 16;

/// Returns the payload of a reply, if the reply is one whole frame.
fn payload(reply: &[u8]) -> Option<&str> {
    std::str::from_utf8(reply).ok()?.strip_prefix('$')?.split_once('*').map(|(payload, _)| payload)
}

fn without_angle(reply: &[u8], axis: usize, text: usize) -> Option<Vec<u8>> {
    let mut values: Vec<&str> = payload(reply)?.split(',').collect();
    let first = values.len().checked_sub(STATUS_VALUES)?;
    if !values[0].starts_with("STATUS?") {
        return None;
    }
    *values.get_mut(first + 13 + axis)? = NO_ANGLE[text % NO_ANGLE.len()];
    Some(encode(&values.join(",")))
}

/// Draws a time as the unit writes it, often far from the current one.
fn some_time(dice: &mut Dice) -> [String; 6] {
    let year = [1970, 1999, 2000, 2026, 2027, 2038, 2099, 2100, 9999, 0][dice.below(10)];
    let month = 1 + dice.below(12);
    let parts = [year, month, 1 + dice.below(31), dice.below(24), dice.below(60), dice.below(60)];
    parts.map(|part| part.to_string())
}

fn falsified(reply: &[u8], dice: &mut Dice) -> Option<Vec<u8>> {
    let payload = payload(reply)?;
    let (word, values) = payload.split_once(',')?;
    let mut values: Vec<String> = values.split(',').map(str::to_owned).collect();
    match word.split(['?', '=']).next()? {
        "STATUS" | "VERSION" | "ERRSTATUS" => return None,
        word if word.contains("TIME") && dice.chance(0.7) => {
            // Change whole times of clocks and windows, which may reverse a window.
            for time in values.chunks_mut(6).filter(|time| time.len() == 6) {
                if dice.chance(0.6) {
                    time.clone_from_slice(&some_time(dice));
                }
            }
        }
        _ => {
            let at = dice.below(values.len());
            ODD[dice.below(ODD.len())].clone_into(&mut values[at]);
        }
    }
    Some(encode(&format!("{word},{}", values.join(","))))
}
