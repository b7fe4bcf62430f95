//! Sentences about on-board track.

use jiff::Timestamp;

use super::clock;
use crate::{
    astro::AzEl,
    device::Place,
    model::DistanceUnit,
    plan::{
        Supervision,
        on_board::{Cause, OffLimits, Ranked, Trespass, Unknown},
    },
    ui::format,
};

/// Returns the reason why a unit misses, as a clause that begins with the unit.
pub fn cause(ranked: &Ranked, unit: DistanceUnit) -> String {
    match &ranked.cause {
        Cause::Refraction => {
            "the unit leaves refraction out and points below where the satellite appears".to_owned()
        }
        Cause::Place { place, away_km } => format!(
            "the unit's location is {} from this station: {}",
            format::distance(*away_km, usize::from(*away_km < 100.0), unit),
            place_words(*place)
        ),
        Cause::Clock { ahead_s } => {
            format!("the unit's clock is {}", clock::side(*ahead_s))
        }
        Cause::TimeOffset { offset_s } => {
            format!("the unit's tracking time offset is {} s", format::signed(*offset_s, 1))
        }
        Cause::AzimuthOffset(offset_deg) => {
            format!("the unit's azimuth offset is {}°", format::signed(*offset_deg, 2))
        }
        Cause::ElevationOffset(offset_deg) => {
            format!("the unit's elevation offset is {}°", format::signed(*offset_deg, 2))
        }
        Cause::NorthOffset { offset_deg, off_deg } => format!(
            "the unit's north offset is {}°, which is {} off the station's mount",
            format::signed(*offset_deg, 1),
            format::degrees(off_deg.abs(), 1)
        ),
        Cause::MinimumElevation(lowest_deg) => {
            format!("the unit does not point below {}", format::degrees(*lowest_deg, 1))
        }
        Cause::OtherSatellite { catalog_number: 0, .. } => "the unit holds no satellite".to_owned(),
        Cause::OtherSatellite { catalog_number, name } => {
            format!("the unit holds {name} ({catalog_number})")
        }
        Cause::Elements { told_deg, expected_deg } => format!(
            "the unit predicts a maximum of {} and Azel {}: its elements or its location differ",
            format::degrees(*told_deg, 1),
            format::degrees(*expected_deg, 1)
        ),
    }
}

fn place_words(place: Place) -> String {
    let angle = |angle_deg: f64, plus, minus| {
        let letter = if angle_deg < 0.0 { minus } else { plus };
        format!("{}\u{a0}{letter}", format::number(angle_deg.abs(), 2))
    };
    format!("{} {}", angle(place.latitude_deg, 'N', 'S'), angle(place.longitude_deg, 'E', 'W'))
}

/// Returns the deviation by which a unit would miss `name`, and the reason.
pub fn would_miss(name: &str, found: &Supervision, now: Timestamp, unit: DistanceUnit) -> String {
    let deviation_text = format::degrees(found.worst.angle.degrees(), 1);
    // In a current pass, the worst time may lie in the past.
    let is_ahead = found.worst.time > now;
    let time_text = if is_ahead {
        format!(" at {}", format::moment(found.worst.time, now))
    } else {
        String::new()
    };
    match found.causes.first() {
        Some(first) => {
            let reason = super::capitalised(&cause(first, unit));
            format!("{reason}. It would miss {name} by up to {deviation_text}{time_text}.")
        }
        None => format!(
            "By its own settings the unit would miss {name} by up to {deviation_text}{time_text}."
        ),
    }
}

/// Lists unknown facts about a unit; `None` if nothing or only its elements are unknown.
pub fn not_known(found: &Supervision) -> Option<String> {
    let word = |unknown: &Unknown| match unknown {
        Unknown::Place => Some("its site"),
        Unknown::Clock => Some("its clock"),
        Unknown::Offsets => Some("its offsets"),
        Unknown::Elements => None,
    };
    let words: Vec<&str> = found.unknown.iter().filter_map(word).collect();
    (!words.is_empty()).then(|| format!("The unit has not reported {} yet.", format::list(&words)))
}

/// Returns the note on a unit that tracks well enough.
pub fn within_beam(found: &Supervision, unit: DistanceUnit) -> Option<String> {
    let first = found.causes.first()?;
    let deviation_text = format::degrees(found.worst.angle.degrees(), 2);
    Some(format!("Up to {deviation_text} off: {}.", cause(first, unit)))
}

/// Returns the note on a unit whose minimum elevation is below that of the station.
pub fn lower_minimum(unit_deg: f64, station_deg: f64) -> String {
    format!(
        "The unit's minimum elevation is {}, the station's {}. Change the unit's minimum under Antennas.",
        format::degrees(unit_deg, 1),
        format::degrees(station_deg, 1)
    )
}

/// Describes the first place where a unit's program would enter a forbidden zone, and the remedy.
pub fn trespass(trespass: &Trespass, now: Timestamp) -> String {
    let Trespass { time, direction, limit } = trespass;
    let bound = match limit {
        OffLimits::Elevation { lowest_deg } => {
            format!("below the {} of this antenna", format::degrees(*lowest_deg, 1))
        }
        OffLimits::Forbidden(barrier) => super::forbidden(barrier),
        OffLimits::Travel => "beyond the travel of its axes".to_owned(),
    };
    format!(
        "Not sent: at {} the unit would point to {}, {bound}. Follow from here instead.",
        format::moment(*time, now),
        pair(*direction)
    )
}

fn pair(direction: AzEl) -> String {
    let elevation = format::degrees(direction.elevation_deg(), 1);
    format!("{}, {elevation}", format::degrees(direction.azimuth_deg(), 1))
}
