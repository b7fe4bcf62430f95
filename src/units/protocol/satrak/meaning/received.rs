//! Sentences for the answers of a unit.

use super::{Meaning, Tone, date_time, degrees, place, plain};
use crate::protocol::satrak::{
    AxisMotion, Faults, Frame, Reply, ReplyError, Settings, SspaMode, Status, TrackState, Verb,
    Word, explain,
};

pub(super) fn meaning(frame: &Frame) -> Meaning {
    let is_answer =
        |frame: &Frame| frame.fields().first().is_some_and(|first| first == "OK" || first == "ERR");
    // An outcome has no values to hide, and the operator needs its code.
    if frame.command() == Some((Word::SatelliteFtp, Verb::Query)) && !is_answer(frame) {
        return Meaning::new(Tone::Plain, "FTP source of the elements, values hidden");
    }
    match Reply::parse(frame) {
        Ok(parsed) => reply(&parsed.reply),
        Err(ReplyError::UnknownWord(_) | ReplyError::NoSuchRequest { .. }) => {
            Meaning::new(Tone::Caution, "Not in the document")
        }
        Err(ReplyError::NeitherOkNorErr(_)) => Meaning::new(Tone::Bad, "Neither OK nor ERR"),
        Err(ReplyError::Count { found, min, max, looks_like_decimal_commas, .. }) => {
            let reason =
                if looks_like_decimal_commas { ", decimal commas by the look" } else { "" };
            let expected = match max {
                _ if max == min => format!("{min}"),
                usize::MAX => format!("at least {min}"),
                _ => format!("{min} to {max}"),
            };
            Meaning::new(
                Tone::Bad,
                format!("Not read: {found} values instead of {expected}{reason}"),
            )
        }
        Err(ReplyError::Field { error, .. }) => {
            Meaning::new(Tone::Bad, format!("Not read: {error}"))
        }
    }
}

fn reply(reply: &Reply) -> Meaning {
    let text = match reply {
        Reply::Done => return Meaning::new(Tone::Good, "Accepted"),
        Reply::Refused { code } => {
            let comma = if code.is_empty() { "" } else { "," };
            return Meaning::new(Tone::Bad, format!("Refused: ERR{comma}{code}"));
        }
        Reply::Version(version) => {
            let parts = [Some(&version.control_unit), version.drive_unit.as_ref()];
            let parts: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
            let named = parts.join(", ");
            if named.is_empty() { "No version".to_owned() } else { named }
        }
        Reply::Status(status) => state(status),
        Reply::Faults(faults) => fault_list(faults),
        Reply::Clock(clock) => {
            let never = if clock.is_set() { "" } else { ", never set" };
            format!("Clock {}{never}", date_time(clock.time))
        }
        // A unit without settings may report a stop that is not after its start.
        Reply::StartStopTime(window) if !window.is_ordered() => "No tracking window".to_owned(),
        Reply::StartStopTime(window) => {
            format!("Tracks from {} to {}", date_time(window.start), date_time(window.stop))
        }
        Reply::Settings(settings) => settings_in_short(settings),
        Reply::AngleSettings(angles) => format!(
            "X {}° at {}, Y {}° at {}",
            plain(angles.x_deg),
            angles.x_sensor,
            plain(angles.y_deg),
            angles.y_sensor
        ),
        Reply::GpsData(gps) => match (gps.valid, gps.position, gps.time) {
            (true, Some(position), Some(time)) => {
                format!("GPS fix {} at {}", place(position), date_time(time))
            }
            _ => "No GPS fix".to_owned(),
        },
        Reply::TimedPosition(position) => format!(
            "X {}, Y {} at {}",
            degrees(position.x_deg),
            degrees(position.y_deg),
            date_time(position.time)
        ),
        Reply::GpsSettings(settings) => match settings.position {
            _ if settings.automatic => "Place from GPS".to_owned(),
            Some(position) => format!("Place by hand: {}", place(position)),
            None => "Place by hand".to_owned(),
        },
        Reply::Satellite(satellite) if satellite.name.is_empty() => "Holds no satellite".to_owned(),
        Reply::Satellite(satellite) => format!(
            "Holds {} ({}) from {}",
            satellite.name, satellite.catalog_number, satellite.file
        ),
        Reply::SatelliteHttp(source) if source.url.is_empty() => "No web source".to_owned(),
        Reply::SatelliteHttp(source) => {
            format!("Elements from {} every {} d", source.url, source.period_days)
        }
        Reply::SatelliteFtp(_) => "FTP source of the elements, values hidden".to_owned(),
        Reply::ImageStatus(status) => format!("Image file: {}", status.raw),
        Reply::Reduction(scales) => {
            format!("Drive scales: X {}, Y {}", plain(scales.x()), plain(scales.y()))
        }
    };
    Meaning::new(Tone::Plain, text)
}

fn state(status: &Status) -> String {
    let mut parts =
        vec![format!("Az {}", degrees(status.az_deg)), format!("El {}", degrees(status.el_deg))];
    let direction = |axis, motion| match motion {
        AxisMotion::Still => None,
        AxisMotion::Positive => Some(format!("{axis}+")),
        AxisMotion::Negative => Some(format!("{axis}\u{2212}")),
        AxisMotion::Unknown(code) => Some(format!("{axis} by code {code}")),
    };
    let moving = [direction("X", status.x_motion), direction("Y", status.y_motion)];
    let moving: Vec<String> = moving.into_iter().flatten().collect();
    parts.push(if moving.is_empty() {
        "standing".to_owned()
    } else {
        format!("moving {}", moving.join(" and "))
    });
    if status.tracking_enabled {
        parts.push(match status.track_state {
            TrackState::InTrackTime => "tracking".to_owned(),
            TrackState::NotInTrackTime => "tracking on, outside its window".to_owned(),
            TrackState::Completed => "tracking on, its window is over".to_owned(),
            TrackState::BeforeStart => "waiting at the start of the track".to_owned(),
            TrackState::Unknown(code) => format!("tracking on, state {code}"),
        });
    }
    let limits = status.limits;
    for (is_set, end) in [
        (limits.x_plus, "X+"),
        (limits.x_minus, "X\u{2212}"),
        (limits.y_plus, "Y+"),
        (limits.y_minus, "Y\u{2212}"),
    ] {
        if is_set {
            parts.push(format!("{end} limit set"));
        }
    }
    if status.fault {
        parts.push("a fault exists, ERRSTATUS? tells which".to_owned());
    }
    parts.join(", ")
}

fn fault_list(faults: &Faults) -> String {
    let active: Vec<&str> = faults.active().map(|kind| explain::fault_name(kind.index())).collect();
    if active.is_empty() {
        "No faults".to_owned()
    } else {
        format!("Faults: {}", active.join(", "))
    }
}

/// Returns the most important settings; the values of the frame show the others.
fn settings_in_short(settings: &Settings) -> String {
    let sspa = match settings.sspa {
        SspaMode::Off => "off".to_owned(),
        SspaMode::On => "on".to_owned(),
        SspaMode::Auto => "by its own rule".to_owned(),
        SspaMode::Unknown(code) => format!("code {code}"),
    };
    format!(
        "Minimum elevation {}°, threshold {}°, north offset {}°, SSPA {sspa}",
        plain(settings.minimum_elevation_deg),
        plain(settings.elevation_threshold_deg),
        plain(settings.north_offset_deg)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn says(payload: &str) -> (Tone, String) {
        let Meaning { tone, text } = meaning(&Frame::from_payload(payload));
        (tone, text)
    }

    #[test]
    fn a_state_is_one_sentence() {
        for (payload, words) in [
            (
                "STATUS?,0,299.49,-4.35,0,0,0,0,0,0,0,0,0,0,80.0,35.0,1",
                "Az 299.49°, El \u{2212}4.35°, standing",
            ),
            (
                "STATUS?,0,299.49,34.35,1,0,0,0,0,0,0,0,0,0,80.0,35.0,1",
                "Az 299.49°, El 34.35°, standing, X+ limit set",
            ),
            (
                "STATUS?,1,0,0,0,0,0,1,1,1,0,0,1,-1,80.0,35.0",
                "Az 0.00°, El 0.00°, moving X+ and Y\u{2212}, tracking, Y\u{2212} limit set, \
                 a fault exists, ERRSTATUS? tells which",
            ),
        ] {
            assert_eq!(says(payload), (Tone::Plain, words.to_owned()));
        }
    }

    #[test]
    fn answers_are_told_in_words() {
        for (payload, words) in [
            ("ERRSTATUS?,0,0,0,0,0,0,0,1,0,0,2,0", "Faults: motor of X, sensor of Y"),
            ("ERRSTATUS?,0,0,0,0,0,0,0,0,0,0,0", "No faults"),
            ("TIME?,16,43,0,17,3,2017,250", "Clock 2017-03-17 16:43:00.250"),
            ("TIME?,4,35,43,1,1,2000", "Clock 2000-01-01 04:35:43, never set"),
            ("GPS_DATA?,41.01N,29.17W,1,6,0,2,19,10,17", {
                "GPS fix 41.01° N, 29.17° W at 2017-10-19 06:00:02"
            }),
            ("GPS_DATA?,,,0,0,0,0,0,0,0", "No GPS fix"),
            ("SATELLITE?,,,1,0,0.0", "Holds no satellite"),
            ("START_STOP_TIME?,0,0,0,1,1,2000,0,0,0,1,1,2000", "No tracking window"),
            ("SATELLITE?,a.txt,AO-7, OSCAR 7,1,7530,78.4", "Holds AO-7, OSCAR 7 (7530) from a.txt"),
            ("SATELLITE_FTP?(hidden)", "FTP source of the elements, values hidden"),
            ("SATELLITE_FTP?,h,u,hunter2,22,f,s,1,1", "FTP source of the elements, values hidden"),
        ] {
            assert_eq!(says(payload), (Tone::Plain, words.to_owned()));
        }
    }

    #[test]
    fn acceptance_refusal_and_nonsense_are_told_apart() {
        for (payload, tone, words) in [
            ("MOVE=,OK", Tone::Good, "Accepted"),
            ("MOVE=,ERR,7", Tone::Bad, "Refused: ERR,7"),
            ("SATELLITE_FTP?,ERR,7", Tone::Bad, "Refused: ERR,7"),
            ("STOP=,ERR", Tone::Bad, "Refused: ERR"),
            ("STOP=,HM", Tone::Bad, "Neither OK nor ERR"),
            ("HELLO?,1", Tone::Caution, "Not in the document"),
            ("TIME?,1", Tone::Bad, "Not read: 1 values instead of 6 to 7"),
            ("TIME?,1,x,1,1,1,2017", Tone::Bad, "Not read: value 2 is not a whole number"),
        ] {
            assert_eq!(says(payload), (tone, words.to_owned()));
        }
    }
}
