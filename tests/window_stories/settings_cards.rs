//! Content of a unit's cards besides its settings.

use azel::{
    contract::driver::Command,
    device::{Program, settings::Value},
    model::UiCommand,
    station::AntennaId,
};
use egui::Key;

use crate::window_stories::{
    rig::{self, LARGE, Window, asked},
    settings::{group, settles},
    settings_rig::{apply, change, opened, press, read, says, state_of, texts},
    states,
};

#[test]
fn the_window_of_the_selected_pass_is_filled_in_to_be_applied() {
    let mut window = opened(LARGE, read());
    press(&mut window, "Take from pass");
    assert_eq!(asked(&mut window), [], "filled in, not sent");
    assert_eq!(state_of(&window, "Stop"), "Edited");
    apply(&mut window);
    let values = settles(asked(&mut window)).remove(0).values;
    let stop = Value::Time("2026-08-12T11:21:26Z".parse().unwrap());
    // The pass is under way, and the unit already has its start.
    assert_eq!(values, [("stop", stop)].into());
}

#[test]
fn automatic_tracking_is_switched_on_after_a_question_and_off_at_once() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        press(&mut window, "Switch on…");
        assert_eq!(asked(&mut window), []);
        window.key_press(Key::Enter);
        let asked_for = |on| UiCommand::antenna(AntennaId(1), Command::AutoTrack(on));
        assert_eq!(asked(&mut window), [asked_for(true)]);
        for (auto, wanted) in [(Some(true), "On"), (None, "Not reported")] {
            change(&mut window, 0, |snapshot| {
                let program = snapshot.state.program.unwrap();
                snapshot.state.program = Some(Program { auto, ..program });
            });
            assert!(says(&window, &format!("Automatic tracking, on the unit: {wanted}")));
            if auto.is_some() {
                press(&mut window, "Switch off");
                assert_eq!(asked(&mut window), [asked_for(false)]);
            }
        }
    }
}

#[test]
fn the_clock_is_not_set_while_the_unit_tracks() {
    let mut snapshot = states::tracking(0.0);
    snapshot.state.link_since = read().state.link_since;
    snapshot.state.groups = read().state.groups;
    let mut window = opened(LARGE, snapshot);
    assert!(says(&window, "Not while the unit is tracking."));
    press(&mut window, "Set from this PC");
    assert_eq!(asked(&mut window), []);
    // 3.0 s ahead is several beam widths of a low satellite.
    assert!(
        texts(&window)
            .iter()
            .any(|text| text.starts_with("Effect on") && text.ends_with("Outside beam"))
    );
}

#[test]
fn the_effect_of_the_clock_is_that_on_the_tracked_satellite() {
    for (mut snapshot, wanted) in [
        (states::tracking(0.0), "along the path of NOAA 20"),
        (states::holding(), "along the path of METEOR-M2 4"),
    ] {
        snapshot.state.link_since = read().state.link_since;
        snapshot.state.groups = read().state.groups;
        let values = &mut group(&mut snapshot, "file").last_read.as_mut().unwrap().values;
        values.insert("catalog_number", Value::Integer(59_051));
        let window = opened(LARGE, snapshot);
        assert!(says(&window, wanted), "{wanted}");
    }
}

#[test]
fn a_place_far_from_the_site_is_a_warning() {
    let mut snapshot = read();
    let mut window = opened(LARGE, snapshot.clone());
    assert!(!says(&window, "Distance to site: Differs"));
    let values = &mut group(&mut snapshot, "gps").last_read.as_mut().unwrap().values;
    values.insert("latitude_deg", Value::Decimal(41.5));
    change(&mut window, 0, |of| *of = snapshot);
    assert!(says(&window, "Distance to site: Differs"));
}

#[test]
fn faults_stand_with_what_to_do() {
    let mut snapshot = read();
    states::report(&mut snapshot, &[2, 10], rig::now());
    let window = opened(LARGE, snapshot);
    assert!(says(&window, "Faults, read 11:15:30Z"));
    assert_eq!(state_of_check(&window, "Age of the elements"), "Caution");
    assert_eq!(state_of_check(&window, "X position sensor"), "Fault");
    assert!(says(&window, "The X angle cannot be trusted: check the sensor and its cable."));
}

#[test]
fn a_good_result_is_not_told_of_a_check_that_is_not_good() {
    let mut snapshot = read();
    states::report(&mut snapshot, &[2], rig::now());
    let window = opened(LARGE, snapshot);
    assert!(!says(&window, "Age of the elements: no fault reported"));
    assert!(says(&window, "Element file: no fault reported"));
}

fn state_of_check(window: &Window, name: &str) -> String {
    let before = format!("{name}: ");
    let told = texts(window).into_iter();
    told.filter_map(|text| Some(text.strip_prefix(&before)?.to_owned())).next_back().unwrap()
}
