//! Copying of shown texts to another program or a message.

use egui::{Event, Role, accesskit::Live};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    console::copied,
    rig::{self, LARGE, Window, settle},
    states,
};

/// Returns the first row of the list of passes.
fn row(window: &Window) -> Node<'_> {
    let mut rows = window.get_all_by_role(Role::ListBoxOption);
    let is_row = |node: &Node<'_>| {
        node.accesskit_node().label().is_some_and(|label| label.contains(", AOS T"))
    };
    rows.find(is_row).unwrap()
}

/// Opens a menu by `open`, chooses `item` and returns the copied text.
fn choose(window: &mut Window, item: &str, open: impl FnOnce(&Window)) -> String {
    open(window);
    settle(window);
    copied(window, |window| window.get_by_label(item).click()).join("\n")
}

#[test]
fn pass_and_sentence_are_copied_from_their_menus() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    let pass = choose(&mut window, "Copy this pass", |window| row(window).click_secondary());
    assert!(pass.contains("AOS 20") && pass.contains("max "), "{pass}");
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    let sentence = choose(&mut window, "Copy this sentence", |window| {
        let nodes = window.get_all_by_label_contains("Holding at");
        let lives = |node: &Node<'_>| node.accesskit_node().live() == Live::Polite;
        nodes.into_iter().find(lives).unwrap().click_secondary();
    });
    assert!(sentence.starts_with("Holding at"), "{sentence}");
}

#[test]
fn the_row_with_the_focus_is_copied_with_the_keys() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    row(&window).click();
    settle(&mut window);
    let pass = copied(&mut window, |window| window.event(Event::Copy)).join("\n");
    assert!(pass.contains("AOS 20") && pass.contains("LOS 20"), "{pass}");
}
