//! Card of an antenna, which shows the measured position with its age, and the antenna's activity
//! regardless of its cause.

use std::{sync::Arc, time::Duration};

use azel::{
    contract::driver::{Command, Intent, LinkLoss, LinkState, OnBoardView, Snapshot},
    device::AxisMotion,
    model::{Model, UiCommand},
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    on_board::found,
    rig::{self, LARGE, asked},
    states,
};

fn lost(snapshot: Snapshot, model: &Model) -> Snapshot {
    let since = model.steady - Duration::from_secs(5);
    let retry_at = model.steady + Duration::from_secs(2);
    Snapshot {
        link: LinkState::Lost { start: since, reason: LinkLoss::Silent, retry_at },
        ..snapshot
    }
}

#[test]
fn without_a_fresh_measurement_there_is_no_error_and_no_rate() {
    for size in rig::sizes() {
        let live = rig::window(size, rig::model(states::tracking(0.1)));
        live.get_by_label_contains("Az: Predicted 296.51, actual 296.51, error +0.00");
        live.get_by_label_contains("Off beam axis 0.10°");

        let mut model = rig::model(states::tracking(0.1));
        let mut snapshot = lost(states::tracking(0.1), &model);
        let measured = snapshot.state.measured.as_mut().unwrap();
        measured.requested = model.steady - Duration::from_millis(4900);
        model.shown_mut().antennas[0].snapshot = Arc::new(snapshot);
        let window = rig::window(size, model);
        let az = "actual 296.51, 4.9 s old, error not known, rate not known";
        window.get_by_label_contains(az);
        window.get_by_label_contains("Off beam axis –");
    }
}

fn by_itself() -> Snapshot {
    Snapshot { intent: Intent::Standby, target: None, ..states::tracking(0.0) }
}

#[test]
fn the_mode_is_that_of_the_antenna_also_when_the_unit_tracks_by_itself() {
    for size in rig::sizes() {
        let mut snapshot = by_itself();
        let window = rig::window(size, rig::model(snapshot.clone()));
        let track = window.get_by_role_and_label(Role::RadioButton, "Track, not by this console");
        assert_eq!(track.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
        let take_over = "Take over the track of NOAA 20";
        assert!(window.query_by_label(take_over).is_none(), "nothing to watch it by");

        let view = OnBoardView { found: Arc::new(found(0.0)), missing: None, arrives: None };
        snapshot.on_board = Some(view);
        let mut window = rig::window(size, rig::model(snapshot));
        window.get_by_label(take_over).click();
        let id = window.state().model.antennas[0].id();
        assert_eq!(asked(&mut window), [UiCommand::antenna(id, Command::TakeOver)]);
    }
}

#[test]
fn a_motion_that_this_console_has_ended_is_nobody_elses() {
    let mut snapshot = states::manual();
    snapshot.state.measured = Some(states::measured(205.0, 5.0, AxisMotion::Plus));
    let said = |snapshot: &Snapshot| states::sentence(&rig::model(snapshot.clone()));
    assert!(said(&snapshot).starts_with("Moving, not by this console"));
    snapshot.runs_out = true;
    assert_eq!(said(&snapshot), "Stopping at 205.0°, 5.0°: Azel has ended the motion.");
}

#[test]
fn what_does_not_set_has_no_los_and_another_day_is_named() {
    let mut model = rig::model(states::tracking(0.0));
    let passes = model.pass_lists.favourites.passes.clone();
    let always = passes.iter().find(|it| it.is_always_up()).unwrap();
    let mut snapshot = states::tracking(0.0);
    let held = snapshot.state.on_board.satellite.as_mut().unwrap();
    held.catalog_number = always.number();
    snapshot.state.on_board.window = Some((rig::now(), "2026-08-14T07:57:24Z".parse().unwrap()));
    model.shown_mut().antennas[0].snapshot = Arc::new(snapshot);
    let said = states::sentence(&model);
    assert!(!said.contains("LOS"), "{said}");
    if said.contains("it stops and holds") {
        assert!(said.contains("It does not set; at 14 Aug 07:57:24Z it stops"), "{said}");
    }
}

#[test]
fn a_header_that_is_cut_keeps_what_matters_and_loses_the_age_of_the_elements_first() {
    let mut snapshot = states::tracking(0.0);
    if let Some(held) = &mut snapshot.state.on_board.satellite {
        held.catalog_number = 25_544;
        "ISS (ZARYA)".clone_into(&mut held.name);
    }
    for size in rig::sizes() {
        let window = rig::window(size, rig::model(snapshot.clone()));
        let header = window.get_by_label_contains("JPSS-1 43013").accesskit_node();
        let header = header.value().or_else(|| header.label()).unwrap();
        let place = |words: &str| header.find(words).unwrap_or_else(|| panic!("{header}"));
        let other = place("Satrak has another satellite");
        let light = header.find("sunlit").unwrap_or_else(|| place("in shadow"));
        assert!(other < light && light < place("lements "), "{header}");
    }
}

#[test]
fn the_head_of_a_card_has_the_name_that_the_unit_gives_itself() {
    for size in rig::sizes() {
        let mut snapshot = states::holding();
        snapshot.state.unit_name = Some("ROOF 2".to_owned());
        let window = rig::window(size, rig::model(snapshot));
        window.get_by_label_contains("Satrak, X/Y mount, ROOF 2, link");
    }
}

#[test]
fn a_unit_that_was_not_asked_yet_is_not_said_to_hold_nothing() {
    let window = rig::window(LARGE, rig::model(rig::quiet()));
    window.get_by_label("On the unit: not read yet");
    let mut snapshot = states::tracking(0.0);
    if let Some(held) = &mut snapshot.state.on_board.satellite {
        held.catalog_number = 0;
        held.name.clear();
    }
    let window = rig::window(LARGE, rig::model(snapshot));
    window.get_by_label("On the unit: no satellite");
}
