//! Layout of the card of every make, which must fit every window in every theme.

use std::collections::HashMap;

use azel::{
    astro::AzEl,
    contract::{
        self,
        antenna::TrackAgain,
        driver::{Breach, Command, Event, Intent, LeftMoving, Refusal, Snapshot, StopState},
    },
    model::{Model, ThemeName},
    plan::Barrier,
    station::Antenna,
    ui::theme,
};
use egui::{Rect, Role, accesskit::NodeId, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    extremes::nothing_overlaps,
    maintenance, makes, on_board,
    rig::{self, SIZES, Window, settle},
    states,
};

/// Starts of lines at the end of the card that may need scrolling.
const SCROLLED: [&str; 5] = ["Travel: ", "Readings: ", "Faults: ", "More: ", "Details"];

fn cases() -> Vec<(Antenna, Snapshot)> {
    let manual = Intent::Manual;
    vec![
        (makes::pair(), makes::pair_at(manual)),
        (makes::pair(), makes::pair_at(Intent::Standby)),
        (makes::alone(), makes::alone_at(manual, false)),
        (makes::rc2000c(), makes::rc2000c_off()),
        (makes::rc2000c(), makes::rc2000c_at(manual)),
        (makes::rc2000c(), makes::rc2000c_alarmed(manual)),
        (makes::rc2000c(), makes::rc2000c_uncalibrated(manual)),
        (makes::pair(), maintenance::locked(makes::pair_at(Intent::Standby))),
        (makes::rc2000c(), maintenance::locked(makes::rc2000c_off())),
    ]
}

fn nothing_is_cut(window: &Window, size: [f32; 2]) {
    let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
    for role in [Role::Button, Role::RadioButton, Role::TextInput, Role::Slider] {
        for node in window.query_all_by_role(role) {
            let name = node.accesskit_node().label().unwrap_or_default();
            let is_scrolled = SCROLLED.iter().any(|start| name.starts_with(start));
            assert!(
                is_scrolled || whole.contains_rect(node.rect()),
                "{name:?} at {:?}",
                node.rect()
            );
        }
    }
}

#[test]
fn the_card_of_every_make_fits_every_window_in_every_theme() {
    for size in SIZES {
        for (config, snapshot) in cases() {
            let mut window = rig::window(size, makes::model(config, snapshot));
            for name in [ThemeName::Dark, ThemeName::Light, ThemeName::Night] {
                theme::set(&window.ctx, name);
                settle(&mut window);
                nothing_is_cut(&window, size);
                nothing_overlaps(&window);
            }
        }
    }
}

#[test]
fn nothing_of_the_card_lies_on_something_else_when_all_is_unfolded() {
    for (config, snapshot) in cases() {
        let mut window = rig::window(rig::SMALL, makes::model(config, snapshot));
        for fold in ["Travel: ", "Readings: ", "Faults: ", "More: "] {
            if let Some(line) = window.query_by_label_contains(fold) {
                line.click_accesskit();
            }
            settle(&mut window);
        }
        // The upper part of the card covers scrolled lines.
        rig::scroll(&mut window, pos2(870.0, rig::SMALL[1] - 8.0), 5000.0);
        nothing_overlaps(&window);
    }
}

#[test]
fn the_mark_that_a_card_goes_on_below_lies_on_no_row() {
    for size in SIZES {
        let mut found = 0;
        for (config, snapshot) in cases() {
            let window = rig::window(size, makes::model(config, snapshot));
            let seen: HashMap<NodeId, Rect> = window.ctx.viewport(|viewport| {
                let layers = viewport.this_pass.widgets.layers();
                let widgets = layers.flat_map(|(_, widgets)| widgets);
                widgets.map(|of| (of.id.accesskit_id(), of.interact_rect)).collect()
            });
            let Some(mark) = window.query_by_label("Scroll for more") else { continue };
            let mark = mark.rect();
            for role in [Role::Button, Role::Label, Role::RadioButton, Role::TextInput] {
                for node in window.query_all_by_role(role) {
                    let node = node.accesskit_node();
                    let name = node.label().or(node.value()).unwrap_or_default();
                    let place = seen.get(&node.locate().0).copied().unwrap_or(Rect::NOTHING);
                    let is_free = name == "Scroll for more" || !place.intersects(mark.shrink(1.0));
                    assert!(is_free, "{size:?}: {name:?} at {place:?}");
                }
            }
            found += 1;
        }
        assert!(found > 0, "{size:?}");
    }
}

#[test]
fn a_fold_that_is_opened_at_the_lower_end_is_brought_into_sight() {
    let bottom = rig::SMALL[1];
    let model = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual));
    let [first, ..] = model.antennas[0].variant().actions else { panic!("no actions") };
    // The readings fit. The actions do not fit, and begin at the top.
    let field = format!("{}: {}", first.label, first.fields[0].label);
    let mut window = rig::window(rig::SMALL, model);
    for (fold, inside) in [("Readings: ", "Satellite: "), ("More: ", &field)] {
        let line = |window: &Window| window.get_by_label_contains(fold).rect();
        // Scroll as Tab does: the line comes just into view, at the lower end.
        window.get_by_label_contains(fold).focus();
        settle(&mut window);
        let before = line(&window);
        assert!(before.bottom() <= bottom && before.bottom() > bottom - 60.0, "{before:?}");
        window.get_by_label_contains(fold).click();
        settle(&mut window);
        let modes = window.get_by_role_and_label(Role::RadioButton, "Manual").rect();
        assert!(line(&window).top() >= modes.bottom(), "{fold} {:?}", line(&window));
        let content = window.get_by_label_contains(inside).rect();
        assert!(content.bottom() <= bottom, "{inside} {content:?}");
        // Closing the fold moves no remaining line upwards.
        let open = line(&window);
        window.get_by_label_contains(fold).click();
        settle(&mut window);
        assert!(line(&window).top() >= open.top(), "{fold}");
    }
}

/// Returns `true` if such a control of the card exists, and is whole in the window.
fn stays(window: &Window, size: [f32; 2], is_it: impl Fn(&str) -> bool) -> bool {
    let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
    let buttons = window.query_all_by_role(Role::Button);
    let mut found = buttons.filter(|of| is_it(&of.accesskit_node().label().unwrap_or_default()));
    found.any(|of| whole.contains_rect(of.rect()))
}

#[test]
fn track_jog_and_stop_stay_in_sight_however_far_the_card_is_scrolled() {
    let of_makes = cases().into_iter().map(|(config, snapshot)| makes::model(config, snapshot));
    let others = around_the_jog_keys().into_iter().map(|(_, model)| model);
    for (case, model) in of_makes.chain(others).enumerate() {
        let mut window = rig::window(rig::SMALL, model);
        for fold in ["Travel: ", "Readings: ", "Faults: ", "More: "] {
            if let Some(line) = window.query_by_label_contains(fold) {
                line.click_accesskit();
            }
            settle(&mut window);
        }
        let foot = pos2(rig::SMALL[0] - 120.0, rig::SMALL[1] - 8.0);
        rig::scroll(&mut window, foot, -5000.0);
        for starts in [&["STOP"][..], &["Jog "], &["Track ", "Hold 1 s to track anyway"]] {
            let is_it = |of: &str| starts.iter().any(|start| of.starts_with(start));
            let tracks = window.query_by_label_contains("Locked while tracking").is_some();
            let has_none = starts.contains(&"Track ")
                && (window.query_by_role_and_label(Role::RadioButton, "Track").is_none()
                    || window.query_by_label_contains("Selected and tracked").is_some())
                || tracks && starts.contains(&"Jog ");
            assert!(has_none || stays(&window, rig::SMALL, is_it), "case {case}: {starts:?}");
        }
    }
}

/// Returns the places of the jog keys for up and left, if there are any.
fn jog_keys(model: Model, size: [f32; 2]) -> Option<[Rect; 2]> {
    let window = rig::window(size, model);
    let place = |key| Some(window.query_by_label(key)?.rect());
    Some([place("Jog Y+")?, place("Jog X−")?])
}

fn told(refusal: Refusal) -> Model {
    let mut model = rig::model(states::manual());
    model.shown_mut().antennas[0].news = Some((Event::NotSent(refusal), rig::now()));
    model
}

fn offered_again() -> Model {
    let mut model = rig::model(states::manual());
    let command = contract::Command::Antenna(model.antennas[0].id(), Command::Resume);
    let name = "NOAA 20 (JPSS-1)".to_owned();
    model.shown_mut().antennas[0].track_again = Some(TrackAgain { name, command, end: rig::now() });
    model
}

fn unguarded() -> Model {
    let mut model = rig::model(Snapshot { unguarded: true, ..states::manual() });
    model.shown_mut().antennas[0].asks_unguarded = true;
    model
}

/// Returns states that add and remove lines around the jog keys.
fn around_the_jog_keys() -> Vec<(&'static str, Model)> {
    let since = states::moving().state.measured.unwrap().received;
    let stop = StopState::NotConfirmed { start: since };
    let inside = Some(Breach {
        barrier: Barrier::KeepOut("mast".into()),
        unknown_axis: None,
        may_leave: false,
    });
    let barrier = Barrier::KeepOut("the mast of the neighbours".into());
    let at = AzEl::from_degrees(103.0, 24.0);
    vec![
        ("holding", rig::model(states::holding())),
        ("tracking", rig::model(states::tracking(0.1))),
        ("moving", rig::model(states::moving())),
        ("would miss", rig::model(on_board::told(on_board::found(23.0)))),
        ("a little off", rig::model(on_board::told(on_board::found(0.2)))),
        ("stop", rig::model(Snapshot { stop, ..states::manual() })),
        (
            "left moving",
            rig::model(Snapshot {
                left_moving: Some(LeftMoving { start: Some(rig::now()) }),
                ..states::manual()
            }),
        ),
        ("inside", rig::model(Snapshot { breach: inside, ..states::manual() })),
        ("unguarded", unguarded()),
        ("track again", offered_again()),
        ("news", told(Refusal::NoRefuge)),
        ("long news", told(Refusal::Forbidden { barrier, direction: at })),
    ]
}

#[test]
fn nothing_that_comes_and_goes_moves_the_jog_keys() {
    for size in [rig::SMALL, rig::LARGE, [1920.0, 1080.0]] {
        let usual = jog_keys(rig::model(states::manual()), size);
        assert!(usual.is_some());
        for (what, model) in around_the_jog_keys() {
            // A low card has no jog keys while the antenna tracks a target, because they are locked
            // then.
            let is_without = size == rig::SMALL && what == "tracking";
            let wanted = if is_without { None } else { usual };
            assert_eq!(jog_keys(model, size), wanted, "{what} at {size:?}");
        }
    }
}
