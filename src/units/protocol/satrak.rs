//! Codec of the Satrak antenna controller unit (SVS, TCP port 4001).
//!
//! [`Decoder`] converts bytes to [`Frame`]s. A frame becomes a [`Reply`] for the console or a
//! [`Request`] for the simulator; a request becomes bytes. This module does no I/O, uses no time
//! and accepts any input without a failure.
//!
//! Facts come from the vendor's document "SATRAK Communication Protocol"; its sections are cited as
//! "section 6". The document contradicts itself in places (a comma more or less after `?`, 15 or 16
//! status fields). Azel reads both forms there, and sends the safer form.

mod clock;
mod coded;
mod explain;
mod faults;
mod fields;
mod frame;
mod gps;
mod meaning;
mod motion;
mod number;
mod reply;
mod request;
mod request_parse;
mod satellite;
mod service;
mod settings;
mod status;
mod text;
mod word;

pub use clock::{ClockTime, StartStopTime, TimedPosition, TrackWindow, UnitTime};
pub use explain::{Value, explain_reply, explain_request};
pub use faults::{FaultKind, FaultState, Faults};
pub use fields::{FieldError, FieldProblem};
pub use frame::{
    Decoder, Frame, FrameError, HIDDEN, MAX_LINE_BYTES, Oddity, ReceivedLine, Shown, checksum,
    encode, redact,
};
pub use gps::{GpsData, GpsSettings, GpsSettingsChange, Position};
pub use meaning::{Meaning, Tone};
pub use motion::{Goto, Motion, Move, Step};
pub use number::ValueError;
pub use reply::{Note, ParsedReply, Reply, ReplyError, Version};
pub use request::{Halt, Query, Request, Setting};
pub use request_parse::RequestError;
pub use satellite::{
    FtpTle, HttpTle, Satellite, SatelliteChoice, SatelliteFtp, SatelliteHttp, TleSelection,
    UpdateErrorAction,
};
pub use service::{AngleChange, AngleSettings, ImageStatus, Reduction, SensorAngles};
pub use settings::{
    PositionBase, Settings, SettingsChange, SettingsRequest, SspaAutoRule, SspaMode, TleMode,
};
pub use status::{AxisMotion, Limits, Status, TrackState};
pub use text::{Password, TextProblem, TextValue, UrlValue};
pub use word::{Verb, Word};
