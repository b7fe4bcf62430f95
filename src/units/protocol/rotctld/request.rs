//! Requests of a client.

use super::Position;

/// Any request of a client. Its values were checked at construction, so encoding cannot fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Request {
    /// `\dump_state`: protocol version and limits.
    State,
    /// `\dump_caps`: limits and functions, for people.
    Capabilities,
    /// `\get_info`: name of the rotator.
    Info,
    /// `\get_pos`: current position.
    Position,
    /// `\get_status`: words for moving axes and for reached limits.
    Status,
    /// `\stop`: stop of all motion.
    Stop,
    Motion(Motion),
    /// `q`: the end of the connection, without an answer.
    Quit,
}

/// A request that can move the antenna. Only the driver's gate may encode it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// `\set_pos`: a turn to a position.
    GoTo(Position),
    /// `\park`: a turn to the park position of the rotator.
    Park,
    /// `\move`: a turn until stopped.
    Turn { sense: Sense, speed: Option<Speed> },
}

/// Senses in which `\move` turns one or both axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sense {
    Up,
    Down,
    /// Counter-clockwise, seen from above.
    Left,
    Right,
    UpLeft,
    UpRight,
    DownLeft,
    DownRight,
}

impl Sense {
    pub const ALL: [Self; 8] = [
        Self::Up,
        Self::Down,
        Self::Left,
        Self::Right,
        Self::UpLeft,
        Self::UpRight,
        Self::DownLeft,
        Self::DownRight,
    ];

    /// Returns the number in the protocol: one bit for each sense.
    pub const fn number(self) -> u16 {
        match self {
            Self::Up => 2,
            Self::Down => 4,
            Self::Left => 8,
            Self::Right => 16,
            Self::UpLeft => 32,
            Self::UpRight => 64,
            Self::DownLeft => 128,
            Self::DownRight => 256,
        }
    }

    /// Returns the words for the sense, in capitals.
    const fn words(self) -> &'static [&'static str] {
        match self {
            Self::Up => &["UP"],
            Self::Down => &["DOWN"],
            Self::Left => &["LEFT", "CCW"],
            Self::Right => &["RIGHT", "CW"],
            Self::UpLeft => &["UP_LEFT", "UP_CCW"],
            Self::UpRight => &["UP_RIGHT", "UP_CW"],
            Self::DownLeft => &["DOWN_LEFT", "DOWN_CCW"],
            Self::DownRight => &["DOWN_RIGHT", "DOWN_CW"],
        }
    }

    /// Returns the sense of an argument: a number or a word of any case.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let is_meant = |sense: &Self| {
            text.parse() == Ok(sense.number())
                || sense.words().iter().any(|word| text.eq_ignore_ascii_case(word))
        };
        Self::ALL.into_iter().find(is_meant)
    }

    /// Returns the signs of the rates of azimuth and elevation.
    pub const fn signs(self) -> [f64; 2] {
        match self {
            Self::Up => [0.0, 1.0],
            Self::Down => [0.0, -1.0],
            Self::Left => [-1.0, 0.0],
            Self::Right => [1.0, 0.0],
            Self::UpLeft => [-1.0, 1.0],
            Self::UpRight => [1.0, 1.0],
            Self::DownLeft => [-1.0, -1.0],
            Self::DownRight => [1.0, -1.0],
        }
    }
}

/// Speed of `\move`, 1 to 100 per cent of the max speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Speed(u8);

impl Speed {
    /// Returns a speed in per cent; `None` outside 1 to 100.
    pub fn new(per_cent: u8) -> Option<Self> {
        (1..=100).contains(&per_cent).then_some(Self(per_cent))
    }

    pub const fn per_cent(self) -> u8 {
        self.0
    }
}

/// A word of `\get_status`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StatusWord {
    Moving,
    MovingAzimuth,
    MovingElevation,
}

impl StatusWord {
    pub const ALL: [Self; 3] = [Self::Moving, Self::MovingAzimuth, Self::MovingElevation];

    pub const fn word(self) -> &'static str {
        match self {
            Self::Moving => "MOVING",
            Self::MovingAzimuth => "MOVING_AZ",
            Self::MovingElevation => "MOVING_EL",
        }
    }
}

impl Request {
    /// Returns the bytes to send in one piece.
    pub fn to_bytes(self) -> Vec<u8> {
        let text = match self {
            Self::State => "\\dump_state\n".to_owned(),
            Self::Capabilities => "\\dump_caps\n".to_owned(),
            Self::Info => "_\n".to_owned(),
            Self::Position => "p\n".to_owned(),
            Self::Status => "s\n".to_owned(),
            Self::Stop => "S\n".to_owned(),
            Self::Motion(Motion::GoTo(position)) => {
                format!("P {:.2} {:.2}\n", position.azimuth_deg(), position.elevation_deg())
            }
            Self::Motion(Motion::Park) => "K\n".to_owned(),
            Self::Motion(Motion::Turn { sense, speed }) => {
                let speed = speed.map_or(-1, |speed| i16::from(speed.per_cent()));
                format!("M {} {speed}\n", sense.number())
            }
            Self::Quit => "q\n".to_owned(),
        };
        text.into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_have_the_bytes_that_rotctld_reads() {
        let text = |request: Request| String::from_utf8(request.to_bytes()).unwrap();
        let position = Position::new(163.0, 41.456).unwrap();
        assert_eq!(text(Request::Motion(Motion::GoTo(position))), "P 163.00 41.46\n");
        let turn = Motion::Turn { sense: Sense::Left, speed: Speed::new(50) };
        assert_eq!(text(Request::Motion(turn)), "M 8 50\n");
        let turn = Motion::Turn { sense: Sense::DownRight, speed: None };
        assert_eq!(text(Request::Motion(turn)), "M 256 -1\n");
        assert_eq!(text(Request::State), "\\dump_state\n");
    }

    #[test]
    fn a_sense_has_a_number_and_words() {
        for sense in Sense::ALL {
            assert_eq!(Sense::parse(&sense.number().to_string()), Some(sense));
            for word in sense.words() {
                assert_eq!(Sense::parse(&word.to_lowercase()), Some(sense));
            }
        }
        assert_eq!(Sense::parse("SIDE"), None);
        assert_eq!(Sense::parse("3"), None);
    }

    #[test]
    fn a_speed_is_from_1_to_100() {
        assert_eq!(Speed::new(0), None);
        assert_eq!(Speed::new(101), None);
        assert_eq!(Speed::new(100).unwrap().per_cent(), 100);
    }
}
