//! What a make of controller says of itself, so that the station file, the forms
//! and the links can be made for it.

use std::fmt;

use super::{
    Antenna, AntennaId, Connection, Direction, Following, Monitor, MotionLimits, Mount, PollRates,
    Resume, Setting, USUAL_RESUME_AFTER_S, USUAL_SWAY_DEG,
    connection::{check_address, check_line},
};
use crate::device::{Make, Moves};

/// A make of controller. Everything that an antenna of it needs follows from
/// here.
pub struct Kind {
    /// Names it in the station file.
    pub key: &'static str,
    /// How an antenna is called that has no other name.
    pub name: &'static str,
    /// Over what it is reached.
    pub link: Link,
    /// Where it answers as it leaves the factory, or else an example.
    pub usual_address: &'static str,
    /// Figures of an antenna of which nothing else is known.
    pub usual: Usual,
    /// What its connection holds besides the address, in the order of the file.
    pub settings: &'static [&'static Setting],
    /// All that the rest of the program may take it for.
    pub makes: &'static [&'static Make],
    /// Which of these it is with the settings of a connection.
    pub make: fn(&Connection) -> &'static Make,
    /// The controller of an antenna whose connection is of this kind. Silent until
    /// its link is up.
    pub open: fn(&Antenna) -> Box<dyn Moves>,
}

/// Over what a controller is reached.
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
pub struct Usual {
    /// How the axes are arranged: what is set later is other ends of them.
    pub mount: Mount,
    /// Full width of the beam at half power, degrees.
    pub beam_width_deg: f64,
    /// Where Park sends the antenna.
    pub park: Direction,
    /// What the mount can do.
    pub limits: MotionLimits,
    /// How often the controller is asked.
    pub poll: PollRates,
    /// How this program follows a target with it.
    pub follow: Following,
}

impl Kind {
    /// A connection to `address` with the usual settings.
    pub fn connection(&'static self, address: &str) -> Connection {
        Connection::new(self, address)
    }

    /// An antenna at `address` with the usual settings and figures.
    pub fn antenna(&'static self, name: &str, address: &str) -> Antenna {
        let Usual { mount, beam_width_deg, park, limits, poll, follow } = self.usual;
        Antenna {
            id: AntennaId::FIRST,
            name: name.to_owned(),
            connection: self.connection(address),
            mount,
            beam_width_deg,
            park,
            limits,
            poll,
            follow,
            monitor: Monitor::default(),
            sway_deg: USUAL_SWAY_DEG,
            resume: Resume::default(),
            resume_after_s: USUAL_RESUME_AFTER_S,
        }
    }

    /// Whether it can be reached at `address`; the reason when it cannot.
    pub fn check_address(&self, address: &str) -> Result<(), &'static str> {
        match self.link {
            Link::Tcp => check_address(address),
            Link::Line { .. } => check_line(address),
        }
    }
}

/// By the key, which no two kinds have in common.
impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Kind").field(&self.key).finish()
    }
}
