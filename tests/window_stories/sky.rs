//! Sky plot under the pointer: directions, times along the path, a closer look.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::time::add_seconds,
    contract::driver::Intent,
    engine::antenna::{Recent, refresh},
    model::UiCommand,
    station::{AntennaId, Frequency},
    ui::format,
};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    makes,
    rig::{self, LARGE, SIZES, Window, asked, scroll, settle},
    states,
};

fn window(size: [f32; 2]) -> Window {
    rig::window(size, rig::model(states::holding()))
}

/// Returns the middle of the sky plot: the zenith.
pub(crate) fn zenith(window: &Window) -> Pos2 {
    window.get_by_role(Role::Canvas).rect().center()
}

fn label(window: &Window, start: &str) -> Option<String> {
    let node = window.query_by_label_contains(start)?;
    node.accesskit_node().value()
}

/// Returns the place of the mark of LOS.
fn los(window: &Window) -> Pos2 {
    let is_mark = |text: String| text.starts_with("LOS 11:21:") && text.contains("Z, azimuth");
    let mut found = window.get_all_by_label_contains("LOS 11:21:");
    let mark = found.find(|node| node.accesskit_node().value().is_some_and(is_mark));
    mark.expect("the mark of LOS").rect().center()
}

#[test]
fn the_pointer_over_the_sky_reads_azimuth_and_elevation() {
    for size in SIZES {
        let mut window = window(size);
        let at = zenith(&window) + vec2(60.0, 0.0);
        window.hover_at(at);
        settle(&mut window);
        let east = label(&window, "Pointer at azimuth").unwrap();
        assert!(east.starts_with("Pointer at azimuth 90.0°, elevation "), "{east}");
        window.hover_at(zenith(&window) + vec2(0.0, 60.0));
        settle(&mut window);
        let south = label(&window, "Pointer at azimuth").unwrap();
        assert!(south.starts_with("Pointer at azimuth 180.0°"), "{south}");
        // The plot does not read the pointer over the card.
        window.hover_at(Pos2::new(size[0] - 30.0, 300.0));
        settle(&mut window);
        assert_eq!(label(&window, "Pointer at azimuth"), None);
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn a_point_of_the_path_has_a_time_which_the_profile_marks_too() {
    let mut window = window(LARGE);
    let los = los(&window);
    let sky = zenith(&window);
    // Along the rim, the path ends here.
    window.hover_at(los + (sky - los) * 0.02);
    settle(&mut window);
    let in_sky = label(&window, "Path at ").expect("a time of the path");
    let in_profile = label(&window, "Profile at ").expect("the same time in the profile");
    assert_eq!(in_sky[8..17], in_profile[11..20], "{in_sky} {in_profile}");
    window.hover_at(Pos2::new(30.0, 300.0));
    settle(&mut window);
    assert_eq!((label(&window, "Path at "), label(&window, "Profile at ")), (None, None));
}

#[test]
fn a_time_of_the_profile_is_marked_in_the_sky() {
    let mut window = window(LARGE);
    let profile = window.get_by_label_contains("NOAA 20 profile").rect();
    window.hover_at(profile.center());
    settle(&mut window);
    let in_profile = label(&window, "Profile at ").unwrap();
    let in_sky = label(&window, "Path at ").unwrap();
    assert_eq!(in_sky[8..17], in_profile[11..20], "{in_sky} {in_profile}");

    // The arrow keys read the path as the pointer does.
    window.hover_at(Pos2::new(30.0, 300.0));
    window.get_by_label_contains("NOAA 20 profile").focus();
    settle(&mut window);
    assert!(label(&window, "Path at 11:15:30Z").is_some(), "the present");
    window.key_press(Key::ArrowRight);
    settle(&mut window);
    assert!(label(&window, "Path at 11:15:40Z").is_some());
    assert!(label(&window, "Profile at 11:15:40Z").is_some());
    assert_eq!(asked(&mut window), []);
}

#[test]
fn the_wheel_brings_the_sky_closer_and_a_double_click_brings_it_back() {
    for size in rig::sizes() {
        let mut window = window(size);
        let reads = |window: &Window| label(window, "Pointer at azimuth").unwrap();
        // The pointer is between zenith and east, away from marks.
        let at = zenith(&window) + vec2(90.0, 2.0);
        window.hover_at(at);
        settle(&mut window);
        let before = reads(&window);
        let rim = los(&window);
        scroll(&mut window, at, 200.0);
        assert_eq!(reads(&window), before, "the place under the pointer stays");
        let closer = los(&window);
        assert!(closer.distance(at) > 1.5 * rim.distance(at), "{rim} {closer}");
        let press = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        window.input_mut().events.extend([true, false, true, false].map(press));
        settle(&mut window);
        let back = los(&window);
        assert!(back.distance(rim) < 1.0, "{back} {rim}");
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn plus_and_zero_magnify_the_sky_that_has_the_focus() {
    let mut window = window(LARGE);
    let (whole, zenith) = (los(&window), zenith(&window));
    window.get_by_role(Role::Canvas).focus();
    settle(&mut window);
    window.key_press(Key::Plus);
    settle(&mut window);
    assert!((los(&window).distance(zenith) / whole.distance(zenith) - 1.5).abs() < 0.01);
    window.key_press(Key::Num0);
    settle(&mut window);
    assert!(los(&window).distance(whole) < 0.5);
    assert_eq!(window.state().views.stored().strip_hours, None, "the strip keeps its hours");
}

/// Returns the texts that the window of `model` paints.
fn painted(model: azel::model::Model) -> Vec<String> {
    painted::texts(&rig::window(LARGE, model))
}

#[test]
fn the_doppler_shift_is_that_of_the_satellites_own_frequencies() {
    let mut model = rig::model(states::holding());
    let none = painted(rig::model(states::holding()));
    assert!(!none.iter().any(|words| words.contains("MHz") || words == "Doppler"), "{none:?}");
    let of = |satellite, mhz, name: &str| Frequency { satellite, mhz, name: name.to_owned() };
    let own = [of(rig::NOAA_20, 7812.0, "HRD"), of(rig::NOAA_20, 1707.0, "")];
    Arc::make_mut(&mut model.shown_mut().station).frequencies =
        [own[0].clone(), of(25_544, 145.8, "")].into();
    Arc::make_mut(&mut model.shown_mut().station).frequencies.push(own[1].clone());
    let look = model.sky.selected.unwrap().look;
    let shown = painted(model);
    for of in own {
        let khz = format::signed(look.doppler_hz(of.mhz * 1e6) / 1e3, 2);
        let words = format!("{khz} kHz\n{}", format!("{} {} MHz", of.name, of.mhz).trim());
        assert!(shown.contains(&words), "{words:?} in {shown:?}");
    }
    assert!(!shown.iter().any(|words| words.contains("145.8") || words.contains("437")));
}

fn with_a_second_antenna() -> Window {
    let mut model = rig::model(states::holding());
    let second = makes::model(makes::pair(), makes::pair_at(Intent::Position));
    model.shown_mut().antennas.extend(second.antennas.clone());
    Arc::make_mut(&mut model.shown_mut().antennas[1].config).id = AntennaId(2);
    rig::window(LARGE, model)
}

#[test]
fn all_antennas_stand_in_the_sky_with_the_stop_of_their_azimuth() {
    let mut window = with_a_second_antenna();
    let genius = label_of_button(&window, "Antenna Genius").expect("its mark");
    assert!(genius.contains("azimuth"), "{genius}");
    window.get_by_role_and_label(Role::Button, &genius).click();
    assert_eq!(asked(&mut window), [UiCommand::SelectAntenna(1)]);
    window.state_mut().model.selected_antenna = 1;
    settle(&mut window);
    assert!(label_of_button(&window, "Antenna Satrak").is_some());
    assert!(label_of_button(&window, "Antenna Genius").is_none(), "the loud one is selected");

    // The layer removes the other antennas.
    window.get_by_role_and_label(Role::Button, "Layers").click();
    settle(&mut window);
    window.get_by_role_and_label(Role::CheckBox, "Other antennas").click();
    settle(&mut window);
    assert!(label_of_button(&window, "Antenna Satrak").is_none());
    assert_eq!(asked(&mut window), []);
}

fn label_of_button(window: &Window, start: &str) -> Option<String> {
    let mut buttons = window.query_all_by_role(Role::Button);
    buttons.find_map(|node| node.accesskit_node().label().filter(|label| label.starts_with(start)))
}

#[test]
fn errors_of_the_last_tracks_stay_to_be_looked_at() {
    let mut model = rig::model(states::tracking(0.02));
    assert!(model.antennas[0].past_tracks.is_empty());
    let site = model.station.site;
    let number = |model: &azel::model::Model, number| model.pass_lists.satellite(number).cloned();
    for second in 0..8 {
        let mut snapshot = states::tracking(0.02 * f64::from(second));
        let mut measured = snapshot.state.measured.unwrap();
        measured.received = model.steady + Duration::from_secs(u64::try_from(second).unwrap());
        measured.time = add_seconds(measured.time, f64::from(second));
        snapshot.state.measured = Some(measured);
        let noaa = number(&model, rig::NOAA_20);
        let antenna = &mut model.shown_mut().antennas[0];
        antenna.snapshot = Arc::new(snapshot);
        refresh(antenna, &mut Recent::default(), site, |_| noaa.as_ref());
    }
    let mut over = states::holding();
    let mut measured = over.state.measured.unwrap();
    measured.received = model.steady + Duration::from_mins(1);
    over.state.measured = Some(measured);
    model.shown_mut().antennas[0].snapshot = Arc::new(over);
    refresh(&mut model.shown_mut().antennas[0], &mut Recent::default(), site, |_| None);
    let past = model.antennas[0].past_tracks.iter().next().expect("a past track").clone();
    assert_eq!(past.name, "NOAA 20 (JPSS-1)");

    let mut window = rig::window(LARGE, model);
    window.get_by_role_and_label(Role::ComboBox, "Errors of the last tracks").click();
    settle(&mut window);
    window.get_by_label_contains("NOAA 20, 11:15Z to 11:15Z: rms ").click();
    settle(&mut window);
    window.get_by_label_contains("Past track of NOAA 20, 11:15Z to 11:15Z: rms ");
    window.get_by_role_and_label(Role::ComboBox, "Errors of the last tracks").click();
    settle(&mut window);
    window.get_by_label("The selected pass").click();
    settle(&mut window);
    window.get_by_label_contains("NOAA 20 profile");
    assert_eq!(asked(&mut window), []);
}
