//! Distances in the unit that the operator has chosen.

use super::{number, signed};
use crate::model::DistanceUnit;

/// Returns the symbol of a unit.
pub fn distance_unit(unit: DistanceUnit) -> &'static str {
    match unit {
        DistanceUnit::Kilometres => "km",
        DistanceUnit::Miles => "mi",
        DistanceUnit::NauticalMiles => "nmi",
    }
}

fn in_unit(km: f64, unit: DistanceUnit) -> f64 {
    match unit {
        DistanceUnit::Kilometres => km,
        DistanceUnit::Miles => km / 1.609_344,
        DistanceUnit::NauticalMiles => km / 1.852,
    }
}

/// Formats a distance with its unit.
pub fn distance(km: f64, decimals: usize, unit: DistanceUnit) -> String {
    format!("{} {}", distance_number(km, decimals, unit), distance_unit(unit))
}

/// Formats a distance for a place that shows the unit beside it.
pub fn distance_number(km: f64, decimals: usize, unit: DistanceUnit) -> String {
    number(in_unit(km, unit), decimals)
}

/// Formats a speed with its unit.
pub fn speed(km_s: f64, unit: DistanceUnit) -> String {
    format!("{}/s", distance(km_s, 2, unit))
}

/// Formats a range rate with its sign and unit; positive while the range grows.
pub fn range_rate(km_s: f64, unit: DistanceUnit) -> String {
    format!("{} {}/s", signed(in_unit(km_s, unit), 2), distance_unit(unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_has_the_figure_of_its_unit() {
        use DistanceUnit::{Kilometres, Miles, NauticalMiles};
        let texts = [Kilometres, Miles, NauticalMiles]
            .map(|distance_unit| distance(1852.0, 0, distance_unit));
        assert_eq!(texts, ["1852 km", "1151 mi", "1000 nmi"]);
        let rates =
            [Kilometres, Miles, NauticalMiles].map(|distance_unit| range_rate(-7.0, distance_unit));
        assert_eq!(rates, ["−7.00 km/s", "−4.35 mi/s", "−3.78 nmi/s"]);
        assert_eq!(speed(7.5, Miles), "4.66 mi/s");
    }
}
