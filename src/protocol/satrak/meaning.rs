//! What a frame says, in one plain sentence.

mod received;
mod sent;

use jiff::Timestamp;

use super::{Frame, Position, number};

/// One sentence and how it is to be taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Meaning {
    /// How it is to be taken.
    pub tone: Tone,
    /// The sentence, without a full stop.
    pub text: String,
}

/// How a sentence is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// Something is asked or told.
    Plain,
    /// Something is to be changed or to move.
    Change,
    /// It was accepted.
    Good,
    /// It is not in the document.
    Caution,
    /// It was refused, or cannot be read.
    Bad,
}

impl Meaning {
    fn new(tone: Tone, text: impl Into<String>) -> Self {
        Self { tone, text: text.into() }
    }

    /// What a client says with this frame.
    pub fn of_request(frame: &Frame) -> Self {
        sent::meaning(frame)
    }

    /// What a unit says with this frame.
    pub fn of_reply(frame: &Frame) -> Self {
        received::meaning(frame)
    }
}

/// Up to three decimals, with a true minus sign.
fn plain(value: f64) -> String {
    number::plain(value).replace('-', "\u{2212}")
}

/// As [`plain`], with a sign.
fn signed(value: f64) -> String {
    let plus = if value < 0.0 { "" } else { "+" };
    format!("{plus}{}", plain(value))
}

/// Two decimals and the degree sign, as angles are measured.
fn degrees(value: f64) -> String {
    format!("{value:.2}°").replace('-', "\u{2212}")
}

fn place(position: Position) -> String {
    let side = |angle: f64, plus, minus| {
        format!("{}° {}", plain(angle.abs()), if angle < 0.0 { minus } else { plus })
    };
    let latitude = side(position.latitude_deg(), 'N', 'S');
    let longitude = side(position.longitude_deg(), 'E', 'W');
    format!("{latitude}, {longitude}")
}

/// Date and time, to the millisecond where there is a fraction.
fn date_time(time: Timestamp) -> String {
    let form = if time.subsec_nanosecond() == 0 { "%F %T" } else { "%F %T.%3f" };
    time.strftime(form).to_string()
}
