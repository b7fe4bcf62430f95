//! Menus of rows, bars, satellites and the sky, by mouse and by key.

use azel::{
    astro::AzEl,
    contract,
    contract::driver::Command,
    model::{UiCommand, View},
    station::AntennaId,
};
use egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, LARGE, Window, asked, settle},
    sky::zenith,
    states,
};

const METEOR_M2_4: u32 = 59_051;
const EUTELSAT_7C: u32 = 44_334;
const BAR: &str = "METEOR-M2 4, 12:44Z to 12:56Z, max 49°";
const ROW: &str = "METEOR-M2 4, AOS T−1:28:51, max 49°, Trackable";

fn window(size: [f32; 2]) -> Window {
    rig::window(size, rig::model(states::holding()))
}

fn meteor(window: &Window) -> azel::contract::passes::PassListKey {
    let model = &window.state().model;
    let mut passes = model.pass_lists.favourites.passes.iter();
    let is_it = |pass: &&azel::contract::passes::PredictedPass| {
        pass.number() == METEOR_M2_4 && pass.pass.aos.time > model.now
    };
    passes.find(is_it).unwrap().key()
}

fn choose(window: &mut Window, entry: &str) -> Vec<UiCommand> {
    settle(window);
    window.get_by_role_and_label(Role::Button, entry).click();
    let commands = asked(window);
    assert!(window.query_by_role_and_label(Role::Button, entry).is_none(), "the menu is closed");
    commands
}

#[test]
fn a_bar_and_a_row_offer_what_can_be_done_with_their_pass() {
    let mut window = window(LARGE);
    let pass = meteor(&window);
    for place in [BAR, ROW] {
        window.get_by_label(place).click_secondary();
        assert_eq!(choose(&mut window, "Select"), [UiCommand::SelectPass(pass)]);
        window.get_by_label(place).click_secondary();
        let elements = [UiCommand::InspectObject(METEOR_M2_4), UiCommand::Show(View::Elements)];
        let commands = choose(&mut window, "Open in Elements");
        assert!(commands.iter().all(|command| elements.contains(command)), "{commands:?}");
        assert!(!commands.is_empty());
        window.get_by_label(place).click_secondary();
        let unmark =
            contract::Command::SetFavourites { numbers: vec![METEOR_M2_4], is_favourite: false };
        assert_eq!(choose(&mut window, "Remove from favourites"), [UiCommand::Station(unmark)]);
        // Azel asks before it tracks.
        window.get_by_label(place).click_secondary();
        assert_eq!(choose(&mut window, "Track with Satrak…"), []);
        window.get_by_label_contains("Track METEOR-M2 4 with Satrak? The antenna moves");
        window.key_press(Key::Enter);
        let track = contract::Command::Track { antenna: AntennaId(1), pass, is_agreed: false };
        assert_eq!(asked(&mut window), [UiCommand::Station(track)]);
    }
}

#[test]
fn a_menu_opens_by_key_and_its_first_entry_has_the_focus() {
    for (key, modifiers) in [(Key::F10, Modifiers::SHIFT), (Key::Menu, Modifiers::NONE)] {
        let mut window = window(LARGE);
        let pass = meteor(&window);
        window.get_by_label(BAR).focus();
        settle(&mut window);
        window.key_press_modifiers(modifiers, key);
        settle(&mut window);
        assert!(window.get_by_role_and_label(Role::Button, "Select").is_focused(), "{key:?}");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [UiCommand::SelectPass(pass)]);
    }
}

#[test]
fn a_track_that_runs_is_named_before_another_begins() {
    let mut window = rig::window(LARGE, rig::model(states::tracking(0.0)));
    window.get_by_label(BAR).click_secondary();
    assert_eq!(choose(&mut window, "Track with Satrak…"), []);
    window.get_by_label_contains("Satrak tracks NOAA 20 until");
    window.get_by_label_contains("Tracking METEOR-M2 4, which rises in");
}

#[test]
fn a_satellite_of_the_sky_is_selected_tracked_or_pointed_at_from_its_menu() {
    for size in rig::sizes() {
        let mut window = window(size);
        let satellite = "EUTELSAT 7C, azimuth 211.8°";
        window.get_by_label_contains(satellite).click_secondary();
        assert_eq!(choose(&mut window, "Select"), [UiCommand::SelectSatellite(EUTELSAT_7C)]);
        window.get_by_label_contains(satellite).click_secondary();
        let commands = choose(&mut window, "Point Satrak here…");
        let [UiCommand::Station(contract::Command::Antenna(_, Command::Preview(Some(to))))] =
            &commands[..]
        else {
            panic!("{commands:?}")
        };
        assert!((to.azimuth.unwrap().degrees() - 211.8).abs() < 0.06);
        window.get_by_role_and_label(Role::Button, "Point here");
    }
}

#[test]
fn the_sky_itself_has_a_menu_where_the_pointer_is() {
    let mut window = window(LARGE);
    let at = zenith(&window) + vec2(0.0, 60.0);
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.hover_at(at);
    settle(&mut window);
    window.input_mut().events.extend([true, false].map(press));
    let commands = choose(&mut window, "Point Satrak here…");
    let [UiCommand::Station(contract::Command::Antenna(_, Command::Preview(Some(to))))] =
        &commands[..]
    else {
        panic!("{commands:?}")
    };
    let to = AzEl { azimuth: to.azimuth.unwrap(), elevation: to.elevation.unwrap() };
    assert!((to.azimuth_deg() - 180.0).abs() < 0.1 && to.elevation_deg() > 60.0, "{to:?}");
    let note = window.get_by_label_contains("Satrak to 180").accesskit_node().value();
    assert!(note.unwrap().contains("The path is being checked."));
}
