//! The description of a make of controller, on which the station file, the forms, the links and the
//! window depend.

use std::fmt;

use super::{
    Antenna, AntennaId, Automatic, Connection, DEFAULT_RESUME_AFTER_S, DEFAULT_SWAY_DEG, Direction,
    Monitor, MotionLimits, Mount, PollRates, Resume, Setting, TrackSettings, Upkeep,
    connection::{check_address, check_line},
};
use crate::{
    astro::PointingModel,
    device::{Controller, ElementFiles, Explained, Variant, WireLine},
};

/// A make of controller. It describes everything that an antenna of this make needs, except the
/// simulator, which is no part of a station.
pub struct ControllerSpec {
    /// Key in the station file.
    pub key: &'static str,
    /// Name of the product.
    pub name: &'static str,
    /// Default name of an antenna.
    pub short_name: &'static str,
    /// Link over which Azel reaches the unit.
    pub link: Link,
    /// Factory address of the unit, or else an example.
    pub default_address: &'static str,
    /// Default figures of an antenna.
    pub defaults: DefaultFigures,
    /// Settings of the connection besides the address, in the order of the file.
    pub settings: &'static [&'static Setting],
    /// Likely reason why the unit has refused or closed the connection, as a sentence.
    pub closed_note: Option<&'static str>,
    /// Transfer of element files; `None` if the make takes none.
    pub element_files: Option<&'static ElementFiles>,
    /// Function that splits a line of the link into values; `None` if the make has none.
    pub explain: Option<fn(&WireLine) -> Explained>,
    /// Function that explains why a typed text, in capitals, is none of
    /// [`AntennaState::questions`](crate::device::AntennaState::questions), in a sentence or two.
    /// `None` if there is no explanation.
    pub why_no_question: Option<fn(&str) -> String>,
    /// All variants of the units.
    pub variants: &'static [&'static Variant],
    /// Function that returns the variant of a unit with the settings of its connection.
    pub variant: fn(&Connection) -> &'static Variant,
    /// Function that creates the controller of an antenna of this make, silent until its link is
    /// up.
    pub open: fn(&Antenna) -> Box<dyn Controller>,
}

/// Link over which Azel reaches a controller.
#[derive(Debug, Clone, Copy)]
pub enum Link {
    /// TCP, with a host and a port as address.
    Tcp,
    /// Serial line of seven bits and even parity. Its address is a serial port, or the host and
    /// port of a serial server that passes the bytes on.
    Line {
        /// Setting with the line speed, bits a second.
        baud: &'static Setting,
    },
}

/// Default figures for the antennas of a make.
#[derive(Debug, Clone, Copy)]
pub struct DefaultFigures {
    /// Arrangement of the axes. A station changes only the ends of their travel.
    pub mount: Mount,
    /// Full width of the beam at half power, degrees.
    pub beam_width_deg: f64,
    /// Park position.
    pub park: Direction,
    /// Limits of the mount.
    pub limits: MotionLimits,
    /// Rates at which Azel asks the controller.
    pub poll: PollRates,
    /// Settings for program track.
    pub follow: TrackSettings,
    /// Time from the end of one pass until the antenna can go to the next, seconds. It covers the
    /// halt, and the transfer and read-back of the next target.
    pub set_up_s: f64,
}

impl ControllerSpec {
    /// Returns a connection to `address` with default settings.
    pub fn connection(&'static self, address: &str) -> Connection {
        Connection::new(self, address)
    }

    /// Returns an antenna at `address` with default settings and figures.
    pub fn antenna(&'static self, name: &str, address: &str) -> Antenna {
        let DefaultFigures { mount, beam_width_deg, park, limits, poll, follow, .. } =
            self.defaults;
        Antenna {
            id: AntennaId::FIRST,
            name: name.to_owned(),
            connection: self.connection(address),
            connects_at_start: false,
            mount,
            beam_width_deg,
            park,
            limits,
            poll,
            follow,
            upkeep: Upkeep::default(),
            monitor: Monitor::default(),
            pointing_model: PointingModel::default(),
            sway_deg: DEFAULT_SWAY_DEG,
            resume: Resume::default(),
            resume_after_s: DEFAULT_RESUME_AFTER_S,
            automatic: Automatic::default(),
        }
    }

    /// Returns `true` if a unit can track the satellite with this name. Units without element files
    /// need no name.
    pub fn takes_satellite(&self, name: &str) -> bool {
        self.element_files.is_none_or(|files| (files.check_name)("satellite name", name).is_ok())
    }

    /// Checks that `address` fits the link; returns the reason if it does not.
    pub fn check_address(&self, address: &str) -> Result<(), &'static str> {
        match self.link {
            Link::Tcp => check_address(address),
            Link::Line { .. } => check_line(address),
        }
    }
}

/// Compares by the key, which is unique for each make.
impl PartialEq for ControllerSpec {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl fmt::Debug for ControllerSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ControllerSpec").field(&self.key).finish()
    }
}
