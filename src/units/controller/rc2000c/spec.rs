//! The description of an RC2000C.

use super::{Rc2000c, actions};
use crate::{
    device::{
        Capabilities, CountPoint, Effect, JogSpeed, JogSpeeds, SecondAxis, Standstill, Variant,
        settings::{Field, Key, Unfit, Value},
    },
    station::{
        AfterPass, Antenna, Connection, ControllerSpec, DefaultFigures, Direction, Link,
        MotionLimits, Mount, PollRates, Setting, Table, TrackSettings,
    },
};

const SLOW: JogSpeed = JogSpeed { name: "Slow", share: 0.25 };
pub(super) const FAST: JogSpeed = JogSpeed { name: "Fast", share: 1.0 };

/// Description of an RC2000C on the factory's bus address, not calibrated.
pub static SPEC: ControllerSpec = ControllerSpec {
    key: "rc2000c",
    name: "Research Concepts RC2000C",
    short_name: "RC2000C",
    link: Link::Line { baud: &BAUD },
    default_address: if cfg!(windows) { "COM3" } else { "/dev/ttyUSB0" },
    defaults: DefaultFigures {
        mount: Mount::AzEl {
            azimuth_from_deg: 0.0,
            azimuth_to_deg: 360.0,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        },
        beam_width_deg: 1.5,
        park: Direction { azimuth_deg: 180.0, elevation_deg: 45.0 },
        limits: MotionLimits {
            minimum_elevation_deg: 5.0,
            maximum_rate_deg_s: 2.0,
            maximum_step_deg: 5.0,
        },
        poll: PollRates { idle_hz: 2.0, moving_hz: 4.0 },
        follow: TrackSettings {
            period_s: 2.0,
            dead_band_deg: 0.2,
            latency_s: 0.5,
            after: AfterPass::Hold,
        },
        set_up_s: 2.0,
    },
    settings: &[&BAUD, &BUS_ADDRESS, &AZIMUTH_POINTS, &ELEVATION_POINTS],
    closed_note: None,
    element_files: None,
    explain: None,
    why_no_question: None,
    variants: &[&VARIANT],
    variant: |_| &VARIANT,
    open: |antenna| Box::new(Rc2000c::new(antenna)),
};

/// The only variant: all units of this make have the same abilities.
pub static VARIANT: Variant = Variant {
    capabilities: Capabilities {
        axes: ["Az", "El"],
        has_program: false,
        takes_positions: true,
        arrives_within_deg: 0.5,
        position_step_deg: 0.0,
        azimuth_wraps: false,
        second_axis: SecondAxis::Elevation,
        jog: JogSpeeds::Named(&[SLOW, FAST]),
        jogs_one_axis: true,
        steps: false,
        ends_jogs: true,
        waits_for_word: true,
        // A count is some hundredths of a degree; the slow speed is a few tenths of a degree a
        // second.
        standstill: Standstill { resolution_deg: 0.1, slowest_deg_s: 0.3, overrun_s: 0.6 },
        effect: Effect { shows_after_s: 5.0, ignores_deg: 0.0 },
        stop_note: None,
    },
    track_offsets: None,
    clock: None,
    groups: &[],
    actions: actions::ACTIONS,
};

/// Line speed, bits a second. A serial server has its own setting; Azel then uses the value only to
/// compute how long replies take.
pub static BAUD: Setting =
    Setting::new(Field::edit(Key::choice("baud", BAUDS), "Line speed, baud"), || {
        Value::Choice(9600)
    });

const BAUDS: &[(i64, &str)] =
    &[(300, "300"), (600, "600"), (1200, "1200"), (2400, "2400"), (4800, "4800"), (9600, "9600")];

/// Address of the unit on the bus.
pub static BUS_ADDRESS: Setting =
    Setting::new(Field::edit(Key::integer("bus_address", 49, 111), "Bus address"), || {
        Value::Integer(50)
    });

const CALIBRATION: Table = Table { key: "calibration", title: "Calibration" };

/// Measured points of the azimuth, counts and degrees.
pub static AZIMUTH_POINTS: Setting =
    Setting::new(Field::edit(Key::points("azimuth"), "Azimuth counts"), || {
        Value::Points(Vec::new())
    })
    .in_table(CALIBRATION)
    .noted(not_calibrated);

/// Measured points of the elevation, counts and degrees.
pub static ELEVATION_POINTS: Setting =
    Setting::new(Field::edit(Key::points("elevation"), "Elevation counts"), || {
        Value::Points(Vec::new())
    })
    .in_table(CALIBRATION)
    .noted(not_calibrated);

fn not_calibrated(value: &Value) -> Option<&'static str> {
    let is_empty = matches!(value, Value::Points(points) if points.is_empty());
    is_empty.then_some("Not calibrated: the antenna is shown in counts and goes to no angle.")
}

/// Conversion of the counts of both position sensors: points that the operator has measured, with a
/// straight line between and beyond them. Each axis has two or more points, or none while it is not
/// calibrated.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Calibration {
    pub azimuth: Vec<CountPoint>,
    pub elevation: Vec<CountPoint>,
}

impl Calibration {
    /// Returns the calibration of an RC2000C with this connection.
    pub fn from_connection(connection: &Connection) -> Self {
        Self {
            azimuth: connection.points(&AZIMUTH_POINTS).to_vec(),
            elevation: connection.points(&ELEVATION_POINTS).to_vec(),
        }
    }

    /// Writes the calibration to the settings of `connection`. Returns an error with the reason if
    /// it does not fit.
    pub fn put_into(self, connection: &mut Connection) -> Result<(), Unfit> {
        connection.put(&AZIMUTH_POINTS, self.azimuth)?;
        connection.put(&ELEVATION_POINTS, self.elevation)
    }
}

impl Antenna {
    /// Returns an RC2000C at `address` on the factory's bus address, not calibrated, with default
    /// figures.
    pub fn rc2000c(name: &str, address: &str) -> Self {
        SPEC.antenna(name, address)
    }
}
