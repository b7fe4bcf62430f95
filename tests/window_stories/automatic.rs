//! Automatic operation in Operate and in the lanes of the plan.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract::{
        Command,
        automatic::{Doing, Interruption, OffBecause, Operation, Taking},
        driver::{LinkLoss, LinkState},
    },
    model::{Model, UiCommand, View},
    station::OnClose,
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    closing,
    every_view::painted,
    extremes::{nothing_is_cut, nothing_overlaps},
    plan,
    rig::{self, LARGE, SIZES, SMALL, Window, settle},
    states,
    wide::three,
};

const INTERRUPTIONS: [Interruption; 4] =
    [Interruption::ByHand, Interruption::Elsewhere, Interruption::EndedByUnit, Interruption::Clock];

/// Returns automatic operation that is on.
pub(crate) fn on(doing: &Doing) -> Operation {
    let on = serde_json::json!({
        "on": { "doing": doing, "failures": 0, "moved_at": null, "moves_since": null }
    });
    serde_json::from_value(on).unwrap()
}

fn suspended(by: Interruption) -> Operation {
    Operation::Suspended { interruption: by, start: rig::now() }
}

/// Returns three antennas, of which the first has this operation and a plan.
pub(crate) fn scene(operation: Operation) -> Model {
    let mut model = three();
    model.shown_mut().schedule = Arc::new(plan::planned(&model));
    // Remove the pass that is up, because it does not belong to this antenna.
    let schedule = &mut Arc::make_mut(&mut model.shown_mut().schedule).schedule;
    schedule.entries.retain(|entry| entry.start > rig::now());
    model.shown_mut().antennas[0].operation = operation;
    model
}

pub(crate) fn suspended_scene() -> Model {
    scene(suspended(Interruption::Clock))
}

/// Returns the state of automatic operation that takes the pass under way until 11:21:27Z.
fn taking(proved: bool) -> Doing {
    let model = rig::model(rig::quiet());
    let noaa_20 = model.pass_of(rig::NOAA_20).unwrap();
    let taking: Taking = serde_json::from_value(serde_json::json!({
        "pass": noaa_20.key(),
        "from": noaa_20.pass.aos.time,
        "until": noaa_20.pass.los.time,
        "asked_at": add_seconds(model.now, -70.0),
        "requests": 1,
        "attempt": "begun",
        "proved_at": proved.then(|| add_seconds(model.now, -60.0)),
        "given_up": null,
    }))
    .unwrap();
    Doing::Takes(taking)
}

fn announces() -> Doing {
    let model = scene(on(&Doing::Rests));
    let next = model.next_entry(model.antennas[0].id()).unwrap();
    let pass = (next.pass.satellite, next.pass.aos);
    Doing::Announces { moves_at: add_seconds(model.now, 7.0), pass }
}

/// Returns the painted words of automatic operation on the card.
fn on_card(window: &Window) -> String {
    let node = window.get_by_label_contains("Automatic operation: ");
    let label = node.accesskit_node().value().unwrap();
    let words = label.strip_prefix("Automatic operation: ").unwrap().to_owned();
    assert!(painted::texts(window).contains(&words), "{words}");
    let cut = painted::cut(window);
    assert!(!cut.contains(&words), "{words}");
    words
}

fn tags(window: &Window) -> usize {
    painted::texts(window).iter().filter(|text| *text == "AUTO").count()
}

#[test]
fn chip_and_card_say_at_every_size_what_comes_next_and_when() {
    for size in [SMALL, LARGE, [1920.0, 1080.0]] {
        for (doing, told) in [
            (Doing::Rests, "Next at 12:31:57Z: SUOMI NPP. Loads 12:30:04Z, in 1:14:34."),
            (Doing::Parks, "Parks. Next at 12:31:57Z: SUOMI NPP. Loads 12:30:04Z, in 1:14:34."),
            (announces(), "Moves at 11:15:37Z, in 0:07 unless you press STOP: SUOMI NPP."),
            (taking(false), "Sent 11:14:20Z, not verified yet: NOAA 20."),
            (taking(true), "Takes NOAA 20 until 11:21:26Z, then SUOMI NPP at 12:31:57Z."),
        ] {
            let window = rig::window(size, scene(on(&doing)));
            assert_eq!(on_card(&window), told, "{size:?}");
            assert_eq!(tags(&window), 2, "{size:?}: on the chip and on the card");
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
        }
        let window = rig::window(size, scene(Operation::Off(OffBecause::NotSwitchedOn)));
        assert_eq!(tags(&window), 0);
    }
}

#[test]
fn a_suspension_is_told_with_its_reason_and_its_button_at_every_size() {
    for size in [SMALL, LARGE, [1920.0, 1080.0]] {
        for by in INTERRUPTIONS {
            let mut window = rig::window(size, scene(suspended(by)));
            assert!(on_card(&window).starts_with("Suspended. The "), "{size:?}");
            assert_eq!(tags(&window), 2);
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
            window.state_mut().commands.clear();
            let label = "Go on with SUOMI NPP, 12:31:57Z: automatic operation is suspended";
            let button = window.get_by_role_and_label(Role::Button, label);
            assert!(button.rect().bottom() <= size[1]);
            button.click();
            let id = window.state().model.antennas[0].id();
            assert_eq!(rig::asked(&mut window), [UiCommand::Station(Command::GoOn(id))]);
        }
    }
}

#[test]
fn nothing_below_moves_while_the_words_change() {
    for size in SIZES {
        let places = [Doing::Rests, announces(), taking(false), taking(true)].map(|doing| {
            let window = rig::window(size, scene(on(&doing)));
            window.get_all_by_role_and_label(Role::RadioButton, "Standby").next().unwrap().rect()
        });
        assert!(places.iter().all(|place| *place == places[0]), "{size:?}: {places:?}");
    }
}

#[test]
fn a_chip_keeps_its_tag_while_the_unit_does_not_answer() {
    let mut model = scene(on(&Doing::Rests));
    let since = rig::ago(&model, 14);
    Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot).link =
        LinkState::Lost { start: since, reason: LinkLoss::Closed, retry_at: since };
    let window = rig::window(SMALL, model);
    assert_eq!(tags(&window), 2);
    assert!(painted::texts(&window).iter().any(|text| text == "14 s ago"));
}

#[test]
fn a_lane_label_shows_its_whole_time_and_its_button_covers_no_bar() {
    for size in SIZES {
        let doings = [Doing::Rests, Doing::Parks, announces(), taking(false), taking(true)];
        let operations = doings.iter().map(on).chain(INTERRUPTIONS.map(suspended));
        for operation in operations {
            let is_suspended = !operation.is_on();
            let mut model = scene(operation);
            model.view = View::Plan;
            let mut window = rig::window(size, model);
            let cut = painted::cut(&window);
            let is_of_lane =
                |words: &&String| words.starts_with("On. ") || words.starts_with("Suspended");
            assert!(!cut.iter().any(|words| is_of_lane(&words)), "{size:?}: {cut:?}");
            nothing_overlaps(&window);
            if !is_suspended {
                continue;
            }
            let label = "Go on with SUOMI NPP, 12:31:57Z";
            let button = window.get_by_role_and_label(Role::Button, label).rect();
            for bar in window.query_all_by_role(Role::ListBoxOption) {
                let name = bar.accesskit_node().label().unwrap_or_default();
                let is_apart = bar.rect().left() > button.right();
                assert!(is_apart || !name.contains(" with Satrak, "), "{size:?}: {name}");
            }
            window.state_mut().commands.clear();
            window.get_by_role_and_label(Role::Button, label).click();
            settle(&mut window);
            let id = window.state().model.antennas[0].id();
            let go_on = UiCommand::Station(Command::GoOn(id));
            assert!(window.state().commands.contains(&go_on), "{size:?}");
        }
    }
}

#[test]
fn a_long_name_in_a_lane_is_cut_after_its_time() {
    let mut model = scene(on(&Doing::Rests));
    model.view = View::Plan;
    // A satellite that no list knows has its number as its name.
    let entry = &mut Arc::make_mut(&mut model.shown_mut().schedule).schedule.entries[0];
    entry.pass.satellite = 799_999_999;
    let window = rig::window(LARGE, model);
    let texts = painted::texts(&window);
    assert!(texts.iter().any(|text| text == "On. Next 12:31:57Z: 799999999."), "{texts:?}");
}

/// Words for the next pass in the plan, of SUOMI NPP.
const NEXT: &str = "The next would be SUOMI NPP at 12:31:57Z.";

#[test]
fn closing_between_passes_asks_while_automatic_operation_is_not_off() {
    for size in SIZES {
        for operation in [on(&Doing::Rests), on(&Doing::Parks), suspended(Interruption::ByHand)] {
            let mut window = closing::asked_about(size, scene(operation));
            assert!(rig::says(
                &window,
                &format!(
                    "Automatic operation of Satrak ends: it takes no pass until you switch it on \
                     again. {NEXT} Close anyway?"
                )
            ));
            window.state_mut().commands.clear();
            window.get_by_role_and_label(Role::Button, "Close (Enter)").click();
            assert_eq!(rig::asked(&mut window), [UiCommand::Close]);
        }
        let mut window = rig::window(size, scene(Operation::Off(OffBecause::Operator)));
        let story = window.state_mut();
        assert!(!story.views.ask_before_closing(&story.model, &mut story.commands));
    }
}

#[test]
fn the_question_before_closing_names_all_antennas_that_work_by_themselves() {
    let mut model = scene(on(&Doing::Rests));
    model.shown_mut().antennas[2].operation = suspended(Interruption::Elsewhere);
    for index in [0, 2] {
        Arc::make_mut(&mut model.shown_mut().antennas[index].config).automatic.is_on_at_start =
            true;
    }
    let mut window = closing::asked_about(LARGE, model);
    assert!(rig::says(
        &window,
        "Automatic operation of Satrak and RC2000C ends: it takes no pass until this station runs \
         again."
    ));
    window.state_mut().commands.clear();
    window.get_by_role_and_label(Role::Button, "Cancel").click();
    assert_eq!(rig::asked(&mut window), []);
}

#[test]
fn closing_during_a_pass_names_automatic_operation_whatever_the_station_file_says() {
    for on_close in [None, Some(OnClose::Hold)] {
        let mut model = rig::model(states::tracking(0.1));
        Arc::make_mut(&mut model.shown_mut().station).on_close = on_close;
        model.shown_mut().antennas[0].operation = on(&taking(true));
        let window = closing::asked_about(LARGE, model);
        for told in ["Satrak tracks NOAA 20 by itself.", "Automatic operation of Satrak ends: "] {
            assert!(rig::says(&window, told), "{told}");
        }
        window.get_by_role_and_label(Role::Button, "Close and hold");
    }
}
