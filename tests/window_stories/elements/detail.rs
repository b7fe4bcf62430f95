//! The selected object in detail.

use std::sync::Arc;

use azel::{
    contract,
    device::HeldSatellite,
    model::{UiCommand, View},
    station::{self, Frequency, Priority},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use super::{METEOR_M2_3, click, is_disabled, view};
use crate::window_stories::{
    rig::{self, NOAA_20, SIZES, Window, asked, says, settle},
    states,
};

#[test]
fn the_selected_row_is_shown_in_detail_with_its_priority() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        if size == rig::SMALL {
            click(&mut window, "Details");
        }
        assert!(says(&window, "NOAA 20 (JPSS-1), 43013, 2017-073A"));
        assert!(says(&window, "Inclination: 98."));
        assert!(says(&window, "Priority 3"));
        click(&mut window, "More important");
        let numbers = vec![NOAA_20];
        let priority = Priority::ALL[1];
        let wanted = contract::Command::SetPriority { numbers, priority };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
    }
}

pub(super) fn detail(window: &mut Window, size: [f32; 2]) {
    if size == rig::SMALL {
        click(window, "Details");
    }
}

#[test]
fn the_detail_says_what_each_antenna_holds() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Satrak: What it holds has not been read yet."));
        let hold = |window: &mut Window, number: u32, name: &str| {
            let antenna = &mut window.state_mut().model.shown_mut().antennas[0];
            Arc::make_mut(&mut antenna.snapshot).state.on_board.satellite = Some(HeldSatellite {
                catalog_number: number,
                name: name.to_owned(),
                maximum_elevation_deg: None,
            });
            settle(window);
        };
        hold(&mut window, METEOR_M2_3, "METEOR-M2 3");
        assert!(says(&window, "Satrak: Holds another satellite, METEOR-M2 3."));
        hold(&mut window, NOAA_20, "NOAA 20");
        assert!(says(&window, "Satrak: Holds this satellite; it does not report the epoch"));
        let model = &mut window.state_mut().model;
        let mut genius = station::Antenna::genius("Genius", "192.168.1.250:9006");
        genius.id = station::AntennaId(7);
        model.shown_mut().antennas.push(rig::antenna(genius, rig::quiet()));
        settle(&mut window);
        assert!(says(&window, "Genius: Stores no elements: Azel tracks with the set in use."));
    }
}

#[test]
fn the_detail_lists_the_next_passes_and_opens_one_on_the_sky_plot() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Next passes, floor 10°"));
        let key = window.state().model.catalog_table.detail.as_ref().unwrap().passes[0].key();
        let passes: Vec<_> = window.query_all_by_label_contains("Pass at ").collect();
        assert_eq!(passes.len(), 3);
        passes[0].scroll_to_me();
        settle(&mut window);
        let passes: Vec<_> = window.query_all_by_label_contains("Pass at ").collect();
        passes[0].click();
        let wanted = [UiCommand::SelectPass(key), UiCommand::Show(View::Operate)];
        assert_eq!(asked(&mut window), wanted);
    }
}

#[test]
fn frequencies_are_changed_beside_the_elements() {
    let mut window = view([1440.0, 1200.0], Vec::new());
    let own = Frequency::read_list("43013 7812 HRD").unwrap();
    Arc::make_mut(&mut window.state_mut().model.shown_mut().station).frequencies = own;
    settle(&mut window);
    assert!(says(&window, "7812.000 MHz HRD"));
    click(&mut window, "Edit frequencies");
    let field = "Frequencies, one per line";
    window.get_by_role_and_label(Role::MultilineTextInput, field).focus();
    settle(&mut window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text("x".to_owned()));
    settle(&mut window);
    assert!(is_disabled(&window, "Save frequencies"));
    assert!(says(&window, "Each line must be MHz and a name"));
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text("7812 HRD, X band".to_owned()));
    settle(&mut window);
    click(&mut window, "Save frequencies");
    let frequencies = Frequency::read_list("43013 7812 HRD, X band").unwrap();
    let wanted = contract::Command::SetFrequencies { satellite: NOAA_20, frequencies };
    assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
    assert!(!says(&window, "Each line must be"));
}

#[test]
fn the_elements_are_copied_as_tle_and_omm() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        for (button, start) in
            [("TLE", "NOAA 20 (JPSS-1)\n1 43013U"), ("OMM", "[\n{\"OBJECT_NAME\"")]
        {
            window.get_by_role_and_label(Role::Button, button).click();
            window.step();
            let copied = copied(&window);
            assert!(copied.starts_with(start), "{button}: {copied}");
        }
    }
}

/// Returns the text that the last frame copied.
fn copied(window: &Window) -> String {
    let commands = &window.output().platform_output.commands;
    let text = commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    text.unwrap_or_default()
}

#[test]
fn a_favourite_without_a_pass_is_there_to_be_uploaded() {
    let mut model = rig::model(states::holding());
    model.view = View::Elements;
    model.selected = None;
    let window = rig::window(rig::LARGE, model);
    assert!(!says(&window, "Click a satellite in the table"));
    assert!(window.query_by_label("Upload to Satrak").is_some());
}
