//! Codec of the RC2000C antenna controller (Research Concepts, SA-bus on a
//! serial line).
//!
//! [`Decoder`] converts bytes to [`Frame`]s. A frame becomes a [`Reply`] for the console or a
//! [`Request`] for the simulator; a request becomes bytes. This module does no I/O, uses no time
//! and accepts any input without a failure.
//!
//! Facts come from appendices D and E of the vendor's manual, cited as "appendix D" and "appendix
//! E". An acknowledgement says that the unit understood a command. Only a later status shows
//! whether the unit carried it out.

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
