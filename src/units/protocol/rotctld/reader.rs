//! Reading of a server's answers, as a client.

use std::collections::HashSet;

use super::{ErrorCode, Limits, Line, Position, Request, StatusWord, position::number};

/// Max number of lines in an answer to `\dump_state`.
pub const MAX_STATE_LINES: usize = 32;

/// A complete answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// Acceptance of the command; the rotator may still move.
    Done,
    Error(ErrorCode),
    Position(Position),
    Info(String),
    Status(Vec<StatusWord>),
    /// Limits of the rotator; `None` if the server does not state all of them.
    State(Option<Limits>),
}

/// A line that does not belong to the answer of the request. After such a line, the client cannot
/// trust the connection, because answers do not name their request.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UnreadableAnswer {
    #[error("the answer {line:?} is not one to the request")]
    Line { line: String },
    #[error("the answer has a line of more than {} bytes", super::MAX_LINE_BYTES)]
    LongLine,
    #[error("the answer has more than {MAX_STATE_LINES} lines")]
    ManyLines,
}

/// Reader of the answer to one request, line by line.
#[derive(Debug, Clone)]
pub struct Reader {
    request: Request,
    lines: Vec<String>,
}

impl Reader {
    /// Returns a reader of the answer to `request`.
    pub fn new(request: Request) -> Self {
        Self { request, lines: Vec::new() }
    }

    /// Takes the next line; returns the answer once it is complete.
    pub fn line(&mut self, line: Line) -> Result<Option<Answer>, UnreadableAnswer> {
        let Line::Text(line) = line else { return Err(UnreadableAnswer::LongLine) };
        if let Some(code) = report(&line) {
            return self.reported(code, line).map(Some);
        }
        self.lines.push(line);
        match self.request {
            Request::Position => self.position(),
            Request::Info => Ok(self.lines.pop().map(Answer::Info)),
            Request::Status => Ok(self.lines.pop().map(|words| Answer::Status(status(&words)))),
            Request::State => self.state(),
            // The list for people ends with a code; the reader keeps none of its lines.
            Request::Capabilities => {
                self.lines.clear();
                Ok(None)
            }
            Request::Stop | Request::Motion(_) | Request::Quit => Err(self.unreadable()),
        }
    }

    /// Ends an answer at its code. Success alone does not answer a question.
    fn reported(&self, code: i32, line: String) -> Result<Answer, UnreadableAnswer> {
        match (ErrorCode::from_report(code), self.request) {
            (Some(_), _) if !self.lines.is_empty() => Err(UnreadableAnswer::Line { line }),
            (Some(code), _) => Ok(Answer::Error(code)),
            (None, Request::Stop | Request::Motion(_) | Request::Capabilities) => Ok(Answer::Done),
            (
                None,
                Request::Position
                | Request::Info
                | Request::Status
                | Request::State
                | Request::Quit,
            ) => Err(UnreadableAnswer::Line { line }),
        }
    }

    fn unreadable(&mut self) -> UnreadableAnswer {
        UnreadableAnswer::Line { line: self.lines.pop().unwrap_or_default() }
    }

    fn position(&mut self) -> Result<Option<Answer>, UnreadableAnswer> {
        let [azimuth, rest @ ..] = self.lines.as_slice() else { return Ok(None) };
        let Some(azimuth) = number(azimuth) else { return Err(self.unreadable()) };
        let [elevation] = rest else { return Ok(None) };
        let position = number(elevation).and_then(|el| Position::new(azimuth, el).ok());
        position.map(|position| Some(Answer::Position(position))).ok_or_else(|| self.unreadable())
    }

    /// Reads the state: version 1 has keys and values until `done`, version 0 a model and four
    /// numbers.
    fn state(&mut self) -> Result<Option<Answer>, UnreadableAnswer> {
        if self.lines.len() > MAX_STATE_LINES {
            return Err(UnreadableAnswer::ManyLines);
        }
        let version = self.lines.first().and_then(|version| version.trim().parse::<u32>().ok());
        match version {
            None => Err(self.unreadable()),
            Some(0) => {
                let Some([.., last]) = self.lines.get(2..) else { return Ok(None) };
                if number(last.trim()).is_none() {
                    return Err(self.unreadable());
                }
                let numbers = self.lines.iter().skip(2).filter_map(|line| number(line.trim()));
                let numbers: Vec<f64> = numbers.collect();
                let [min_az, max_az, min_el, max_el] = numbers[..] else { return Ok(None) };
                Ok(Some(Answer::State(limits([min_az, max_az, min_el, max_el].map(Some)))))
            }
            Some(_) if self.lines.last().is_some_and(|line| line.trim() == "done") => {
                let value = |key: &str| {
                    let mut pairs = self.lines.iter().filter_map(|line| line.split_once('='));
                    pairs.find(|(name, _)| name.trim() == key).and_then(|(_, v)| number(v.trim()))
                };
                let limits = limits(["min_az", "max_az", "min_el", "max_el"].map(value));
                Ok(Some(Answer::State(limits)))
            }
            Some(_) => Ok(None),
        }
    }
}

/// Returns the limits of the four numbers, if they make ranges.
fn limits(numbers: [Option<f64>; 4]) -> Option<Limits> {
    let [Some(min_az), Some(max_az), Some(min_el), Some(max_el)] = numbers else { return None };
    (min_az < max_az && min_el <= max_el).then_some(Limits {
        min_azimuth_deg: min_az,
        max_azimuth_deg: max_az,
        min_elevation_deg: min_el,
        max_elevation_deg: max_el,
    })
}

/// Returns the number of a line such as `RPRT -1`.
fn report(line: &str) -> Option<i32> {
    line.strip_prefix("RPRT ")?.trim().parse().ok()
}

/// Returns the known words of a status.
fn status(words: &str) -> Vec<StatusWord> {
    let read = |word: &str| StatusWord::ALL.into_iter().find(|status| status.word() == word);
    let mut words: Vec<StatusWord> = words.split_whitespace().filter_map(read).collect();
    // rotctld 4.5.4 repeats the whole list.
    let mut unique = HashSet::new();
    words.retain(|word| unique.insert(*word));
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rotctld::Motion;

    fn read(request: Request, text: &str) -> Result<Option<Answer>, UnreadableAnswer> {
        let mut reader = Reader::new(request);
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            let answer = reader.line(Line::Text(line.to_owned()))?;
            if answer.is_some() {
                assert_eq!(lines.peek(), None, "more than an answer");
                return Ok(answer);
            }
        }
        Ok(None)
    }

    fn is_unreadable(request: Request, text: &str) -> bool {
        matches!(read(request, text), Err(UnreadableAnswer::Line { .. }))
    }

    #[test]
    fn a_position_has_two_lines() {
        let position = Position::new(-170.0, 10.25).unwrap();
        let read_position = |text| read(Request::Position, text);
        assert_eq!(read_position("-170.00\n10.25\n"), Ok(Some(Answer::Position(position))));
        assert_eq!(read_position("-170.000000\n10.250000\n"), Ok(Some(Answer::Position(position))));
        assert_eq!(read_position("-170.00\n"), Ok(None));
        assert_eq!(read_position("RPRT -6\n"), Ok(Some(Answer::Error(ErrorCode::IO))));
        for text in ["nan\n", "1.0\nnan\n", "RPRT 0\n", "1.0\nRPRT 0\n", "Dummy rotator\n", "\n"] {
            assert!(is_unreadable(Request::Position, text), "{text}");
        }
    }

    #[test]
    fn a_command_is_answered_by_a_code() {
        let park = Request::Motion(Motion::Park);
        for request in [park, Request::Stop] {
            assert_eq!(read(request, "RPRT 0\n"), Ok(Some(Answer::Done)));
            let refused = Answer::Error(ErrorCode::REJECTED);
            assert_eq!(read(request, "RPRT -9\n"), Ok(Some(refused)));
            // A late position answers an earlier request.
            assert!(is_unreadable(request, "90.00\n"));
            assert!(is_unreadable(request, "RPRT\n"));
        }
    }

    #[test]
    fn limits_are_read_in_both_versions_of_the_protocol() {
        let limits = |text| match read(Request::State, text) {
            Ok(Some(Answer::State(limits))) => limits,
            other => panic!("{other:?}"),
        };
        let first = "1\n1\nmin_az=-180.000000\nmax_az=450.000000\nmin_el=0.000000\n\
                     max_el=90.000000\nsouth_zero=0\nrot_type=AzEl\ndone\n";
        let found = limits(first).unwrap();
        let range = (found.min_azimuth_deg, found.max_azimuth_deg);
        assert_eq!(range, (-180.0, 450.0));
        assert_eq!((found.min_elevation_deg, found.max_elevation_deg), (0.0, 90.0));
        let zero = "0\n603\n0.000000\n360.000000\n-5.000000\n90.000000\n";
        let found = limits(zero).unwrap();
        assert_eq!((found.max_azimuth_deg, found.min_elevation_deg), (360.0, -5.0));
        assert_eq!(limits("1\n1\nmin_az=0\ndone\n"), None);
        assert_eq!(limits("1\n1\nmin_az=9\nmax_az=-9\nmin_el=0\nmax_el=90\ndone\n"), None);
        let refused = Answer::Error(ErrorCode::NOT_IMPLEMENTED);
        assert_eq!(read(Request::State, "RPRT -4\n"), Ok(Some(refused)));
        assert!(is_unreadable(Request::State, "Dummy rotator\n"));
        assert!(is_unreadable(Request::State, "0\n1\nmin_az=1\n"));
    }

    #[test]
    fn a_state_without_an_end_is_unreadable() {
        let text = format!("1\n{}", "key=value\n".repeat(100));
        assert_eq!(read(Request::State, &text), Err(UnreadableAnswer::ManyLines));
        let long = Reader::new(Request::State).line(Line::TooLong);
        assert_eq!(long, Err(UnreadableAnswer::LongLine));
    }

    #[test]
    fn a_status_names_what_moves() {
        let words = |text| read(Request::Status, text);
        let moving = vec![StatusWord::Moving, StatusWord::MovingAzimuth];
        let text = "MOVING MOVING_AZ MOVING_LEFT MOVING MOVING_AZ MOVING_LEFT \n";
        assert_eq!(words(text), Ok(Some(Answer::Status(moving))));
        assert_eq!(words("\n"), Ok(Some(Answer::Status(Vec::new()))));
        assert_eq!(words("RPRT -11\n"), Ok(Some(Answer::Error(ErrorCode::NOT_AVAILABLE))));
    }
}
