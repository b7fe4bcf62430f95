//! The place of a station: what tells a wrong one.

use crate::{
    astro::AzEl,
    model::DistanceUnit,
    ui::{format, widgets::told::Tone},
};

/// Distance from which a typed place differs from a unit's by more than its receiver does.
const AGREES_KM: f64 = 1.0;

/// The place of the Sun, by which a wrong sign is seen at once.
pub fn sun_there(sun: AzEl) -> String {
    let azimuth = format::azimuth(sun.azimuth_deg());
    let elevation_deg = sun.elevation_deg();
    if elevation_deg < 0.0 {
        let below = format::degrees(-elevation_deg, 0);
        return format!(
            "The Sun is {below} below the horizon there now, at {azimuth}. Does that match?"
        );
    }
    let elevation = format::degrees(elevation_deg, 0);
    format!("The Sun is at {azimuth}, {elevation} there now. Does that match?")
}

/// How far a typed place is from the one that a unit told.
pub fn off_the_told(name: &str, km: f64, unit: DistanceUnit) -> (Tone, String) {
    let far = format::distance(km, usize::from(km < 10.0), unit);
    if km < AGREES_KM {
        (Tone::Good, format!("Agrees with the position that {name} reports: {far} apart."))
    } else {
        let words = format!("{far} from the position that {name} reports. Which of them is right?");
        (Tone::Caution, words)
    }
}
