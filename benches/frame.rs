//! Cost of a frame without painting: logic, layout and tessellation of the Operate view on
//! the demo station, while the antenna stands.

// A bench prints to its user, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used)]

use std::time::{Duration, Instant};

use azel::{app::App, clock::Clock, engine::Settings};

const FRAMES: u32 = 500;

fn main() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = Settings {
        path: Some(folder.path().join("none.toml")),
        library: Some(folder.path().join("elements")),
        ..Settings::default()
    };
    for size in [[1440.0, 900.0], [1024.0, 640.0]] {
        let mut harness = egui_kittest::Harness::builder().with_size(size).build_eframe(|cc| {
            let app = App::new(&cc.egui_ctx, &settings, Clock::system()).expect("the app starts");
            app.without_set_up()
        });
        let start = Instant::now();
        let ready = |app: &App| {
            app.model().antenna().is_some_and(|antenna| antenna.snapshot.state.measured.is_some())
                && !app.model().pass_lists.favourites.passes.is_empty()
        };
        while !ready(harness.state()) {
            assert!(start.elapsed() < Duration::from_secs(30), "the demo station does not start");
            harness.step();
        }
        let mut frames = Duration::ZERO;
        let mut tessellation = Duration::ZERO;
        let mut vertices = 0;
        for _ in 0..FRAMES {
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
            "{width} x {height}: logic and layout {:?}, tessellation {:?}, {vertices} vertices",
            frames / FRAMES,
            tessellation / FRAMES
        );
    }
}
