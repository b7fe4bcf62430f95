//! Hills around the station: the operator types them in the form, and Azel shows them in the plot
//! and mentions them for the selected pass.

use std::sync::Arc;

use azel::{
    astro::{HorizonMask, time::add_seconds},
    model::{Model, View},
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    horizon,
    preferences::{form, saved, write},
    rig::{self, LARGE, Window, asked},
    states,
};

const HILLS: &str = "0 2\n90 14\n180 6\n270 9";

/// Returns the page of the horizon, with its form in view.
fn page(size: [f32; 2]) -> Window {
    let mut window = form(size);
    horizon::open(&mut window);
    horizon::show_table(&mut window);
    window
}

fn with_mask(size: [f32; 2], text: &str) -> Window {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask =
        Some(HorizonMask::parse(text).unwrap());
    select_next(&mut model);
    rig::window(size, model)
}

/// Selects the next pass of NOAA 20 as this station sees it.
fn select_next(model: &mut Model) {
    let satellite = Arc::clone(model.pass_lists.satellite(rig::NOAA_20).unwrap());
    let pass = rig::predicted_passes(&satellite, &model.station, model.now).remove(0);
    model.selected = Some(pass.key());
    model.shown_mut().pass_lists.favourites.passes = vec![pass].into();
    model.refresh_sky();
}

#[test]
fn a_mask_is_typed_and_saved() {
    for size in rig::sizes() {
        let mut window = page(size);
        write(&mut window, "Horizon mask", HILLS);
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        let station = saved(horizon::asked(&mut window));
        assert_eq!(station.horizon_mask, HorizonMask::parse(HILLS).ok());
    }
}

#[test]
fn a_wrong_line_is_named_and_nothing_typed_is_lost() {
    for size in rig::sizes() {
        let mut window = page(size);
        write(&mut window, "Horizon mask", "0 2\n\n90;fourteen");
        let why = "Line 3 does not hold an azimuth and an elevation in degrees.";
        window.get_by_label_contains(why);
        window.get_by_label_contains("1 field is not valid: skyline in Horizon");
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        assert_eq!(horizon::asked(&mut window), []);
        write(&mut window, "Horizon mask", "0 2\n400 3");
        window.get_by_label_contains("Line 2: azimuth 400 is not between");
        write(&mut window, "Horizon mask", " ");
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        assert_eq!(saved(horizon::asked(&mut window)).horizon_mask, None);
    }
}

#[test]
fn a_mask_that_is_not_touched_stays_when_the_form_is_saved() {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask = HorizonMask::parse(HILLS).ok();
    model.view = View::Preferences;
    let mut window = rig::window(LARGE, model);
    write(&mut window, "Latitude", "40");
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    assert_eq!(saved(asked(&mut window)).horizon_mask, HorizonMask::parse(HILLS).ok());
}

#[test]
fn the_header_says_when_a_cut_pass_is_clear() {
    for size in rig::sizes() {
        let window = with_mask(size, "0 20");
        window.get_by_label_contains("lear of the mask 11:11:12Z to 11:18:46Z · ");
        let window = with_mask(size, "0 1");
        window.get_by_label_contains("JPSS-1 43013");
        assert!(window.query_by_label_contains("lear of the mask").is_none());
        let window = with_mask(size, "0 89");
        window.get_by_label_contains("ever clear of the mask");
    }
}

#[test]
fn a_wall_on_the_way_parts_the_pass() {
    let window = with_mask(LARGE, "0 1\n290 1\n300 80\n310 1");
    window.get_by_label_contains("lear of the mask in 2 parts");
}

#[test]
fn old_elements_come_before_the_mask() {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask = HorizonMask::parse("0 20").ok();
    model.now = add_seconds(model.now, 9.0 * 86_400.0);
    select_next(&mut model);
    rig::window(LARGE, model).get_by_label_contains("lements 10 d old, clear of the mask ");
}
