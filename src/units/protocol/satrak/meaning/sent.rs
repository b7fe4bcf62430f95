//! Sentences for the requests of a client.

use super::{Meaning, Tone, date_time, place, plain, signed};
use crate::protocol::satrak::{
    AngleChange, Frame, Halt, Motion, Query, Request, RequestError, Setting, Verb, Word, explain,
};

pub(super) fn meaning(frame: &Frame) -> Meaning {
    // Azel hides the values of this frame before it shows the frame.
    if frame.command() == Some((Word::SatelliteFtp, Verb::Set)) {
        let words = "Sets the FTP source of the elements, values hidden";
        return Meaning::new(Tone::Change, words);
    }
    match Request::parse(frame) {
        Ok(Request::Query(query)) => Meaning::new(Tone::Plain, question(query)),
        Ok(Request::Halt(halt)) => Meaning::new(Tone::Change, stop(halt)),
        Ok(Request::Motion(motion)) => Meaning::new(Tone::Change, moves(motion)),
        Ok(Request::Setting(setting)) => Meaning::new(Tone::Change, set(&setting, frame)),
        Err(RequestError::Unknown) => Meaning::new(Tone::Caution, "Not in the document"),
        Err(error) => Meaning::new(Tone::Bad, format!("Makes no sense: {error}")),
    }
}

const fn question(query: Query) -> &'static str {
    match query {
        Query::Version => "Asks for the firmware",
        Query::Status => "Asks for the state",
        Query::Faults => "Asks for the faults",
        Query::Clock => "Asks for the clock",
        Query::StartStopTime => "Asks for the tracking window",
        Query::Settings => "Asks for the settings",
        Query::AngleSettings => "Asks for the angle calibration",
        Query::GpsData => "Asks for the GPS receiver",
        Query::TimedPosition => "Asks for the position with its time",
        Query::GpsSettings => "Asks for the place",
        Query::Satellite => "Asks for the satellite",
        Query::SatelliteHttp => "Asks for the web source of the elements",
        Query::SatelliteFtp => "Asks for the FTP source of the elements",
        Query::ImageStatus => "Asks for the image file",
        Query::Reduction => "Asks for the scales of the drives",
    }
}

const fn stop(halt: Halt) -> &'static str {
    match halt {
        Halt::Stop => "Stops all motion",
        Halt::TrackOff => "Switches tracking off",
        Halt::AutoTrackOff => "Switches auto-track off",
    }
}

fn moves(motion: Motion) -> String {
    match motion {
        Motion::Move(rates) => {
            format!("Moves {}", axes(rates.x_deg_s(), rates.y_deg_s(), " °/s"))
        }
        Motion::Step(steps) => format!("Turns {}", axes(steps.x_deg(), steps.y_deg(), "°")),
        Motion::Goto(goto) => {
            let angle = |name, angle: Option<f64>| Some(format!("{name} {}°", plain(angle?)));
            let angles = [angle("Az", goto.az_deg()), angle("El", goto.el_deg())];
            format!("Goes to {}", angles.into_iter().flatten().collect::<Vec<_>>().join(", "))
        }
        Motion::TrackOn => "Switches tracking on".to_owned(),
        Motion::AutoTrackOn => "Switches auto-track on".to_owned(),
    }
}

/// Returns the names of the axes that turn, with their values.
fn axes(x: f64, y: f64, unit: &str) -> String {
    let turning = [("X", x), ("Y", y)].into_iter().filter(|(_, amount)| amount.abs() > 0.0);
    let words: Vec<String> =
        turning.map(|(axis, amount)| format!("{axis} by {}{unit}", signed(amount))).collect();
    words.join(", ")
}

fn set(setting: &Setting, frame: &Frame) -> String {
    match setting {
        Setting::Time(time) => format!("Sets the clock to {}", date_time(time.time())),
        Setting::StartStopTime(window) => format!(
            "Sets the tracking window from {} to {}",
            date_time(window.start()),
            date_time(window.stop())
        ),
        Setting::Settings(_) => {
            let values = explain::explain_request(frame);
            let changed = values.iter().filter(|value| value.raw != "?").map(|value| {
                let shown = if value.stands_for.is_empty() { &value.raw } else { value.stands_for };
                format!("{} to {}{}", value.name, shown.replace('-', "\u{2212}"), value.unit)
            });
            format!("Sets {}", changed.collect::<Vec<_>>().join(", "))
        }
        Setting::AngleSettings(AngleChange::PresentPosition(angles)) => format!(
            "Calibrates: the present position is X {}°, Y {}°",
            plain(angles.x_deg()),
            plain(angles.y_deg())
        ),
        Setting::AngleSettings(AngleChange::Given { x_sensor, y_sensor, angles }) => format!(
            "Calibrates: X {}° at {x_sensor}, Y {}° at {y_sensor}",
            plain(angles.x_deg()),
            plain(angles.y_deg())
        ),
        Setting::RtcReupdate => "Sets the clock from GPS".to_owned(),
        Setting::GpsSettings(change) => {
            let origin = if change.automatic { "from GPS" } else { "by hand" };
            format!("Sets the place {origin}: {}", place(change.position))
        }
        Setting::Satellite(choice) => {
            format!("Chooses {} from {}", choice.name.as_str(), choice.file.as_str())
        }
        Setting::SatelliteHttp(source) => {
            let days = source.period_days;
            format!("Takes elements from {} every {days} d", source.url.as_str())
        }
        Setting::SatelliteFtp(_) => "Sets the FTP source of the elements".to_owned(),
        Setting::LoadImage(file) => format!("Loads the image {}", file.as_str()),
        Setting::Reduction(scales) => {
            format!(
                "Sets the scales of the drives: X {}, Y {}",
                plain(scales.x()),
                plain(scales.y())
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn says(payload: &str) -> (Tone, String) {
        let Meaning { tone, text } = meaning(&Frame::from_payload(payload));
        (tone, text)
    }

    #[test]
    fn every_query_is_told_apart() {
        let words: std::collections::BTreeSet<_> =
            Query::ALL.into_iter().map(|(_, word)| says(&format!("{word}?")).1).collect();
        assert_eq!(words.len(), Query::ALL.len());
        assert!(words.iter().all(|words| words.starts_with("Asks for")));
    }

    #[test]
    fn orders_say_what_they_change() {
        for (payload, words) in [
            ("STOP=", "Stops all motion"),
            ("MOVE=,-3.5,0", "Moves X by \u{2212}3.5 °/s"),
            ("MOVE=,-3.5,2", "Moves X by \u{2212}3.5 °/s, Y by +2 °/s"),
            ("STEP=,2,0", "Turns X by +2°"),
            ("GOTO=,125.1,32.6", "Goes to Az 125.1°, El 32.6°"),
            ("GOTO=,NONE,40.5", "Goes to El 40.5°"),
            ("TRACK=,1", "Switches tracking on"),
            ("TIME=,16,43,0,17,3,2017", "Sets the clock to 2017-03-17 16:43:00"),
            ("SETTINGS=,?,?,-1.5,?,?,?,5.0,?,0,?,?", {
                "Sets azimuth offset to \u{2212}1.5°, minimum elevation to 5.0°, SSPA to off"
            }),
            ("GPS_SETTINGS=,0,41.02N,29.17E", "Sets the place by hand: 41.02° N, 29.17° E"),
            ("SATELLITE=,a.txt,AO-7,1,0", "Chooses AO-7 from a.txt"),
        ] {
            assert_eq!(says(payload), (Tone::Change, words.to_owned()));
        }
    }

    #[test]
    fn the_ftp_source_is_named_without_its_values() {
        for payload in ["SATELLITE_FTP=(hidden)", "SATELLITE_FTP=,h,u,hunter2,22,f,s,1,1"] {
            let (tone, words) = says(payload);
            assert_eq!(tone, Tone::Change);
            assert_eq!(words, "Sets the FTP source of the elements, values hidden");
        }
    }

    #[test]
    fn what_is_no_request_is_said_so() {
        assert_eq!(says("HELLO=,1").0, Tone::Caution);
        assert_eq!(says("MOVE=,0,0"), (Tone::Bad, "Makes no sense: no axis would move".into()));
    }
}
