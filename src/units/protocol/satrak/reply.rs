//! Typed replies, read from frames.

use super::fields::{FieldError, FrameFields};
use super::{
    AngleSettings, Faults, Frame, GpsData, GpsSettings, ImageStatus, Oddity, Reduction, Satellite,
    SatelliteFtp, SatelliteHttp, Settings, StartStopTime, Status, TimedPosition, UnitTime, Verb,
    Word,
};

#[derive(Debug, Clone, PartialEq)]
pub enum Reply {
    Version(Version),
    Status(Status),
    Faults(Faults),
    Clock(UnitTime),
    StartStopTime(StartStopTime),
    Settings(Settings),
    AngleSettings(AngleSettings),
    GpsData(GpsData),
    TimedPosition(TimedPosition),
    GpsSettings(GpsSettings),
    Satellite(Satellite),
    SatelliteHttp(SatelliteHttp),
    SatelliteFtp(SatelliteFtp),
    ImageStatus(ImageStatus),
    Reduction(Reduction),
    /// Acceptance of a request. For a motion, it means the start and not the arrival.
    Done,
    Refused {
        /// Error code, raw: the document lists none.
        code: String,
    },
}

/// Reply to `VERSION?`: free texts, on which no decision depends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Version {
    /// Firmware of the control unit, with its date.
    pub control_unit: String,
    /// Firmware of the drive unit, with its date.
    pub drive_unit: Option<String>,
    /// Texts in addition to the texts in the document.
    pub others: Vec<String>,
}

impl Version {
    fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        let text = |field| fields.text(field).map(str::to_owned);
        Ok(Self {
            control_unit: text(1)?,
            drive_unit: text(2).ok(),
            others: (3..=fields.count()).map(text).collect::<Result<_, _>>()?,
        })
    }
}

/// A deviation worth one line in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Note {
    Oddity(Oddity),
    /// Number of values in addition to those in the document.
    ExtraFields(usize),
    /// Number of values in the document that the reply lacks.
    MissingFields(usize),
}

/// A reply, with word and verb of its request.
#[derive(Debug, Clone, PartialEq)]
pub struct ParsedReply {
    pub word: Word,
    pub verb: Verb,
    pub reply: Reply,
    /// Deviations worth a line in the log.
    pub notes: Vec<Note>,
}

/// Reason why a frame is not a reply. The error contains no values, because they may be secret.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReplyError {
    #[error("unknown word {0}")]
    UnknownWord(String),
    /// A word that the document does not have with this verb.
    #[error("{word}{} is no request", verb.sign())]
    NoSuchRequest {
        word: Word,
        /// Verb with which the word came.
        verb: Verb,
    },
    /// A setting's answer that is neither `OK` nor `ERR`.
    #[error("{0}= without OK or ERR")]
    NeitherOkNorErr(Word),
    /// A wrong number of values.
    #[error("{word}? with {found} instead of {min} to {max} values")]
    Count {
        word: Word,
        found: usize,
        min: usize,
        max: usize,
        /// `true` if the unit seems to write decimal commas.
        looks_like_decimal_commas: bool,
    },
    #[error("{word}?: {error}")]
    Field {
        word: Word,
        /// Number of the value, and the problem with it.
        error: FieldError,
    },
}

/// Number of values of a reply: the readable min, the number in the document, the readable max, and
/// the number of decimals among them.
struct ReplyShape {
    min: usize,
    listed: usize,
    max: usize,
    decimals: usize,
}

impl ReplyShape {
    const fn for_word(word: Word) -> Option<Self> {
        /// Max number of values of a reply that ends in a text, which may contain commas.
        const ANY: usize = usize::MAX;
        let (min, listed, max, decimals) = match word {
            // No decision depends on these texts, so their number does not matter.
            Word::Version => (1, 2, ANY, 0),
            Word::Status => (Status::MIN_FIELDS, Status::FIELDS, Status::MAX_FIELDS, 4),
            // None of these values is a decimal, so no additional value comes from a decimal comma.
            Word::ErrStatus => (Faults::MIN_FIELDS, Faults::FIELDS, ANY, 0),
            // Section 8 lists seven values, but its example has six.
            Word::Time => (6, 7, 7, 0),
            Word::StartStopTime => (12, 12, 12, 0),
            // With one value more or less, the places of the settings would be unknown.
            Word::Settings => (Settings::FIELDS, Settings::FIELDS, Settings::FIELDS, 5),
            Word::AngleSettings => (4, 4, 4, 2),
            Word::GpsData | Word::Tpos => (9, 9, 9, 2),
            Word::GpsSettings => (3, 3, 3, 2),
            Word::Satellite => (Satellite::FIELDS, ANY, ANY, 0),
            Word::SatelliteHttp => (SatelliteHttp::FIELDS, ANY, ANY, 0),
            Word::SatelliteFtp => {
                (SatelliteFtp::FIELDS, SatelliteFtp::FIELDS, SatelliteFtp::FIELDS, 0)
            }
            Word::LoadImage => (1, 1, ANY, 0),
            Word::Reduction => (2, 2, 2, 2),
            Word::Move
            | Word::Step
            | Word::Goto
            | Word::Stop
            | Word::Track
            | Word::TrackAutoEnable
            | Word::RtcReupdate => return None,
        };
        Some(Self { min, listed, max, decimals })
    }

    fn check(&self, word: Word, found: usize) -> Result<(), ReplyError> {
        if (self.min..=self.max).contains(&found) {
            return Ok(());
        }
        // A unit with decimal commas splits every decimal, or only those that are not whole.
        let looks_like_decimal_commas = found > self.max && self.decimals > 0;
        let Self { min, max, .. } = *self;
        Err(ReplyError::Count { word, found, min, max, looks_like_decimal_commas })
    }

    fn note(&self, word: Word, found: usize) -> Option<Note> {
        match word {
            // Additional values are commas in the name or the address.
            Word::Satellite | Word::SatelliteHttp => None,
            _ if found > self.listed => Some(Note::ExtraFields(found - self.listed)),
            _ if found < self.listed => Some(Note::MissingFields(self.listed - found)),
            _ => None,
        }
    }
}

impl Reply {
    /// Reads a frame from a unit.
    pub fn parse(frame: &Frame) -> Result<ParsedReply, ReplyError> {
        let (word, verb) =
            frame.command().ok_or_else(|| ReplyError::UnknownWord(bounded(frame.word())))?;
        let mut notes: Vec<Note> = frame.oddities().iter().copied().map(Note::Oddity).collect();
        let fields = FrameFields::new(frame);
        let reply = match (frame.fields().first().map(String::as_str), verb) {
            // This test comes before the count: the document does not state the form of a failed
            // query.
            (Some("ERR"), _) if is_refusal(word, fields.count()) => {
                Self::Refused { code: fields.joined(1, 0).unwrap_or_default() }
            }
            (Some("OK"), Verb::Set) => Self::Done,
            (_, Verb::Set) => return Err(ReplyError::NeitherOkNorErr(word)),
            (_, Verb::Query) => {
                let shape =
                    ReplyShape::for_word(word).ok_or(ReplyError::NoSuchRequest { word, verb })?;
                shape.check(word, fields.count())?;
                notes.extend(shape.note(word, fields.count()));
                read(word, fields).map_err(|error| ReplyError::Field { word, error })?
            }
        };
        Ok(ParsedReply { word, verb, reply, notes })
    }
}

/// Returns `true` if `ERR` before the values of a reply means a refusal.
fn is_refusal(word: Word, count: usize) -> bool {
    // `ERR` may be the address of the server: a code would then carry the password to the log.
    word != Word::SatelliteFtp || count <= 2
}

fn read(word: Word, fields: FrameFields<'_>) -> Result<Reply, FieldError> {
    Ok(match word {
        Word::Status => Reply::Status(Status::read(fields)?),
        Word::ErrStatus => Reply::Faults(Faults::read(fields)?),
        Word::Time => Reply::Clock(UnitTime::read(fields)?),
        Word::StartStopTime => Reply::StartStopTime(StartStopTime::read(fields)?),
        Word::Settings => Reply::Settings(Settings::read(fields)?),
        Word::AngleSettings => Reply::AngleSettings(AngleSettings::read(fields)?),
        Word::GpsData => Reply::GpsData(GpsData::read(fields)?),
        Word::Tpos => Reply::TimedPosition(TimedPosition::read(fields)?),
        Word::GpsSettings => Reply::GpsSettings(GpsSettings::read(fields)?),
        Word::Satellite => Reply::Satellite(Satellite::read(fields)?),
        Word::SatelliteHttp => Reply::SatelliteHttp(SatelliteHttp::read(fields)?),
        Word::SatelliteFtp => Reply::SatelliteFtp(SatelliteFtp::read(fields)?),
        Word::LoadImage => Reply::ImageStatus(ImageStatus { raw: fields.joined(0, 0)? }),
        Word::Reduction => Reply::Reduction(Reduction::read(fields)?),
        // The caller has refused words whose reply has no shape.
        _ => Reply::Version(Version::read(fields)?),
    })
}

/// Returns enough characters of a word to find it in the log.
fn bounded(word: &str) -> String {
    word.chars().take(32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(payload: &str) -> Result<Reply, ReplyError> {
        Reply::parse(&Frame::from_payload(payload)).map(|parsed| parsed.reply)
    }

    #[test]
    fn decimal_commas_are_never_read_as_other_angles() {
        // The commas turn 16 fields into 20, and 15 into 19.
        for tail in ["", ",1"] {
            let payload = format!("STATUS?,0,299,49,34,35,0,0,0,0,0,0,0,0,0,0,80,0,35,0{tail}");
            let error = parse(&payload).unwrap_err();
            assert!(
                matches!(error, ReplyError::Count { looks_like_decimal_commas: true, .. }),
                "{error:?}"
            );
        }
        assert!(parse("TPOS?,306,00,48,74,15,33,41,17,10,2017,818").is_err());
    }

    #[test]
    fn a_query_can_be_refused() {
        assert_eq!(parse("TPOS?,ERR,12"), Ok(Reply::Refused { code: "12".into() }));
        assert_eq!(parse("STOP=,ERR"), Ok(Reply::Refused { code: String::new() }));
        assert_eq!(parse("STOP=,HM"), Err(ReplyError::NeitherOkNorErr(Word::Stop)));
        assert_eq!(parse("STOP="), Err(ReplyError::NeitherOkNorErr(Word::Stop)));
    }

    #[test]
    fn a_server_called_err_puts_no_password_into_a_code() {
        let payload = "SATELLITE_FTP?,ERR,user,hunter2,22,f,s,1,1";
        let reply = parse(payload);
        assert!(matches!(reply, Ok(Reply::SatelliteFtp(_))), "{reply:?}");
        assert_eq!(parse("SATELLITE_FTP?,ERR,7"), Ok(Reply::Refused { code: "7".into() }));
    }

    #[test]
    fn what_nobody_asks_is_no_reply() {
        assert_eq!(parse("HELLO?,1"), Err(ReplyError::UnknownWord("HELLO?".into())));
        let verb = Verb::Query;
        assert_eq!(parse("MOVE?,1"), Err(ReplyError::NoSuchRequest { word: Word::Move, verb }));
    }

    #[test]
    fn a_ninth_ftp_value_is_not_guessed() {
        let eight = "SATELLITE_FTP?,10.0.1.2,u,secret,22,f,s,1,0";
        let Ok(Reply::SatelliteFtp(ftp)) = parse(eight) else { panic!("not read") };
        assert_eq!(ftp.password.reveal(), "secret");
        assert!(!format!("{ftp:?}").contains("secret"));
        assert!(matches!(parse(&format!("{eight},1")), Err(ReplyError::Count { .. })));
    }
}
