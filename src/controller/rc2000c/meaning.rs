//! Meaning of a frame, for the wire log.

use crate::{
    device::{Meaning, panel::Tone},
    protocol::rc2000c::{Address, Decoder, Frame, Motion, Query, Reply, Request, Setting},
};

/// Meaning of a command to the unit at `address`.
pub(super) fn of_sent(bytes: &[u8], address: Address) -> Option<Meaning> {
    let mut decoder = Decoder::new(address);
    decoder.push(bytes);
    let frame = decoder.next().and_then(Result::ok);
    let Some(Ok(request)) = frame.as_ref().map(Request::parse) else { return None };
    Some(Meaning::plain(match request {
        Request::Query(Query::DeviceType) => "Asks for the type of the unit",
        Request::Query(Query::Status) => "Asks for the status",
        Request::Query(Query::SatelliteName(_)) => "Asks for the name of a stored satellite",
        Request::Stop => "Stops azimuth and elevation",
        Request::Motion(Motion::AutoMove(_)) => "Goes to a satellite or a position",
        Request::Motion(Motion::Jog(_)) => "Turns an axis for a time",
        Request::Motion(Motion::Polarization(_)) => "Turns the polarization",
        Request::Motion(Motion::ResetDrive(_)) => "Clears the alarm of a drive",
        Request::Motion(Motion::RestartTracking) => "Starts its tracking again",
        Request::Setting(Setting::AutoPolarization(_)) => "Sets the automatic polarization",
        Request::Setting(Setting::Band(_)) => "Chooses the band of the receiver",
    }))
}

/// Meaning of a reply.
pub(super) fn of_reply(frame: &Frame) -> Option<Meaning> {
    let (tone, text) = match Reply::parse(frame).ok()? {
        Reply::DeviceType(_) => (Tone::Plain, "Type of the unit"),
        Reply::Status { .. } => (Tone::Plain, "Status"),
        Reply::SatelliteName(_) => (Tone::Plain, "Name of a stored satellite"),
        Reply::Offline { .. } => (Tone::Plain, "Remote mode is off, nothing is taken"),
        Reply::Refused { .. } => (Tone::Bad, "Refused"),
    };
    Some(Meaning { tone, ..Meaning::plain(text) })
}
