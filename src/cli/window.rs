//! Start of the window, or one sentence why it cannot open.

use std::{
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
};

use anyhow::{anyhow, bail};
use egui::{Vec2, vec2};

use crate::{
    app::App,
    cli::{marks, no_window, this_program, work_area::WorkArea},
    clock::Clock,
    engine::{
        Settings,
        claim::{HolderKind, claims_folder},
        records_folder,
    },
    station,
};

/// Usual size of the window, in points.
const USUAL: Vec2 = vec2(1440.0, 900.0);
/// Minimum size of the window, in points.
const SMALLEST: Vec2 = vec2(1024.0, 640.0);
/// Height left for the title bar, in points; X11 tells it only once the window is there.
const TITLE_BAR: f32 = 40.0;
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
        claims: claims_folder().map(|folder| (folder, HolderKind::Window)),
        ..Settings::default()
    };
    let work_area = WorkArea::of_the_desktop();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("azel")
            .with_inner_size(USUAL)
            .with_min_inner_size(SMALLEST),
        // Off: flat colours do not need it, and a software renderer pays for it in every pixel.
        dithering: false,
        ..Default::default()
    };
    // A missing system library makes the window toolkit panic instead of returning an error.
    // The operator needs a sentence, not a back-trace.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|panic| {
        // That one becomes a sentence.
        if !panic.payload_as_str().is_some_and(|why| why.contains(NO_LIBRARY)) {
            tracing::error!("{panic}");
        }
    }));
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| {
        eframe::run_native(
            "Azel",
            options,
            Box::new(move |cc| {
                if let Some(area) = work_area {
                    let points = area.points(cc.egui_ctx.native_pixels_per_point().unwrap_or(1.0));
                    let size = fitting(points);
                    cc.egui_ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(size));
                }
                let mut app =
                    App::new(&cc.egui_ctx, &settings, Clock::system())?.with_notifier()?;
                if let Some(folder) = folder {
                    app = app.with_stations_in(folder);
                }
                Ok(Box::new(if demo { app.without_set_up() } else { app }))
            }),
        )
    }));
    panic::set_hook(hook);
    match outcome {
        Ok(result) => result.map_err(|error| anyhow!(no_window::reason(&error.to_string()))),
        Err(panic) => {
            let why = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
                .unwrap_or_else(|| "unknown reason".to_owned());
            if why.contains(NO_LIBRARY) {
                bail!(no_window::reason(&why));
            }
            bail!("The window broke down: {why}")
        }
    }
}

/// Size of a window that stays clear of the panels of a desktop with `room` points for it.
fn fitting(room: Vec2) -> Vec2 {
    (room - vec2(0.0, TITLE_BAR)).min(USUAL).max(SMALLEST)
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
        assert_eq!(fitting(vec2(2560.0, 1400.0)), USUAL);
        assert_eq!(fitting(vec2(1440.0, 860.0)), vec2(1440.0, 820.0));
        assert_eq!(fitting(vec2(1366.0, 728.0)), vec2(1366.0, 688.0));
        assert_eq!(fitting(vec2(800.0, 480.0)), SMALLEST);
    }
}
