//! Settings of the station, which the operator types, corrects, saves and reverts.

use std::sync::Arc;

use azel::{
    clock::Instant,
    contract::{
        self,
        driver::{LinkFault, LinkFinding, LinkLoss, LinkState, Snapshot},
        link_tests::{LinkTest, LinkTestStage},
    },
    model::{Model, UiCommand, View},
    station::Station,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    rig::{self, SIZES, Window, says, settle},
    states,
};

const WRONG: &str = "Latitude must be a number from −90 to 90°.";

pub(crate) fn form(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Preferences;
    rig::window(size, model)
}

/// Shows the page with this title.
pub(crate) fn open(window: &mut Window, page: &str) {
    window.get_by_role_and_label(Role::RadioButton, page).click();
    settle(window);
}

/// Returns the form at the page of the antenna.
pub(crate) fn antenna_form(size: [f32; 2]) -> Window {
    let mut window = form(size);
    open(&mut window, "Satrak");
    window
}

/// Adds an antenna of this make, whose page then opens.
pub(crate) fn add(window: &mut Window, make: &str) {
    window.get_by_role_and_label(Role::ComboBox, "Add an antenna").click();
    settle(window);
    window.get_by_role_and_label(Role::Button, make).click();
    settle(window);
}

/// Returns the commands other than requests for the effect of an antenna's edits.
pub(crate) fn asked(window: &mut Window) -> Vec<UiCommand> {
    let mut commands = rig::asked(window);
    commands.retain(|command| !matches!(command, UiCommand::ShowTracked(_)));
    commands
}

/// Replaces the text in a field of the station by `words`.
pub(crate) fn write(window: &mut Window, field: &str, words: &str) {
    // The label beside the field has the same words.
    let is_field = |role| matches!(role, Role::TextInput | Role::MultilineTextInput);
    let fields = window.get_all_by_label(field);
    let first = fields.into_iter().find(|node| is_field(node.accesskit_node().role()));
    first.expect("such a field").focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

#[test]
fn tab_into_a_field_selects_its_value_and_a_click_does_not() {
    let mut window = form(rig::LARGE);
    let field = |window: &Window| {
        let field = window.get_by_role_and_label(Role::TextInput, "Latitude");
        field.value().unwrap_or_default()
    };
    window.get_by_role_and_label(Role::TextInput, "Name").focus();
    settle(&mut window);
    window.key_press(Key::Tab);
    settle(&mut window);
    window.event(Event::Text("52.5".to_owned()));
    settle(&mut window);
    assert_eq!(field(&window), "52.5", "typed over the old value");
    let place = window.get_by_role_and_label(Role::TextInput, "Latitude").rect().right_center();
    let place = place - egui::vec2(8.0, 0.0);
    window.get_by_role_and_label(Role::TextInput, "Longitude, east").focus();
    settle(&mut window);
    window.drag_at(place);
    window.drop_at(place);
    settle(&mut window);
    window.event(Event::Text("1".to_owned()));
    settle(&mut window);
    assert_eq!(field(&window), "52.51", "set into it");
}

fn is_disabled(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

pub(crate) fn saved(commands: Vec<UiCommand>) -> Station {
    match <[UiCommand; 1]>::try_from(commands) {
        Ok([UiCommand::Station(contract::Command::SaveStation(station))]) => *station,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_form_opens_from_rail_menu_and_key() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Preferences").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num6);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num1);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Operate)]);
        window.get_by_label("Station Şile 1").click();
        settle(&mut window);
        window.get_by_label("Station settings…").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
    }
}

#[test]
fn a_wrong_field_says_why_and_cannot_be_saved() {
    for size in rig::sizes() {
        let mut window = form(size);
        assert!(is_disabled(&window, "Save and use"), "nothing is edited");
        write(&mut window, "Latitude", "91");
        assert!(says(&window, WRONG) && says(&window, "1 field is not valid: Latitude in Site."));
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        assert_eq!(asked(&mut window), []);
        let field = window.get_by_role_and_label(Role::TextInput, "Latitude");
        assert_eq!(field.value().as_deref(), Some("91"));
    }
}

#[test]
fn right_fields_are_saved_as_typed() {
    for size in rig::sizes() {
        let mut window = form(size);
        write(&mut window, "Latitude", "91");
        write(&mut window, "Latitude", "−33,5");
        assert!(!says(&window, WRONG) && says(&window, "1 change"));
        open(&mut window, "Satellites and priorities");
        write(&mut window, "Satellites", "25544, 43013");
        assert!(says(&window, "2 changes in 2 sections"));
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        let station = saved(asked(&mut window));
        assert!((station.site.latitude().degrees() + 33.5).abs() < 1e-9);
        assert_eq!(station.favourites.numbers(), [25_544, 43_013]);
        assert_eq!(station.antennas, rig::station().antennas);
    }
}

#[test]
fn revert_brings_back_what_is_used() {
    for size in rig::sizes() {
        let mut window = form(size);
        assert!(is_disabled(&window, "Revert"));
        write(&mut window, "Latitude", "x");
        window.get_by_role_and_label(Role::Button, "Revert").click();
        assert_eq!(asked(&mut window), []);
        assert!(!says(&window, WRONG) && says(&window, "Nothing to save."));
        let field = window.get_by_role_and_label(Role::TextInput, "Latitude");
        assert_eq!(field.value().as_deref(), Some("41.02"));
    }
}

#[test]
fn what_was_typed_survives_another_view() {
    for size in rig::sizes() {
        let mut window = form(size);
        write(&mut window, "Latitude", "91");
        for view in [View::Operate, View::Preferences] {
            window.state_mut().model.view = view;
            settle(&mut window);
        }
        assert!(says(&window, WRONG));
    }
}

#[test]
fn an_antenna_is_added_and_removed() {
    for size in rig::sizes() {
        let mut window = form(size);
        add(&mut window, "Add SVS Satrak");
        assert!(says(&window, "Satrak 2. SVS Satrak, X/Y"), "its page is shown");
        assert!(says(&window, "Satrak 2: 1 edited"));
        press(&mut window, "Save and use");
        assert_eq!(saved(asked(&mut window)).antennas.len(), 2);
        let mut window = antenna_form(size);
        press(&mut window, "Remove antenna");
        assert!(says(&window, "Satrak is removed from the station with its settings."));
        press(&mut window, "Save and use");
        assert_eq!(saved(asked(&mut window)).antennas.len(), 0);
    }
}

#[test]
fn the_fields_of_a_new_antenna_are_new() {
    for size in SIZES {
        let mut window = form(size);
        add(&mut window, "Add SVS Satrak");
        let texts = painted::texts(&window);
        assert!(texts.iter().filter(|of| *of == "New").count() > 5, "{texts:?}");
    }
}

#[test]
fn a_removal_is_undone_in_place_and_a_double_click_removes_nothing() {
    for size in SIZES {
        let mut window = antenna_form(size);
        let place = window.get_by_role_and_label(Role::Button, "Remove antenna").rect().center();
        for (said, is_removed) in [("Undo: keep it", true), ("Remove antenna", false)] {
            window.drag_at(place);
            window.drop_at(place);
            settle(&mut window);
            assert!(window.get_by_role_and_label(Role::Button, said).rect().contains(place));
            assert_eq!(says(&window, "It is removed when you save."), is_removed);
        }
        assert!(is_disabled(&window, "Save and use"), "nothing is edited");
    }
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

#[test]
fn a_duplicate_has_all_but_the_name_and_the_address() {
    for size in rig::sizes() {
        let mut window = antenna_form(size);
        write(&mut window, "Beamwidth", "1.7");
        press(&mut window, "Duplicate");
        press(&mut window, "Save and use");
        let station = saved(asked(&mut window));
        let [first, second] = &station.antennas[..] else { panic!("{:?}", station.antennas) };
        assert_eq!((&*first.name, &*second.name), ("Satrak", "Satrak 2"));
        assert_ne!(first.id, second.id);
        assert_eq!(second.connection.address, first.connection.spec().default_address);
        assert!((second.beam_width_deg - 1.7).abs() < 1e-9);
    }
}

#[test]
fn a_link_is_tested_as_it_is_typed() {
    for size in rig::sizes() {
        let mut window = antenna_form(size);
        write(&mut window, "Address of the Satrak", "nowhere");
        assert!(is_disabled(&window, "Test link"));
        write(&mut window, "Address of the Satrak", "tower:4001");
        press(&mut window, "Test link");
        let [UiCommand::Station(contract::Command::TestLink(antenna))] = &asked(&mut window)[..]
        else {
            panic!("no test")
        };
        assert_eq!(antenna.connection.address, "tower:4001");
        let finding = LinkFinding::NotOpened(LinkFault::Refused);
        let done = LinkTestStage::Done { finding, time: rig::now() };
        for (stage, words) in [
            (done, "tower:4001 refuses the connection."),
            (LinkTestStage::InUse, "Not asked: an antenna of this station uses the unit."),
        ] {
            let test = LinkTest { antenna: (**antenna).clone(), stage };
            window.state_mut().model.shown_mut().link_tests = Arc::new(vec![test]);
            settle(&mut window);
            assert!(says(&window, words), "{words}");
        }
        write(&mut window, "Address of the Satrak", "tower:4002");
        assert!(!says(&window, "Not asked:"), "the outcome is of another address");
    }
}

#[test]
fn it_says_what_came_of_saving() {
    for size in rig::sizes() {
        let mut window = form(size);
        window.state_mut().views.saved(Err("the disk is full".to_owned()));
        settle(&mut window);
        assert!(says(&window, "Not saved: the disk is full."));
        let now = rig::now();
        window.state_mut().views.saved(Ok(now));
        settle(&mut window);
        assert!(says(&window, "Saved 11:15:30Z."));
    }
}

#[test]
fn the_demo_station_is_taken_over_without_its_antennas() {
    for size in SIZES {
        let mut model: Model = rig::model(states::holding());
        (model.shown_mut().demo, model.view) = (true, View::Preferences);
        let before = Station::clone(&model.station);
        assert_eq!(before.antennas.len(), 1);
        let mut window = rig::window(size, model);
        assert!(says(&window, "Saving ends the demo and uses this station."));
        assert!(window.query_by_label("Save and use").is_none(), "the button says what ends");
        window.get_by_role_and_label(Role::Button, "Save and end the demo").click();
        let name = "Station".to_owned();
        let wanted = Station { name, antennas: Vec::new(), ..before };
        assert_eq!(saved(asked(&mut window)), wanted);
    }
}

#[test]
fn in_the_demo_all_pages_are_about_the_new_station() {
    for size in SIZES {
        let mut model: Model = rig::model(states::holding());
        (model.shown_mut().demo, model.view) = (true, View::Preferences);
        let mut window = rig::window(size, model);
        assert!(says(&window, "Preferences of your new station"));
        open(&mut window, "Site");
        for of_the_demo in ["Satrak", "demo, not saved", "Recording", "Nothing is recorded"] {
            assert!(!says(&window, of_the_demo), "{of_the_demo}");
        }
        open(&mut window, "Horizon and keep-outs");
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|text| text == "No antenna yet"));
        assert!(!texts.iter().any(|text| text.starts_with("Shown: Satrak")));
    }
}

#[test]
fn a_page_that_is_used_at_once_has_nothing_to_save() {
    for is_demo in [true, false] {
        let mut model = rig::model(states::holding());
        (model.shown_mut().demo, model.view) = (is_demo, View::Preferences);
        let mut window = rig::window(rig::LARGE, model);
        let save = if is_demo { "Save and end the demo" } else { "Save and use" };
        open(&mut window, "Appearance");
        assert!(is_disabled(&window, save));
        assert!(says(&window, "Changes on this page are applied at once."));
        open(&mut window, "Site");
        write(&mut window, "Name", "Şile 2");
        open(&mut window, "Appearance");
        assert!(!is_disabled(&window, save), "of another page");
        assert!(says(&window, "1 change"));
    }
}

#[test]
fn a_letter_that_is_typed_is_no_command() {
    for size in rig::sizes() {
        let mut window = form(size);
        window.get_by_role_and_label(Role::TextInput, "Latitude").focus();
        settle(&mut window);
        for key in [Key::A, Key::T, Key::M, Key::N, Key::P] {
            window.key_press(key);
        }
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn every_field_and_the_bar_below_are_whole_in_every_window() {
    const WIDE: [[f32; 2]; 2] = [[1920.0, 1080.0], [2560.0, 1440.0]];
    for (size, columns) in SIZES.into_iter().chain(WIDE).zip([1, 1, 2, 3]) {
        let mut model = rig::model(states::holding());
        model.view = View::Preferences;
        Arc::make_mut(&mut model.shown_mut().station).favourites = Station::default().favourites;
        let mut window = rig::window(size, model);
        let bar = window.get_by_role_and_label(Role::Button, "Save and use").rect();
        assert!(bar.right() <= size[0] && bar.bottom() <= size[1], "{bar:?}");
        let card = window.get_by_role_and_label(Role::TextInput, "Latitude").rect();
        open(&mut window, "Satellites and priorities");
        let all = window.get_by_role_and_label(Role::MultilineTextInput, "Satellites").rect();
        assert!(all.right() < size[0] && all.height() > card.height(), "{all:?}");
        open(&mut window, "Satrak");
        let fields: Vec<_> = window.query_all_by_role(Role::TextInput).collect();
        let mut lefts: Vec<i32> = fields.iter().map(|node| node.rect().left() as i32).collect();
        // Leave out the search, which is in the list.
        lefts.retain(|left| *left > 232 + 72);
        lefts.sort_unstable();
        lefts.dedup();
        assert_eq!(lefts.len(), columns, "{size:?}: {lefts:?}");
        let preview = window.query_by_label_contains("An X/Y mount");
        assert_eq!(preview.is_some(), size != rig::SMALL, "beside the fields, or a fold");
    }
}

#[test]
fn two_antennas_of_one_name_are_not_saved_and_a_free_one_is_offered() {
    for size in rig::sizes() {
        let mut window = form(size);
        add(&mut window, "Add SVS Satrak");
        write(&mut window, "Name", "satrak ");
        assert!(says(&window, "Name must differ from those of the other antennas."));
        assert!(is_disabled(&window, "Save and use"));
        press(&mut window, "Use satrak 2");
        assert!(!is_disabled(&window, "Save and use"));
    }
}

#[test]
fn an_antenna_that_moves_is_not_let_go_by_saving() {
    let changed = |snapshot| {
        let mut model = rig::model(snapshot);
        model.view = View::Preferences;
        let mut window = rig::window(SIZES[0], model);
        open(&mut window, "Satrak");
        write(&mut window, "Beamwidth", "3");
        window
    };
    for snapshot in [states::moving(), states::tracking(0.1)] {
        let window = changed(snapshot);
        assert!(is_disabled(&window, "Save and use"));
        assert!(says(&window, "Satrak moves or tracks. Stop it, then save."));
    }
    let now = Instant::now();
    let link = LinkState::Lost { start: now, reason: LinkLoss::Silent, retry_at: now };
    for snapshot in [states::holding(), Snapshot { link, ..states::moving() }] {
        assert!(!is_disabled(&changed(snapshot), "Save and use"));
    }
}

#[test]
fn what_does_not_touch_the_antenna_is_saved_while_it_moves() {
    let mut model = rig::model(states::moving());
    model.view = View::Preferences;
    let mut window = rig::window(SIZES[0], model);
    write(&mut window, "Name", "Hill");
    assert!(!is_disabled(&window, "Save and use"));
}

#[test]
fn the_site_is_not_changed_while_an_antenna_moves_or_tracks() {
    for (field, value) in [("Latitude", "40"), ("Altitude", "9")] {
        for (snapshot, is_busy) in
            [(states::moving(), true), (states::tracking(0.1), true), (states::holding(), false)]
        {
            let mut model = rig::model(snapshot);
            model.view = View::Preferences;
            let mut window = rig::window(SIZES[0], model);
            write(&mut window, field, value);
            assert_eq!(is_disabled(&window, "Save and use"), is_busy, "{field}");
            let why = "Satrak moves or tracks. To change the site or its air, stop it, then save.";
            assert_eq!(says(&window, why), is_busy, "{field}");
        }
    }
}
