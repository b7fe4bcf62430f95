//! Replies of a server.

use super::{Command, ErrorCode, Format, Limits, Position, StatusWord};

/// The answer to a command.
#[derive(Debug, Clone, PartialEq)]
pub enum Reply {
    /// Success: the server has carried out or accepted the command.
    Done,
    Error(ErrorCode),
    Position(Position),
    /// Name of the rotator, of which the server sends at most [`Reply::MAX_NAME`] characters.
    Info(String),
    Status(Vec<StatusWord>),
    State(Limits),
    Capabilities {
        name: String,
        limits: Limits,
    },
}

impl Reply {
    /// Max length of a name, characters. `HamClock` takes less than 50 bytes of the answer to
    /// `get_info`, including the names that it adds.
    pub const MAX_NAME: usize = 24;

    /// Returns the text to send in one piece, because clients such as Gpredict read each answer at
    /// once.
    pub fn to_text(&self, command: &Command) -> String {
        match &command.format {
            Format::Plain => self.plain(),
            Format::Extended { separator, echo } => self.extended(*separator, echo),
        }
    }

    fn plain(&self) -> String {
        let mut records = self.records(false);
        // Values come without a code, except the list of capabilities.
        if records.is_empty() || matches!(self, Self::Capabilities { .. }) {
            records.push(self.report());
        }
        records.join("\n") + "\n"
    }

    fn extended(&self, separator: char, echo: &str) -> String {
        let mut text = format!("{echo}{separator}");
        for record in self.records(true) {
            text.push_str(&record);
            text.push(separator);
        }
        // A line feed ends the answer with any separator.
        text + &self.report() + "\n"
    }

    fn report(&self) -> String {
        let code = if let Self::Error(code) = self { code.report() } else { 0 };
        format!("RPRT {code}")
    }

    /// Returns the values, with their names for the extended protocol.
    fn records(&self, are_named: bool) -> Vec<String> {
        let named = |name: &str, value: String| {
            if are_named { format!("{name}: {value}") } else { value }
        };
        match self {
            Self::Done | Self::Error(_) => Vec::new(),
            Self::Position(position) => vec![
                named("Azimuth", two_places(position.azimuth_deg())),
                named("Elevation", two_places(position.elevation_deg())),
            ],
            Self::Info(name) => vec![named("Info", short(name))],
            Self::Status(words) => {
                let words = words.iter().map(|word| format!("{} ", word.word()));
                vec![named("Status flags", words.collect())]
            }
            Self::State(limits) => state(*limits, are_named),
            Self::Capabilities { name, limits } => capabilities(name, *limits),
        }
    }
}

/// Returns the version that libhamlib reads as keys and values until `done`, a model number, which
/// clients ignore, and the limits.
fn state(limits: Limits, are_named: bool) -> Vec<String> {
    let angle = |key: &str, name: &str, angle_deg: f64| {
        if are_named { format!("{name}: {angle_deg:.6}") } else { format!("{key}={angle_deg:.6}") }
    };
    let (version, model, south) = if are_named {
        ("rotctld Protocol Ver: 1", "Rotor Model: 1", "South Zero: 0")
    } else {
        ("1", "1", "south_zero=0")
    };
    vec![
        version.to_owned(),
        model.to_owned(),
        angle("min_az", "Minimum Azimuth", limits.min_azimuth_deg),
        angle("max_az", "Maximum Azimuth", limits.max_azimuth_deg),
        angle("min_el", "Minimum Elevation", limits.min_elevation_deg),
        angle("max_el", "Maximum Elevation", limits.max_elevation_deg),
        south.to_owned(),
        "rot_type=AzEl".to_owned(),
        "done".to_owned(),
    ]
}

/// Returns the lines of rotctld's list that clients read: `HamClock` and cqrlog look for the
/// limits.
fn capabilities(name: &str, limits: Limits) -> Vec<String> {
    vec![
        "Caps dump for model:\t1".to_owned(),
        format!("Model name:\t\t{}", short(name)),
        "Mfg name:\t\tAzel".to_owned(),
        "Rot type:\t\tAz-El".to_owned(),
        format!("Min Azimuth:\t\t{:.2}", limits.min_azimuth_deg),
        format!("Max Azimuth:\t\t{:.2}", limits.max_azimuth_deg),
        format!("Min Elevation:\t\t{:.2}", limits.min_elevation_deg),
        format!("Max Elevation:\t\t{:.2}", limits.max_elevation_deg),
    ]
}

/// Returns a name as ASCII, on one line.
fn short(name: &str) -> String {
    let letters = name.chars().map(|letter| match letter {
        ' '..='~' => letter,
        _ => '?',
    });
    letters.take(Reply::MAX_NAME).collect()
}

/// Returns an angle with two places, without a sign of zero. `SDRangel` needs the decimal point.
fn two_places(angle_deg: f64) -> String {
    let text = format!("{angle_deg:.2}");
    if text == "-0.00" { "0.00".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(line: &str, reply: &Reply) -> String {
        reply.to_text(&Command::parse(line).unwrap())
    }

    const LIMITS: Limits = Limits {
        min_azimuth_deg: -180.0,
        max_azimuth_deg: 450.0,
        min_elevation_deg: 0.0,
        max_elevation_deg: 90.0,
    };

    // The expected bytes come from rotctld 4.5.4.

    #[test]
    fn plain_answers_are_those_of_rotctld() {
        let position = Reply::Position(Position::new(-110.25, 9.93).unwrap());
        assert_eq!(answer("p", &position), "-110.25\n9.93\n");
        assert_eq!(answer("P 90 45", &Reply::Done), "RPRT 0\n");
        assert_eq!(answer("p", &Reply::Error(ErrorCode::TIMED_OUT)), "RPRT -5\n");
        assert_eq!(answer("_", &Reply::Info("Dummy rotator".to_owned())), "Dummy rotator\n");
        assert_eq!(answer("s", &Reply::Status(Vec::new())), "\n");
        let moving = vec![StatusWord::Moving, StatusWord::MovingAzimuth];
        assert_eq!(answer("s", &Reply::Status(moving)), "MOVING MOVING_AZ \n");
        let state = "1\n1\nmin_az=-180.000000\nmax_az=450.000000\nmin_el=0.000000\n\
                     max_el=90.000000\nsouth_zero=0\nrot_type=AzEl\ndone\n";
        assert_eq!(answer("\\dump_state", &Reply::State(LIMITS)), state);
    }

    #[test]
    fn extended_answers_are_those_of_rotctld() {
        let position = Reply::Position(Position::new(-110.25, 9.93).unwrap());
        assert_eq!(
            answer("+p", &position),
            "get_pos:\nAzimuth: -110.25\nElevation: 9.93\nRPRT 0\n"
        );
        assert_eq!(answer(";p", &position), "get_pos:;Azimuth: -110.25;Elevation: 9.93;RPRT 0\n");
        assert_eq!(answer("+P 90 45", &Reply::Done), "set_pos: 90 45\nRPRT 0\n");
        let refused = Reply::Error(ErrorCode::INVALID);
        assert_eq!(answer(";P 999 10", &refused), "set_pos: 999 10;RPRT -1\n");
        let info = Reply::Info("Dummy rotator".to_owned());
        assert_eq!(answer("+_", &info), "get_info:\nInfo: Dummy rotator\nRPRT 0\n");
        assert_eq!(answer("+S", &Reply::Done), "stop:\nRPRT 0\n");
        assert_eq!(
            answer("+s", &Reply::Status(Vec::new())),
            "get_status:\nStatus flags: \nRPRT 0\n"
        );
        let state = "dump_state:\nrotctld Protocol Ver: 1\nRotor Model: 1\n\
                     Minimum Azimuth: -180.000000\nMaximum Azimuth: 450.000000\n\
                     Minimum Elevation: 0.000000\nMaximum Elevation: 90.000000\nSouth Zero: 0\n\
                     rot_type=AzEl\ndone\nRPRT 0\n";
        assert_eq!(answer("+\\dump_state", &Reply::State(LIMITS)), state);
    }

    #[test]
    fn capabilities_have_the_lines_that_clients_look_for() {
        let reply = Reply::Capabilities { name: "Satrak".to_owned(), limits: LIMITS };
        let text = answer("+\\dump_caps", &reply);
        assert!(text.starts_with("dump_caps:\n") && text.ends_with("\nRPRT 0\n"), "{text}");
        for line in ["Min Azimuth:\t\t-180.00\n", "Max Elevation:\t\t90.00\n"] {
            assert!(text.contains(line), "{text}");
        }
        assert!(answer("1", &reply).ends_with("\nRPRT 0\n"));
    }

    #[test]
    fn answers_are_short_enough_for_the_buffers_of_clients() {
        let name = "An antenna with a very long name\nand a line feed, ÄÖÜ";
        let text = answer("+_", &Reply::Info(name.to_owned()));
        assert_eq!(text.lines().count(), 3, "{text}");
        assert!(text.len() < 50 && text.is_ascii(), "{text}");
        let position = Reply::Position(Position::new(-359.999, -0.001).unwrap());
        assert_eq!(answer("p", &position), "-360.00\n0.00\n");
        for line in answer("\\dump_state", &Reply::State(LIMITS)).lines() {
            assert!(line.len() < 64, "{line}");
        }
    }
}
