//! Sentences of the set-up.

use crate::{
    astro::{AzEl, LocatorSquare},
    ui::{format, widgets::told::Tone},
};

/// Length of a degree of latitude.
const KM_A_DEGREE: f64 = 111.2;
/// Distance from which a typed place differs from a unit's by more than its receiver does.
const AGREES_KM: f64 = 1.0;

pub(super) fn missing(labels: &[&str]) -> String {
    match labels {
        [only] => format!("Site: {only} is missing."),
        labels => format!("Site: {} fields are empty.", labels.len()),
    }
}

/// Size of the square of a locator.
pub(super) fn square(square: LocatorSquare) -> String {
    let height_km = square.height_deg * KM_A_DEGREE;
    let width_km = 2.0 * height_km * square.centre.latitude.degrees().to_radians().cos();
    let km = |length: f64| format::number(length, usize::from(length < 10.0));
    format!("The centre of a square of {} by {} km.", km(width_km), km(height_km))
}

/// The place of the Sun, by which a wrong sign is seen at once.
pub(super) fn sun(sun: AzEl) -> String {
    let azimuth = format::azimuth(sun.azimuth_deg());
    let elevation_deg = sun.elevation_deg();
    if elevation_deg < 0.0 {
        let below = format::degrees(-elevation_deg, 0);
        return format!(
            "The Sun is {below} below the horizon there now, at {azimuth}. Is that so?"
        );
    }
    let elevation = format::degrees(elevation_deg, 0);
    format!("The Sun is at {azimuth}, {elevation} there now. Is that so?")
}

pub(super) fn off_the_told(name: &str, km: f64) -> (Tone, String) {
    let far = format::number(km, usize::from(km < 10.0));
    if km < AGREES_KM {
        (Tone::Good, format!("Agrees with the place that {name} told: {far} km apart."))
    } else {
        let words = format!("{far} km from the place that {name} told. Which of them is right?");
        (Tone::Caution, words)
    }
}
