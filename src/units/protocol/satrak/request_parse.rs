//! Decoding of requests from frames, as a unit or its simulator does, with the odd forms of the
//! document's examples.

use super::fields::{FieldError, FieldProblem, FrameFields};
use super::{
    AngleChange, ClockTime, Frame, FtpTle, Goto, GpsSettingsChange, Halt, HttpTle, Motion, Move,
    Password, Position, PositionBase, Query, Reduction, Request, SatelliteChoice, SensorAngles,
    Setting, SettingsChange, SettingsRequest, SspaAutoRule, SspaMode, Step, TextValue,
    TleSelection, TrackWindow, UrlValue, ValueError, Verb, Word,
};

/// Reason why a frame is not a request.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RequestError {
    /// An unknown word, or a word that does not exist with this sign.
    #[error("unknown request")]
    Unknown,
    /// A wrong number of values.
    #[error("{found} values instead of {expected}")]
    Count {
        found: usize,
        /// Number of values in the document.
        expected: usize,
    },
    /// A value that cannot be read.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// A value that is out of range or has no meaning.
    #[error(transparent)]
    Value(#[from] ValueError),
}

impl Request {
    /// Reads a frame from a client.
    pub fn parse(frame: &Frame) -> Result<Self, RequestError> {
        let (word, verb) = frame.command().ok_or(RequestError::Unknown)?;
        let fields = FrameFields::new(frame);
        match verb {
            Verb::Query => {
                let mut matching = Query::ALL.into_iter().filter(|(_, name)| *name == word);
                let (query, _) = matching.next().ok_or(RequestError::Unknown)?;
                exactly(fields, 0)?;
                Ok(Self::Query(query))
            }
            Verb::Set => parse_set(word, fields),
        }
    }
}

fn exactly(fields: FrameFields<'_>, expected: usize) -> Result<(), RequestError> {
    let found = fields.count();
    if found == expected { Ok(()) } else { Err(RequestError::Count { found, expected }) }
}

/// Returns the number of values that a setting takes.
const fn value_count(word: Word) -> usize {
    match word {
        Word::Move | Word::Step | Word::Goto | Word::Reduction => 2,
        Word::Track | Word::TrackAutoEnable | Word::LoadImage => 1,
        Word::Time => 6,
        Word::StartStopTime => 12,
        Word::Settings => 11,
        Word::AngleSettings => 5,
        Word::GpsSettings => 3,
        Word::Satellite | Word::SatelliteHttp => 4,
        Word::SatelliteFtp => 8,
        _ => 0,
    }
}

fn parse_set(word: Word, fields: FrameFields<'_>) -> Result<Request, RequestError> {
    // The document's example of SATELLITE_FTP= omits file and satellite.
    let is_short_ftp = word == Word::SatelliteFtp && fields.count() == 6;
    if !is_short_ftp {
        exactly(fields, value_count(word))?;
    }
    let motion = |motion| Ok(Request::Motion(motion));
    let setting = match word {
        Word::Move => {
            return motion(Motion::Move(Move::new(fields.decimal(1)?, fields.decimal(2)?)?));
        }
        Word::Step => {
            return motion(Motion::Step(Step::new(fields.decimal(1)?, fields.decimal(2)?)?));
        }
        Word::Goto => return motion(Motion::Goto(parse_goto(fields)?)),
        Word::Stop => return Ok(Request::Halt(Halt::Stop)),
        // Switching on passes the gate as a motion. Switching off is always allowed.
        Word::Track if switch(fields, 1)? => return motion(Motion::TrackOn),
        Word::Track => return Ok(Request::Halt(Halt::TrackOff)),
        Word::TrackAutoEnable if switch(fields, 1)? => return motion(Motion::AutoTrackOn),
        Word::TrackAutoEnable => return Ok(Request::Halt(Halt::AutoTrackOff)),
        Word::Time => Setting::Time(ClockTime::new(fields.time(1, 0)?)?),
        Word::StartStopTime => {
            Setting::StartStopTime(TrackWindow::new(fields.time(1, 0)?, fields.time(7, 0)?)?)
        }
        Word::Settings => Setting::Settings(parse_settings(fields)?),
        Word::AngleSettings => Setting::AngleSettings(parse_angles(fields)?),
        Word::RtcReupdate => Setting::RtcReupdate,
        Word::GpsSettings => Setting::GpsSettings(GpsSettingsChange {
            automatic: switch(fields, 1)?,
            position: Position::read(fields, 2)?,
        }),
        Word::Satellite => Setting::Satellite(SatelliteChoice {
            file: text(fields, 1)?,
            name: text(fields, 2)?,
            period: fields.integer(3)?,
            continue_tracking: switch(fields, 4)?,
        }),
        Word::SatelliteHttp => Setting::SatelliteHttp(HttpTle {
            url: UrlValue::new(fields.text(1)?)?,
            period_days: fields.integer(2)?,
            continue_on_error: switch(fields, 3)?,
            continue_tracking: switch(fields, 4)?,
        }),
        Word::SatelliteFtp => Setting::SatelliteFtp(parse_ftp(fields, is_short_ftp)?),
        Word::LoadImage => Setting::LoadImage(text(fields, 1)?),
        Word::Reduction => {
            Setting::Reduction(Reduction::new(fields.decimal(1)?, fields.decimal(2)?)?)
        }
        Word::Version | Word::Status | Word::ErrStatus | Word::GpsData | Word::Tpos => {
            return Err(RequestError::Unknown);
        }
    };
    Ok(Request::Setting(setting))
}

/// Reads exactly 0 or 1: an unexplained number must not switch anything.
fn switch(fields: FrameFields<'_>, field: usize) -> Result<bool, FieldError> {
    match fields.integer::<i64>(field)? {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(FieldError { field, problem: FieldProblem::Range }),
    }
}

fn text(fields: FrameFields<'_>, field: usize) -> Result<TextValue, RequestError> {
    Ok(TextValue::new("text", fields.text(field)?)?)
}

fn parse_goto(fields: FrameFields<'_>) -> Result<Goto, RequestError> {
    let angle = |field| match fields.text(field)? {
        "NONE" => Ok(None),
        _ => fields.decimal(field).map(Some),
    };
    Ok(Goto::new(angle(1)?, angle(2)?)?)
}

fn parse_settings(fields: FrameFields<'_>) -> Result<SettingsRequest, RequestError> {
    // Only section 13 uses `?` for a value that stays.
    let keeps = |field| fields.text(field).map(|text| text == "?");
    let integer = |field| {
        if keeps(field)? { Ok(None) } else { fields.integer::<i64>(field).map(Some) }
    };
    let decimal = |field| if keeps(field)? { Ok(None) } else { fields.decimal(field).map(Some) };
    let change = SettingsChange {
        rtc_from_gps: if keeps(1)? { None } else { Some(switch(fields, 1)?) },
        time_offset_ms: integer(2)?,
        az_offset_deg: decimal(3)?,
        el_offset_deg: decimal(4)?,
        lead_ms: integer(5)?,
        position_base: integer(6)?.map(PositionBase::from_code),
        minimum_elevation_deg: decimal(7)?,
        north_offset_deg: decimal(8)?,
        sspa: integer(9)?.map(SspaMode::from_code),
        sspa_auto: integer(10)?.map(SspaAutoRule::from_code),
        elevation_threshold_deg: decimal(11)?,
    };
    Ok(SettingsRequest::new(&change)?)
}

fn parse_angles(fields: FrameFields<'_>) -> Result<AngleChange, RequestError> {
    let angles = SensorAngles::new(fields.decimal(3)?, fields.decimal(5)?)?;
    // In this case, a unit ignores the sensor values (section 15), so any values are valid.
    if switch(fields, 1)? {
        return Ok(AngleChange::PresentPosition(angles));
    }
    let (x_sensor, y_sensor) = (fields.integer(2)?, fields.integer(4)?);
    Ok(AngleChange::Given { x_sensor, y_sensor, angles })
}

fn parse_ftp(fields: FrameFields<'_>, is_short: bool) -> Result<FtpTle, RequestError> {
    let selection = if is_short {
        None
    } else {
        Some(TleSelection { file: text(fields, 5)?, satellite: text(fields, 6)? })
    };
    // These values count from the end, because the short form lacks two values before them.
    let last = fields.count();
    Ok(FtpTle {
        address: text(fields, 1)?,
        user: text(fields, 2)?,
        password: Password::new(fields.text(3)?)?,
        port: fields.integer(4)?,
        selection,
        period_days: fields.integer(last - 1)?,
        continue_on_error: switch(fields, last)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(payload: &str) -> Result<Request, RequestError> {
        Request::parse(&Frame::from_payload(payload))
    }

    #[test]
    fn odd_forms_of_the_document_are_taken() {
        for (odd, plain) in [
            ("TRACK_AUTO_ENABLE =,1", "TRACK_AUTO_ENABLE=,1"),
            ("ANGLE_SETTINGS=0,39049,160.0,36838,40.0", "ANGLE_SETTINGS=,0,39049,160.0,36838,40.0"),
            ("STEP=,+2,0", "STEP=,2,0"),
            (
                "SATELLITE_FTP=, 10.0.1.2,username,password,22,1,1",
                "SATELLITE_FTP=,10.0.1.2,username,password,22,1,1",
            ),
        ] {
            assert_eq!(parse(odd).unwrap().payload(), plain);
        }
    }

    #[test]
    fn what_has_no_sense_is_refused() {
        let (found, expected) = (1, 4);
        let count = RequestError::Count { found, expected };
        assert_eq!(parse("SATELLITE=,sysImage.json"), Err(count));
        for bad in [
            "MOVE=,0,0",
            "MOVE=,nan,1",
            "GOTO=,NONE,NONE",
            "TRACK=,2",
            "STATUS=",
            "MOVE?",
            "STATUS?,1",
            "SETTINGS=,1,100,1.0,2.0,60000,1,3.0,6.0,1,1,1,2.0",
            "TIME=,0,0,0,31,2,2020",
            "DATETIMEG?=,1",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
