//! The readings of the front panel, line by line.

use super::{checks, names::SatelliteNames};
use crate::{
    device::panel::{Reading, Tone},
    protocol::rc2000c::{
        DeviceType, FeedPosition, FeedReading, LimitEnd, NameDisplay, PolarizationCode,
        PolarizationDevice, PolarizationMotion, Position, Receiver, ReceiverChannel, Status,
        Submode, Track, TrackBand,
    },
};

/// Max signal level of the receiver.
const MAX_AGC: f64 = 1023.0;

pub(super) fn readings(
    status: &Status,
    device: Option<DeviceType>,
    names: &SatelliteNames,
) -> Vec<Reading> {
    let mut lines = Vec::new();
    lines.extend(device.map(|device| Reading::new("Unit", device.to_string())));
    lines.push(Reading::new("Satellite", satellite(status)));
    lines.push(Reading::new("Azimuth", position(status.azimuth)));
    lines.push(Reading::new("Elevation", position(status.elevation)));
    lines.push(polarization(status.feed, status.polarization_motion));
    if let Some(mode) = status.polarization_mode {
        lines.push(Reading::new("Polarity", polarity(mode.code)));
        let automatic = if mode.is_automatic { "on" } else { "off" };
        lines.push(Reading::new("Automatic polarization", automatic));
    }
    lines.extend(status.receiver.map(signal));
    lines.extend(status.track.map(track));
    lines.extend(status.allows_polarization().map(polarization_commands));
    let alarm = checks::alarm(status.alarm);
    lines.push(match alarm {
        Some(alarm) => Reading::new("Alarm", alarm.name).in_tone(Tone::Bad),
        None => Reading::new("Alarm", "none"),
    });
    lines.extend(stored(names));
    lines
}

fn satellite(status: &Status) -> String {
    let name = status.satellite;
    match status.name_display {
        _ if name.is_blank() => "none".to_owned(),
        NameDisplay::OnSatellite => name.to_string(),
        NameDisplay::NearSatellite => format!("near {name}"),
        NameDisplay::Hidden => format!("{name}, not shown"),
        NameDisplay::Unknown(_) => format!("{name}?"),
    }
}

fn position(position: Position) -> String {
    match position {
        Position::Counts(counts) => format!("{counts} counts"),
        Position::TenthsOfDegree(tenths) => format!("{:.1}°", f64::from(tenths) / 10.0),
        Position::Limit(LimitEnd::CounterClockwise) => "at the limit CCW".to_owned(),
        Position::Limit(LimitEnd::Clockwise) => "at the limit CW".to_owned(),
        Position::Limit(LimitEnd::Down) => "at the limit DOWN".to_owned(),
        Position::Limit(LimitEnd::Up) => "at the limit UP".to_owned(),
        Position::Unknown(text) => format!("{:?}", String::from_utf8_lossy(&text)),
    }
}

fn polarization(feed: FeedReading, motion: PolarizationMotion) -> Reading {
    let device = match feed.device {
        PolarizationDevice::Polarotor => "polarotor",
        PolarizationDevice::RotatingFeed => "rotating feed",
        PolarizationDevice::Unknown(_) => "unknown device",
    };
    let reading = match (feed.position, feed.units()) {
        (FeedPosition::ClockwiseLimit, _) => "at the limit CW".to_owned(),
        (FeedPosition::CounterClockwiseLimit, _) => "at the limit CCW".to_owned(),
        (_, Some(units)) => units.to_string(),
        (_, None) => "unknown".to_owned(),
    };
    let turns = match motion {
        PolarizationMotion::Still => "",
        PolarizationMotion::JogClockwise => ", turning CW",
        PolarizationMotion::JogCounterClockwise => ", turning CCW",
        PolarizationMotion::ToStored => ", on its way",
        PolarizationMotion::Unknown(_) => ", may be turning",
    };
    let tone = if turns.is_empty() { Tone::Plain } else { Tone::Caution };
    Reading::new("Polarization", format!("{reading} ({device}){turns}")).in_tone(tone)
}

fn polarity(code: PolarizationCode) -> &'static str {
    match code {
        PolarizationCode::Horizontal => "H",
        PolarizationCode::NearHorizontal => "near H",
        PolarizationCode::Vertical => "V",
        PolarizationCode::NearVertical => "near V",
        PolarizationCode::None => "none",
        PolarizationCode::Unknown(_) => "unknown",
    }
}

fn signal(receiver: Receiver) -> Reading {
    let channel = match receiver.channel {
        ReceiverChannel::One => ", channel 1",
        ReceiverChannel::Two => ", channel 2",
        ReceiverChannel::Unknown => "",
    };
    Reading::new("Signal", format!("{}{channel}", receiver.agc))
        .with_bar(f64::from(receiver.agc) / MAX_AGC)
}

fn track(Track { band, submode }: Track) -> Reading {
    let band = match band {
        TrackBand::C => "C band",
        TrackBand::K => "K band",
        TrackBand::L => "L band",
        TrackBand::Unknown => "unknown band",
    };
    let doing = match submode {
        Submode::Off => "off",
        Submode::Setup => "setting up",
        Submode::AutoEntry => "entering by itself",
        Submode::Step => "step track",
        Submode::Search => "searching",
        Submode::Program => "program track",
        Submode::JammedError => "error: jammed",
        Submode::LimitError => "error: at a limit",
        Submode::DriveError => "error: drive",
        Submode::PeakLimitError => "error: no peak",
        Submode::AzimuthScaleError => "error: azimuth scale factor",
        Submode::GeoPositionError => "error: geographic position",
        Submode::SystemError => "error: system",
        Submode::ChecksumError => "error: checksum",
        Submode::Unknown(_) => "unknown",
    };
    let tone = match submode {
        Submode::Off => Tone::Plain,
        error if error.is_error() => Tone::Bad,
        _ => Tone::Caution,
    };
    Reading::new("TRACK", format!("{doing}, {band}")).in_tone(tone)
}

fn polarization_commands(are_allowed: bool) -> Reading {
    let (text, tone) =
        if are_allowed { ("allowed", Tone::Plain) } else { ("not now", Tone::Caution) };
    Reading::new("Polarization commands", text).in_tone(tone)
}

fn stored(names: &SatelliteNames) -> Option<Reading> {
    let listed: Vec<&str> = names.read().iter().map(|name| name.as_str().trim()).collect();
    let text = match (listed.is_empty(), names.is_complete()) {
        (true, true) => "none".to_owned(),
        (true, false) => return None,
        (false, true) => listed.join(", "),
        (false, false) => format!("{}, …", listed.join(", ")),
    };
    Some(Reading::new("Stored satellites", text))
}
