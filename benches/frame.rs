//! Cost of a frame of the Operate view without painting: logic, layout and tessellation. Each cost
//! is in wall time and, in brackets, in processor time of this thread.
//!
//! The stations are the demo station with standing antennas, stations without antennas but with
//! 1,000 favourites or the whole catalogue, and 1,000 favourites in the plan of three antennas with
//! switched-off units. The window is drawn as by eframe without a screen reader. Each frame shows
//! the next second, so that every moving element has moved.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used)]

use std::{
    ops::{AddAssign, Sub},
    sync::{
        Arc,
        atomic::{AtomicI64, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use azel::{
    app::App,
    clock::Clock,
    controller::SPECS,
    engine::Settings,
    makes::DemoAddresses,
    orbit::{Elements, bundled},
    station::{self, Favourites, Station},
};
use eframe::App as _;
use egui::{
    RawInput, Rect, Vec2,
    epaint::{ClippedShape, Primitive},
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
    let first = |count: usize| -> Favourites {
        catalog.iter().map(Elements::catalog_number).take(count).collect()
    };
    let nowhere = || "127.0.0.1:1".to_owned();
    let demo =
        Station::demo(&DemoAddresses { satrak: nowhere(), genius: nowhere(), rc2000c: nowhere() });
    let alone = Station { antennas: Vec::new(), ..Station::default() };
    for (name, count, station, drawn) in [
        ("1,000 favourites", 1000, &alone, 300),
        ("all favourites", 20_000, &alone, 100),
        ("1,000 favourites, three antennas", 1000, &demo, 300),
    ] {
        let station = Station { favourites: first(count), ..station.clone() };
        let file = format!("{name}.toml");
        station::save(&station, &folder.path().join(&file), SPECS).expect("a station file");
        let is_planned =
            |app: &App| app.model().antennas.is_empty() || app.model().schedule.made_at.is_some();
        frames(name, [1440.0, 900.0], drawn, &settings(&file), is_planned);
    }
}

/// Returns a clock on which the next second begins whenever the counter is raised.
fn clock(seconds: &Arc<AtomicI64>) -> Clock {
    let (begun, seconds) = (Timestamp::now(), Arc::clone(seconds));
    Clock::new(move || begun + SignedDuration::from_secs(seconds.load(Ordering::Relaxed)))
}

/// The window without a painter.
struct Window {
    ctx: egui::Context,
    app: App,
    frame: eframe::Frame,
    screen: Rect,
    drawn: u32,
}

impl Window {
    /// Draws a frame, one second after the previous frame.
    fn draw(&mut self) -> Drawn {
        self.drawn += 1;
        let (screen_rect, time) = (Some(self.screen), Some(f64::from(self.drawn)));
        let input = RawInput { screen_rect, time, focused: true, ..RawInput::default() };
        let mut logic = Spent::default();
        let (all, mut output) = timed(|| {
            self.ctx.run_ui(input, |ui| {
                logic += timed(|| self.app.logic(ui.ctx(), &mut self.frame)).0;
                self.app.ui(ui, &mut self.frame);
            })
        });
        // No painter uses the textures.
        output.textures_delta.clear();
        Drawn { logic, layout: all - logic, shapes: output.shapes }
    }
}

/// A frame with its cost.
struct Drawn {
    logic: Spent,
    layout: Spent,
    shapes: Vec<ClippedShape>,
}

fn frames(
    name: &str,
    size: [f32; 2],
    count: u32,
    settings: &Settings,
    is_ready: impl Fn(&App) -> bool,
) {
    let seconds = Arc::new(AtomicI64::new(0));
    let ctx = egui::Context::default();
    let app = App::new(&ctx, settings, clock(&seconds)).expect("the app starts");
    let mut window = Window {
        ctx,
        app: app.without_set_up(),
        frame: eframe::Frame::_new_kittest(),
        screen: Rect::from_min_size(egui::Pos2::ZERO, Vec2::from(size)),
        drawn: 0,
    };
    let start = Instant::now();
    while !is_ready(&window.app) || window.app.model().pass_lists.favourites.passes.is_empty() {
        assert!(start.elapsed() < Duration::from_mins(2), "the station does not start");
        window.draw();
        thread::sleep(Duration::from_millis(5));
    }
    let [mut logic, mut layout, mut tessellation] = [Spent::default(); 3];
    let mut vertices = 0;
    for _ in 0..count {
        seconds.fetch_add(1, Ordering::Relaxed);
        let drawn = window.draw();
        logic += drawn.logic;
        layout += drawn.layout;
        let (spent, primitives) = timed(|| window.ctx.tessellate(drawn.shapes, 1.0));
        tessellation += spent;
        vertices = primitives
            .iter()
            .map(|clipped| match &clipped.primitive {
                Primitive::Mesh(mesh) => mesh.vertices.len(),
                Primitive::Callback(_) => 0,
            })
            .sum::<usize>();
    }
    let [width, height] = size;
    println!(
        "{name}, {width} x {height}: logic {}, layout {}, tessellation {}, {vertices} vertices",
        logic.told(count),
        layout.told(count),
        tessellation.told(count)
    );
}

/// Wall time and processor time of this thread. Other work on the machine does not lengthen the
/// processor time.
#[derive(Clone, Copy, Default)]
struct Spent {
    wall_s: f64,
    cpu_s: f64,
}

impl AddAssign for Spent {
    fn add_assign(&mut self, other: Self) {
        self.wall_s += other.wall_s;
        self.cpu_s += other.cpu_s;
    }
}

impl Sub for Spent {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { wall_s: self.wall_s - other.wall_s, cpu_s: self.cpu_s - other.cpu_s }
    }
}

impl Spent {
    fn told(self, count: u32) -> String {
        let ms = |of_all_s: f64| of_all_s * 1e3 / f64::from(count);
        format!("{:.3} ms ({:.3})", ms(self.wall_s), ms(self.cpu_s))
    }
}

fn timed<T>(run: impl FnOnce() -> T) -> (Spent, T) {
    let (start, start_cpu_s) = (Instant::now(), cpu_s());
    let result = run();
    let cpu_s = cpu_s() - start_cpu_s;
    (Spent { wall_s: start.elapsed().as_secs_f64(), cpu_s }, result)
}

/// Returns the processor time of this thread, seconds.
#[cfg(unix)]
fn cpu_s() -> f64 {
    let clock = nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID;
    Duration::from(clock.now().expect("a clock")).as_secs_f64()
}

/// Returns NaN: other systems have no measurement.
#[cfg(not(unix))]
fn cpu_s() -> f64 {
    f64::NAN
}
