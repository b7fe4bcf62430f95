//! Number of frames that one input costs.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use azel::{app::frames, model::UiCommand};
use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, LARGE, Window, asked},
    states,
};

/// Returns a window, and a flag that is `true` if another frame is due at once.
fn counted() -> (Window, Arc<AtomicBool>) {
    let mut window = rig::window(LARGE, rig::model(states::manual()));
    let due = Arc::<AtomicBool>::default();
    let told = Arc::clone(&due);
    frames::draw_once(&window.ctx, move |asked| {
        told.fetch_or(asked.delay.is_zero(), Ordering::Relaxed);
    });
    rig::settle(&mut window);
    (window, due)
}

/// Draws frames until none is due, each with the next of `inputs` while there are any. Returns
/// their number.
fn drawn((window, due): &mut (Window, Arc<AtomicBool>), inputs: &[&[Event]]) -> usize {
    let mut inputs = inputs.iter();
    let mut frames = 0;
    let mut takes = inputs.next();
    while takes.is_some() || due.load(Ordering::Relaxed) {
        window
            .input_mut()
            .events
            .extend(takes.into_iter().flat_map(|events| events.iter().cloned()));
        due.store(false, Ordering::Relaxed);
        window.step();
        frames += 1;
        assert!(frames < 20, "{:?}", window.ctx.repaint_causes());
        takes = inputs.next();
    }
    frames
}

fn key(key: Key, pressed: bool) -> Event {
    Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE }
}

fn button(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

#[test]
fn a_key_costs_the_frame_that_takes_it_and_the_one_that_shows_what_came_of_it() {
    let mut counted = counted();
    assert_eq!(drawn(&mut counted, &[&[]]), 1);
    // F9 has no function here.
    for quick in [Key::F9, Key::ArrowDown] {
        assert_eq!(drawn(&mut counted, &[&[key(quick, true), key(quick, false)]]), 2);
        assert_eq!(drawn(&mut counted, &[&[key(quick, true)], &[key(quick, false)]]), 2);
        assert_eq!(drawn(&mut counted, &[&[key(quick, true)]]), 2);
        assert_eq!(drawn(&mut counted, &[&[key(quick, false)]]), 1);
    }
    let (window, _) = &mut counted;
    let selects = |command: &UiCommand| matches!(command, UiCommand::SelectPass(_));
    assert!(asked(window).iter().any(selects));
}

#[test]
fn a_click_costs_a_frame_for_each_way_of_the_button_and_the_one_that_shows_what_came_of_it() {
    let mut counted = counted();
    let (window, _) = &mut counted;
    let row = window.get_all_by_role(egui::Role::ListBoxOption).next().unwrap();
    let at = row.rect().center();
    drawn(&mut counted, &[&[Event::PointerMoved(at)]]);
    assert_eq!(drawn(&mut counted, &[&[button(at, true)], &[button(at, false)]]), 3);
}
