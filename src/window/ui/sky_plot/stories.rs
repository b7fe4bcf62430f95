//! Tests of the sky plot from the operator's view.

mod crowded;

use egui::{Key as Press, Role, Vec2, vec2};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use super::*;
use crate::{astro::AzEl, ui::widgets::testing::window};

const OTHERS: [OtherSatellite<'static>; 2] = [
    OtherSatellite {
        catalog_number: 36508,
        name: "CRYOSAT 2",
        direction: AzEl::from_degrees(30.0, 22.0),
        ahead: &[],
        geostationary: false,
    },
    OtherSatellite {
        catalog_number: 54259,
        name: "EUTELSAT 7C",
        direction: AzEl::from_degrees(212.0, 36.0),
        ahead: &[AzEl::from_degrees(212.0, 36.0), AzEl::from_degrees(f64::NAN, 36.0)],
        geostationary: true,
    },
];

#[derive(Default)]
struct Story {
    plot: SkyPlotState,
    chosen: Option<u32>,
}

fn story(size: Vec2, scene: SkyScene<'static>) -> Harness<'static, Story> {
    let samples = testing::pass();
    window(size, Story::default(), move |ui, story: &mut Story| {
        let mut scene = scene.clone();
        scene.track = scene.track.or_else(|| Some(testing::track(&samples)));
        let rect = ui.max_rect();
        story.chosen =
            show(ui, rect, &scene, &mut story.plot, &mut |_, _, _| {}).chosen.or(story.chosen);
    })
}

fn sky() -> SkyScene<'static> {
    SkyScene { others: &OTHERS, ..testing::empty() }
}

const LARGE: Vec2 = vec2(704.0, 580.0);

#[test]
fn a_satellite_is_found_by_its_name_and_clicked() {
    let mut harness = story(LARGE, sky());
    harness.run();
    harness.get_by_label("CRYOSAT 2, azimuth 30.0°, elevation 22.0°").click();
    harness.run();
    assert_eq!(harness.state().chosen, Some(36508));
}

#[test]
fn enter_chooses_the_satellite_that_has_the_focus() {
    let mut harness = story(LARGE, sky());
    harness.run();
    harness.get_by_label_contains("EUTELSAT 7C").focus();
    harness.run();
    harness.key_press(Press::Enter);
    harness.run();
    assert_eq!(harness.state().chosen, Some(54259));
}

#[test]
fn the_plot_and_its_marks_are_read_aloud() {
    let mut harness = story(
        LARGE,
        SkyScene {
            measured: Some(Measured {
                direction: AzEl::from_degrees(185.51, 37.47),
                lost: Some("14 s"),
            }),
            ..sky()
        },
    );
    harness.run();
    harness.get_by_role_and_label(Role::Canvas, "Holding at 343.1°, 5.0°.");
    harness.get_by_label_contains("AOS 11:01:53Z, azimuth");
    harness.get_by_label_contains("TCA 11:0");
    harness.get_by_label_contains("LOS 11:14:45Z, azimuth");
    harness.get_by_label("Antenna, no reply for 14 s, azimuth 185.5°, elevation 37.5°");
    let selected =
        |name| harness.get_by_label_contains(name).accesskit_node().is_selected() == Some(true);
    assert!(selected("NOAA 20, azimuth"));
    assert!(!selected("CRYOSAT 2"));
}

#[test]
fn a_layer_that_is_switched_off_takes_its_satellites_along() {
    let mut harness = story(LARGE, sky());
    harness.run();
    harness.get_by_label("Layers").click();
    harness.run();
    harness.get_by_label("Other satellites").click();
    harness.run();
    assert!(!harness.state().plot.layers.others);
    assert!(harness.query_by_label_contains("CRYOSAT 2").is_none());
    assert!(harness.query_by_label_contains("NOAA 20").is_some());
}

#[test]
fn a_low_or_narrow_plot_has_the_legend_behind_a_button() {
    // A narrow plot also has no room for the legend next to the disc.
    for size in [vec2(672.0, 468.0), vec2(520.0, 580.0)] {
        let mut harness = story(size, sky());
        harness.run();
        harness.get_by_role_and_label(Role::Button, "Legend").click();
        harness.run();
    }
    let harness = story(LARGE, sky());
    assert!(harness.query_by_role_and_label(Role::Button, "Legend").is_none());
}

#[test]
fn what_is_not_a_number_is_left_out() {
    const NOWHERE: AzEl = AzEl::from_degrees(f64::NAN, f64::NAN);
    let scene = SkyScene {
        minimum_elevation: crate::astro::Angle::from_degrees(f64::NAN),
        beam_width: crate::astro::Angle::from_degrees(f64::NAN),
        others: &[OtherSatellite {
            catalog_number: 1,
            name: "LOST",
            direction: NOWHERE,
            ahead: &[NOWHERE, NOWHERE],
            geostationary: false,
        }],
        sun: Some(NOWHERE),
        moon: Some(NOWHERE),
        commanded: Some(NOWHERE),
        ghost: Some(Ghost { end: NOWHERE, way: &[NOWHERE, NOWHERE], is_refused: true }),
        measured: Some(Measured { direction: NOWHERE, lost: None }),
        predicted: Some(AzEl::from_degrees(0.0, 10.0)),
        recent_errors: &[(f32::NAN, f32::NAN), (f32::INFINITY, 0.0)],
        ..testing::empty()
    };
    for size in [LARGE, vec2(40.0, 30.0)] {
        let mut harness = story(size, scene.clone());
        harness.run();
        assert!(harness.query_by_label_contains("LOST").is_none());
    }
}

#[test]
fn the_sky_may_be_empty() {
    let mut harness = window(LARGE, SkyPlotState::default(), |ui, state| {
        let rect = ui.max_rect();
        show(ui, rect, &testing::empty(), state, &mut |_, _, _| {});
    });
    harness.run();
}

/// Returns the texts of the last frame with their places.
fn texts(harness: &Harness<'_, Story>) -> Vec<(String, Rect)> {
    fn collect(shape: &egui::Shape, found: &mut Vec<(String, Rect)>) {
        match shape {
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|outline| collect(outline, found)),
            egui::Shape::Text(text) => {
                let place = text.galley.rect.translate(text.pos.to_vec2());
                found.push((text.galley.text().to_owned(), place));
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    for clipped in &harness.output().shapes {
        collect(&clipped.shape, &mut found);
    }
    found
}

/// Returns the vertices of all filled shapes of the last frame.
fn vertices(harness: &Harness<'_, Story>) -> Vec<egui::epaint::Vertex> {
    fn collect(shape: &egui::Shape, found: &mut Vec<egui::epaint::Vertex>) {
        match shape {
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|outline| collect(outline, found)),
            egui::Shape::Mesh(mesh) => found.extend(&mesh.vertices),
            _ => {}
        }
    }
    let mut found = Vec::new();
    for clipped in &harness.output().shapes {
        collect(&clipped.shape, &mut found);
    }
    found
}

fn plot(harness: &Harness<'_, Story>) -> Rect {
    harness.get_by_role(Role::Canvas).rect()
}

#[test]
fn no_label_and_the_beam_view_lie_on_each_other() {
    for turn in (0..360_i16).step_by(15) {
        let turned = |direction: AzEl| {
            AzEl::from_degrees(direction.azimuth_deg() + f64::from(turn), direction.elevation_deg())
        };
        let samples: Vec<_> = testing::pass()
            .into_iter()
            .map(|sample| crate::plan::Sample { direction: turned(sample.direction), ..sample })
            .collect();
        let mut harness = window(LARGE, Story::default(), move |ui, story: &mut Story| {
            let track = testing::track(&samples);
            let scene = SkyScene { predicted: track.position, track: Some(track), ..sky() };
            show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
        });
        harness.run();
        let view = beam_view::place(plot(&harness));
        let all = texts(&harness);
        let caption = all.iter().find(|(words, _)| words.starts_with("Beam ")).unwrap().1;
        for (words, place) in all.iter().filter(|(words, _)| !words.starts_with("Beam ")) {
            let is_clear = |candidate: Rect| !candidate.intersect(*place).is_positive();
            assert!(is_clear(view) && is_clear(caption), "{turn}: {words:?} at {place:?}");
        }
    }
}

#[test]
fn an_azimuth_stop_touches_no_name_of_the_rim() {
    for (azimuth, letter) in [(0.0, "N"), (90.0, "E"), (180.0, "S"), (270.0, "W")] {
        let mut harness = window(LARGE, Story::default(), move |ui, story: &mut Story| {
            let azimuth = crate::astro::Angle::from_degrees(azimuth);
            let stops = [AzimuthStop { azimuth, names: "Genius".into() }];
            let scene = SkyScene { stops: &stops, ..testing::empty() };
            show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
        });
        harness.run();
        let bad = theme::tokens(&harness.ctx).bad;
        let of_stop = vertices(&harness).into_iter().filter(|vertex| vertex.color == bad);
        let stop = Rect::from_points(&of_stop.map(|vertex| vertex.pos).collect::<Vec<_>>());
        assert!(stop.is_positive());
        let all = texts(&harness);
        let name = all.iter().find(|(words, _)| words == letter).unwrap().1;
        // The line of a letter is higher than the letter.
        let gap = name.shrink2(vec2(0.0, 3.0)).intersect(stop.expand(3.0));
        assert!(!gap.is_positive(), "{letter} at {name:?}, stop at {stop:?}");
    }
}

#[test]
fn the_name_of_the_sun_stands_beside_the_sun_also_near_the_beam() {
    for deviation in [0.0, 1.0, 2.0, 4.6] {
        let beam = AzEl::from_degrees(185.0, 37.0);
        let sun = AzEl::from_degrees(185.0, 37.0 + deviation);
        let measured = Measured { direction: beam, lost: None };
        let scene = SkyScene { sun: Some(sun), measured: Some(measured), ..testing::empty() };
        let mut harness = story(LARGE, scene);
        harness.run();
        let dome = Dome::fitted(plot(&harness));
        let position = dome.point(sun).unwrap();
        let all = texts(&harness);
        let name = all.iter().find(|(words, _)| words.starts_with("Sun ")).unwrap().1;
        let distance = name.clamp(position).distance(position);
        assert!(distance < 34.0, "{deviation}: {distance}");
    }
}

#[test]
fn a_label_across_the_rim_has_a_ground_on_both_sides_of_it() {
    let samples: Vec<_> = testing::pass();
    let mut harness = window(LARGE, Story::default(), move |ui, story: &mut Story| {
        let track = testing::track(&samples);
        let scene = SkyScene { track: Some(track), ..sky() };
        show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
    });
    harness.run();
    let dome = Dome::fitted(plot(&harness));
    let across: Vec<_> = texts(&harness)
        .into_iter()
        .filter(|(words, place)| {
            let is_label = ["AOS", "TCA", "LOS"].iter().any(|word| words.starts_with(word));
            is_label && dome.touches(*place) && !dome.holds(*place)
        })
        .collect();
    assert!(!across.is_empty());
    let ground = theme::tokens(&harness.ctx).bg0;
    for (words, place) in across {
        let is_corner = |vertex: &egui::epaint::Vertex| {
            vertex.color == ground && vertex.pos.distance(place.min) < 4.0
        };
        let lies_on_it = vertices(&harness).iter().any(is_corner);
        assert!(lies_on_it, "{words:?} at {place:?}");
    }
}

#[test]
fn the_name_of_an_azimuth_stop_stands_outside_of_the_disc() {
    for azimuth in (0..360_i16).step_by(15) {
        let mut harness = window(LARGE, Story::default(), move |ui, story: &mut Story| {
            let azimuth = crate::astro::Angle::from_degrees(f64::from(azimuth));
            let stops = [AzimuthStop { azimuth, names: "Genius".into() }];
            let scene = SkyScene { stops: &stops, ..testing::empty() };
            show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
        });
        harness.run();
        let dome = Dome::fitted(plot(&harness));
        let all = texts(&harness);
        let (_, name) = all.iter().find(|(words, _)| words.contains("stop")).unwrap();
        // Letters are lower than their line, and the corner of a line may touch the rim.
        let nearest = name.shrink2(vec2(0.0, 3.0)).clamp(dome.centre);
        let min = dome.radius - 4.0;
        assert!(nearest.distance(dome.centre) > min, "{azimuth}: {name:?}");
    }
}
