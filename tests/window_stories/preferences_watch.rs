//! Automatic acts of the station for its antennas, as the form sets them.

use azel::{
    contract::driver::{Snapshot, StoppingWay},
    station::{Monitor, OnClose, Resume},
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    preferences::{asked, form, open, saved, write},
    rig::{self, Window, says, settle},
    settings_rig::press,
    states,
};

/// Chooses one of the words of the form, even outside the view.
fn choose(window: &mut Window, word: &str) {
    window.get_by_role_and_label(Role::RadioButton, word).click_accesskit();
    settle(window);
}

#[test]
fn what_is_done_by_itself_is_chosen_and_saved() {
    for size in rig::sizes() {
        let mut window = form(size);
        choose(&mut window, "Stop and hold");
        open(&mut window, "Satrak");
        for word in ["Alarm only", "Keep tracking"] {
            choose(&mut window, word);
        }
        assert!(says(&window, "Continues by itself if the antenna is where it was left."));
        write(&mut window, "Allowed sway", "0,25");
        write(&mut window, "Resume after outages up to", "601");
        assert!(says(&window, "Resume after outages up to must be a number from 0 to 600 s."));
        write(&mut window, "Resume after outages up to", "20");
        press(&mut window, "Save and use");
        let station = saved(asked(&mut window));
        let [antenna] = &station.antennas[..] else { panic!("{:?}", station.antennas) };
        assert_eq!((antenna.monitor, antenna.resume), (Monitor::Alarm, Resume::Continue));
        assert_eq!((antenna.sway_deg, antenna.resume_after_s), (0.25, 20.0));
        assert_eq!(station.on_close, Some(OnClose::Hold));
    }
}

#[test]
fn a_station_that_asks_says_so_and_comes_back_from_another_choice() {
    let mut window = form(rig::LARGE);
    choose(&mut window, "Let finish");
    assert!(says(&window, "A unit that tracks by itself goes on, with nobody watching here."));
    choose(&mut window, "Ask");
    assert!(says(&window, "Nothing to save."));
}

#[test]
fn the_way_after_stop_is_the_makes_until_it_was_seen_often_enough() {
    let shown = |stopping_way: StoppingWay| {
        let mut model = rig::model(Snapshot { stopping_way, ..states::holding() });
        model.view = azel::model::View::Preferences;
        let mut window = rig::window(rig::LARGE, model);
        open(&mut window, "Satrak");
        window
    };
    let window = shown(StoppingWay { overrun_s: 0.4, stops: 1, is_learned: false });
    assert!(says(
        &window,
        "Coasts for 0.4 s: the default of its make, until 3 STOPs are measured (1 so far)."
    ));
    let window = shown(StoppingWay { overrun_s: 0.62, stops: 7, is_learned: true });
    assert!(says(&window, "Coasts for 0.6 s: the longest of the last 3 of 7 STOPs."));
}
