//! Words for the offsets of a track.

use jiff::{SignedDuration, Timestamp};

use crate::{
    astro::{Angle, Offset, TrackOffsets},
    contract::driver::LeftOffsets,
    device::{self, settings::WriteError},
    ui::format,
};

/// Reason why a unit that tracks on its own gets no offsets.
pub const OFFSETS_NEED_ELEMENTS: &str =
    "Azel has no elements of what the unit tracks, and cannot judge where an offset would lead.";

/// Explains the handling of offsets that a unit adds to its own track. `current` is the sum of
/// these offsets.
pub fn offsets_on_unit_about(current: &str) -> String {
    format!(
        "Each step is written to the unit, read back, and taken back after the track. The unit adds \
         in all: {current}. It holds nothing along or across, and the sign of its time is not \
         documented: for these, follow from here."
    )
}

/// Returns the offsets that a unit adds to its own track.
pub fn offsets_on_unit(unit: Option<&device::Offsets>) -> String {
    let Some(unit) = unit else { return "not read yet".to_owned() };
    let step =
        |offset: Offset, value: f64| offset.with_thousandths((value * 1000.0).round() as i32);
    let offsets = [
        step(Offset::Time(SignedDuration::ZERO), unit.time_s),
        step(Offset::Azimuth(Angle::ZERO), unit.azimuth_deg),
        step(Offset::Elevation(Angle::ZERO), unit.elevation_deg),
    ];
    listed(offsets.into_iter())
}

/// Describes an offset that was not added to the track of a unit.
pub fn offset_not_taken(error: &WriteError) -> String {
    format!("The offset is not in force: {error}.")
}

/// Describes the offsets of a track that are still on a unit.
pub fn offsets_left(
    antenna: &str,
    added: TrackOffsets,
    left_offsets: &LeftOffsets,
    now: Timestamp,
) -> String {
    let added = offsets(added);
    match left_offsets {
        LeftOffsets::Found { start } => format!(
            "The unit of {antenna} still adds {added} to its tracks, written for a pass at {}. Azel \
             takes it back once the unit neither tracks nor is locked out.",
            format::moment(*start, now)
        ),
        LeftOffsets::Failed(error) => format!(
            "The unit of {antenna} may still add {added} to its tracks: it was not taken back, since \
             {error}. Azel tries again. To try at once, take it back, or set it under Antennas."
        ),
        LeftOffsets::Refused(refusal) => format!(
            "The unit of {antenna} has gone on to its next pass and still adds {added}: taking it back \
             there is refused. {} Azel tries again, and takes it back at the end of this pass.",
            super::refusal(refusal, now)
        ),
    }
}

/// Returns the name of an offset as on the card.
pub fn offset_name(offset: Offset) -> &'static str {
    match offset {
        Offset::Time(_) => "Time",
        Offset::Along(_) => "Along track",
        Offset::Across(_) => "Across track",
        Offset::Azimuth(_) => "Azimuth",
        Offset::Elevation(_) => "Elevation",
    }
}

/// Returns the value of an offset with sign and unit.
pub fn offset_value(offset: Offset) -> String {
    match offset {
        Offset::Time(time) => format!("{} s", format::signed(time.as_secs_f64(), 2)),
        Offset::Along(angle)
        | Offset::Across(angle)
        | Offset::Azimuth(angle)
        | Offset::Elevation(angle) => format!("{}°", format::signed(angle.degrees(), 2)),
    }
}

/// Lists all offsets that are not zero, in one line.
pub fn offsets(offsets: TrackOffsets) -> String {
    listed(offsets.components().into_iter())
}

fn listed(offsets: impl Iterator<Item = Offset>) -> String {
    let nonzero = offsets.filter(|offset| !offset.is_zero());
    let short = |offset| match offset {
        Offset::Time(_) => "time",
        Offset::Along(_) => "along",
        Offset::Across(_) => "across",
        Offset::Azimuth(_) => "az",
        Offset::Elevation(_) => "el",
    };
    let texts = nonzero.map(|offset| format!("{} {}", short(offset), offset_value(offset)));
    let words: Vec<String> = texts.collect();
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}

/// Returns an offset for the middle of a sentence.
pub fn offset(offset: Offset) -> String {
    let value = offset_value(offset);
    match offset {
        Offset::Time(_) => format!("of {value}"),
        Offset::Along(_) => format!("of {value} along the track"),
        Offset::Across(_) => format!("of {value} across the track"),
        Offset::Azimuth(_) => format!("of {value} in azimuth"),
        Offset::Elevation(_) => format!("of {value} in elevation"),
    }
}
