//! Every view as an image. `UPDATE_SNAPSHOTS=1 cargo test --test azel images` accepts new images.
//! If an image differs, the test writes `NAME.diff.png` and `NAME.new.png` beside it.

use std::{fs, path::Path};

use azel::{model::ThemeName, ui::theme};
use egui_kittest::{SnapshotOptions, try_image_snapshot_options};
use image::{
    DynamicImage, RgbaImage,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use crate::window_stories::{
    every_view::scene,
    replay,
    rig::{self, LARGE, SMALL, settle},
};

const FOLDER: &str = "tests/window_stories/images";

/// One scene of each view.
const VIEWS: [&str; 9] = [
    "Operate, tracking",
    "Plan",
    "Elements",
    "Antennas",
    "Console",
    "Record",
    "Map",
    "Preferences, an antenna",
    "Set-up, antennas",
];

/// States that look different from those of [`VIEWS`].
const STATES: [&str; 5] =
    ["Operate, jog", "Operate, link lost", REPLAY, "Alarms", "Horizon and keep-outs"];

/// Name of the replay scene. A replay has its own present and states its day once, so the checks of
/// every view leave it out.
const REPLAY: &str = "Operate, replay";

fn options() -> SnapshotOptions {
    SnapshotOptions::new().output_path(FOLDER)
}

fn image(name: &str, size: [f32; 2], theme: ThemeName) -> RgbaImage {
    let mut window =
        if name == REPLAY { rig::window(size, replay::model()) } else { scene(name, size) };
    theme::set(&window.ctx, theme);
    settle(&mut window);
    window.render().unwrap()
}

/// Returns a name such as `operate-jog-1024x640-dark`.
fn file_name(scene: &str, [width, height]: [f32; 2], theme: ThemeName) -> String {
    let words: Vec<String> = scene
        .split(|letter: char| !letter.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    format!("{}-{width}x{height}-{theme:?}", words.join("-")).to_lowercase()
}

fn accepts() -> bool {
    std::env::var_os("UPDATE_SNAPSHOTS").is_some()
}

/// Writes an accepted image again, in half of the bytes that the library takes for it.
fn write_small(image: &RgbaImage, name: &str) {
    let file = fs::File::create(Path::new(FOLDER).join(name).with_extension("png")).unwrap();
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    DynamicImage::from(image.clone()).to_rgb8().write_with_encoder(encoder).unwrap();
}

fn assert_as_accepted(scenes: &[&str], size: [f32; 2], theme: ThemeName) {
    let differences: Vec<String> = scenes
        .iter()
        .filter_map(|scene| {
            let name = file_name(scene, size, theme);
            let drawn = image(scene, size, theme);
            let compared = try_image_snapshot_options(&drawn, name.as_str(), &options());
            if accepts() {
                write_small(&drawn, &name);
            }
            compared.err().map(|error| error.to_string())
        })
        .collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

#[test]
fn large_and_dark() {
    assert_as_accepted(&VIEWS, LARGE, ThemeName::Dark);
}

#[test]
fn large_and_light() {
    assert_as_accepted(&VIEWS, LARGE, ThemeName::Light);
}

#[test]
fn small_and_dark() {
    assert_as_accepted(&VIEWS, SMALL, ThemeName::Dark);
}

#[test]
fn small_and_light() {
    assert_as_accepted(&VIEWS, SMALL, ThemeName::Light);
}

#[test]
fn further_states_and_the_night() {
    assert_as_accepted(&STATES, LARGE, ThemeName::Dark);
    assert_as_accepted(&VIEWS[..1], LARGE, ThemeName::Night);
}

#[test]
fn a_panel_that_is_moved_by_a_pixel_is_another_image() {
    if accepts() {
        // In this mode, the library would accept the moved image too.
        return;
    }
    let name = file_name(VIEWS[0], SMALL, ThemeName::Dark);
    let folder = tempfile::tempdir().unwrap();
    let file = format!("{name}.png");
    fs::copy(Path::new(FOLDER).join(&file), folder.path().join(&file)).unwrap();
    let options = SnapshotOptions::new().output_path(folder.path());
    let drawn = image(VIEWS[0], SMALL, ThemeName::Dark);
    try_image_snapshot_options(&drawn, name.as_str(), &options).unwrap();
    // Move the column of passes one pixel to the right.
    let mut moved = drawn.clone();
    for (x, y) in (301..400).rev().flat_map(|x| (100..600).map(move |y| (x, y))) {
        moved.put_pixel(x, y, *drawn.get_pixel(x - 1, y));
    }
    assert!(try_image_snapshot_options(&moved, name, &options).is_err());
    assert!(folder.path().join(file.replace(".png", ".diff.png")).exists());
}
