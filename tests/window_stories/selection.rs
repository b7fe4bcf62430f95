//! Selected pass, which follows the selected antenna unless the operator has chosen another pass.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract::{
        automatic::Doing,
        passes::{PassListKey, PredictedPass},
    },
    device::{AxisMotion, Phase},
    model::Model,
    plan::schedule::{Entry, PassKey as Key},
    station::AntennaId,
};

use crate::window_stories::{
    automatic, plan,
    rig::{self, NOAA_20},
    states,
};

/// Returns the coming passes of the plan, in the order in which their antenna takes them.
fn planned(model: &Model) -> Vec<PassListKey> {
    let entries = model.schedule.schedule.entries.iter();
    let ahead = entries.filter(|entry| entry.start > model.now);
    ahead.map(|entry| (entry.pass.satellite, entry.pass.aos)).collect()
}

/// Returns an antenna that tracks NOAA 20 and takes all passes after it.
fn tracking() -> Model {
    let mut model = rig::model(states::tracking(0.1));
    let mut plan = plan::planned(&model);
    let entry = plan.schedule.entries[0].clone();
    let upcoming = model.pass_lists.favourites.upcoming(model.now);
    let later = upcoming.iter().filter(|of| !of.is_always_up() && of.pass.aos.time > model.now);
    plan.schedule.entries = later
        .map(|predicted| {
            let (satellite, aos) = predicted.key();
            let (from, to) = (aos, predicted.pass.los.time);
            Entry { pass: Key { satellite, aos }, start: from, end: to, ..entry.clone() }
        })
        .collect();
    assert!(plan.schedule.entries.len() > 3);
    model.shown_mut().schedule = Arc::new(plan);
    model.selected = None;
    model
}

/// Ends the track of the antenna, which then stands; the time is a moment after LOS.
fn after_los(model: &mut Model) {
    model.shown_mut().antennas.clone_from(&rig::model(states::holding()).antennas);
    model.now = add_seconds(states::los(), 1.0);
}

fn pass_of(model: &Model, catalog_number: u32) -> Option<PassListKey> {
    model.pass_of(catalog_number).map(PredictedPass::key)
}

#[test]
fn the_tracked_pass_is_selected_and_after_los_the_next_one_of_the_plan() {
    let mut model = tracking();
    model.follow_antenna();
    assert_eq!(model.selected, pass_of(&model, NOAA_20));
    after_los(&mut model);
    model.follow_antenna();
    assert_eq!(model.selected, Some(planned(&model)[0]));
    assert!(model.selected_pass().is_some(), "there is no empty screen");
}

#[test]
fn the_last_snapshot_of_a_track_selects_no_later_pass_of_its_satellite() {
    let mut model = tracking();
    model.follow_antenna();
    let los = states::los();
    let later = rig::predicted_passes(
        &model.pass_of(NOAA_20).unwrap().satellite,
        &rig::station(),
        add_seconds(los, 12.0 * 3600.0),
    );
    let listed = Arc::make_mut(&mut model.shown_mut().pass_lists.favourites.passes);
    let dated = listed.partition_point(|predicted| !predicted.is_always_up());
    listed.splice(dated..dated, later);
    model.now = add_seconds(los, 0.3);
    assert!(pass_of(&model, NOAA_20).is_some(), "there is a later pass");
    assert!(model.antennas[0].tracks());
    model.follow_antenna();
    assert_eq!(model.selected, Some(planned(&model)[0]));
}

#[test]
fn the_pass_that_the_antenna_waits_for_is_selected() {
    let mut model = rig::model(states::program(Phase::AtStart, AxisMotion::Still));
    model.selected = None;
    model.follow_antenna();
    assert_eq!(model.selected, pass_of(&model, NOAA_20));
}

#[test]
fn the_choice_of_the_operator_stays_until_that_pass_is_over() {
    let mut model = tracking();
    let later = planned(&model)[1];
    model.choose_pass(later);
    model.follow_antenna();
    assert_eq!(model.selected, Some(later), "although the antenna tracks another one");
    after_los(&mut model);
    model.follow_antenna();
    assert_eq!(model.selected, Some(later));
    let los = model.pass_lists.find(later).unwrap().pass.los.time;
    model.now = add_seconds(los, 1.0);
    model.follow_antenna();
    let next = planned(&model)[0];
    assert_eq!(model.selected, Some(next));
    model.now = rig::now();
    model.follow_antenna();
    assert_ne!(model.selected, Some(later), "the clock was set back: the choice is over");
}

#[test]
fn a_choice_survives_a_list_that_is_being_made() {
    let mut model = tracking();
    let later = planned(&model)[1];
    model.choose_pass(later);
    let passes = std::mem::take(&mut model.shown_mut().pass_lists.favourites.passes);
    model.follow_antenna();
    assert!(model.selected_pass().is_none());
    model.shown_mut().pass_lists.favourites.passes = passes;
    model.follow_antenna();
    assert_eq!(model.selected, Some(later));
}

/// Adds a second antenna, which takes the third pass.
fn pair(model: &mut Model) {
    let mut second = model.antennas[0].clone();
    Arc::make_mut(&mut second.config).id = AntennaId(2);
    model.shown_mut().antennas.push(second);
    let mut plan = (*model.schedule).clone();
    let mut ahead = plan.schedule.entries.iter_mut().filter(|entry| entry.start > model.now);
    ahead.nth(2).unwrap().antenna = AntennaId(2);
    model.shown_mut().schedule = Arc::new(plan);
}

#[test]
fn an_antenna_that_is_selected_brings_the_next_pass_of_its_own_plan() {
    let mut model = tracking();
    after_los(&mut model);
    pair(&mut model);
    for (place, nth) in [(0, 0), (1, 2), (0, 0)] {
        model.select_antenna(place);
        assert_eq!(model.selected, Some(planned(&model)[nth]), "antenna {place}");
    }
    let own = planned(&model)[1];
    model.selected = Some(own);
    model.select_antenna(0);
    assert_eq!(model.selected, Some(own), "it is selected already");
    let later = planned(&model)[3];
    model.choose_pass(later);
    model.select_antenna(1);
    assert_eq!(model.selected, Some(later), "the operator is about to track it with another one");
}

#[test]
fn before_its_first_track_an_antenna_keeps_the_selection_unless_it_works_by_itself() {
    let mut model = tracking();
    model.shown_mut().antennas.clone_from(&rig::model(states::holding()).antennas);
    model.selected = pass_of(&model, NOAA_20);
    model.follow_antenna();
    assert_eq!(model.selected, pass_of(&model, NOAA_20), "it can still be tracked by hand");
    model.shown_mut().antennas[0].operation = automatic::on(&Doing::Rests);
    model.follow_antenna();
    assert_eq!(model.selected, Some(planned(&model)[0]), "the antenna will take this one");
}

#[test]
fn at_the_start_a_pass_under_way_is_selected_whatever_the_plan_has() {
    let mut model = tracking();
    model.shown_mut().antennas.clone_from(&rig::model(states::holding()).antennas);
    let plan = std::mem::take(&mut model.shown_mut().schedule);
    let under_way = model.next_pass().map(PredictedPass::key);
    for schedule in [Arc::default(), plan] {
        model.selected = None;
        model.shown_mut().schedule = schedule;
        model.follow_antenna();
        assert_eq!(model.selected, under_way, "the order in which both come does not matter");
    }
}

#[test]
fn without_a_plan_the_next_pass_of_any_favourite_is_selected() {
    let mut model = rig::model(states::holding());
    model.selected = None;
    model.follow_antenna();
    assert_eq!(model.selected, model.next_pass().map(PredictedPass::key));
    assert!(model.selected.is_some());
}
