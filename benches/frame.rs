//! Cost of a frame without painting: logic, layout and tessellation of the Operate view on
//! the demo station while the antenna stands, and on stations without antennas and with 1,000
//! favourites or the whole catalogue as favourites. Each frame is of the next second, so that
//! everything that moves has moved.

// A bench prints to its user, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used)]

use std::{
    sync::{
        Arc,
        atomic::{AtomicI64, Ordering},
    },
    time::{Duration, Instant},
};

use azel::{
    app::App,
    clock::Clock,
    engine::Settings,
    orbit::{Elements, bundled},
    station::{self, Station},
};
use jiff::{SignedDuration, Timestamp};

fn main() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = |name: &str| Settings {
        path: Some(folder.path().join(name)),
        library: Some(folder.path().join("elements")),
        ..Settings::default()
    };
    let is_measured = |app: &App| {
        app.model().antenna().is_some_and(|antenna| antenna.snapshot.state.measured.is_some())
    };
    for size in [[1440.0, 900.0], [1024.0, 640.0]] {
        frames("demo", size, 500, &settings("none.toml"), is_measured);
    }
    let catalog = bundled().expect("a catalogue");
    for (name, count, drawn) in [("1,000 favourites", 1000, 300), ("all favourites", 20_000, 100)] {
        let numbers = catalog.iter().map(Elements::catalog_number).take(count);
        let station =
            Station { antennas: Vec::new(), favourites: numbers.collect(), ..Station::default() };
        let file = format!("{count}.toml");
        station::save(&station, &folder.path().join(&file)).expect("a station file");
        frames(name, [1440.0, 900.0], drawn, &settings(&file), |_| true);
    }
}

/// A clock on which the next second begins whenever the counter is raised.
fn clock(seconds: &Arc<AtomicI64>) -> Clock {
    let (begun, seconds) = (Timestamp::now(), Arc::clone(seconds));
    Clock::new(move || begun + SignedDuration::from_secs(seconds.load(Ordering::Relaxed)))
}

fn frames(
    name: &str,
    size: [f32; 2],
    count: u32,
    settings: &Settings,
    is_ready: impl Fn(&App) -> bool,
) {
    let seconds = Arc::new(AtomicI64::new(0));
    let mut harness = egui_kittest::Harness::builder().with_size(size).build_eframe(|cc| {
        let app = App::new(&cc.egui_ctx, settings, clock(&seconds)).expect("the app starts");
        app.without_set_up()
    });
    let start = Instant::now();
    while !is_ready(harness.state())
        || harness.state().model().pass_lists.favourites.passes.is_empty()
    {
        assert!(start.elapsed() < Duration::from_mins(2), "the station does not start");
        harness.step();
    }
    let mut frames = Duration::ZERO;
    let mut tessellation = Duration::ZERO;
    let mut vertices = 0;
    for _ in 0..count {
        seconds.fetch_add(1, Ordering::Relaxed);
        let start = Instant::now();
        harness.step();
        frames += start.elapsed();
        let shapes = harness.output().shapes.clone();
        let start = Instant::now();
        let primitives = harness.ctx.tessellate(shapes, 1.0);
        tessellation += start.elapsed();
        vertices = primitives
            .iter()
            .map(|clipped| match &clipped.primitive {
                egui::epaint::Primitive::Mesh(mesh) => mesh.vertices.len(),
                egui::epaint::Primitive::Callback(_) => 0,
            })
            .sum::<usize>();
    }
    let [width, height] = size;
    println!(
        "{name}, {width} x {height}: logic and layout {:?}, tessellation {:?}, {vertices} vertices",
        frames / count,
        tessellation / count
    );
}
