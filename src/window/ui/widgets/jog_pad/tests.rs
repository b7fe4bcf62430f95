use super::*;
use crate::ui::widgets::testing;
use egui::{Event, Key, Pos2, pos2, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};

#[derive(Default)]
struct Pad {
    state: JogState,
    locked: bool,
    blocked: Vec<JogDirection>,
    direction: Option<JogDirection>,
}

const XY: JogKeys = JogKeys::Xy { x_plus: "E", x_minus: "W", y_plus: "N", y_minus: "S" };

fn pad(pad: Pad) -> Harness<'static, Pad> {
    let mut window = testing::window([200.0, 200.0], pad, |ui, pad| {
        let rect = Rect::from_min_size(pos2(20.0, 20.0), vec2(136.0, 136.0));
        let model = JogModel {
            locked: pad.locked,
            blocked: &pad.blocked,
            requested: "0.50",
            real_deg_s: Some(0.48),
            keys: XY,
        };
        pad.direction = show(ui, rect, &model, &mut pad.state);
    });
    window.run();
    window
}

fn key_at(window: &Harness<'_, Pad>, name: &str) -> Pos2 {
    window.get_by_label(name).rect().center()
}

#[test]
fn a_pointer_holds_a_key_until_it_is_released() {
    let mut window = pad(Pad::default());
    let position = key_at(&window, "Jog X+");
    window.drag_at(position);
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XPlus));
    // The pointer moves slightly for ten seconds.
    for _ in 0..40 {
        window.hover_at(position + vec2(9.0, 3.0));
        window.step();
        assert_eq!(window.state().direction, Some(JogDirection::XPlus));
    }
    window.drop_at(position);
    window.step();
    assert_eq!(window.state().direction, None);
}

#[test]
fn losing_the_window_releases_and_only_a_new_press_holds_again() {
    let mut window = pad(Pad::default());
    let position = key_at(&window, "Jog Y−");
    window.drag_at(position);
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::YMinus));
    window.input_mut().focused = false;
    window.step();
    assert_eq!(window.state().direction, None);
    window.input_mut().focused = true;
    window.step();
    assert_eq!(window.state().direction, None, "the old press must not move metal again");
    window.drop_at(position);
    window.step();
    window.drag_at(position);
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::YMinus));
}

#[test]
fn a_pointer_that_leaves_the_window_releases() {
    let mut window = pad(Pad::default());
    window.drag_at(key_at(&window, "Jog X−"));
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XMinus));
    window.event(Event::PointerGone);
    window.step();
    assert_eq!(window.state().direction, None);
}

#[test]
fn arrow_keys_jog_only_with_the_focus_on_the_pad() {
    let mut window = pad(Pad::default());
    window.key_down(Key::ArrowRight);
    window.step();
    assert_eq!(window.state().direction, None);
    window.key_up(Key::ArrowRight);
    window.get_by_label("Jog Y+").focus();
    window.run();
    window.key_down(Key::ArrowRight);
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XPlus));
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XPlus));
    window.key_up(Key::ArrowRight);
    window.step();
    assert_eq!(window.state().direction, None);
}

#[test]
fn space_holds_the_key_with_the_focus() {
    let mut window = pad(Pad::default());
    window.get_by_label("Jog X−").focus();
    window.run();
    window.key_down(Key::Space);
    window.run_steps(2);
    assert_eq!(window.state().direction, Some(JogDirection::XMinus));
    window.key_up(Key::Space);
    window.step();
    assert_eq!(window.state().direction, None);
}

#[test]
fn a_pad_that_is_given_the_keyboard_jogs_with_the_arrows_alone() {
    let mut window = pad(Pad::default());
    window.state_mut().state.focus();
    window.run();
    assert!(window.get_by_label("Jog with the arrow keys").is_focused());
    assert_eq!(window.state().direction, None, "the keyboard alone moves nothing");
    for key in [Key::Enter, Key::Space] {
        window.key_down(key);
        window.run_steps(2);
        assert_eq!(window.state().direction, None, "{key:?} names no direction");
        window.key_up(key);
    }
    for (key, direction) in
        [(Key::ArrowUp, JogDirection::YPlus), (Key::ArrowLeft, JogDirection::XMinus)]
    {
        window.key_down(key);
        window.run_steps(2);
        assert_eq!(window.state().direction, Some(direction));
        window.key_up(key);
        window.step();
        assert_eq!(window.state().direction, None);
    }
}

#[test]
fn an_arrow_that_is_already_down_does_not_jog_when_the_keyboard_comes() {
    let mut window = pad(Pad { locked: true, ..Pad::default() });
    window.key_down(Key::ArrowRight);
    window.step();
    window.state_mut().state.focus();
    window.state_mut().locked = false;
    window.run_steps(3);
    assert!(window.get_by_label("Jog with the arrow keys").is_focused());
    assert_eq!(window.state().direction, None);
}

#[test]
fn the_keyboard_comes_when_the_pad_is_free_unless_something_else_was_pressed() {
    for (other, comes) in [(None, true), (Some(Key::F), false)] {
        let mut window = pad(Pad { locked: true, ..Pad::default() });
        window.state_mut().state.focus();
        window.run_steps(2);
        if let Some(key) = other {
            window.key_press(key);
            window.run_steps(2);
        }
        window.state_mut().locked = false;
        window.run_steps(2);
        assert_eq!(window.get_by_label("Jog with the arrow keys").is_focused(), comes);
    }
}

#[test]
fn losing_the_window_or_the_right_to_jog_takes_the_keyboard_away() {
    for loses_window in [true, false] {
        let mut window = pad(Pad::default());
        window.state_mut().state.focus();
        window.run();
        window.key_down(Key::ArrowUp);
        window.step();
        assert_eq!(window.state().direction, Some(JogDirection::YPlus));
        window.input_mut().focused = !loses_window;
        window.state_mut().locked = !loses_window;
        window.run_steps(2);
        assert_eq!(window.state().direction, None);
        window.input_mut().focused = true;
        window.state_mut().locked = false;
        window.run_steps(2);
        assert!(!window.get_by_label("Jog with the arrow keys").is_focused());
        assert_eq!(window.state().direction, None);
    }
}

#[test]
fn losing_the_window_ends_a_jog_by_keyboard() {
    let mut window = pad(Pad::default());
    window.get_by_label("Jog Y+").focus();
    window.run();
    window.key_down(Key::ArrowUp);
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::YPlus));
    window.input_mut().focused = false;
    window.step();
    assert_eq!(window.state().direction, None);
    window.input_mut().focused = true;
    window.run_steps(2);
    assert_eq!(window.state().direction, None);
}

#[test]
fn escape_ends_a_jog() {
    let mut window = pad(Pad::default());
    window.drag_at(key_at(&window, "Jog X+"));
    window.step();
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert_eq!(window.state().direction, None);
}

#[test]
fn a_limit_blocks_its_own_direction_only() {
    let mut window = pad(Pad { blocked: vec![JogDirection::XPlus], ..Pad::default() });
    let position = key_at(&window, "Jog X+");
    window.drag_at(position);
    window.step();
    assert_eq!(window.state().direction, None);
    window.drop_at(position);
    window.step();
    window.drag_at(key_at(&window, "Jog X−"));
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XMinus));
}

#[test]
fn a_limit_that_is_reached_ends_the_jog() {
    let mut window = pad(Pad::default());
    window.drag_at(key_at(&window, "Jog X+"));
    window.step();
    assert_eq!(window.state().direction, Some(JogDirection::XPlus));
    window.state_mut().blocked.push(JogDirection::XPlus);
    window.step();
    assert_eq!(window.state().direction, None);
}

#[test]
fn a_locked_pad_does_nothing() {
    let mut window = pad(Pad { locked: true, ..Pad::default() });
    window.drag_at(key_at(&window, "Jog Y+"));
    window.run_steps(2);
    assert_eq!(window.state().direction, None);
}

#[test]
fn the_keys_say_what_they_turn_on_every_mount() {
    let names = |keys: JogKeys| -> Vec<String> {
        let labels = JogDirection::ALL.into_iter().filter_map(|direction| keys.label(direction));
        labels.map(|label| label.name).collect()
    };
    assert_eq!(names(XY), ["Y+", "X−", "X+", "Y−"]);
    assert_eq!(names(JogKeys::AzEl), ["up", "counterclockwise", "clockwise", "down"]);
    let alone = ["Other +", "counterclockwise", "clockwise", "Other −"];
    assert_eq!(names(JogKeys::AzOther("Other")), alone);
    assert_eq!(names(JogKeys::Az), ["counterclockwise", "clockwise"]);
}
