//! The catalogue as a table, the marked objects, and the refused records.

use std::sync::Arc;

use azel::{
    contract::{self, CatalogState},
    model::{
        UiCommand, View,
        export::{ElementForm, Export},
    },
    orbit::{Refusal, RefusalReason},
    station::{PassLimits, SatelliteGroup},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};

use super::{METEOR_M2_3, click, file_source, is_disabled, report, server, view, write};
use crate::window_stories::rig::{self, NOAA_20, SIZES, Window, asked, says, settle};

/// Returns the names of the rows in view.
fn rows(window: &Window) -> Vec<String> {
    let rows = window.query_all_by_role(Role::ListBoxOption);
    let names = rows.map(|row| row.accesskit_node().label().unwrap_or_default());
    // Leave out the rows of the selected object's passes.
    names.filter(|name| name.contains(", elements ")).collect()
}

#[test]
fn the_catalog_is_searched_by_name_number_and_designator() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        window.event(Event::Text("meteor-m2 3".to_owned()));
        settle(&mut window);
        assert_eq!(rows(&window).len(), 1);
        window.get_by_label_contains("METEOR-M2 3, 57166, elements ");
        write(&mut window, "Search the catalogue", "43013");
        window.get_by_label_contains("NOAA 20 (JPSS-1), 43013, elements ");
        write(&mut window, "Search the catalogue", "1998-067A");
        window.get_by_label_contains("ISS (ZARYA), 25544, ");
        write(&mut window, "Search the catalogue", "no such");
        assert!(says(&window, "No object matches \"no such\"."));
    }
}

#[test]
fn groups_choose_what_is_shown() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let chip = |window: &mut Window, name: &str| {
            window.get_by_role_and_label(Role::RadioButton, name).click();
            settle(window);
        };
        chip(&mut window, "Favourites, 5");
        assert_eq!(rows(&window).len(), 5);
        write(&mut window, "Search the catalogue", "starlink");
        assert!(says(&window, "No object matches \"starlink\" here. Choose All"));
        chip(&mut window, "All, 16\u{2009}089");
        assert!(rows(&window).len() > 5);
    }
}

#[test]
fn a_click_on_a_head_sorts_and_the_next_one_turns_the_order() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "meteor");
        click(&mut window, "Sort by number");
        let up = rows(&window);
        click(&mut window, "Sort by number, ascending");
        let mut down = rows(&window);
        down.reverse();
        assert!(up.len() > 2);
        assert_eq!(up, down);
        for column in ["epoch age", "next pass", "source", "maximum elevation", "priority"] {
            click(&mut window, &format!("Sort by {column}"));
            assert_eq!(rows(&window).len(), up.len(), "{column}");
        }
    }
}

#[test]
fn only_rows_in_view_are_built() {
    for size in rig::sizes() {
        let window = view(size, Vec::new());
        assert!((5..40).contains(&rows(&window).len()), "{}", rows(&window).len());
    }
}

fn favour(number: u32, is_favourite: bool) -> UiCommand {
    let numbers = vec![number];
    UiCommand::Station(contract::Command::SetFavourites { numbers, is_favourite })
}

#[test]
fn satellites_are_followed_and_unfollowed_by_their_star() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "57166");
        click(&mut window, "Add METEOR-M2 3 to the favourites");
        assert_eq!(asked(&mut window), [favour(METEOR_M2_3, true)]);
        write(&mut window, "Search the catalogue", "43013");
        click(&mut window, "Remove NOAA 20 (JPSS-1) from the favourites");
        assert_eq!(asked(&mut window), [favour(NOAA_20, false)]);
    }
}

#[test]
fn rows_are_marked_by_mouse_and_keys_and_changed_together() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "meteor-m2");
        click(&mut window, "Sort by number");
        let count = rows(&window).len();
        assert!(count >= 3);
        let at = |window: &Window, index: usize| {
            let name = rows(window)[index].clone();
            window.get_by_role_and_label(Role::ListBoxOption, &name).rect().center()
        };
        let first = at(&window, 0);
        window.hover_at(first);
        window.drag_at(first);
        window.drop_at(first);
        settle(&mut window);
        window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        settle(&mut window);
        assert!(says(&window, "2 selected"));
        window.key_press(Key::ArrowDown);
        settle(&mut window);
        window.key_press(Key::Space);
        settle(&mut window);
        assert!(says(&window, "3 selected"));
        window.key_press(Key::Num1);
        let commands = asked(&mut window);
        let [UiCommand::Station(contract::Command::SetPriority { numbers, priority })] =
            &commands[..]
        else {
            panic!("{commands:?}");
        };
        assert_eq!((numbers.len(), priority.number()), (3, 1));
        window.key_press(Key::F);
        let commands = asked(&mut window);
        let is_of_all = |command: &UiCommand| {
            matches!(command, UiCommand::Station(contract::Command::SetFavourites { numbers, .. })
                if numbers.len() == 3)
        };
        assert!(commands.iter().all(is_of_all) && commands.len() == 1, "{commands:?}");
        click(&mut window, "Clear");
        assert!(!says(&window, "selected"));
        window.get_by_role_and_label(Role::ListBox, "Catalogue").focus();
        settle(&mut window);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        settle(&mut window);
        assert!(says(&window, &format!("{count} selected")));
    }
}

#[test]
fn refused_records_have_their_place_and_reason() {
    for size in SIZES {
        let own = file_source();
        let mut held = report(&own, 12);
        held.files[0].merge.refused = vec![Refusal {
            line: 1207,
            object: Some("OBJECT M".to_owned()),
            reason: RefusalReason::Checksum { line: 2, found: 7, expected: 4 },
        }];
        let mut window = view(size, vec![(own, held)]);
        assert!(!says(&window, "own, line 1207"));
        window.get_by_label_contains("1 refused record. The previous elements stay").click();
        settle(&mut window);
        let words = "own, line 1207, OBJECT M: The checksum of line 2 is 7, the line gives 4.";
        assert!(says(&window, words));
    }
}

#[test]
fn what_is_typed_in_the_preferences_is_not_overtaken() {
    let mut window = view(rig::LARGE, Vec::new());
    window.state_mut().model.view = View::Preferences;
    settle(&mut window);
    write(&mut window, "Latitude", "1");
    window.state_mut().model.view = View::Elements;
    settle(&mut window);
    write(&mut window, "Search the catalogue", "43013");
    assert!(is_disabled(&window, "Remove NOAA 20 (JPSS-1) from the favourites"));
    window.get_by_role_and_label(Role::CheckBox, "Mark all that are shown").click();
    settle(&mut window);
    assert!(says(&window, "Save or revert the preferences before you change favourites."));
}

#[test]
fn without_elements_there_is_still_a_way_to_add_some() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        window.state_mut().model.shown_mut().catalog = CatalogState::Failed;
        settle(&mut window);
        assert!(says(&window, "There are no elements."));
        assert!(says(&window, "There is nothing to search."));
        click(&mut window, "Add a source");
        click(&mut window, "CelesTrak active");
        assert!(!is_disabled(&window, "Add source"));
    }
}

#[test]
fn every_control_is_whole_in_every_window() {
    for size in [rig::LARGE, [1200.0, 800.0], rig::SMALL] {
        let window = view(size, vec![server(3.0)]);
        for role in [Role::Button, Role::TextInput, Role::RadioButton, Role::CheckBox] {
            for node in window.query_all_by_role(role) {
                let name = node.accesskit_node().label().unwrap_or_default();
                // The window may cut the last row.
                let is_of_row = name.ends_with("favourites") || name.starts_with("Mark ");
                let most = if is_of_row { size[1] + 50.0 } else { size[1] };
                let rect = node.rect();
                assert!(rect.right() <= size[0] && rect.bottom() <= most, "{name} {rect}");
            }
        }
    }
}

#[test]
fn groups_of_the_operator_stand_behind_those_of_the_sources() {
    let mut window = view([1700.0, 900.0], Vec::new());
    let weather = SatelliteGroup {
        name: "weather".to_owned(),
        satellites: vec![NOAA_20, METEOR_M2_3, 999],
        priority: None,
        limits: PassLimits::default(),
    };
    Arc::make_mut(&mut window.state_mut().model.shown_mut().station).groups = vec![weather];
    settle(&mut window);
    window.get_by_role_and_label(Role::RadioButton, "weather, your group, 2").click();
    settle(&mut window);
    assert_eq!(rows(&window).len(), 2, "one is not held");
    Arc::make_mut(&mut window.state_mut().model.shown_mut().station).groups.clear();
    settle(&mut window);
    assert!(rows(&window).len() > 2, "the group is gone");
}

#[test]
fn what_is_listed_or_marked_is_exported() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let export = |window: &mut Window, list: &str, form: &str| {
            window.get_by_role_and_label(Role::ComboBox, list).click();
            settle(window);
            click(window, form);
            asked(window)
        };
        write(&mut window, "Search the catalogue", "meteor-m2 3");
        asked(&mut window);
        let save = |numbers: &[u32], form| {
            [UiCommand::Save(Export::Elements { numbers: numbers.into(), form })]
        };
        let list = "Export the 1 listed";
        let saved = export(&mut window, list, "TLE\u{2026}");
        assert_eq!(saved, save(&[METEOR_M2_3], ElementForm::Tle));
        click_mark(&mut window, "Mark METEOR-M2 3");
        write(&mut window, "Search the catalogue", "noaa 20 ");
        click_mark(&mut window, "Mark NOAA 20 (JPSS-1)");
        asked(&mut window);
        let saved = export(&mut window, "Export the 2 marked", "OMM, CSV\u{2026}");
        assert_eq!(saved, save(&[NOAA_20, METEOR_M2_3], ElementForm::OmmCsv));
    }
}

fn click_mark(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::CheckBox, name).click();
    settle(window);
}

#[test]
fn a_key_opens_the_upload_of_the_selected_row() {
    let mut window = view(rig::LARGE, Vec::new());
    write(&mut window, "Search the catalogue", "meteor-m2 3");
    window.get_by_label_contains("METEOR-M2 3, 57166, elements ").click();
    settle(&mut window);
    window.key_press(Key::U);
    settle(&mut window);
    window.get_by_role_and_label(Role::Button, "Back to the elements");
}

#[test]
fn the_inspector_uploads_its_satellite_beside_the_followed_ones() {
    let mut window = view(rig::LARGE, Vec::new());
    let followed = window.state().model.station.favourites.numbers().len();
    write(&mut window, "Search the catalogue", "meteor-m2 3");
    window.get_by_label_contains("METEOR-M2 3, 57166, elements ").click();
    settle(&mut window);
    click(&mut window, "Upload to Satrak");
    assert!(says(&window, &format!("{} satellites to send", followed + 1)));
    let leave_out = |node: &Node<'_>| {
        node.accesskit_node()
            .label()
            .is_some_and(|label| label.starts_with("Leave out METEOR-M2 3"))
    };
    assert_eq!(window.query_all_by_role(Role::Button).filter(leave_out).count(), 1);
}
