//! Words for the location of a station, to detect a wrong one.

use crate::{
    astro::AzEl,
    model::DistanceUnit,
    ui::{format, widgets::status_line::Tone},
};

/// Distance from the position of a unit below which an entered site agrees, km.
const AGREES_KM: f64 = 1.0;

/// Describes the direction of the Sun, which reveals a wrong sign of a coordinate.
pub fn sun_there(sun: AzEl) -> String {
    let (azimuth_deg, elevation_deg) = (sun.azimuth_deg(), sun.elevation_deg());
    let elevation = format::degrees(elevation_deg.abs(), 0);
    let height = if elevation_deg < 0.0 { "below the horizon" } else { "high" };
    format!(
        "There the Sun is now {} ({}), {elevation} {height}. Is that right?",
        compass_point(azimuth_deg),
        format::azimuth(azimuth_deg)
    )
}

fn compass_point(azimuth_deg: f64) -> &'static str {
    const POINTS: [&str; 16] = [
        "N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW",
        "NW", "NNW",
    ];
    let nearest = (azimuth_deg / 22.5).round() as usize % POINTS.len();
    POINTS.get(nearest).copied().unwrap_or_default()
}

/// Describes the distance between an entered site and the position that a unit reported.
pub fn off_the_told(name: &str, km: f64, unit: DistanceUnit) -> (Tone, String) {
    let far = format::distance(km, usize::from(km < 10.0), unit);
    if km < AGREES_KM {
        (Tone::Good, format!("Agrees with the position that {name} reports: {far} apart."))
    } else {
        let words = format!("{far} from the position that {name} reports. Which of them is right?");
        (Tone::Caution, words)
    }
}
