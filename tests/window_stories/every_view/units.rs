//! Distances stand in the unit that was chosen, wherever they are shown.

use azel::model::DistanceUnit;

use crate::window_stories::{
    every_view::{SCENES, words},
    rig::{SIZES, settle},
};

/// Whether `symbol` stands in `words` as the unit of a figure or the head of a column.
fn has_unit(words: &str, symbol: &str) -> bool {
    let ends =
        |of: &&str| of.split('/').next().is_some_and(|of| of.trim_matches(['.', ',']) == symbol);
    words.split_whitespace().any(|of| ends(&of))
}

#[test]
fn no_view_has_kilometres_where_nautical_miles_are_chosen() {
    let (mut faults, mut counted) = (Vec::new(), 0);
    for scene in &SCENES {
        for size in SIZES {
            let mut window = scene.open(size);
            window.state_mut().model.appearance.distances = DistanceUnit::NauticalMiles;
            settle(&mut window);
            for words in words(&window) {
                counted += usize::from(has_unit(&words, "nmi"));
                if has_unit(&words, "km") {
                    faults.push(format!("{} {size:?}: {words:?}", scene.name));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(counted > 50, "{counted} distances");
}
