//! Sentences of the set-up.

use crate::{astro::LocatorSquare, model::DistanceUnit, ui::format};

/// Length of a degree of latitude, km.
const KM_A_DEGREE: f64 = 111.2;

pub(super) fn missing(labels: &[&str]) -> String {
    let verb = if labels.len() == 1 { "is" } else { "are" };
    // Commas in a label would look like commas of the list.
    let before_comma = |label: &&str| label.split(',').next().unwrap_or_default().to_owned();
    let names: Vec<String> = labels.iter().map(before_comma).collect();
    format!("Site: {} {verb} missing.", format::list(&names))
}

/// Describes the size of a locator square.
pub(super) fn square(square: LocatorSquare, unit: DistanceUnit) -> String {
    let height_km = square.height_deg * KM_A_DEGREE;
    let width_km = 2.0 * height_km * square.centre.latitude.degrees().to_radians().cos();
    let decimals = |km: f64| usize::from(km < 10.0);
    let width = format::distance_number(width_km, decimals(width_km), unit);
    let height = format::distance(height_km, decimals(height_km), unit);
    format!("The centre of a square of {width} by {height}.")
}
