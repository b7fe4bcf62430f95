//! Antennas of every make, which the operator adds in the form, fills in wrong and right, saves and
//! reads back.

use std::sync::Arc;

use azel::{
    controller::{
        SPECS,
        rc2000c::{BAUD, BUS_ADDRESS, Calibration},
        rotator_genius::Rotators,
    },
    model::View,
    station::{self, AfterPass, Antenna, Mount, Station},
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::{add, antenna_form, asked, open, saved, write},
    rig::{self, Window, says, settle},
    states,
};

const SATRAK: &str = "Add SVS Satrak";
const GENIUS: &str = "Add 4O3A Rotator Genius";
const RC2000C: &str = "Add Research Concepts RC2000C";

/// Returns the form of a station without antennas.
fn bare(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Preferences;
    model.shown_mut().antennas.clear();
    Arc::make_mut(&mut model.shown_mut().station).antennas.clear();
    rig::window(size, model)
}

fn press(window: &mut Window, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(role, name).click();
    settle(window);
}

fn save(window: &mut Window) -> Station {
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    saved(asked(window))
}

fn has_field(window: &Window, label: &str) -> bool {
    window.query_by_role_and_label(Role::TextInput, label).is_some()
}

/// Returns the text in the field with this name.
fn typed(window: &Window, label: &str) -> String {
    let mut fields = window.get_all_by_label(label);
    let is_field = |role| matches!(role, Role::TextInput | Role::MultilineTextInput);
    let field = fields.find(|node| is_field(node.accesskit_node().role()));
    field.and_then(|node| node.value()).expect("a field with a text")
}

/// Writes the station to its file, and returns it as read again.
fn reloaded(station: &Station) -> Station {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    station::save(station, &path, SPECS).unwrap();
    let loaded = station::load(&path, SPECS).unwrap();
    assert_eq!(loaded.notes, []);
    loaded.station
}

fn the_antenna(station: &Station) -> &Antenna {
    let [antenna] = &station.antennas[..] else { panic!("{:?}", station.antennas) };
    antenna
}

#[test]
fn every_make_is_added_as_it_stands_and_comes_back_from_its_file() {
    for size in rig::sizes() {
        let mut window = bare(size);
        for button in [SATRAK, GENIUS, RC2000C] {
            add(&mut window, button);
        }
        let station = save(&mut window);
        let makes: Vec<&str> = station.antennas.iter().map(|of| of.connection.spec().key).collect();
        assert_eq!(makes, ["satrak", "genius", "rc2000c"]);
        let names: Vec<&str> = station.antennas.iter().map(|of| &*of.name).collect();
        assert_eq!(names, ["Satrak", "Genius", "RC2000C"]);
        assert_eq!(reloaded(&station), station);

        let mut model = rig::model(states::holding());
        model.view = View::Preferences;
        model.shown_mut().station = reloaded(&station).into();
        let mut window = rig::window(size, model);
        open(&mut window, "Site");
        write(&mut window, "Elevation floor", "11");
        let wanted = Station { elevation_floor_deg: 11.0, ..station };
        assert_eq!(save(&mut window), wanted, "read back into the form and saved");
    }
}

#[test]
fn a_section_without_a_field_of_the_make_is_left_out() {
    let title = "Upkeep between passes";
    for (button, has_upkeep) in [(SATRAK, true), (GENIUS, false), (RC2000C, false)] {
        let mut window = bare(rig::LARGE);
        add(&mut window, button);
        assert_eq!(says(&window, title), has_upkeep, "{button}");
    }
}

#[test]
fn a_genius_is_set_up() {
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, GENIUS);
        write(&mut window, "Address of the Genius", "tower:9006");
        write(&mut window, "Azimuth from", "-90");
        write(&mut window, "Azimuth to", "450");
        write(&mut window, "Elevation to", "90");
        write(&mut window, "Dead band", "1,5");
        press(&mut window, Role::RadioButton, "Park");
        let station = save(&mut window);
        let antenna = the_antenna(&station);
        assert_eq!(antenna.connection, Antenna::genius("", "tower:9006").connection);
        assert_eq!(antenna.mount.travel_deg(), [(-90.0, 450.0), (0.0, 90.0)]);
        assert_eq!(antenna.follow.after, AfterPass::Park);
        assert!((antenna.follow.dead_band_deg - 1.5).abs() < 1e-9);
        assert_eq!(reloaded(&station), station);
    }
}

#[test]
fn one_rotator_asks_for_no_elevation() {
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, GENIUS);
        assert!(has_field(&window, "Elevation to") && has_field(&window, "Park elevation"));
        assert!(!has_field(&window, "Maximum step"), "it takes no steps");
        write(&mut window, "Elevation to", "steep");
        assert!(says(&window, "Elevation to must be a number from 0 to 180°."));
        press(&mut window, Role::RadioButton, "Only rotator 2");
        assert!(!has_field(&window, "Elevation to") && !has_field(&window, "Park elevation"));
        let station = save(&mut window);
        assert_eq!(Rotators::from_connection(&the_antenna(&station).connection), Rotators::Second);
        press(&mut window, Role::RadioButton, "Azimuth + elevation");
        assert_eq!(typed(&window, "Elevation to"), "steep", "what was typed is still there");
    }
}

#[test]
fn ends_that_cross_are_named_at_the_field() {
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, GENIUS);
        write(&mut window, "Azimuth from", "200");
        write(&mut window, "Azimuth to", "190");
        assert!(says(&window, "Azimuth to must be 1 to 1080° more than Azimuth from."));
        write(&mut window, "Azimuth to", "560");
        write(&mut window, "Elevation from", "60");
        write(&mut window, "Elevation to", "30");
        assert!(!says(&window, "Azimuth to must"));
        assert!(says(&window, "Elevation to must be 1° or more above Elevation from."));
    }
}

#[test]
fn an_rc2000c_is_set_up() {
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, RC2000C);
        assert!(says(&window, "A serial port, such as /dev/ttyUSB0 or COM3"));
        assert!(says(&window, "Not calibrated"));
        write(&mut window, "Port or address", "/dev/ttyS1");
        press(&mut window, Role::RadioButton, "1200");
        write(&mut window, "Bus address", "111");
        write(&mut window, "Azimuth counts", "30 90\n3630 270");
        write(&mut window, "Elevation counts", "30 0\n1830 90");
        assert!(!says(&window, "Not calibrated"));
        let station = save(&mut window);
        let connection = &the_antenna(&station).connection;
        let calibration = Calibration::from_connection(connection);
        assert_eq!(connection.address, "/dev/ttyS1");
        assert_eq!((connection.whole(&BAUD), connection.whole(&BUS_ADDRESS)), (1200, 111));
        assert_eq!((calibration.azimuth.len(), calibration.elevation.len()), (2, 2));
        assert!(matches!(the_antenna(&station).mount, Mount::AzEl { .. }));
        assert_eq!(reloaded(&station), station);
    }
}

#[test]
fn wrong_fields_of_an_rc2000c_are_named_and_its_table_is_kept_as_typed() {
    const TABLE: &str = "30 90\n\n1830 180 x";
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, RC2000C);
        write(&mut window, "Port or address", "host:x");
        assert!(says(&window, "Port or address must have a port from 1 to 65535 after the host."));
        write(&mut window, "Port or address", "COM3");
        write(&mut window, "Bus address", "48");
        assert!(says(&window, "Bus address must be a whole number from 49 to 111."));
        write(&mut window, "Bus address", "49");
        write(&mut window, "Azimuth counts", TABLE);
        assert!(says(
            &window,
            "Azimuth counts line 3 must be a count and an angle, such as 1240 45.5."
        ));
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        assert_eq!(asked(&mut window), []);
        for view in [View::Operate, View::Preferences] {
            window.state_mut().model.view = view;
            settle(&mut window);
        }
        assert_eq!(typed(&window, "Azimuth counts"), TABLE);
        write(&mut window, "Azimuth counts", "30 90");
        assert!(says(&window, "Azimuth counts must hold two points or more, or none."));
        write(&mut window, "Azimuth counts", "30 90\n3630 90");
        assert!(says(&window, "Azimuth counts must hold angles that change with the counts."));
        write(&mut window, "Azimuth counts", "30 90\n3630 270");
        assert!(!says(&window, "Off a straight line"), "two points are always on it");
        assert_eq!(the_antenna(&save(&mut window)).name, "RC2000C");
    }
}

#[test]
fn points_that_do_not_fit_are_seen_beside_the_table() {
    for size in rig::sizes() {
        let mut window = bare(size);
        add(&mut window, RC2000C);
        write(&mut window, "Elevation counts", "1000 0\n2000 46\n3000 90");
        assert!(says(
            &window,
            "Off a straight line by −0.33°, +0.67°, −0.33°, most at 2000 counts."
        ));
    }
}

#[test]
fn how_a_satrak_is_tracked_from_here_can_be_set() {
    for size in rig::sizes() {
        let mut window = antenna_form(size);
        write(&mut window, "Latency", "61");
        assert!(says(&window, "Latency must be a number from 0 to 60 s."));
        write(&mut window, "Latency", "0.7");
        press(&mut window, Role::RadioButton, "Wait for the next");
        let follow = the_antenna(&save(&mut window)).follow;
        assert_eq!(follow.after, AfterPass::Next);
        assert!((follow.latency_s - 0.7).abs() < 1e-9);
    }
}
