//! What a Satrak says of itself to the station.

use super::{MAKE, Satrak};
use crate::station::{
    AfterPass, Antenna, Direction, Following, Holds, Kind, Link, MotionLimits, Mount, PollRates,
    Setting, Usual, Value,
};

/// A Satrak in the station, with the factory figures of its document.
pub static KIND: Kind = Kind {
    key: MAKE.key,
    name: "Satrak",
    link: Link::Tcp,
    usual_address: "192.168.10.21:4001",
    usual: Usual {
        mount: Mount::Xy {
            lower_axis_azimuth_deg: 0.0,
            travel_from_deg: 5.0,
            travel_to_deg: 175.0,
        },
        beam_width_deg: 0.88,
        park: Direction { azimuth_deg: 0.0, elevation_deg: 90.0 },
        limits: MotionLimits {
            minimum_elevation_deg: 5.0,
            maximum_rate_deg_s: 3.0,
            maximum_step_deg: 5.0,
        },
        poll: PollRates { idle_hz: 2.0, moving_hz: 5.0 },
        follow: Following {
            period_s: 1.0,
            dead_band_deg: 0.1,
            latency_s: 0.3,
            after: AfterPass::Hold,
        },
    },
    settings: &[&ELEMENT_FILE],
    makes: &[&MAKE],
    make: |_| &MAKE,
    open: |antenna| {
        let element_file = antenna.connection.text(&ELEMENT_FILE).to_owned();
        Box::new(Satrak::new(antenna.poll, element_file))
    },
};

/// The element file on the unit from which satellites are chosen; empty for the
/// one that the unit uses already.
pub static ELEMENT_FILE: Setting = Setting {
    key: "element_file",
    table: None,
    label: "Element file on the unit",
    holds: Holds::Text,
    usual: Value::Text(String::new()),
    note: |_| None,
};

impl Antenna {
    /// A Satrak at `address` with the usual figures.
    pub fn satrak(name: &str, address: &str) -> Self {
        KIND.antenna(name, address)
    }
}
