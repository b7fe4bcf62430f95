//! Set-up of a station: the questions, displays and refusals of each step.

use std::{sync::Arc, time::Duration};

use azel::{
    contract::{
        self,
        driver::{LinkFault, LinkFinding},
        link_tests::{LinkTest, LinkTestStage},
    },
    controller::SPECS,
    device::{
        AntennaState, OnBoard, Place, UnitClock,
        panel::{Check, CheckState},
    },
    model::{Model, UiCommand, View},
    station::{Antenna, Station},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::{saved, write},
    rig::{self, SIZES, Window, asked, says, settle},
};

pub(crate) const NEXT: [&str; 4] = [
    "Next: Antennas (Enter)",
    "Next: Satellites (Enter)",
    "Next: Elements (Enter)",
    "Next: Check and finish (Enter)",
];
const FINISH: &str = "Finish (Enter)";

pub(crate) fn window(size: [f32; 2]) -> Window {
    let mut model: Model = rig::model(rig::quiet());
    (model.shown_mut().demo, model.view) = (true, View::Setup);
    rig::window(size, model)
}

pub(crate) fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

fn is_locked(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

fn field(window: &Window, name: &str) -> String {
    window.get_by_role_and_label(Role::TextInput, name).value().unwrap_or_default()
}

fn is_at(window: &Window, step: &str) -> bool {
    window.query_by_role_and_label(Role::Heading, step).is_some()
}

pub(crate) fn write_site(window: &mut Window) {
    write(window, "Name", "Şile 2");
    write(window, "Locator", "KN41ob");
    write(window, "Altitude", "121");
}

/// Adds an antenna of the first make, and returns the antenna that a link test gets.
pub(crate) fn add_and_test(window: &mut Window, address: &str) -> Antenna {
    press(window, &format!("Add {}", SPECS[0].name));
    write(window, "Address of the Satrak", address);
    press(window, "Test link of Satrak");
    match <[UiCommand; 1]>::try_from(asked(window)) {
        Ok([UiCommand::Station(contract::Command::TestLink(antenna))]) => *antenna,
        other => panic!("{other:?}"),
    }
}

pub(crate) fn tell(window: &mut Window, antenna: &Antenna, finding: LinkFinding) {
    let stage = LinkTestStage::Done { finding, time: rig::now() };
    let test = LinkTest { antenna: antenna.clone(), stage };
    window.state_mut().model.shown_mut().link_tests = Arc::new(vec![test]);
    settle(window);
}

pub(crate) fn reached() -> LinkFinding {
    let place = Place { latitude_deg: 41.176, longitude_deg: 29.613, step_deg: 1e-4 };
    let clock = UnitClock { ahead_s: -0.02, error_s: 0.0, is_set: true, read_at: rig::now() };
    let state = AntennaState {
        identity: Some("SATRAK CU V1.2".to_owned()),
        on_board: OnBoard { place: Some(place), clock: Some(clock), ..OnBoard::default() },
        ..AntennaState::default()
    };
    LinkFinding::Reached { after: Duration::from_millis(12), state: Box::new(state) }
}

#[test]
fn four_steps_make_a_station_without_anything_of_the_demo() {
    for size in rig::sizes() {
        let mut window = window(size);
        let demo = Station::clone(&window.state().model.station);
        assert!(is_at(&window, "Site") && is_locked(&window, NEXT[0]));
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        assert!(is_at(&window, "Antennas"));
        add_and_test(&mut window, "unit.local:4001");
        press(&mut window, NEXT[1]);
        press(&mut window, "Remove all");
        write(&mut window, "Search the catalogue", "25544");
        window.key_press(Key::Enter);
        settle(&mut window);
        assert!(says(&window, "1 chosen"));
        press(&mut window, NEXT[2]);
        press(&mut window, NEXT[3]);
        assert!(is_at(&window, "Check and finish"));
        assert_eq!(asked(&mut window), [], "nothing is written before the end");
        press(&mut window, FINISH);
        let station = saved(asked(&mut window));
        assert_eq!(station.name, "Şile 2");
        assert_eq!(station.favourites.numbers(), [25_544]);
        assert!((station.site.latitude().degrees() - 41.0625).abs() < 1e-4);
        assert!((station.site.longitude().degrees() - 29.2083).abs() < 1e-4);
        let addresses: Vec<&str> =
            station.antennas.iter().map(|of| &*of.connection.address).collect();
        assert_eq!(addresses, ["unit.local:4001"]);
        assert_ne!(station.antennas[0].connection, demo.antennas[0].connection);
    }
}

#[test]
fn enter_goes_on_alt_left_goes_back_and_a_skipped_step_says_so() {
    for size in rig::sizes() {
        let mut window = window(size);
        window.key_press(Key::Enter);
        settle(&mut window);
        assert!(is_at(&window, "Site"), "the site is missing");
        assert!(says(&window, "Site: Name, Latitude, Longitude and Altitude are missing."));
        write_site(&mut window);
        for step in ["Antennas", "Satellites", "Elements", "Check and finish"] {
            window.key_press(Key::Enter);
            settle(&mut window);
            assert!(is_at(&window, step), "{step}");
        }
        for step in ["Elements", "Satellites", "Antennas", "Site"] {
            window.key_press_modifiers(Modifiers::ALT, Key::ArrowLeft);
            settle(&mut window);
            assert!(is_at(&window, step), "{step}");
        }
        assert_eq!(field(&window, "Name"), "Şile 2");
        press(&mut window, "Skip this step");
        window.get_by_label_contains("Step 1: Site, skipped");
        window.get_by_label_contains("Step 2: Antennas, done");
        for _ in 0..3 {
            press(&mut window, "Skip this step");
        }
        press(&mut window, FINISH);
        let demo = Station::clone(&window.state().model.station);
        let station = saved(asked(&mut window));
        assert_eq!((station.antennas.len(), station.site), (0, demo.site));
    }
}

#[test]
fn the_set_up_is_found_again_where_it_was_left() {
    for size in rig::sizes() {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        press(&mut window, &format!("Add {}", SPECS[1].name));
        window.get_by_role_and_label(Role::Button, "Stay in the demo").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Operate)]);
        for view in [View::Operate, View::Map, View::Setup] {
            window.state_mut().model.view = view;
            settle(&mut window);
        }
        assert!(is_at(&window, "Antennas"));
        window.get_by_role_and_label(Role::Button, "Remove Genius");
        window.get_by_label_contains("Step 1: Site").click();
        settle(&mut window);
        assert_eq!(field(&window, "Name"), "Şile 2");
        let story = window.state_mut();
        let mut commands = Vec::new();
        assert!(story.views.ask_before_closing(&story.model, &mut commands), "it would be lost");
    }
}

#[test]
fn the_station_menu_leads_to_the_set_up_of_a_demo_alone() {
    for (demo, view) in [(true, View::Operate), (false, View::Operate)] {
        let mut model = rig::model(rig::quiet());
        (model.shown_mut().demo, model.view) = (demo, view);
        let mut window = rig::window(rig::SMALL, model);
        window.get_by_label("Station Şile 1").click();
        settle(&mut window);
        let entry = window.query_by_label("Set up your station…");
        assert_eq!(entry.is_some(), demo);
        if let Some(entry) = entry {
            entry.click();
            assert_eq!(asked(&mut window), [UiCommand::Show(View::Setup)]);
        }
    }
}

#[test]
fn a_locator_fills_the_place_and_the_sun_tells_a_wrong_sign() {
    for size in SIZES {
        let mut window = window(size);
        let altitude =
            |window: &Window| window.get_by_role_and_label(Role::TextInput, "Altitude").rect();
        let before = altitude(&window);
        write(&mut window, "Locator", "KN41ob");
        assert_eq!(altitude(&window), before, "nothing moves under the pointer");
        assert_eq!(field(&window, "Latitude"), "41.0625");
        assert!(says(&window, "The centre of a square of 7.0 by 4.6 km."));
        assert!(says(&window, "Is that right?"));
        write(&mut window, "Longitude, east", "-150.6");
        assert!(says(&window, "below the horizon. Is that right?"));
        write(&mut window, "Locator", "KN41oz");
        assert!(says(&window, "Locator has a wrong character at place 6: it must be A to X."));
        assert_eq!(field(&window, "Longitude, east"), "-150.6", "what is wrong fills nothing");
    }
}

#[test]
fn the_place_of_a_reached_unit_can_be_taken() {
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        let antenna = add_and_test(&mut window, "unit.local:4001");
        tell(&mut window, &antenna, reached());
        assert!(says(&window, "Reached, SATRAK CU V1.2, 12 ms."));
        assert!(says(&window, "Its clock agrees with this computer's."));
        window.key_press_modifiers(Modifiers::ALT, Key::ArrowLeft);
        settle(&mut window);
        assert!(says(&window, "km from the position that Satrak reports. Which of them is right?"));
        press(&mut window, "Use the location of Satrak: 41.176° N, 29.613° E");
        assert_eq!(field(&window, "Latitude"), "41.17600");
        assert!(says(&window, "Agrees with the position that Satrak reports: 0.0 km apart."));
    }
}

#[test]
fn a_tested_antenna_stays_tested_when_its_element_file_is_typed() {
    let mut window = window(rig::LARGE);
    write_site(&mut window);
    press(&mut window, NEXT[0]);
    let none = "or none: Azel then predicts passes only.";
    assert!(says(&window, none));
    let antenna = add_and_test(&mut window, "unit.local:4001");
    assert!(!says(&window, none), "there is one");
    tell(&mut window, &antenna, reached());
    let again = "Test again of Satrak";
    assert!(window.query_by_role_and_label(Role::Button, again).is_some());
    write(&mut window, "Element file on the unit", "weather.txt");
    assert!(window.query_by_role_and_label(Role::Button, again).is_some());
    write(&mut window, "Address of the Satrak", "unit.local:4002");
    assert!(window.query_by_role_and_label(Role::Button, again).is_none());
}

#[test]
fn each_outcome_of_a_test_says_what_to_check() {
    for size in rig::sizes() {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        let antenna = add_and_test(&mut window, "unit.local:4001");
        let text = "SSH-2.0-OpenSSH_9.2".to_owned();
        for (finding, words) in [
            (LinkFinding::Silent, "Nothing came from unit.local:4001 in 2 s."),
            (LinkFinding::Closed, "unit.local:4001 closed the connection without an answer."),
            (
                LinkFinding::SomethingElse { text },
                "Something else answers at unit.local:4001: SSH-2.0-OpenSSH_9.2",
            ),
            (LinkFinding::NotOpened(LinkFault::Refused), "unit.local:4001 refuses the connection."),
            (LinkFinding::NotOpened(LinkFault::NobodyThere), "Nobody answers at unit.local:4001."),
        ] {
            tell(&mut window, &antenna, finding);
            assert!(says(&window, words), "{words}");
            assert!(says(&window, "Satrak: you can continue."), "{words}");
        }
        // The outcome applies only to the tested address.
        write(&mut window, "Address of the Satrak", "other.local:4001");
        assert!(!says(&window, "Nobody answers"));
        window.get_by_role_and_label(Role::Button, "Test link of Satrak");
    }
}

#[test]
fn a_unit_that_is_reached_with_a_fault_says_so_in_every_place() {
    let names = ["Sensor of rotator 2", "Limits of rotator 2", "Panic code"];
    let [sensor, limits, panic] =
        names.map(|name| Check::new(name, CheckState::Good, "Look there."));
    let reached_with = |checks: &[Check]| {
        let LinkFinding::Reached { after, mut state } = reached() else { panic!("it is reached") };
        state.checks = checks.into();
        LinkFinding::Reached { after, state }
    };
    let fault = Check { state: CheckState::Fault, ..sensor };
    let caution = Check { state: CheckState::Caution, ..limits };
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        let antenna = add_and_test(&mut window, "unit.local:4001");
        tell(&mut window, &antenna, reached_with(std::slice::from_ref(&panic)));
        assert!(says(&window, "reached, 12 ms"), "{size:?}");
        window.get_by_label_contains("1 of 1 reached");
        assert!(!says(&window, "you can continue"), "{size:?}");
        tell(&mut window, &antenna, reached_with(&[caution.clone(), panic.clone()]));
        assert!(says(&window, "reached, 1 warning"), "{size:?}");
        tell(&mut window, &antenna, reached_with(&[fault.clone(), caution.clone()]));
        assert!(says(&window, "reached, 1 fault"), "{size:?}");
        assert!(says(&window, "Sensor of rotator 2: Look there."), "{size:?}");
        window.get_by_label_contains("1 of 1 reached, 1 with a fault");
        let words = "Satrak: you can continue. Follow the advice above before you use it.";
        assert!(says(&window, words), "{size:?}");
        assert!(!says(&window, "Azel tries again"), "it was reached");
    }
}

#[test]
fn the_outcome_of_a_test_says_when_and_goes_on_counting() {
    for size in rig::sizes() {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        let antenna = add_and_test(&mut window, "unit.local:4001");
        for finding in [reached(), LinkFinding::Silent] {
            window.state_mut().model.now = rig::now();
            tell(&mut window, &antenna, finding);
            assert!(says(&window, "Tested just now."));
            for (minutes, words) in [(14, "Tested 14 min ago."), (15, "Tested 15 min ago.")] {
                window.state_mut().model.now =
                    rig::now() + jiff::SignedDuration::from_mins(minutes);
                settle(&mut window);
                assert!(says(&window, words), "{words}");
            }
        }
    }
}

#[test]
fn enter_in_an_address_tests_it_and_goes_on_once_it_was_tested() {
    let mut window = window(rig::LARGE);
    write_site(&mut window);
    press(&mut window, NEXT[0]);
    press(&mut window, &format!("Add {}", SPECS[0].name));
    write(&mut window, "Address of the Satrak", "unit.local:4001");
    window.key_press(Key::Enter);
    let tested = match <[UiCommand; 1]>::try_from(asked(&mut window)) {
        Ok([UiCommand::Station(contract::Command::TestLink(antenna))]) => *antenna,
        other => panic!("{other:?}"),
    };
    assert_eq!(tested.connection.address, "unit.local:4001");
    let test = LinkTest { antenna: tested.clone(), stage: LinkTestStage::Working };
    window.state_mut().model.shown_mut().link_tests = Arc::new(vec![test]);
    window.key_press(Key::Enter);
    assert_eq!(asked(&mut window), [], "it is being tested");
    assert!(is_at(&window, "Antennas"));
    tell(&mut window, &tested, LinkFinding::Silent);
    window.key_press(Key::Enter);
    settle(&mut window);
    assert!(is_at(&window, "Satellites"));
    window.get_by_label_contains("Step 2: Antennas, done, 0 of 1 reached");
}

#[test]
fn a_step_with_an_untested_antenna_has_no_tick() {
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        let antenna = add_and_test(&mut window, "unit.local:4001");
        press(&mut window, NEXT[1]);
        window.get_by_label_contains("Step 2: Antennas, 0 of 1 reached");
        tell(&mut window, &antenna, reached());
        window.get_by_label_contains("Step 2: Antennas, done, 1 of 1 reached");
    }
}

#[test]
fn an_address_of_the_demo_is_not_taken() {
    let mut window = window(rig::LARGE);
    write_site(&mut window);
    press(&mut window, NEXT[0]);
    let address = window.state().model.antennas[0].config.connection.address.clone();
    press(&mut window, &format!("Add {}", SPECS[0].name));
    write(&mut window, "Address of the Satrak", &address);
    assert!(says(&window, "Satrak: this address belongs to the demo station"));
    assert!(is_locked(&window, NEXT[1]));
}

#[test]
fn a_station_that_was_not_saved_says_why() {
    let mut window = window(rig::LARGE);
    for _ in 0..4 {
        press(&mut window, "Skip this step");
    }
    press(&mut window, FINISH);
    window.state_mut().views.saved(Err("the disk is full".to_owned()));
    settle(&mut window);
    assert!(says(&window, "Not saved: The disk is full."));
    assert!(!is_locked(&window, FINISH));
}

#[test]
fn every_button_is_in_the_window_and_is_named() {
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        for next in NEXT.into_iter().chain([FINISH]) {
            let right = window.get_by_role_and_label(Role::Button, next).rect();
            let left = window.get_by_role_and_label(Role::Button, "Back").rect();
            assert!(right.right() <= size[0] && right.bottom() <= size[1], "{right:?}");
            assert!(left.right() < right.left(), "{left:?} {right:?}");
            if next != FINISH {
                press(&mut window, next);
            }
        }
    }
}

#[test]
fn letters_of_a_name_are_no_commands() {
    let mut window = window(rig::LARGE);
    for key in [Key::A, Key::T, Key::P] {
        window.key_press(key);
    }
    window.event(Event::Text("atp".to_owned()));
    assert_eq!(asked(&mut window), []);
    assert_eq!(field(&window, "Name"), "atp", "the first field has the focus");
}

#[test]
fn the_reason_why_a_field_cannot_be_used_moves_nothing_below_it() {
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        let places = |window: &Window, below: &[&str]| -> Vec<_> {
            below.iter().map(|label| window.get_by_label(label).rect()).collect()
        };
        let below = ["Longitude, east", "Altitude", NEXT[0]];
        let before = places(&window, &below);
        write(&mut window, "Latitude", "91");
        assert!(says(&window, "Latitude must be"), "{size:?}");
        assert_eq!(places(&window, &below), before, "{size:?}");
        write(&mut window, "Latitude", "41");
        press(&mut window, NEXT[0]);
        press(&mut window, &format!("Add {}", SPECS[0].name));
        let below = ["Test link of Satrak", "Remove Satrak"];
        write(&mut window, "Address of the Satrak", "unit.local:4001");
        let before = places(&window, &below);
        write(&mut window, "Address of the Satrak", "unit.local:");
        let why = "Address of the Satrak must have a port from 1 to 65535 after the host.";
        assert!(says(&window, why), "{size:?}");
        assert!(!says(&window, &format!("{why} Use")), "an address of nobody is no cure");
        assert_eq!(places(&window, &below), before, "{size:?}");
    }
}

#[test]
fn the_note_of_a_field_that_is_filled_stays_and_moves_no_button() {
    for size in SIZES {
        let mut window = window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        press(&mut window, &format!("Add {}", SPECS[0].name));
        let place = |window: &Window| window.get_by_label("Test link of Satrak").rect();
        let before = place(&window);
        write(&mut window, "Element file on the unit", "active.txt");
        assert_eq!(place(&window), before);
    }
}
