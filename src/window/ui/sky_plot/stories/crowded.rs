//! Tests of labels with little room.

use super::*;

/// Returns a crowded sky: a pass, two satellites, the Moon, an antenna at the zenith and one at the
/// rim.
fn crowded(turn: i16) -> Harness<'static, Story> {
    let turned = move |direction: AzEl| {
        AzEl::from_degrees(direction.azimuth_deg() + f64::from(turn), direction.elevation_deg())
    };
    let samples: Vec<_> = testing::pass()
        .into_iter()
        .map(|sample| crate::plan::Sample { direction: turned(sample.direction), ..sample })
        .collect();
    let mut harness = window(vec2(672.0, 412.0), Story::default(), move |ui, story: &mut Story| {
        let antenna = |index, name, azimuth, elevation| OtherAntenna {
            index,
            name,
            commanded: None,
            measured: Some(Measured {
                direction: AzEl::from_degrees(azimuth, elevation),
                lost: None,
            }),
            bearing: None,
        };
        let scene = SkyScene {
            track: Some(testing::track(&samples)),
            moon: Some(AzEl::from_degrees(32.0, 20.0)),
            antennas: &[antenna(0, "Satrak", 0.0, 90.0), antenna(1, "Genius", 173.0, 0.0)],
            keyholes: Some(Keyholes {
                lower_axis_azimuth: crate::astro::Angle::ZERO,
                radius: crate::astro::Angle::from_degrees(5.0),
            }),
            ..sky()
        };
        show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
    });
    harness.run();
    harness
}

#[test]
fn no_text_of_a_crowded_sky_lies_on_another() {
    for turn in (0..360_i16).step_by(10) {
        let all = texts(&crowded(turn));
        for (index, (words, place)) in all.iter().enumerate() {
            for (other, rect) in &all[index + 1..] {
                // Letters are lower than the height of their line.
                let [one, two] = [place, rect].map(|mark| mark.shrink2(vec2(2.0, 3.5)));
                assert!(!one.intersect(two).is_positive(), "{turn}: {words:?} on {other:?}");
            }
        }
    }
}

/// Sizes of the plot in the smallest, a common and two large windows, points.
const SIZES: [Vec2; 4] = [vec2(672.0, 412.0), LARGE, vec2(1100.0, 840.0), vec2(1500.0, 1160.0)];

fn turned_pass(turn: i16) -> Vec<crate::plan::Sample> {
    let turned = |sample: crate::plan::Sample| {
        let azimuth_deg = sample.direction.azimuth_deg() + f64::from(turn);
        let direction = AzEl::from_degrees(azimuth_deg, sample.direction.elevation_deg());
        crate::plan::Sample { direction, ..sample }
    };
    testing::pass().into_iter().map(turned).collect()
}

/// Returns `true` if the path crosses a text.
fn crosses(path: &[Pos2], text: Rect) -> bool {
    let letters = text.shrink2(vec2(0.0, 3.0));
    let position = |pair: &[Pos2], step: u8| pair[0].lerp(pair[1], f32::from(step) / 20.0);
    path.windows(2).any(|pair| (0..=20).any(|step| letters.contains(position(pair, step))))
}

#[test]
fn the_number_of_a_ring_lies_on_no_track_and_no_text() {
    for size in SIZES {
        for turn in (0..360_i16).step_by(15) {
            let samples = turned_pass(turn);
            let drawn = samples.clone();
            let mut harness = window(size, Story::default(), move |ui, story: &mut Story| {
                let scene = SkyScene { track: Some(testing::track(&drawn)), ..sky() };
                show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
            });
            harness.run();
            let dome = Dome::fitted(plot(&harness));
            let path = dome.path(samples.iter().map(|sample| sample.direction));
            let all = texts(&harness);
            for number in ["30°", "60°"] {
                let (_, rect) = all.iter().find(|(words, _)| words == number).expect(number);
                assert!(!crosses(&path, *rect), "{size:?} {turn}: {number} at {rect:?}");
                let letters = rect.shrink2(vec2(0.0, 2.0));
                let other = all.iter().find(|(words, other)| {
                    words != number && other.shrink2(vec2(0.0, 2.0)).intersects(letters)
                });
                assert_eq!(other, None, "{size:?} {turn}: {number} at {rect:?}");
            }
        }
    }
}

#[test]
fn the_name_of_the_moon_leaves_a_track_that_comes_below_it() {
    for size in SIZES {
        for turn in (0..360_i16).step_by(30) {
            let samples = turned_pass(turn);
            for place in [samples.len() / 4, samples.len() / 3] {
                let near = samples[place].direction;
                let moon = AzEl::from_degrees(near.azimuth_deg() + 8.0, near.elevation_deg() - 8.0);
                let drawn = samples.clone();
                let mut harness = window(size, Story::default(), move |ui, story: &mut Story| {
                    let track = story.chosen.map(|_| testing::track(&drawn));
                    let scene = SkyScene { track, moon: Some(moon), ..testing::empty() };
                    show(ui, ui.max_rect(), &scene, &mut story.plot, &mut |_, _, _| {});
                });
                harness.run();
                harness.state_mut().chosen = Some(1);
                harness.run();
                let dome = Dome::fitted(plot(&harness));
                let path = dome.path(samples.iter().map(|sample| sample.direction));
                let all = texts(&harness);
                let (_, name) = all.iter().find(|(words, _)| words == "Moon").expect("a name");
                assert!(!crosses(&path, *name), "{size:?} {turn} {place}: {name:?}");
            }
        }
    }
}

#[test]
fn the_ground_of_a_label_covers_no_mark() {
    for turn in (0..360_i16).step_by(30) {
        let harness = crowded(turn);
        let t = theme::tokens(&harness.ctx);
        let mut flat = Vec::new();
        for clipped in &harness.output().shapes {
            flatten(&clipped.shape, &mut flat);
        }
        let of_mark = |mesh: &egui::Mesh| mesh.vertices.iter().any(|vertex| vertex.color == t.moon);
        let first_mark = flat.iter().position(|shape| match shape {
            egui::Shape::Circle(circle) => circle.fill == t.other,
            egui::Shape::Mesh(mesh) => of_mark(mesh),
            _ => false,
        });
        let places: Vec<Rect> = texts(&harness).into_iter().map(|(_, place)| place).collect();
        for shape in &flat[first_mark.expect("a mark")..] {
            let egui::Shape::Rect(ground) = shape else { continue };
            let is_ground = ground.fill == t.sky && ground.stroke.width == 0.0;
            let names = places.iter().any(|place| ground.rect.contains_rect(*place));
            assert!(!(is_ground && names), "{turn}: {:?}", ground.rect);
        }
    }
}

fn flatten(shape: &egui::Shape, found: &mut Vec<egui::Shape>) {
    match shape {
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|outline| flatten(outline, found)),
        other => found.push(other.clone()),
    }
}
