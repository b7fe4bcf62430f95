//! Keys and the list of keys.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use azel::{
    astro::{
        Angle, TrackOffsets,
        xy_mount::{AxisAngles, azel_from_axes},
    },
    contract::{alarms::AlarmKind, driver, passes::PredictedPass},
    engine::alarms::KeepAlarms,
    model::{UiCommand, View},
    station::{AntennaId, Mount, Take},
    ui::{
        format,
        keys::{ALL, Binding, KeyScope, list::in_words},
    },
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    following, plan, record, replay,
    rig::{self, LARGE, SIZES, SMALL, Window, asked, settle},
    sky_time, states,
};

/// Returns a window in which every key has something to do.
fn opened(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::manual());
    for name in ["Mast", "Roof", "Field"] {
        let mut config = model.station.antennas[0].clone();
        name.clone_into(&mut config.name);
        model.shown_mut().antennas.push(rig::antenna(config, states::manual()));
    }
    let now = model.now;
    model.shown_mut().alarms.raise(None, AlarmKind::Elements("the file is empty".to_owned()), now);
    model.selected = model.pass_lists.favourites.passes.get(2).map(PredictedPass::key);
    let mut window = rig::window(size, model);
    // Go one step away from the end of the choices.
    window.key_press(Key::Plus);
    asked(&mut window);
    window
}

/// Returns all texts of the window.
fn all_words(window: &Window) -> Vec<String> {
    window
        .query_all(egui_kittest::kittest::By::new())
        .map(|node| {
            let node = node.accesskit_node();
            format!("{:?} {:?} {:?}", node.label(), node.value(), node.numeric_value())
        })
        .collect()
}

fn line(binding: &Binding) -> String {
    format!("{}: {}", in_words(binding), binding.does_where())
}

#[test]
fn k_asks_whether_to_park_and_says_where() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::K);
        assert_eq!(asked(&mut window), []);
        let park = window.state().model.antennas[0].config.park_direction();
        let [azimuth, elevation] =
            [park.azimuth_deg(), park.elevation_deg()].map(|deg| format::degrees(deg, 1));
        let where_to = format!("It parks at azimuth {azimuth}, elevation {elevation}.");
        window.get_by_label_contains(&format!("Park Satrak? {where_to}"));
        window.key_press(Key::Enter);
        let park = UiCommand::antenna(AntennaId(1), driver::Command::Park);
        assert_eq!(asked(&mut window), [park]);
        window.get_by_role_and_label(Role::RadioButton, "Park").click();
        settle(&mut window);
        window.get_by_label(&where_to);
    }
}

#[test]
fn enter_on_cancel_says_no() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::K);
        settle(&mut window);
        window.get_by_role_and_label(Role::Button, "Cancel").focus();
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), []);
        settle(&mut window);
        assert!(window.query_by_label_contains("Park Satrak?").is_none(), "it is answered");
    }
}

#[test]
fn the_keys_of_an_x_y_mount_say_which_way_on_the_sky_they_lead() {
    let window = rig::window(SMALL, rig::model(states::manual()));
    let Mount::Xy { lower_axis_azimuth_deg, .. } = window.state().model.antennas[0].config.mount
    else {
        panic!("no X/Y mount")
    };
    let zenith = Angle::from_degrees(0.0);
    for (key, lower, upper) in [("Jog X+", 1.0, 0.0), ("Jog Y+", 0.0, 1.0), ("Jog X−", -1.0, 0.0)]
    {
        let [lower, upper] = [lower, upper].map(|deg| zenith + Angle::from_degrees(deg));
        let axes = AxisAngles { lower, upper };
        let leads = azel_from_axes(axes, Angle::from_degrees(lower_axis_azimuth_deg));
        let side = format::side_of_sky(leads.azimuth_deg());
        let node = window.get_by_label(key);
        let about = node.accesskit_node().data().description().map(str::to_owned);
        let axis = key.trim_start_matches("Jog ");
        assert_eq!(about, Some(format!("{axis}: towards {side}")));
    }
}

#[test]
fn every_key_of_the_list_does_something() {
    for binding in ALL.iter().filter(|binding| binding.place != KeyScope::Focus) {
        for key in binding.keys() {
            let mut window = opened(SMALL);
            if binding.place == KeyScope::Map {
                window.state_mut().model.view = View::Map;
                window.state_mut().model.refresh_sky();
                // Go one step away from the end of the choices.
                window.key_press(Key::Plus);
                asked(&mut window);
            }
            if binding.place == KeyScope::Plan {
                window = plan::view(SMALL);
                // Set the other choice first, so that the key changes the choice.
                let take = if key == Key::V { Take::Always } else { Take::Never };
                let model = &mut window.state_mut().model;
                let pass = model.selected_pass().unwrap();
                let (satellite, tca) = (pass.number(), pass.pass.tca.time);
                let now = model.now;
                Arc::make_mut(&mut model.shown_mut().station).choose_pass(
                    satellite,
                    tca,
                    Some(take),
                    now,
                );
                window.key_press(Key::Plus);
                asked(&mut window);
            }
            if binding.place == KeyScope::Record {
                window = record::to_correct(SMALL);
                window.state_mut().model.shown_mut().record = Some(Arc::default());
                asked(&mut window);
                // No row follows the last one.
                if key == Key::ArrowUp {
                    window.key_press(Key::ArrowDown);
                    asked(&mut window);
                }
            }
            if binding.place == KeyScope::Replay {
                window = rig::window(SMALL, replay::model());
            }
            if key == Key::Home && binding.place == KeyScope::Operate {
                window = sky_time::later(SMALL);
            }
            if binding.does.starts_with("while tracking") {
                let model = following::tracking(TrackOffsets::NONE);
                window = rig::window(SMALL, model);
            }
            let other = match binding.place {
                KeyScope::Plan => Some(View::Plan),
                KeyScope::Elements => Some(View::Elements),
                KeyScope::Preferences => Some(View::Preferences),
                _ => None,
            };
            if let Some(view) = other {
                window.state_mut().model.view = view;
                rig::settle(&mut window);
            }
            let before = all_words(&window);
            window.key_press_modifiers(binding.modifiers, key);
            let asked = asked(&mut window);
            let field = window.query_by_label("Go to azimuth, degrees");
            let seen =
                field.is_some_and(|field| field.is_focused()) || all_words(&window) != before;
            assert!(!asked.is_empty() || seen, "{}", line(binding));
        }
    }
}

const VIEWS: [View; 9] = [
    View::Operate,
    View::Plan,
    View::Elements,
    View::Antennas,
    View::Console,
    View::Record,
    View::Map,
    View::Preferences,
    View::Setup,
];

/// Returns `true` if the key works in the view without the focus on a certain control.
fn is_live(binding: &Binding, view: View) -> bool {
    match binding.place {
        KeyScope::Everywhere | KeyScope::Views => true,
        KeyScope::Operate => view == View::Operate,
        KeyScope::Record => view == View::Record,
        KeyScope::Map => view == View::Map,
        KeyScope::Plan => view == View::Plan,
        KeyScope::Elements => view == View::Elements,
        KeyScope::Preferences => view == View::Preferences,
        // The keys of a replay come before those of the views.
        KeyScope::Focus | KeyScope::Replay => false,
    }
}

#[test]
fn no_key_has_two_effects_in_any_view() {
    let once = |bindings: Vec<&Binding>, place: &str| {
        let mut taken: Vec<(Modifiers, Key)> = Vec::new();
        for binding in bindings {
            for key in binding.keys() {
                assert!(!taken.contains(&(binding.modifiers, key)), "{place}: {}", line(binding));
                taken.push((binding.modifiers, key));
            }
        }
    };
    for view in VIEWS {
        once(ALL.iter().filter(|of| is_live(of, view)).collect(), &format!("{view:?}"));
    }
    for place in [KeyScope::Focus, KeyScope::Replay] {
        once(ALL.iter().filter(|of| of.place == place).collect(), &format!("{place:?}"));
    }
}

/// Key in the code of a control, which takes the key while it has the focus.
#[derive(Debug)]
struct Taken {
    /// File below the folder of the views.
    place: String,
    key: Key,
    is_with_ctrl: bool,
}

fn keys_of_controls() -> Vec<Taken> {
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                sources(&path, found);
            } else {
                found.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/window/ui");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let mut keys = Vec::new();
    for file in files {
        let place = file.strip_prefix(&root).unwrap().to_string_lossy().into_owned();
        let is_test = place.ends_with("tests.rs") || place.ends_with("stories.rs");
        if place.starts_with("keys") || is_test {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        for (at, _) in code.match_indices("Key::") {
            let (before, named) = (&code[..at], &code[at + "Key::".len()..]);
            let name: String = named.chars().take_while(char::is_ascii_alphanumeric).collect();
            // Labels of drawings have their own keys, which are not on the keyboard.
            let Some(key) = Key::ALL.iter().find(|key| format!("{key:?}") == name) else {
                continue;
            };
            let is_with_ctrl = before.ends_with("Modifiers::COMMAND, ");
            keys.push(Taken { place: place.clone(), key: *key, is_with_ctrl });
        }
    }
    keys
}

/// Returns the views in which a control of this file can have the focus.
fn views_of(place: &str) -> Vec<View> {
    // The other lists take only the arrows.
    if place == "widgets/list.rs" {
        return vec![View::Elements, View::Console];
    }
    let one = match place.split(['/', '.']).next().unwrap() {
        "operate" | "pass_list" | "profile" | "sky_plot" | "timeline" => View::Operate,
        "elements" => View::Elements,
        "antennas" => View::Antennas,
        "console" => View::Console,
        "map" => View::Map,
        "record" => View::Record,
        "preferences" => View::Preferences,
        "setup" => View::Setup,
        _ => return VIEWS.into(),
    };
    vec![one]
}

#[test]
fn no_control_takes_a_key_that_means_something_else_in_its_view() {
    // In a view, these keys work only while no control has the focus.
    let arrows = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];
    let unfocused = [&arrows[..], &[Key::Space, Key::Enter]].concat();
    let found = keys_of_controls();
    assert!(found.len() > 40, "{found:?}");
    for Taken { place, key, is_with_ctrl } in found {
        for view in views_of(&place) {
            let modifiers = if is_with_ctrl { Modifiers::COMMAND } else { Modifiers::NONE };
            let live = ALL.iter().filter(|of| of.modifiers == modifiers && is_live(of, view));
            let same = live.filter(|of| of.keys().any(|of| of == key)).map(line).next();
            assert!(same.is_none() || unfocused.contains(&key), "{place}: {key:?}, {same:?}");
        }
    }
}

#[test]
fn every_key_of_a_control_is_in_the_list() {
    /// Keys with a common meaning in every table, row and drawing of a desktop.
    const USUAL: [Key; 10] = [
        Key::Home,
        Key::End,
        Key::PageUp,
        Key::PageDown,
        // These keys open the menu of the focused control.
        Key::F10,
        Key::Menu,
        // With Ctrl, these keys select all rows and redo a change.
        Key::A,
        Key::Y,
        // This key acts as Delete.
        Key::Backspace,
        // The list of keys names only 1 and 5 of the keys 1 to 5.
        Key::Num2,
    ];
    for Taken { place, key, .. } in keys_of_controls() {
        let is_between = [Key::Num3, Key::Num4].contains(&key);
        let is_listed = ALL.iter().any(|binding| binding.keys().any(|of| of == key));
        assert!(is_listed || is_between || USUAL.contains(&key), "{place}: {key:?}");
    }
}

fn is_open(window: &Window) -> bool {
    window.query_by_role_and_label(Role::Button, "Close").is_some()
}

#[test]
fn the_question_mark_opens_the_whole_list_and_it_closes_in_every_way() {
    for size in SIZES {
        let mut window = opened(size);
        for close in ["Esc", "?", "Close", "outside"] {
            assert!(!is_open(&window), "{close}");
            window.key_press(Key::Questionmark);
            settle(&mut window);
            assert!(is_open(&window), "{close}");
            for binding in &ALL {
                let row = window.get_by_label(&line(binding)).rect();
                assert!(row.top() > 0.0 && row.bottom() < size[1], "{}: {row:?}", line(binding));
            }
            match close {
                "Esc" => window.key_press(Key::Escape),
                "?" => window.key_press(Key::Questionmark),
                "Close" => window.get_by_role_and_label(Role::Button, "Close").click(),
                _ => {
                    let at = egui::pos2(10.0, size[1] - 10.0);
                    window.drag_at(at);
                    window.drop_at(at);
                }
            }
            settle(&mut window);
        }
        assert!(!is_open(&window));
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn while_the_list_is_open_only_stop_works_below_it() {
    for size in rig::sizes() {
        let mut window = opened(size);
        window.key_press(Key::Questionmark);
        settle(&mut window);
        for key in [Key::T, Key::M, Key::N, Key::A, Key::ArrowDown] {
            window.key_press(key);
        }
        assert_eq!(asked(&mut window), []);
        window.get_by_label("STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}

#[test]
fn a_question_mark_that_is_typed_opens_nothing() {
    for size in rig::sizes() {
        let mut window = opened(size);
        window.get_by_label("Go to azimuth, degrees").focus();
        settle(&mut window);
        window.key_press(Key::Questionmark);
        settle(&mut window);
        assert!(!is_open(&window));
    }
}

#[test]
fn plus_minus_and_zero_zoom_the_strip() {
    for (size, steps) in [
        (LARGE, ["Next 12 hours", "Next 8 hours", "Next 12 hours", "Next 24 hours"]),
        (SMALL, ["Next 4 hours", "Next 2 hours", "Next 4 hours", "Next 8 hours"]),
    ] {
        let mut window = rig::window(size, rig::model(states::holding()));
        let shows = |window: &Window, wanted: &str| {
            window.get_by_role_and_label(Role::ListBox, wanted);
        };
        shows(&window, steps[0]);
        for (key, wanted) in [Key::Plus, Key::Minus, Key::Minus].into_iter().zip(&steps[1..]) {
            window.key_press(key);
            settle(&mut window);
            shows(&window, wanted);
        }
        window.key_press(Key::Num0);
        settle(&mut window);
        shows(&window, steps[0]);
        for _ in 0..6 {
            window.key_press(Key::Plus);
        }
        settle(&mut window);
        shows(&window, "Next hour");
    }
}

#[test]
fn up_and_down_lead_from_pass_to_pass_wherever_no_control_has_the_focus() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        let keys: Vec<_> = window
            .state()
            .model
            .pass_lists
            .favourites
            .passes
            .iter()
            .map(PredictedPass::key)
            .collect();
        for (at, key, wanted) in
            [(1, Key::ArrowDown, Some(2)), (2, Key::ArrowUp, Some(1)), (0, Key::ArrowUp, None)]
        {
            window.state_mut().model.selected = Some(keys[at]);
            settle(&mut window);
            window.key_press(key);
            let wanted: Vec<_> =
                wanted.map(|at: usize| UiCommand::SelectPass(keys[at])).into_iter().collect();
            assert_eq!(asked(&mut window), wanted);
        }
        window.get_by_label("Jog X+");
        window.get_by_role_and_label(Role::RadioButton, "Manual").focus();
        settle(&mut window);
        window.key_press(Key::ArrowDown);
        assert_eq!(asked(&mut window), [], "the focus is elsewhere");
    }
}

#[test]
fn a_pass_that_is_selected_elsewhere_is_scrolled_into_view() {
    /// Bottom of the list in a wide and low window, points.
    const BOTTOM: f32 = 560.0;
    let mut window = rig::window([1440.0, 640.0], rig::model(states::holding()));
    let passes = window.state().model.pass_lists.favourites.passes.clone();
    let list = |window: &Window, index: usize| {
        let name = format!("{}, ", passes[index].satellite.short_name());
        let selected = window.query_all_by_role(Role::ListBoxOption).find(|node| {
            node.accesskit_node().is_selected() == Some(true) && node.rect().left() < 100.0
        });
        selected
            .filter(|node| {
                node.accesskit_node().label().is_some_and(|label| label.starts_with(&name))
            })
            .map(|node| node.rect())
    };
    let last = passes.len() - 1;
    for index in [last / 2, 0, last] {
        window.state_mut().model.selected = Some(passes[index].key());
        window.state_mut().model.refresh_sky();
        settle(&mut window);
        let row = list(&window, index).expect("its row is there");
        assert!(row.top() >= 87.0 && row.bottom() <= BOTTOM + 1.0, "{index}: {row:?}");
    }
    // The list keeps the operator's scroll position.
    rig::scroll(&mut window, egui::pos2(230.0, 400.0), 5000.0);
    let row = list(&window, last).expect("its row is partly there");
    assert!(row.bottom() > BOTTOM, "{row:?}");
}

#[test]
fn the_list_opens_with_the_mouse() {
    for size in SIZES {
        for view in [View::Operate, View::Map, View::Preferences] {
            let mut model = rig::model(states::holding());
            model.view = view;
            let mut window = rig::window(size, model);
            let button = window.get_by_role_and_label(Role::Button, "Keys");
            assert!(button.rect().bottom() <= size[1], "{:?}", button.rect());
            button.click();
            settle(&mut window);
            window.get_by_label_contains("Ctrl L: next theme");
            window.get_by_role_and_label(Role::Button, "Close").click();
            settle(&mut window);
            assert!(!is_open(&window));
        }
    }
}
