//! Meaning of a frame in one plain sentence.

mod received;
mod sent;

use jiff::Timestamp;

use super::{Frame, Position, number};

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Meaning {
    pub tone: Tone,
    /// Sentence without a full stop.
    pub text: String,
}

/// Tone of a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// A question or a report.
    Plain,
    /// A change of a setting, or a motion.
    Change,
    /// An accepted request.
    Good,
    /// A frame that is not in the document.
    Caution,
    /// A refusal, or an unreadable frame.
    Bad,
}

impl Meaning {
    fn new(tone: Tone, text: impl Into<String>) -> Self {
        Self { tone, text: text.into() }
    }

    /// Returns the meaning of a client's frame.
    pub fn of_request(frame: &Frame) -> Self {
        sent::meaning(frame)
    }

    /// Returns the meaning of a unit's frame.
    pub fn of_reply(frame: &Frame) -> Self {
        received::meaning(frame)
    }
}

/// Returns a number with up to three decimals and a true minus sign.
fn plain(value: f64) -> String {
    number::plain(value).replace('-', "\u{2212}")
}

/// Returns a number like [`plain`], but also with a plus sign.
fn signed(value: f64) -> String {
    let plus = if value < 0.0 { "" } else { "+" };
    format!("{plus}{}", plain(value))
}

/// Returns an angle with two decimals and the degree sign.
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

/// Returns date and time, with milliseconds if there is a fraction of a second.
fn date_time(time: Timestamp) -> String {
    let form = if time.subsec_nanosecond() == 0 { "%F %T" } else { "%F %T.%3f" };
    time.strftime(form).to_string()
}
