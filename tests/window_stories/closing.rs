//! Closing of the window with typed text that is not yet saved or sent.

use std::{path::Path, sync::Arc};

use azel::{
    clock::Clock,
    contract::{
        self,
        closing::CloseHow,
        driver::{Intent, LinkState, Snapshot, StopState},
    },
    controller::SPECS,
    model::{Model, UiCommand, View},
    station::{self, OnClose},
};
use egui::{Event, Key, Modifiers, Role, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    makes,
    preferences::write,
    rig::{self, LARGE, NOAA_20, Window},
    settings_rig::{press, says},
    states,
    unit::{RealWindow, Unit, clock_from, open, step_until, wait_until},
};

/// Sends the window manager's request to close the window, and returns the window's answer.
fn close(window: &mut RealWindow) -> Vec<ViewportCommand> {
    let root = window.input_mut().viewports.entry(ViewportId::ROOT).or_default();
    root.events.push(ViewportEvent::Close);
    window.step();
    if let Some(root) = window.input_mut().viewports.get_mut(&ViewportId::ROOT) {
        root.events.clear();
    }
    answers(window)
}

fn answers(window: &RealWindow) -> Vec<ViewportCommand> {
    let commands = window.output().viewport_output.values().flat_map(|root| &root.commands);
    let closing = |command: &&ViewportCommand| {
        matches!(command, ViewportCommand::Close | ViewportCommand::CancelClose)
    };
    commands.filter(closing).cloned().collect()
}

fn rename_the_station(window: &mut RealWindow) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num6);
    window.run_steps(3);
    assert_eq!(window.state().model().view, View::Preferences);
    window.get_all_by_role_and_label(Role::TextInput, "Name").next().unwrap().focus();
    window.run_steps(2);
    window.event(Event::Text("Hill".to_owned()));
    window.run_steps(2);
}

#[test]
fn a_window_with_nothing_to_lose_closes_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(&folder.path().join("station.toml"), Clock::system());
    assert_eq!(close(&mut window), []);
    assert!(!says(&window, "Close anyway?"));
}

#[test]
fn a_window_with_unsaved_settings_asks_first() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(&folder.path().join("station.toml"), Clock::system());
    rename_the_station(&mut window);
    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    assert!(says(&window, "The station settings are not saved. Close anyway?"));

    press(&mut window, "Cancel");
    assert!(!says(&window, "Close anyway?"));
    assert!(says(&window, "Hill"), "what was typed is there");

    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    window.get_by_role_and_label(Role::Button, "Close (Enter)").click_accesskit();
    window.step();
    assert_eq!(answers(&window), [ViewportCommand::Close]);
    assert_eq!(close(&mut window), [], "it was asked once");
}

/// Returns a window with the question that closing `model` brings up.
pub(crate) fn asked_about(size: [f32; 2], model: Model) -> Window {
    let mut window = rig::window(size, model);
    let story = window.state_mut();
    assert!(story.views.ask_before_closing(&story.model, &mut story.commands));
    rig::settle(&mut window);
    window
}

const ANSWERS: [(&str, CloseHow); 3] = [
    ("Close and hold", CloseHow::Hold),
    ("Close and park", CloseHow::Park),
    ("Close and let it finish", CloseHow::Leave),
];

#[test]
fn antennas_that_move_or_are_tracked_are_asked_about_by_name() {
    for size in rig::sizes() {
        let model = || {
            let mut model = rig::model(states::tracking(0.1));
            let moved = Snapshot { unproved: true, ..makes::rc2000c_off() };
            model.shown_mut().antennas.push(rig::antenna(makes::rc2000c(), moved));
            model
        };
        for (word, how) in ANSWERS {
            let mut window = asked_about(size, model());
            for told in [
                "Satrak tracks NOAA 20 by itself.",
                "RC2000C was moved and is not known to have stopped.",
                "STOP goes to Satrak and RC2000C first.",
                "Satrak to the park position; everything else is kept until then.",
                "Satrak left tracking, with nobody watching here. STOP goes to the others first.",
            ] {
                assert!(rig::says(&window, told), "{told}");
            }
            press(&mut window, word);
            assert_eq!(
                rig::asked(&mut window),
                [UiCommand::Station(contract::Command::CloseAfter(how))]
            );
            assert!(!rig::says(&window, "Close Azel?"));
        }
        let mut window = asked_about(size, model());
        press(&mut window, "Stay");
        assert_eq!(rig::asked(&mut window), []);
        assert!(!rig::says(&window, "Close Azel?"));
    }
}

#[test]
fn what_the_station_says_of_closing_is_done_unasked_unless_something_else_is_lost() {
    for (on_close, how) in [
        (OnClose::Hold, CloseHow::Hold),
        (OnClose::Park, CloseHow::Park),
        (OnClose::Leave, CloseHow::Leave),
    ] {
        let mut model = rig::model(states::tracking(0.1));
        Arc::make_mut(&mut model.shown_mut().station).on_close = Some(on_close);
        let mut window = asked_about(LARGE, model);
        assert!(!rig::says(&window, "Close Azel?"));
        assert_eq!(
            rig::asked(&mut window),
            [UiCommand::Station(contract::Command::CloseAfter(how))]
        );
    }
    let mut model = rig::model(states::tracking(0.1));
    (Arc::make_mut(&mut model.shown_mut().station).on_close, model.view) =
        (Some(OnClose::Hold), View::Preferences);
    let mut window = rig::window(LARGE, model);
    write(&mut window, "Latitude", "40");
    let story = window.state_mut();
    assert!(story.views.ask_before_closing(&story.model, &mut story.commands));
    rig::settle(&mut window);
    assert!(rig::says(&window, "The station settings are not saved."));
}

#[test]
fn an_answer_that_means_nothing_is_not_offered() {
    for size in rig::sizes() {
        let window = asked_about(size, rig::model(states::moving()));
        assert!(rig::says(&window, "Satrak moves."));
        window.get_by_role_and_label(Role::Button, "Close and park");
        assert!(window.query_by_label("Close and let it finish").is_none());

        let mut owed = states::holding();
        owed.stop = StopState::NotConfirmed { start: azel::clock::Instant::now() };
        owed.link = LinkState::Connecting { start: azel::clock::Instant::now() };
        let window = asked_about(size, rig::model(owed));
        assert!(rig::says(&window, "STOP of Satrak is not confirmed."));
        assert!(window.query_by_label("Close and park").is_none(), "there is no link");
    }
}

/// Opens a window whose unit tracks NOAA 20.
fn tracking(unit: &Unit, path: &Path) -> RealWindow {
    station::save(&unit.station(), path, SPECS).unwrap();
    let mut window = open(path, clock_from(UTC.parse().unwrap()));
    step_until(&mut window, "it is measured", |model| {
        model.antenna().is_some_and(|of| of.snapshot.state.motion_lock == Some(false))
    });
    step_until(&mut window, "the passes are planned", |model| {
        // Wait for the first plan, because it changes the places of the bars in the strip.
        model.schedule.made_at.is_some() && model.pass_of(NOAA_20).is_some()
    });
    window.get_by_label_contains("NOAA 20, 11:08Z to 11:21Z").click();
    window.run_steps(2);
    press(&mut window, "Track NOAA 20");
    step_until(&mut window, "it tracks", |model| model.antenna().unwrap().tracks());
    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    assert!(says(&window, "Satrak tracks NOAA 20 by itself."));
    window
}

const UTC: &str = "2026-08-12T11:14:30Z";

/// Runs frames until the window asks to close.
fn until_it_closes(window: &mut RealWindow) {
    wait_until("it closes", || {
        window.step();
        answers(window) == [ViewportCommand::Close]
    });
}

#[test]
fn close_and_hold_waits_for_proved_standstill() {
    let (unit, folder) = (Unit::start(UTC.parse().unwrap()), tempfile::tempdir().unwrap());
    let mut window = tracking(&unit, &folder.path().join("station.toml"));
    press(&mut window, "Stay");
    window.run_steps(2);
    assert_eq!(answers(&window), []);
    assert!(unit.control.state().is_tracking, "it goes on");
    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    press(&mut window, "Close and hold");
    until_it_closes(&mut window);
    assert!(!unit.control.state().is_tracking);
    assert_eq!(close(&mut window), [], "it was asked once");
}

#[test]
fn close_and_park_stays_until_it_is_parked_and_stop_keeps_the_window() {
    let (unit, folder) = (Unit::start(UTC.parse().unwrap()), tempfile::tempdir().unwrap());
    let mut window = tracking(&unit, &folder.path().join("station.toml"));
    press(&mut window, "Close and park");
    step_until(&mut window, "it parks", |model| {
        model.antenna().unwrap().snapshot.intent == Intent::Park
    });
    window.run_steps(2);
    assert!(says(&window, "Satrak: once it is parked."));
    assert_eq!(answers(&window), []);
    window.key_press(Key::Escape);
    step_until(&mut window, "it is stopped", |model| {
        matches!(model.antenna().unwrap().snapshot.stop, StopState::Stopped { .. })
    });
    window.run_steps(3);
    assert_eq!(answers(&window), []);
    assert!(!says(&window, "Azel closes"), "the operator is needed here");
}

#[test]
fn close_and_let_it_finish_leaves_the_unit_alone() {
    let (unit, folder) = (Unit::start(UTC.parse().unwrap()), tempfile::tempdir().unwrap());
    let mut window = tracking(&unit, &folder.path().join("station.toml"));
    window.get_by_role_and_label(Role::Button, "Close and let it finish").click_accesskit();
    until_it_closes(&mut window);
    drop(window);
    assert!(unit.control.state().is_tracking);
    let received = unit.control.received();
    assert!(!received.iter().any(|(_, frame)| frame == "STOP="), "{received:?}");
}

#[test]
fn a_track_that_stop_has_ended_is_offered_again_in_one_step() {
    let (unit, folder) = (Unit::start(UTC.parse().unwrap()), tempfile::tempdir().unwrap());
    let mut window = tracking(&unit, &folder.path().join("station.toml"));
    press(&mut window, "Stay");
    window.key_press(Key::Escape);
    step_until(&mut window, "it stands", |model| {
        matches!(model.antenna().unwrap().snapshot.stop, StopState::Stopped { .. })
    });
    window.run_steps(2);
    assert!(says(&window, "Was tracking NOAA 20."));
    press(&mut window, "Track NOAA 20 again");
    step_until(&mut window, "it tracks again", |model| model.antenna().unwrap().tracks());
    assert!(!says(&window, "Was tracking NOAA 20."));
    window.key_press(Key::Escape);
    step_until(&mut window, "it stands", |model| {
        matches!(model.antenna().unwrap().snapshot.stop, StopState::Stopped { .. })
    });
    window.run_steps(2);
    assert!(says(&window, "Was tracking NOAA 20."));
    window.get_by_role_and_label(Role::RadioButton, "Manual").click();
    step_until(&mut window, "something else is chosen", |model| {
        model.antenna().unwrap().track_again.is_none()
    });
    window.run_steps(2);
    assert!(!says(&window, "Was tracking NOAA 20."));
}
