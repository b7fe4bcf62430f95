use super::*;
use crate::{
    astro::{AzEl, time::add_seconds},
    ui::widgets::testing,
};
use egui_kittest::{Harness, kittest::Queryable as _};

fn time(seconds: f64) -> Timestamp {
    add_seconds("2026-11-14T11:01:53Z".parse().unwrap(), seconds)
}

/// Returns a pass of ten minutes over the north, highest in its middle.
fn track() -> Vec<Sample> {
    (0..=60)
        .map(|step| {
            let part = f64::from(step) / 60.0;
            let elevation_deg = 5.0 + 60.0 * (part * std::f64::consts::PI).sin();
            let azimuth_deg = (300.0 + 120.0 * part).rem_euclid(360.0);
            Sample {
                time: time(600.0 * part),
                direction: AzEl::from_degrees(azimuth_deg, elevation_deg),
            }
        })
        .collect()
}

fn model<'a>(track: &'a [Sample], errors: &'a [(Timestamp, f32)]) -> ProfileModel<'a> {
    ProfileModel {
        now: time(200.0),
        name: "NOAA 20",
        track,
        tca: Sample { time: time(300.0), direction: AzEl::from_degrees(0.0, 65.0) },
        cut: false,
        mask: None,
        errors,
        half_beam_deg: 0.44,
        marked: None,
    }
}

type Story = (ProfileState, Option<Timestamp>);

fn window(size: [f32; 2], model: Option<ProfileModel<'_>>) -> Harness<'_, Story> {
    testing::window(size, Story::default(), move |ui, (state, requested): &mut Story| {
        *requested =
            show(ui, Rect::from_min_size(pos2(0.0, 0.0), size.into()), model.as_ref(), &[], state);
    })
}

#[test]
fn the_pointer_marks_a_time_and_reads_the_pass_there() {
    let (track, errors) = (track(), [(time(149.0), 0.2), (time(190.0), 0.04)]);
    let mut window = window([392.0, 208.0], Some(model(&track, &errors)));
    window.run();
    // The pointer is at a quarter of the way between the two scales.
    window.hover_at(pos2(LEFT_SCALE + (392.0 - LEFT_SCALE - RIGHT_SCALE) / 4.0, 100.0));
    window.run();
    let requested = window.state().1.unwrap();
    assert!(requested.duration_since(time(150.0)).as_secs_f64().abs() < 0.5, "{requested}");
    window.get_by_label("Profile at 11:04:23Z: elevation 47.4°, azimuth 330°, error 0.20°");
    window.hover_at(pos2(200.0, 10.0));
    window.run();
    assert_eq!(window.state().1, None, "the title is no time");
}

#[test]
fn arrows_mark_a_time_from_the_present_on() {
    let track = track();
    let mut window = window([392.0, 208.0], Some(model(&track, &[])));
    window.run();
    window.get_by_label_contains("NOAA 20 profile").focus();
    window.run();
    assert_eq!(window.state().1, Some(time(200.0)));
    window.key_press(egui::Key::ArrowLeft);
    window.run();
    window.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::ArrowRight);
    window.run();
    assert_eq!(window.state().1, Some(time(250.0)));
    for _ in 0..9 {
        window.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::ArrowRight);
        window.run();
    }
    assert_eq!(window.state().1, Some(time(600.0)), "LOS is the end");
}

#[test]
fn a_time_that_is_marked_in_the_sky_is_read_in_the_profile() {
    let track = track();
    let marked = Some(time(300.0));
    let window = window([392.0, 208.0], Some(ProfileModel { marked, ..model(&track, &[]) }));
    window.get_by_label("Profile at 11:06:53Z: elevation 65.0°, azimuth 000°");
    assert_eq!(window.state().1, None);
}

#[test]
fn the_pass_is_told_in_a_sentence() {
    let errors = [(time(100.0), 0.2), (time(190.0), 0.04), (time(195.0), f32::NAN)];
    let track = track();
    let window = window([392.0, 208.0], Some(model(&track, &errors)));
    window.get_by_role_and_label(
        Role::Image,
        "NOAA 20 profile: AOS 11:01:53Z at azimuth 300°, TCA 11:06:53Z at elevation 65.0°, LOS \
         11:11:53Z at azimuth 060°. Last error 0.04°, half the beamwidth is 0.44°.",
    );
}

#[test]
fn a_cut_pass_has_neither_rise_nor_set() {
    let track = track();
    let window = window([392.0, 208.0], Some(ProfileModel { cut: true, ..model(&track, &[]) }));
    window.get_by_label_contains("from 11:01:53Z");
    window.get_by_label_contains("to 11:11:53Z");
    assert!(window.query_by_label_contains("AOS").is_none());
}

#[test]
fn nothing_selected_and_nothing_known_are_said() {
    window([392.0, 208.0], None).get_by_role_and_label(Role::Image, "No pass selected.");
    let one = [track()[0]];
    for few in [&[][..], &one] {
        window([392.0, 208.0], Some(model(few, &[])))
            .get_by_role_and_label(Role::Image, "The path of NOAA 20 is not known.");
    }
}

#[test]
fn numbers_that_are_none_are_survived() {
    let nan = AzEl::from_degrees(f64::NAN, f64::NAN);
    let mut track = track();
    track[0].direction = nan;
    track[30].direction = nan;
    let errors = [(time(10.0), f32::NAN), (time(20.0), f32::INFINITY), (time(-50.0), 0.1)];
    for half_beam_deg in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        let tca = Sample { direction: nan, ..track[30] };
        let model = ProfileModel { tca, half_beam_deg, ..model(&track, &errors) };
        window([392.0, 208.0], Some(model)).get_by_label_contains("elevation –");
    }
}

#[test]
fn any_size_and_any_name_can_be_shown() {
    let track = track();
    let errors = [(time(5.0), 0.3)];
    let name = "A satellite with a name that is far too long to be shown in one line of it";
    for size in [[392.0, 208.0], [200.0, 120.0], [60.0, 90.0], [10.0, 10.0]] {
        for now in [-100.0, 0.0, 300.0, 900.0] {
            let model = ProfileModel { name, now: time(now), ..model(&track, &errors) };
            window(size, Some(model)).get_by_label_contains(name);
        }
    }
}
