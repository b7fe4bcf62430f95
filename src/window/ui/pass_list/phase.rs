//! The phase of a pass, in words.

use jiff::Timestamp;

use super::PassRow;
use crate::{astro::time::seconds_between, ui::format};

/// Phase of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Phase {
    Upcoming,
    /// A pass of a satellite that is up and sets within the list.
    InProgress,
    /// A pass of a satellite that is up and sets after the end of the list.
    NoLos,
    /// A satellite that neither rises nor sets within the list.
    AllTheTime,
    Over,
}

impl Phase {
    pub(super) fn new(row: &PassRow<'_>, now: Timestamp) -> Self {
        if row.starts_before && row.ends_after {
            Self::AllTheTime
        } else if now < row.aos {
            Self::Upcoming
        } else if row.ends_after {
            Self::NoLos
        } else if now < row.los {
            Self::InProgress
        } else {
            Self::Over
        }
    }
}

/// Returns the countdown of the row: a word before the time, possibly empty, and the time.
pub(super) fn countdown(row: &PassRow<'_>, phase: Phase, now: Timestamp) -> (&'static str, String) {
    match phase {
        Phase::Upcoming => ("", format::countdown(now, row.aos)),
        Phase::InProgress => ("LOS", format::countdown(now, row.los)),
        Phase::NoLos => ("LOS", "later".to_owned()),
        Phase::AllTheTime => ("", "always up".to_owned()),
        Phase::Over => ("LOS", "over".to_owned()),
    }
}

/// Returns the elapsed part of the pass, 0 to 1. `None` if one of its ends is unknown.
pub(super) fn progress(row: &PassRow<'_>, phase: Phase, now: Timestamp) -> Option<f32> {
    if phase != Phase::InProgress || row.starts_before {
        return None;
    }
    let whole_s = seconds_between(row.aos, row.los);
    let done_s = seconds_between(row.aos, now);
    (whole_s > 0.0).then(|| (done_s / whole_s).clamp(0.0, 1.0) as f32)
}

/// Returns the azimuths of AOS and LOS, with an ellipsis for an end outside the list. Empty if both
/// ends are outside.
pub(super) fn azimuths(row: &PassRow<'_>) -> String {
    if row.starts_before && row.ends_after {
        return String::new();
    }
    let end = |outside: bool, azimuth_deg: f64| {
        if outside { "…".to_owned() } else { format::azimuth(azimuth_deg) }
    };
    let start_text = end(row.starts_before, row.aos_azimuth_deg);
    let end_text = end(row.ends_after, row.los_azimuth_deg);
    format!("{start_text} → {end_text}")
}

/// Returns the duration of the pass, with ">" if one end is outside the list. If the time clear of
/// the mask is shorter, the text begins with that time. Empty if both ends are outside.
pub(super) fn duration(row: &PassRow<'_>) -> String {
    let length = format::duration(seconds_between(row.aos, row.los));
    let length = match row.clear_s {
        Some(clear_s) => format!("clear {} of {length}", format::duration(clear_s)),
        None => length,
    };
    match (row.starts_before, row.ends_after) {
        (false, false) => length,
        (true, true) => String::new(),
        (true, false) | (false, true) => format!("> {length}"),
    }
}

/// Returns the time of AOS: a dash if AOS lies before the list, empty if LOS also lies after the
/// list.
pub(super) fn aos_time(row: &PassRow<'_>, now: Timestamp) -> String {
    match (row.starts_before, row.ends_after) {
        (false, _) if format::is_today(row.aos, now) => format::moment(row.aos, now),
        // With seconds, the verdict next to the time would have no room.
        (false, _) => format::minute(row.aos, now),
        (true, false) => "–".to_owned(),
        (true, true) => String::new(),
    }
}

/// Returns the pass as one line for other programs and messages, with its day; times are UTC.
pub(super) fn copied(row: &PassRow<'_>) -> String {
    let azimuth = |degrees: f64| format::azimuth(degrees);
    let aos = format!("AOS {} at {}", format::copied(row.aos), azimuth(row.aos_azimuth_deg));
    let los = format!("LOS {} at {}", format::copied(row.los), azimuth(row.los_azimuth_deg));
    let [aos, los] = match (row.starts_before, row.ends_after) {
        (true, true) => ["always up".to_owned(), String::new()],
        (true, false) => ["already up".to_owned(), los],
        (false, true) => [aos, "no LOS".to_owned()],
        (false, false) => [aos, los],
    };
    let maximum = format!("max {}", format::degrees(row.max_elevation_deg, 0));
    let parts = [row.name.to_owned(), aos, los, maximum];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// Returns the text of the row for screen readers.
pub(super) fn spoken(row: &PassRow<'_>, phase: Phase, now: Timestamp) -> String {
    let (word, time) = countdown(row, phase, now);
    let word = match phase {
        Phase::Upcoming => "AOS ",
        Phase::AllTheTime => "",
        Phase::InProgress | Phase::NoLos | Phase::Over => &format!("{word} "),
    };
    let maximum = format::degrees(row.max_elevation_deg, 0);
    let verdict = row.verdict.map(|verdict| format!(", {}", verdict.sentence()));
    format!("{}, {word}{time}, max {maximum}{}", row.name, verdict.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, time::add_seconds},
        plan::Loss,
        ui::pass_list::Verdict,
    };

    const AOS: Timestamp = Timestamp::UNIX_EPOCH;

    fn row(starts_before: bool, ends_after: bool) -> PassRow<'static> {
        PassRow {
            key: (25_544, AOS),
            name: "ISS",
            aos: AOS,
            los: add_seconds(AOS, 600.0),
            starts_before,
            ends_after,
            max_elevation_deg: 51.6,
            aos_azimuth_deg: 249.0,
            los_azimuth_deg: 46.0,
            verdict: Some(Verdict::Loses { seconds: 11.4, loss: Loss::Keyhole(Angle::ZERO) }),
            clear_s: None,
            path: &[],
        }
    }

    fn spoken_at(row: &PassRow<'_>, seconds: f64) -> String {
        let now = add_seconds(AOS, seconds);
        spoken(row, Phase::new(row, now), now)
    }

    #[test]
    fn a_pass_counts_to_aos_then_to_los() {
        let row = row(false, false);
        let tail = ", max 52°, Loses 12 s at keyhole N";
        assert_eq!(spoken_at(&row, -60.0), format!("ISS, AOS T−01:00{tail}"));
        assert_eq!(spoken_at(&row, 0.0), format!("ISS, LOS T−10:00{tail}"));
        assert_eq!(spoken_at(&row, 599.5), format!("ISS, LOS T−00:01{tail}"));
        assert_eq!(spoken_at(&row, 600.0), format!("ISS, LOS over{tail}"));
        assert_eq!(azimuths(&row), "249° → 046°");
        assert_eq!(duration(&row), "10:00");
    }

    #[test]
    fn the_mask_moves_no_time_and_is_told_beside_the_duration() {
        let cut = PassRow {
            clear_s: Some(283.0),
            verdict: Some(Verdict::Blocked { seconds: 317.0, is_whole: false }),
            ..row(false, false)
        };
        assert_eq!(duration(&cut), "clear 4:43 of 10:00");
        assert_eq!(aos_time(&cut, AOS), aos_time(&row(false, false), AOS));
        assert!(spoken_at(&cut, -60.0).ends_with("Blocked by the mask for 5:17"));
    }

    #[test]
    fn a_time_that_is_not_today_carries_its_day() {
        let row = row(false, false);
        assert_eq!(aos_time(&row, add_seconds(AOS, 86_399.0)), "00:00:00Z");
        assert_eq!(aos_time(&row, add_seconds(AOS, -1.0)), "1 Jan 1970 00:00Z");
    }

    #[test]
    fn an_end_outside_the_list_is_not_invented() {
        let early = row(true, false);
        assert_eq!(azimuths(&early), "… → 046°");
        assert_eq!((duration(&early).as_str(), aos_time(&early, AOS).as_str()), ("> 10:00", "–"));
        assert_eq!(progress(&early, Phase::new(&early, AOS), AOS), None);
        let late = row(false, true);
        assert_eq!(azimuths(&late), "249° → …");
        assert_eq!(countdown(&late, Phase::new(&late, AOS), AOS).1, "later");
        assert_eq!(Phase::new(&late, add_seconds(AOS, -1.0)), Phase::Upcoming);
    }

    #[test]
    fn a_satellite_without_aos_and_los_is_up_all_the_time() {
        let row = row(true, true);
        for seconds in [-10.0, 300.0, 700.0] {
            assert!(spoken_at(&row, seconds).starts_with("ISS, always up, max 52°"));
        }
        assert_eq!(azimuths(&row) + &duration(&row) + &aos_time(&row, AOS), "");
        assert_eq!(Phase::new(&row, AOS), Phase::AllTheTime);
    }

    #[test]
    fn progress_runs_from_aos_to_los() {
        let row = row(false, false);
        let progress_at = |seconds| {
            let now = add_seconds(AOS, seconds);
            progress(&row, Phase::new(&row, now), now)
        };
        assert_eq!(progress_at(-1.0), None);
        assert_eq!(progress_at(0.0), Some(0.0));
        assert_eq!(progress_at(150.0), Some(0.25));
        assert_eq!(progress_at(600.0), None);
    }
}
