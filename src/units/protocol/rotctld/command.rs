//! Commands as a server reads them.

use super::{Motion, Position, Request, Sense, Speed, position::number};
use crate::protocol::rotctld::ErrorCode;

/// A line of a client: the request and the form of its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Command {
    pub format: Format,
    /// The request, or the error to answer.
    pub request: Result<Request, ErrorCode>,
}

/// Form of an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Format {
    /// Only values, one on each line.
    Plain,
    /// The extended response protocol: the command with its arguments, then records with names,
    /// then the code.
    Extended {
        /// Separator of records: a line feed for `+`, else the character before the command.
        separator: char,
        /// Long name and arguments of the command.
        echo: String,
    },
}

/// Long names, letters and requests without arguments.
const WITHOUT_ARGUMENTS: [(&str, char, Request); 9] = [
    ("get_pos", 'p', Request::Position),
    ("stop", 'S', Request::Stop),
    ("park", 'K', Request::Motion(Motion::Park)),
    ("get_info", '_', Request::Info),
    ("get_status", 's', Request::Status),
    ("dump_caps", '1', Request::Capabilities),
    ("dump_state", '\u{8f}', Request::State),
    ("quit", 'q', Request::Quit),
    ("exit", 'Q', Request::Quit),
];

const SET_POSITION: (&str, char) = ("set_pos", 'P');
const MOVE: (&str, char) = ("move", 'M');

impl Command {
    /// Returns the command of a line; `None` for an empty line and a comment, which get no answer.
    pub fn parse(line: &str) -> Option<Self> {
        let line = line.trim();
        let separator = line.chars().next().filter(|first| is_separator(*first));
        let rest = separator.map_or(line, |separator| &line[separator.len_utf8()..]).trim_start();
        if rest.is_empty() || rest.starts_with('#') {
            return None;
        }
        let (name, arguments) = split(rest);
        let request = request(name, &arguments);
        let format = match separator {
            None => Format::Plain,
            Some(separator) => {
                let separator = if separator == '+' { '\n' } else { separator };
                let words = [vec![long_name(name)], arguments].concat();
                let echo = match words.as_slice() {
                    [name] => format!("{name}:"),
                    [name, arguments @ ..] => format!("{name}: {}", arguments.join(" ")),
                    [] => String::new(),
                };
                Format::Extended { separator, echo }
            }
        };
        Some(Self { format, request })
    }
}

/// Returns `true` for a character before a command that requests the extended protocol.
fn is_separator(first: char) -> bool {
    first.is_ascii_punctuation() && !['\\', '_', '#'].contains(&first)
}

/// Returns the name and arguments of a command. A name is a letter or a long name, with or without
/// `\`: Hamlib requires it, but people and some programs omit it.
fn split(rest: &str) -> (&str, Vec<&str>) {
    let is_long = |word: &str| {
        let mut names = WITHOUT_ARGUMENTS.iter().map(|(name, ..)| *name);
        names.any(|name| name == word) || [SET_POSITION.0, MOVE.0].contains(&word)
    };
    let mut words = rest.split_whitespace();
    let first = words.next().unwrap_or_default();
    if let Some(name) = first.strip_prefix('\\') {
        return (name, words.collect());
    }
    if is_long(first) {
        return (first, words.collect());
    }
    // A letter ends before the next character: `P10 20` is the same as `P 10 20`.
    let end = first.chars().next().map_or(0, char::len_utf8);
    let (name, glued) = first.split_at(end);
    let glued = Some(glued).filter(|glued| !glued.is_empty());
    (name, glued.into_iter().chain(words).collect())
}

fn is_called(name: &str, (long, letter): (&str, char)) -> bool {
    name == long || name.chars().eq([letter])
}

fn long_name(name: &str) -> &str {
    let names = WITHOUT_ARGUMENTS.iter().map(|(long, letter, _)| (*long, *letter));
    let mut names = names.chain([SET_POSITION, MOVE]);
    names.find(|called| is_called(name, *called)).map_or(name, |(long, _)| long)
}

/// Returns the request of a name and its arguments; ignores surplus arguments.
fn request(name: &str, arguments: &[&str]) -> Result<Request, ErrorCode> {
    if is_called(name, SET_POSITION) {
        let [azimuth, elevation, ..] = arguments else { return Err(ErrorCode::INVALID) };
        let angles = number(azimuth).zip(number(elevation));
        let position = angles.and_then(|(azimuth, elevation)| {
            Position::new(azimuth, elevation).ok() // A number that is not finite was refused above.
        });
        let position = position.ok_or(ErrorCode::INVALID)?;
        return Ok(Request::Motion(Motion::GoTo(position)));
    }
    if is_called(name, MOVE) {
        let [sense, speed, ..] = arguments else { return Err(ErrorCode::INVALID) };
        let sense = Sense::parse(sense).ok_or(ErrorCode::INVALID)?;
        // The value -1 leaves the speed unchanged.
        let speed = match speed.parse::<i16>().map_err(|_| ErrorCode::INVALID)? {
            -1 => None,
            speed => {
                let speed = u8::try_from(speed).ok().and_then(Speed::new);
                Some(speed.ok_or(ErrorCode::INVALID)?)
            }
        };
        return Ok(Request::Motion(Motion::Turn { sense, speed }));
    }
    let row = WITHOUT_ARGUMENTS.iter().find(|(long, letter, _)| is_called(name, (long, *letter)));
    row.map(|(.., request)| *request).ok_or(ErrorCode::NOT_IMPLEMENTED)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(line: &str) -> Result<Request, ErrorCode> {
        let command = Command::parse(line).unwrap();
        assert_eq!(command.format, Format::Plain, "{line}");
        command.request
    }

    fn go_to(azimuth_deg: f64, elevation_deg: f64) -> Request {
        let position = Position::new(azimuth_deg, elevation_deg).unwrap();
        Request::Motion(Motion::GoTo(position))
    }

    #[test]
    fn positions_of_all_clients_are_read() {
        // These lines come from Gpredict, libhamlib, SkyRoof, SatNOGS, a comma of a locale,
        // Look4Sat and `nc` by hand.
        for (line, azimuth_deg, elevation_deg) in [
            ("P 180.00 45.00", 180.0, 45.0),
            ("P 163.000000 41.000000", 163.0, 41.0),
            ("P 20.4 0.0", 20.4, 0.0),
            ("P 12.345678901234567 -0.5", 12.345_678_901_234_567, -0.5),
            ("P 180,00 45,50", 180.0, 45.5),
            ("P 120.1 9.98 ", 120.1, 9.98),
            ("\\set_pos 10 20", 10.0, 20.0),
            ("set_pos 1e1 20", 10.0, 20.0),
            ("P10 20", 10.0, 20.0),
            ("P 10 20 30 40", 10.0, 20.0),
        ] {
            assert_eq!(plain(line), Ok(go_to(azimuth_deg, elevation_deg)), "{line}");
        }
        for line in ["P", "P 10", "P nan nan", "P 10 inf", "P ten 20", "P 1.2.3 4"] {
            assert_eq!(plain(line), Err(ErrorCode::INVALID), "{line}");
        }
    }

    #[test]
    fn letters_and_long_names_ask_the_same() {
        for (lines, request) in [
            (["p", "\\get_pos", "get_pos"], Request::Position),
            (["S", "\\stop", "stop"], Request::Stop),
            (["K", "\\park", "park"], Request::Motion(Motion::Park)),
            (["_", "\\get_info", "get_info"], Request::Info),
            (["s", "\\get_status", "get_status"], Request::Status),
            (["1", "\\dump_caps", "dump_caps"], Request::Capabilities),
            (["q", "Q", "\\quit"], Request::Quit),
        ] {
            for line in lines {
                assert_eq!(plain(line), Ok(request), "{line}");
            }
        }
        assert_eq!(plain("\\dump_state"), Ok(Request::State));
    }

    #[test]
    fn a_turn_has_a_sense_and_a_speed() {
        let turn = |sense, speed| Ok(Request::Motion(Motion::Turn { sense, speed }));
        assert_eq!(plain("M 8 50"), turn(Sense::Left, Speed::new(50)));
        assert_eq!(plain("\\move up_ccw -1"), turn(Sense::UpLeft, None));
        for line in ["M", "M 8", "M SIDE 10", "M 8 0", "M 8 200", "M 8 fast", "M 24 1"] {
            assert_eq!(plain(line), Err(ErrorCode::INVALID), "{line}");
        }
    }

    #[test]
    fn what_is_not_implemented_is_answered_with_an_error() {
        for line in ["R 1", "C min_az 10", "w hello", "V SPEED 2", "x", "\\pause 3", "\\", "Ã¼"] {
            assert_eq!(plain(line), Err(ErrorCode::NOT_IMPLEMENTED), "{line}");
        }
        for line in ["", "  ", "# a comment", "+", "; # comment"] {
            assert_eq!(Command::parse(line), None, "{line}");
        }
    }

    #[test]
    fn a_character_before_the_command_asks_for_records_with_names() {
        let format = |line: &str| Command::parse(line).unwrap().format;
        let extended =
            |separator, echo: &str| Format::Extended { separator, echo: echo.to_owned() };
        assert_eq!(format("+p"), extended('\n', "get_pos:"));
        assert_eq!(format(";p"), extended(';', "get_pos:"));
        assert_eq!(format("|\\dump_state"), extended('|', "dump_state:"));
        assert_eq!(format("+P 90 45"), extended('\n', "set_pos: 90 45"));
        assert_eq!(format("+\\set_pos 90.5 45"), extended('\n', "set_pos: 90.5 45"));
        assert_eq!(format("+_"), extended('\n', "get_info:"));
        // The line does not count as a request for help.
        assert_eq!(format("?p"), extended('?', "get_pos:"));
        assert_eq!(Command::parse("+x").unwrap().request, Err(ErrorCode::NOT_IMPLEMENTED));
    }
}
