//! Codec of the RC2000C antenna controller (Research Concepts, SA-bus on a
//! serial line).
//!
//! Bytes become [`Frame`]s in [`Decoder`]; a frame becomes a [`Reply`] on the
//! console's side or a [`Request`] on the simulator's side; a request becomes
//! bytes. Nothing here does I/O, knows the time or fails on any input.
//!
//! Facts come from appendices D and E of the vendor's manual, cited as
//! "appendix D" and "appendix E". An acknowledgement says that a command was
//! understood, never that it was carried out: only a later status tells.

mod address;
mod frame;
mod reply;
mod request;
mod satellite_name;
mod status;

pub use address::{Address, AddressError};
pub use frame::{
    Command, Decoder, Frame, FrameError, Header, MAX_COMMAND_BYTES, MAX_FRAME_BYTES, checksum,
};
pub use reply::{DeviceType, MountKind, NameEntry, Reply, ReplyError};
pub use request::{
    AutoMove, Band, Direction, DriveReset, Jog, MAX_JOG, MIN_JOG, Motion, NameIndex, Polarity,
    PolarizationMove, PolarizationUnits, Query, Request, RequestError, Setting, Speed, ValueError,
};
pub use satellite_name::{NameError, SatelliteName};
pub use status::{
    Alarm, AxisDrive, FeedPosition, FeedReading, LimitEnd, NameDisplay, PolarizationCode,
    PolarizationDevice, PolarizationMode, PolarizationMotion, Position, Receiver, ReceiverChannel,
    Sense, Status, Submode, Track, TrackBand,
};
