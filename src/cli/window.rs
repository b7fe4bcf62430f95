//! Start of the window, or one sentence why it cannot open.

use std::{
    cell::RefCell,
    io,
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    time::Instant,
};

use anyhow::{anyhow, bail};
use eframe::UserEvent;
use egui::{Context, Vec2, vec2};
use winit::event_loop::EventLoop;

use crate::{
    app::{App, RunningStation, frames},
    cli::{held_keys::WithoutRepeats, marks, no_window, this_program, work_area::WorkArea},
    clock::Clock,
    contract::claim::HolderKind,
    engine::{Settings, claim::LockFolders, records_folder},
    model::Appearance,
    station,
};

/// Usual size of the window, in points.
const DEFAULT_SIZE: Vec2 = vec2(1440.0, 900.0);
/// Minimum size of the window, in points: everything is drawn smaller there.
const SMALLEST: Vec2 = vec2(
    Appearance::MIN_VIEW[0] * Appearance::MIN_ZOOM,
    Appearance::MIN_VIEW[1] * Appearance::MIN_ZOOM,
);
/// Height left for the title bar, in points; X11 tells it only once the window is there.
const TITLE_BAR: f32 = 40.0;
/// Size of the block that tells the allocator to keep free memory, in bytes.
const MAX_BYTES: usize = 4 << 20;
/// Part of the panic of the window toolkit without a library.
const NO_LIBRARY: &str = "could not be loaded";

/// Opens the window on the station file at `station`, or on the user's own. `demo`: on the demo
/// station instead.
pub(super) fn run(station: Option<PathBuf>, demo: bool) -> anyhow::Result<()> {
    if cfg!(target_os = "linux") && !has_display() {
        bail!(
            "Azel needs a display: neither DISPLAY nor WAYLAND_DISPLAY is set. \
             Start it in a desktop session."
        );
    }
    let folder = station::settings_path().and_then(|path| path.parent().map(Path::to_path_buf));
    let settings = Settings {
        path: if demo { folder.as_deref().map(station::free_path) } else { station },
        dead_man: this_program(),
        marks: marks(),
        records: records_folder(),
        claims: LockFolders::of_user().map(|folders| (folders, HolderKind::Window)),
        ..Settings::default()
    };
    keep_freed_memory();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("azel")
            .with_inner_size(DEFAULT_SIZE)
            .with_min_inner_size(SMALLEST)
            // The toolkit would unpack its own, a megabyte.
            .with_icon(egui::IconData::default()),
        // Off: flat colours do not need it, and a software renderer pays for it in every pixel.
        dithering: false,
        ..Default::default()
    };
    // A missing system library makes the window toolkit panic instead of returning an error.
    // The operator needs a sentence, not a back-trace.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|panic| {
        // A missing library is reported as a sentence below.
        if !panic.payload_as_str().is_some_and(|explanation| explanation.contains(NO_LIBRARY)) {
            tracing::error!("{panic}");
        }
    }));
    let begin = || RunningStation::start(settings, Clock::system());
    let create = |begun: RunningStation, ctx: &Context| {
        // Not before: an X server without another client drops everybody when this one leaves.
        if let Some(area) = WorkArea::of_the_desktop() {
            let points = area.points(ctx.native_pixels_per_point().unwrap_or(1.0));
            ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(fitting(points)));
        }
        let mut app = App::on(begun, ctx).with_notifier()?;
        if let Some(folder) = folder {
            app = app.with_stations_in(folder);
        }
        Ok(if demo { app.without_set_up() } else { app })
    };
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| show(options, begin, create)));
    panic::set_hook(hook);
    match outcome {
        Ok(result) => result.map_err(|explanation| anyhow!(explanation)),
        Err(panic) => {
            let explanation = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
                .unwrap_or_else(|| "unknown reason".to_owned());
            if explanation.contains(NO_LIBRARY) {
                bail!(no_window::reason(&explanation));
            }
            bail!("The window broke down: {explanation}")
        }
    }
}

/// Starts a station by `begin`, and shows the app that `create` makes of it until its window is
/// closed. Returns the sentence that says why there is none.
fn show(
    options: eframe::NativeOptions,
    begin: impl FnOnce() -> io::Result<RunningStation>,
    create: impl FnOnce(RunningStation, &Context) -> io::Result<App>,
) -> Result<(), String> {
    let events = EventLoop::<UserEvent>::with_user_event().build();
    let events = events.map_err(|error| no_window::reason(&error.to_string()))?;
    // There is a display: while the system makes the window, elements are read and passes searched.
    let begun = begin().map_err(|error| not_started(&error))?;
    let is_jogging = begun.is_jogging();
    let draws = Mutex::new(events.create_proxy());
    let draw = move |request_repaint_info: egui::RequestRepaintInfo| {
        let event = UserEvent::RequestRepaint {
            viewport_id: request_repaint_info.viewport_id,
            when: Instant::now() + request_repaint_info.delay,
            cumulative_pass_nr: request_repaint_info.current_cumulative_pass_nr,
        };
        // Without its loop the window is gone.
        let _ = draws.lock().unwrap_or_else(PoisonError::into_inner).send_event(event);
    };
    // The toolkit keeps its errors to itself: what would paint the window is missing unless the
    // app says otherwise.
    let made = RefCell::new(Err(no_window::nothing_paints()));
    let create: eframe::AppCreator<'_> = Box::new(|cc| {
        frames::draw_once(&cc.egui_ctx, draw);
        let app = create(begun, &cc.egui_ctx);
        *made.borrow_mut() = match &app {
            Ok(_) => Ok(()),
            Err(error) => Err(not_started(error)),
        };
        Ok(Box::new(app?))
    });
    let window = eframe::create_native("Azel", options, create, &events);
    let mut window = WithoutRepeats { window, is_jogging };
    let ended = events.run_app(&mut window);
    drop(window);
    made.into_inner()?;
    ended.map_err(|error| no_window::reason(&error.to_string()))
}

/// Tells the allocator of the GNU C library that large blocks come and go. From the start it gives
/// whatever is free at the end of the heap back to the system; a frame takes it again, and every
/// page of it costs a fault. The first large block that is freed raises that limit to twice its
/// size (`M_MMAP_THRESHOLD` in mallopt(3)). The price is that blocks of up to that size come from the
/// heap then, and are not given back one by one. Other allocators are not changed by it.
fn keep_freed_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(MAX_BYTES)));
}

/// The sentence for a station that cannot start: no fault of the window.
fn not_started(error: &io::Error) -> String {
    format!("The station could not be started: {error}")
}

/// Size of a window that stays clear of the panels of a desktop with `room` points for it.
fn fitting(room: Vec2) -> Vec2 {
    (room - vec2(0.0, TITLE_BAR)).min(DEFAULT_SIZE).max(SMALLEST)
}

fn has_display() -> bool {
    ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_window_stays_clear_of_the_panels_of_the_desktop() {
        assert_eq!(fitting(vec2(2560.0, 1400.0)), DEFAULT_SIZE);
        assert_eq!(fitting(vec2(1440.0, 860.0)), vec2(1440.0, 820.0));
        assert_eq!(fitting(vec2(1366.0, 728.0)), vec2(1366.0, 688.0));
        assert_eq!(fitting(vec2(800.0, 480.0)), vec2(800.0, 440.0));
        assert_eq!(fitting(vec2(320.0, 200.0)), SMALLEST);
    }
}
