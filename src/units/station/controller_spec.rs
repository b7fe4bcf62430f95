//! The description of a make of controller: the station file, the forms, the links and the
//! window are driven by it.

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

/// A make of controller. Everything that an antenna of it needs follows from
/// here, but for its simulator, which is no part of a station.
pub struct ControllerSpec {
    /// Key in the station file.
    pub key: &'static str,
    /// Name on the box.
    pub name: &'static str,
    /// Name of an antenna that has no other name.
    pub short_name: &'static str,
    /// Link over which Azel reaches it.
    pub link: Link,
    /// Address at which it answers as it leaves the factory, or else an example.
    pub default_address: &'static str,
    /// Figures of an antenna of which nothing else is known.
    pub defaults: DefaultFigures,
    /// Settings of its connection besides the address, in the order of the file.
    pub settings: &'static [&'static Setting],
    /// Why it may have refused or closed the connection, in a sentence.
    pub closed_note: Option<&'static str>,
    /// How it is given files of elements, where it takes any.
    pub element_files: Option<&'static ElementFiles>,
    /// Takes a line of its link apart, where it can.
    pub explain: Option<fn(&WireLine) -> Explained>,
    /// Why something that was typed, in capitals, is none of
    /// [`AntennaState::questions`](crate::device::AntennaState::questions); a sentence or
    /// two. `None` where there is no more to say than that it is none.
    pub why_no_question: Option<fn(&str) -> String>,
    /// All that its units can be.
    pub variants: &'static [&'static Variant],
    /// Returns the variant of a unit by the settings of its connection.
    pub variant: fn(&Connection) -> &'static Variant,
    /// The controller of an antenna whose connection is of this make. Silent until
    /// its link is up.
    pub open: fn(&Antenna) -> Box<dyn Controller>,
}

/// Link over which Azel reaches a controller.
#[derive(Debug, Clone, Copy)]
pub enum Link {
    /// TCP: its address is a host and a port.
    Tcp,
    /// A serial line of seven bits and even parity: its address is a serial port,
    /// or the host and port of a serial server that hands the bytes on.
    Line {
        /// The setting that holds the speed, bits a second.
        baud: &'static Setting,
    },
}

/// The figures of an antenna that a make can know.
#[derive(Debug, Clone, Copy)]
pub struct DefaultFigures {
    /// How the axes are arranged. A station changes only the ends of their travel.
    pub mount: Mount,
    /// Full width of the beam at half power, degrees.
    pub beam_width_deg: f64,
    /// Where Park sends the antenna.
    pub park: Direction,
    /// Limits of the mount.
    pub limits: MotionLimits,
    /// How often the controller is asked.
    pub poll: PollRates,
    /// How this program follows a target with it.
    pub follow: TrackSettings,
    /// Time from the end of one pass until it can go to the next, seconds: what has to be
    /// loaded and read back, and the halt before it.
    pub set_up_s: f64,
}

impl ControllerSpec {
    /// A connection to `address` with the usual settings.
    pub fn connection(&'static self, address: &str) -> Connection {
        Connection::new(self, address)
    }

    /// An antenna at `address` with the usual settings and figures.
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

    /// Returns `true` if a unit can track the satellite of this name. Units without element files
    /// need no name.
    pub fn takes_satellite(&self, name: &str) -> bool {
        self.element_files.is_none_or(|files| (files.check_name)("satellite name", name).is_ok())
    }

    /// Checks that `address` fits its link; fails with the reason.
    pub fn check_address(&self, address: &str) -> Result<(), &'static str> {
        match self.link {
            Link::Tcp => check_address(address),
            Link::Line { .. } => check_line(address),
        }
    }
}

/// By the key, which no two makes have in common.
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
