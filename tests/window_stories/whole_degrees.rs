//! Unit with whole degrees, for which Azel shows no decimals.

use azel::{
    astro::AzEl,
    contract::{
        antenna::Prediction,
        driver::{Intent, Snapshot},
    },
};
use egui::Role;
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    makes,
    rig::{self, SIZES, says},
    states,
};

#[test]
fn a_genius_measures_and_is_told_whole_degrees() {
    for size in SIZES {
        let aim = Some(AzEl::from_degrees(173.0, 20.0).into());
        let snapshot = Snapshot { aim, ..makes::pair_at(Intent::Manual) };
        let window = rig::window(size, makes::model(makes::pair(), snapshot));
        assert!(says(&window, "Az: Command 173, actual 43, error −130,"));
        assert!(says(&window, "El: Command 20, actual 12, error −8,"));
        if size == rig::LARGE {
            assert!(says(&window, "Travel Az 43°"));
        } else {
            window.get_by_role_and_label(Role::Button, "Travel: Az 43°  El 12°");
        }
    }
}

#[test]
fn a_target_in_the_sky_keeps_its_decimals() {
    let mut model = makes::model(makes::pair(), makes::pair_at(Intent::Track));
    model.shown_mut().antennas[0].prediction = Some(Prediction {
        catalog_number: Some(rig::NOAA_20),
        time: rig::now(),
        direction: AzEl::from_degrees(43.25, 12.5),
    });
    let window = rig::window(rig::LARGE, model);
    assert!(says(&window, "Az: Predicted 43.25, actual 43, error −0.25,"));
}

#[test]
fn a_satrak_shows_hundredths() {
    let window = rig::window(rig::LARGE, rig::model(states::holding()));
    assert!(says(&window, "actual 343.10,"));
}
