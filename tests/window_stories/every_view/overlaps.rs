//! No text is painted on another.

use azel::astro::time::add_seconds;

use crate::window_stories::{
    every_view::{SCENES, painted},
    rig::{SIZES, settle},
};

/// Most times of the next hours carry a day then, and are longer.
const BACK_S: f64 = 12.0 * 3600.0;

#[test]
fn no_text_lies_on_another() {
    let mut found = Vec::new();
    for scene in &SCENES {
        for size in SIZES {
            let mut window = scene.open(size);
            for when in ["today", "another day"] {
                for [below, above] in painted::on_each_other(&window) {
                    found.push(format!("{} {size:?} {when}: {above:?} on {below:?}", scene.name));
                }
                let model = &mut window.state_mut().model;
                model.now = add_seconds(model.now, -BACK_S);
                settle(&mut window);
            }
        }
    }
    assert!(found.is_empty(), "{}\n{}", found.len(), found.join("\n"));
}
