//! Keys and their list.

use azel::{
    engine::{alarms::AlarmKind, passes::PredictedPass},
    model::{UiCommand, View},
    ui::keys::{ALL, Binding, KeyScope, list::in_words},
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, LARGE, SIZES, SMALL, Window, asked, settle},
    states,
};

/// A window in which every key has something to do.
fn opened(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::manual());
    for name in ["Mast", "Roof", "Field"] {
        let mut config = model.station.antennas[0].clone();
        name.clone_into(&mut config.name);
        model.antennas.push(rig::antenna(config, states::manual()));
    }
    model.alarms.raise(None, AlarmKind::Elements("the file is empty".to_owned()), model.now);
    model.selected = model.pass_lists.favourites.passes.get(2).map(PredictedPass::key);
    let mut window = rig::window(size, model);
    // One step from the ends of the choices.
    window.key_press(Key::Plus);
    asked(&mut window);
    window
}

/// All texts of the window.
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
    format!("{}: {}", in_words(binding), binding.does)
}

#[test]
fn every_key_of_the_list_does_something() {
    for binding in ALL.iter().filter(|binding| binding.place != KeyScope::Focus) {
        for key in binding.keys() {
            let mut window = opened(SMALL);
            if binding.place == KeyScope::Map {
                window.state_mut().model.view = View::Map;
                window.state_mut().model.refresh_sky();
                // One step from the ends of what can be chosen.
                window.key_press(Key::Plus);
                asked(&mut window);
            }
            let other = match binding.place {
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

#[test]
fn no_two_lines_of_the_list_take_the_same_key() {
    let taken: Vec<(Modifiers, Key, KeyScope)> = ALL
        .iter()
        .flat_map(|binding| binding.keys().map(|key| (binding.modifiers, key, binding.place)))
        .collect();
    for (index, (modifiers, key, place)) in taken.iter().enumerate() {
        let same = taken[index + 1..].iter().find(|(other_modifiers, other, other_place)| {
            let views = [KeyScope::Operate, KeyScope::Map];
            let are_apart =
                place != other_place && views.contains(place) && views.contains(other_place);
            (modifiers, key) == (other_modifiers, other)
                && (*place == KeyScope::Focus) == (*other_place == KeyScope::Focus)
                && !are_apart
        });
        assert_eq!(same, None);
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
    for size in SIZES {
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
    for size in SIZES {
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
    for size in SIZES {
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
    /// Bottom of the list in a wide and low window.
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
    // The operator's scroll position stays.
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
