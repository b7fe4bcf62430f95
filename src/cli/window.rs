//! Start of the window, or one sentence why it cannot open.

use std::{
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
};

use anyhow::{anyhow, bail};

use crate::{
    app::App,
    cli::{marks, no_window, this_program},
    clock::Clock,
    engine::{
        Settings,
        claim::{HolderKind, claims_folder},
        records_folder,
    },
    station,
};

/// Minimum size of the window, in points.
const SMALLEST: [f32; 2] = [1024.0, 640.0];
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
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("azel")
            .with_inner_size([1440.0, 900.0])
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

fn has_display() -> bool {
    ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}
