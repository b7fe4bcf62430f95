use super::*;
use crate::ui::widgets::testing;
use egui::vec2;
use egui_kittest::{Harness, kittest::Queryable as _};

const MODEL: GoToModel = GoToModel {
    locked: false,
    azimuth_range_deg: (0.0, 360.0),
    elevation_range_deg: Some((0.0, 90.0)),
    commanded_deg: (Some(185.5), Some(37.4)),
    decimals: 2,
};

type Story = (GoToState, Vec<GoToAction>);

fn fields(model: GoToModel) -> Harness<'static, Story> {
    let mut window = testing::window(
        [220.0, 140.0],
        (GoToState::default(), Vec::new()),
        move |ui, (state, actions): &mut Story| {
            let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(155.0, HEIGHT));
            actions.extend(show(ui, rect, &model, state));
        },
    );
    window.run();
    window
}

fn write(window: &mut Harness<'_, Story>, field: &str, words: &str) {
    window.get_by_label(field).focus();
    window.run();
    window.get_by_label(field).type_text(words);
    window.run();
}

const AZIMUTH: &str = "Go to azimuth, degrees";
const ELEVATION: &str = "Go to elevation, degrees";
const TARGET: Target = Target { azimuth_deg: 121.5, elevation_deg: Some(8.0) };

#[test]
fn enter_previews_and_enter_again_sends() {
    let mut window = fields(MODEL);
    write(&mut window, AZIMUTH, "121,5");
    write(&mut window, ELEVATION, "8");
    window.key_press(Key::Enter);
    window.run();
    assert_eq!(window.state().1, [GoToAction::Preview(TARGET)]);
    window.key_press(Key::Enter);
    window.run();
    assert_eq!(window.state().1, [GoToAction::Preview(TARGET), GoToAction::Send(TARGET)]);
}

#[test]
fn typing_after_the_preview_needs_a_new_preview() {
    let mut window = fields(MODEL);
    write(&mut window, AZIMUTH, "121.5");
    write(&mut window, ELEVATION, "8");
    window.key_press(Key::Enter);
    window.run();
    window.get_by_label(ELEVATION).type_text("5");
    window.run();
    window.key_press(Key::Enter);
    window.run();
    let changed = Target { elevation_deg: Some(85.0), ..TARGET };
    assert_eq!(window.state().1, [GoToAction::Preview(TARGET), GoToAction::Preview(changed)]);
}

#[test]
fn the_button_sends_at_once() {
    let mut window = fields(MODEL);
    write(&mut window, AZIMUTH, "121.5");
    write(&mut window, ELEVATION, "8");
    window.get_by_role_and_label(Role::Button, "Go to").click();
    window.run();
    assert_eq!(window.state().1, [GoToAction::Send(TARGET)]);
}

#[test]
fn bad_input_keeps_the_typing_and_says_why() {
    let mut window = fields(MODEL);
    write(&mut window, AZIMUTH, "12..5");
    write(&mut window, ELEVATION, "8");
    window.get_by_role_and_label(Role::Button, "Go to").click();
    window.run();
    let (state, actions) = window.state();
    assert!(actions.is_empty());
    assert_eq!(state.azimuth, "12..5");
    assert_eq!(state.refusal(), Some("Azimuth “12..5” is not a number. Write 85.5 or 85,5."));
}

#[test]
fn locked_fields_show_the_command_and_send_nothing() {
    let mut window = fields(GoToModel { locked: true, ..MODEL });
    assert_eq!(window.get_by_label(AZIMUTH).value().as_deref(), Some("185.50"));
    window.get_by_role_and_label(Role::Button, "Go to").click();
    window.run();
    assert!(window.state().1.is_empty());
}
