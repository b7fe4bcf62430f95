//! The real app on a station whose units are in memory. The window has only a handle, and cannot
//! tell a unit in memory from a real one.

use std::sync::Arc;

use azel::{
    clock::Clock,
    contract::driver::{Intent, LinkState, StopState},
    controller::SPECS,
    device::Measured,
    driver::{Dial, Outside, Stream, UnitLock},
    model::{Model, View},
    sim::satrak::{Control, Options},
    station::{self, Antenna, Station},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig,
    unit::{RealWindow, open, step_until},
};

/// Returns a unit in memory, and the connections through which a station reaches it.
fn unit() -> (Control, Outside) {
    let clock = Clock::system();
    let control = Control::on_clock(&Options::new(rig::station().site, clock.utc()), clock.clone());
    let served = control.clone();
    let dial = move |_: &Antenna, _: Arc<dyn UnitLock>| -> Dial {
        let served = served.clone();
        Box::new(move || {
            let (near, far) = tokio::io::duplex(4096);
            let unit = served.clone();
            tokio::spawn(async move { unit.serve(far).await });
            Box::pin(async { Ok(Box::new(near) as Box<dyn Stream>) })
        })
    };
    (control, Outside { dial: Arc::new(dial), ..Outside::from(clock) })
}

fn measured(model: &Model) -> Option<Measured> {
    let snapshot = &model.antenna()?.snapshot;
    matches!(snapshot.link, LinkState::Up { .. }).then_some(snapshot.state.measured?)
}

fn intent(model: &Model) -> Option<Intent> {
    model.antenna().filter(|antenna| !antenna.snapshot.pending).map(|of| of.snapshot.intent)
}

fn press(window: &mut RealWindow, key: Key, pressed: bool) {
    let modifiers = Modifiers::NONE;
    window.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
}

#[test]
fn a_window_drives_a_station_through_its_handle_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let antennas = vec![Antenna::satrak("Dish", "in-memory:1")];
    station::save(&Station { antennas, ..rig::station() }, &path, SPECS).unwrap();
    let (unit, outside) = unit();
    let mut window = open(&path, outside);
    step_until(&mut window, "a measured angle", |model| measured(model).is_some());
    assert!(!window.state().model().demo);

    // The antenna moves by hand until the release.
    window.get_by_role_and_label(Role::RadioButton, "Manual").click();
    step_until(&mut window, "manual", |model| intent(model) == Some(Intent::Manual));
    let key = window.get_by_label("Jog X+").rect().center();
    window.event(Event::PointerMoved(key));
    let button = |pressed| Event::PointerButton {
        pos: key,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.event(button(true));
    let moves = |model: &Model| measured(model).is_some_and(|measured| measured.moving());
    step_until(&mut window, "it moves", moves);
    assert!(unit.state().is_moving);
    window.event(button(false));
    step_until(&mut window, "it stands", |model| !moves(model));

    // The antenna goes to its park position, and STOP ends the motion.
    window.get_by_role_and_label(Role::RadioButton, "Park").click();
    step_until(&mut window, "a frame", |_| true);
    press(&mut window, Key::Escape, true);
    press(&mut window, Key::Escape, false);
    let is_stopped = |model: &Model| {
        let stop = model.antenna().map(|antenna| antenna.snapshot.stop);
        matches!(stop, Some(StopState::Stopped { .. }))
    };
    step_until(&mut window, "STOP is proved", is_stopped);
    assert!(!unit.state().is_moving);
    assert_eq!(intent(window.state().model()), Some(Intent::Standby));

    // The console opens, and the link fails.
    let modifiers = Modifiers::COMMAND;
    let key = Key::Num5;
    for pressed in [true, false] {
        window.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
    }
    step_until(&mut window, "the Console", |model| model.view == View::Console);
    assert!(window.state().model().wires.iter().any(|wire| wire.next_number() > 0));
    unit.drop_clients();
    let is_lost = |model: &Model| !model.alarms.list().is_empty();
    step_until(&mut window, "the alarm of the lost link", is_lost);
    step_until(&mut window, "the link again", |model| measured(model).is_some());
}
