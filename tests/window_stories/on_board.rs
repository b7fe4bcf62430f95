//! What the operator is told of a unit that tracks by itself.

use std::sync::Arc;

use azel::{
    app::{UiCommand, alarms::AlarmKind},
    astro::Angle,
    controller::{Place, settings::Value},
    driver::{OnBoardView, Snapshot},
    plan::{
        Supervision,
        on_board::{Cause, Error, Ranked, Unknown},
    },
    ui::words,
};

use crate::{
    rig::{self, LARGE, asked},
    settings::settles,
    settings_desk::{apply, desk, hold, press, read, says, state_of, texts},
    states,
};

fn elsewhere(off_deg: f64) -> Ranked {
    let place = Place { latitude_deg: 12.3, longitude_deg: 45.6, step_deg: 0.01 };
    let off = Some(Angle::from_degrees(off_deg));
    Ranked { cause: Cause::Place { place, away_km: 1596.1 }, off }
}

pub(crate) fn found(off_deg: f64) -> Supervision {
    Supervision {
        worst: Error { off: Angle::from_degrees(off_deg), at: rig::now() },
        is_within_beam: off_deg < 0.44,
        causes: vec![elsewhere(off_deg)],
        unknown: vec![Unknown::Elements],
        lower_minimum_deg: None,
    }
}

pub(crate) fn told(found: Supervision) -> Snapshot {
    let mut snapshot = states::holding();
    snapshot.on_board = Some(OnBoardView { found: Arc::new(found), missing: None });
    snapshot
}

#[test]
fn a_unit_that_would_miss_is_started_by_holding_only() {
    let mut window = rig::window(LARGE, rig::model(told(found(23.0))));
    assert!(says(&window, "The unit stands 1596 km from this station: its place is 12.30"));
    assert!(says(&window, "Follow it from here instead."));
    assert!(!texts(&window).iter().any(|text| text.ends_with(", Trackable")));
    assert!(texts(&window).iter().any(|text| text.ends_with(", The unit would miss")));
    hold(&mut window, "Hold 1 s to track anyway");
    let asked = asked(&mut window);
    assert!(matches!(asked[..], [UiCommand::TrackAnyway { antenna: 0, .. }]), "{asked:?}");
}

#[test]
fn a_unit_that_is_a_little_off_or_points_lower_is_told_of() {
    let lower = Supervision { lower_minimum_deg: Some(3.0), ..found(0.2) };
    let window = rig::window(LARGE, rig::model(told(lower)));
    assert!(says(&window, "Up to 0.20° off: the unit stands 1596 km"));
    assert!(says(&window, "The unit's minimum elevation is 3.0°, the station's 5.0°."));
    assert!(texts(&window).iter().any(|text| text.ends_with(", Trackable")));
}

#[test]
fn the_minimum_of_the_station_is_filled_in_to_be_applied() {
    let mut window = desk(LARGE, read());
    press(&mut window, "Take 5.0° from the station");
    assert_eq!(asked(&mut window), [], "filled in, not sent");
    assert_eq!(state_of(&window, "Minimum elevation"), "Edited");
    apply(&mut window);
    let values = settles(asked(&mut window)).remove(0).values;
    assert_eq!(values, [("minimum_elevation_deg", Value::Decimal(5.0))].into());
}

#[test]
fn a_missed_satellite_is_told_with_the_likeliest_cause() {
    let off = Angle::from_degrees(23.04);
    let missed = AlarmKind::OffTarget { off, cause: Some(elsewhere(23.0)) };
    let said = words::alarm(&missed, "Satrak");
    assert!(said.starts_with("Satrak is 23.0° off its satellite: the unit stands 1596 km"));
    let unexplained = AlarmKind::OffTarget { off, cause: None };
    let said = words::alarm(&unexplained, "Satrak");
    assert!(said.contains("the age of its elements is not known"), "{said}");
}
