//! The description of a Satrak.

use super::{ELEMENT_FILES, GROUPS, Satrak, TRACK_OFFSETS, settings::CLOCK_SETTING, words};
use crate::{
    device::{
        Capabilities, Effect, JogSpeeds, SecondAxis, Standstill, Variant,
        settings::{Field, Key, Value},
    },
    station::{
        AfterPass, Antenna, ControllerSpec, DefaultFigures, Direction, Link, MotionLimits, Mount,
        PollRates, Setting, TrackSettings,
    },
};

/// Description of a Satrak with the factory figures of its document.
pub static SPEC: ControllerSpec = ControllerSpec {
    key: "satrak",
    name: "SVS Satrak",
    short_name: "Satrak",
    link: Link::Tcp,
    default_address: "192.168.10.21:4001",
    defaults: DefaultFigures {
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
        follow: TrackSettings {
            period_s: 1.0,
            dead_band_deg: 0.1,
            latency_s: 0.3,
            after: AfterPass::Hold,
        },
        set_up_s: 12.0,
    },
    settings: &[&ELEMENT_FILE],
    closed_note: None,
    element_files: Some(&ELEMENT_FILES),
    explain: Some(words::explain),
    why_no_question: Some(words::why_no_question),
    variants: &[&VARIANT],
    variant: |_| &VARIANT,
    open: |antenna| {
        let element_file = antenna.connection.text(&ELEMENT_FILE).to_owned();
        Box::new(Satrak::new(antenna.poll, element_file))
    },
};

/// The only variant: all units of this make have the same abilities.
pub static VARIANT: Variant = Variant {
    capabilities: Capabilities {
        axes: ["X", "Y"],
        has_program: true,
        takes_positions: true,
        arrives_within_deg: 0.3,
        position_step_deg: 0.0,
        azimuth_wraps: false,
        second_axis: SecondAxis::Elevation,
        jog: JogSpeeds::AnyRate,
        jogs_one_axis: false,
        steps: true,
        ends_jogs: false,
        waits_for_word: false,
        // Readings are tenths of a degree. A motion slower than half a degree a second, such as
        // tracking, shows later, while Azel watches the antenna at rest.
        standstill: Standstill { resolution_deg: 0.1, slowest_deg_s: 0.5, overrun_s: 0.4 },
        effect: Effect { shows_after_s: 4.0, ignores_deg: 0.0 },
        stop_note: None,
    },
    groups: GROUPS,
    actions: &[],
    track_offsets: Some(&TRACK_OFFSETS),
    clock: Some(&CLOCK_SETTING),
};

/// Setting for the element file on the unit that lists the satellites; empty for the file in use.
pub static ELEMENT_FILE: Setting = Setting::new(
    Field::edit(Key::text("element_file", |_| Ok(())), "Element file on the unit"),
    || Value::Text(String::new()),
)
.noted(|_| {
    Some(
        "If left empty, the unit keeps using its current file. A new unit has none and cannot \
          track.",
    )
});

impl Antenna {
    /// Returns a Satrak at `address` with default figures.
    pub fn satrak(name: &str, address: &str) -> Self {
        SPEC.antenna(name, address)
    }
}
