//! Actions of single makes: every action of every make from its key to its command.

use azel::{
    contract::driver::{Command, Intent},
    device::{
        Variant,
        panel::{Act, Action},
        settings::{Field, Kind, Value, Values},
    },
    model::{Model, UiCommand},
    station::AntennaId,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    makes,
    rig::{self, Window, asked, says, settle},
    states,
};

fn models(intent: Intent) -> [Model; 3] {
    [
        makes::model(makes::pair(), makes::pair_at(intent)),
        makes::model(makes::alone(), makes::alone_at(intent, true)),
        makes::model(makes::rc2000c(), makes::rc2000c_at(intent)),
    ]
}

fn variant(model: &Model) -> &'static Variant {
    model.antennas[0].variant()
}

/// Returns a window with the actions unfolded.
fn unfolded(size: [f32; 2], model: Model) -> Window {
    let mut window = rig::window(size, model);
    // The actions are already unfolded if they have room.
    let line = window.get_by_label_contains("More: ");
    if line.accesskit_node().data().is_expanded() == Some(false) {
        line.click_accesskit();
    }
    settle(&mut window);
    window
}

/// Returns the text to type into a field, and its value.
fn sample(field: &Field) -> (&'static str, Value) {
    match field.kind {
        Kind::Integer { .. } => ("120", Value::Integer(120)),
        Kind::Text(_) => ("SBS 6", Value::Text("SBS 6".to_owned())),
        Kind::Flag => ("", Value::Flag(false)),
        Kind::Choice(choices) => ("", Value::Choice(choices[0].0)),
        ref other => panic!("{other:?}"),
    }
}

fn act(action: &Action, values: Values) -> UiCommand {
    UiCommand::antenna(AntennaId(1), Command::Act(Act { action: action.key, values }))
}

#[test]
fn every_action_goes_out_with_its_values_and_after_its_question() {
    for size in rig::sizes() {
        for model in models(Intent::Manual) {
            let actions = variant(&model).actions;
            assert!(!actions.is_empty());
            let mut window = unfolded(size, model);
            for action in actions {
                for field in action.fields.iter().filter(|field| !sample(field).0.is_empty()) {
                    let name = format!("{}: {}", action.label, field.label);
                    window.get_by_label(&name).focus();
                    settle(&mut window);
                    window.get_by_label(&name).type_text(sample(field).0);
                    settle(&mut window);
                }
                window.get_by_role_and_label(Role::Button, action.label).click_accesskit();
                let values =
                    action.fields.iter().map(|field| (field.key, sample(field).1)).collect();
                if let Some(question) = action.question {
                    assert_eq!(asked(&mut window), [], "{} asks first", action.key);
                    assert!(says(&window, question), "{}", action.key);
                    window.key_press(Key::Enter);
                }
                assert_eq!(asked(&mut window), [act(action, values)], "{}", action.key);
            }
        }
    }
}

#[test]
fn a_question_that_is_not_agreed_to_brings_nothing_about() {
    for size in rig::sizes() {
        for model in models(Intent::Manual) {
            let asking = variant(&model).actions.iter().find(|action| action.question.is_some());
            let Some(action) = asking else { continue };
            let mut window = unfolded(size, model);
            window.get_by_role_and_label(Role::Button, action.label).click_accesskit();
            settle(&mut window);
            window.key_press(Key::Escape);
            assert_eq!(asked(&mut window), []);
            assert!(!says(&window, action.question.unwrap_or_default()));
        }
    }
}

#[test]
fn what_moves_metal_is_locked_outside_of_its_modes_and_the_rest_is_not() {
    for size in rig::sizes() {
        for model in models(Intent::Standby) {
            let actions = variant(&model).actions;
            let plain = |action: &&Action| action.fields.is_empty() && action.question.is_none();
            let mut window = unfolded(size, model);
            for action in actions.iter().filter(plain) {
                window.get_by_role_and_label(Role::Button, action.label).click();
                window.get_by_role_and_label(Role::Button, action.label).click_accesskit();
                let wanted =
                    if action.moves { vec![] } else { vec![act(action, Values::default())] };
                let mut commands = asked(&mut window);
                commands.dedup();
                assert_eq!(commands, wanted, "{}", action.key);
            }
            if actions.iter().any(|action| action.moves) {
                assert!(says(&window, "Motion is locked."));
            }
        }
    }
}

#[test]
fn nothing_can_be_asked_for_without_a_link() {
    for size in rig::sizes() {
        let model = makes::model(makes::rc2000c(), makes::rc2000c_off());
        let actions = variant(&model).actions;
        let mut window = unfolded(size, model);
        for action in actions {
            window.get_by_role_and_label(Role::Button, action.label).click_accesskit();
        }
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn a_choice_and_a_flag_are_changed_in_their_menus() {
    let model = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual));
    let label = |model: &Model| {
        let action = variant(model).actions.iter();
        let of = |action: &&'static Action| {
            action.fields.iter().any(|field| matches!(field.kind, Kind::Flag))
        };
        action.filter(of).find(|action| action.fields.len() > 1)
    };
    let action = label(&model).expect("an action with a flag");
    let flag = action.fields.iter().find(|field| matches!(field.kind, Kind::Flag)).unwrap();
    let mut window = unfolded(rig::LARGE, model);
    for field in action.fields.iter().filter(|field| !sample(field).0.is_empty()) {
        let name = format!("{}: {}", action.label, field.label);
        window.get_by_label(&name).focus();
        settle(&mut window);
        window.get_by_label(&name).type_text(sample(field).0);
        settle(&mut window);
    }
    window.get_by_label(&format!("{}: {}", action.label, flag.label)).click_accesskit();
    settle(&mut window);
    window.get_by_role_and_label(Role::Button, "On").click_accesskit();
    settle(&mut window);
    window.get_by_role_and_label(Role::Button, action.label).click_accesskit();
    let mut values: Values =
        action.fields.iter().map(|field| (field.key, sample(field).1)).collect();
    values.insert(flag.key, Value::Flag(true));
    assert_eq!(asked(&mut window), [act(action, values)]);
}

#[test]
fn tab_brings_into_sight_what_it_leads_to() {
    let model = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual));
    let actions = variant(&model).actions;
    let last = actions.last().expect("an action").label;
    let mut window = unfolded(rig::SMALL, model);
    let place = |window: &Window| window.get_by_role_and_label(Role::Button, last).rect();
    assert!(place(&window).top() > rig::SMALL[1], "it has to be scrolled to");
    window.get_by_label_contains("More: ").focus();
    for _ in 0..40 {
        settle(&mut window);
        if window.get_by_role_and_label(Role::Button, last).is_focused() {
            break;
        }
        window.key_press(Key::Tab);
    }
    assert!(window.get_by_role_and_label(Role::Button, last).is_focused());
    settle(&mut window);
    assert!(place(&window).bottom() <= rig::SMALL[1], "{:?}", place(&window));
}

#[test]
fn the_checks_of_every_make_say_when_they_were_read() {
    let mut satrak = states::manual();
    states::report(&mut satrak, &[], rig::now());
    for (model, count) in [
        (rig::model(satrak), 12),
        (makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual)), 3),
    ] {
        let window = rig::window(rig::LARGE, model);
        let words = format!("No faults. All {count} checks passed, 11:15:30Z.");
        assert!(says(&window, &words), "{words}");
    }
}

#[test]
fn a_satrak_has_nothing_of_the_kind() {
    let window = rig::window(rig::LARGE, rig::model(states::manual()));
    assert!(window.query_by_label_contains("More: ").is_none());
    assert!(window.query_by_label_contains("Told by").is_none());
}
