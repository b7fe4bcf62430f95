//! Trust in the clock of this computer.

use azel::contract::driver::TimeSync;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, LARGE, SIZES, Window},
    states,
};

fn with(size: [f32; 2], sync: TimeSync) -> Window {
    let mut model = rig::model(states::holding());
    model.shown_mut().time_sync = sync;
    rig::window(size, model)
}

#[test]
fn the_large_window_says_how_the_clock_is_kept() {
    for (sync, words) in [
        (TimeSync::Synchronised, "Clock: synchronised"),
        (TimeSync::NotSynchronised, "Clock: not synchronised"),
        (TimeSync::NotKnown, "Clock: sync unknown"),
    ] {
        with(LARGE, sync).get_by_label(words);
    }
}

#[test]
fn a_clock_that_nobody_keeps_is_told_in_every_window() {
    for size in SIZES.into_iter().chain([[1360.0, 700.0], [1200.0, 800.0]]) {
        for antennas in [1, 4, 7] {
            let mut model = rig::model(states::holding());
            model.shown_mut().time_sync = TimeSync::NotSynchronised;
            for number in 1..antennas {
                let mut config = model.station.antennas[0].clone();
                config.name = format!("Antenna {number}");
                model.shown_mut().antennas.push(rig::antenna(config, states::holding()));
            }
            let window = rig::window(size, model);
            let told = window.get_by_label("Clock: not synchronised").rect();
            let clock = window.get_by_label_contains("11:15:30 UTC").rect();
            let chip = window.get_by_label_contains("Satrak: ").rect();
            assert!(told.left() > clock.right() && told.right() < chip.left(), "{size:?}");
        }
    }
}

#[test]
fn the_tool_tip_says_what_it_means() {
    for size in rig::sizes() {
        let mut window = with(size, TimeSync::NotSynchronised);
        window.get_by_label("Clock: not synchronised").hover();
        rig::settle(&mut window);
        // A tool-tip waits for a pointer at rest.
        window.run_steps(40);
        window.get_by_label_contains("A low satellite overhead moves about 1°");
    }
}
