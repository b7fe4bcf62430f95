//! Popups over the window, which must also close without Esc, because Esc is STOP too.

use azel::model::View;
use egui::{Key, Role, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, SIZES, Window, asked, settle},
    settings_rig::press,
    states,
};

/// Returns `true` if a popup is open, recognized by an item that only it has.
fn is_open(window: &Window, inside: &str) -> bool {
    window.query_all_by_label_contains(inside).next().is_some()
}

fn open(window: &mut Window, key: &str) {
    window.get_all_by_label_contains(key).next().unwrap().click();
    settle(window);
}

/// Clicks on the empty background of the sky plot.
fn click_outside(window: &mut Window) {
    let place = pos2(0.45 * window.ctx.content_rect().width(), 150.0);
    window.hover_at(place);
    window.drag_at(place);
    window.drop_at(place);
    settle(window);
}

/// A menu closes by a click outside and by the key that opened it.
#[test]
fn menus_close_by_a_click_outside_and_by_their_own_key() {
    for size in rig::sizes() {
        for (key, inside) in [
            ("Station Şile 1", "Night theme"),
            ("Link of Satrak", "Disconnect"),
            ("Follow something else", "Follow the Moon"),
        ] {
            let mut window = rig::window(size, rig::model(states::holding()));
            open(&mut window, key);
            assert!(is_open(&window, inside), "{key}");
            click_outside(&mut window);
            assert!(!is_open(&window, inside), "{key}: a click outside");
            open(&mut window, key);
            assert!(is_open(&window, inside), "{key}");
            open(&mut window, key);
            assert!(!is_open(&window, inside), "{key}: its key");
            assert_eq!(asked(&mut window), []);
        }
    }
}

/// Popups that stay open during use have a key to close them.
#[test]
fn popups_close_by_a_click_outside_and_by_a_close_key() {
    for size in SIZES {
        for (key, inside) in [("alarm", "No alarms today"), ("Layers", "Sun and Moon")] {
            for by_key in [false, true] {
                let mut window = rig::window(size, rig::model(states::holding()));
                open(&mut window, key);
                assert!(is_open(&window, inside), "{key}");
                if by_key {
                    press(&mut window, "Close");
                } else {
                    click_outside(&mut window);
                }
                settle(&mut window);
                let left: Vec<_> = window
                    .query_all_by_label_contains(inside)
                    .map(|node| (node.rect(), node.accesskit_node().role()))
                    .collect();
                assert!(left.is_empty(), "{size:?} {key}, by its key: {by_key}: {left:?}");
            }
        }
    }
}

#[test]
fn questions_and_dialogs_close_by_a_click_outside_and_by_a_key() {
    for size in SIZES {
        for (shortcut, key, inside, close) in [
            (Some(Key::T), "", "Track NOAA 20 with Satrak?", "Cancel"),
            (Some(Key::Questionmark), "", "this list", "Close"),
            (None, "Lock out…", "Hold 1 s to lock out", "Cancel"),
        ] {
            for by_key in [false, true] {
                let mut window = rig::window(size, rig::model(states::holding()));
                if let Some(shortcut) = shortcut {
                    window.key_press(shortcut);
                } else {
                    press(&mut window, "Link of Satrak");
                    press(&mut window, key);
                }
                settle(&mut window);
                assert!(is_open(&window, inside), "{inside}");
                if by_key {
                    press(&mut window, close);
                } else {
                    let corner = pos2(4.0, window.ctx.content_rect().bottom() - 4.0);
                    window.drag_at(corner);
                    window.drop_at(corner);
                }
                settle(&mut window);
                assert!(!is_open(&window, inside), "{inside}, by its key: {by_key}, {size:?}");
                assert_eq!(asked(&mut window), [], "{inside}");
            }
        }
    }
}

#[test]
fn a_drop_down_closes_by_a_click_outside_and_by_its_own_key() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        model.view = View::Console;
        let mut window = rig::window(size, model);
        let boxes = window.get_all_by_role(Role::ComboBox).count();
        assert!(boxes > 0);
        for index in 0..boxes {
            let click = |window: &mut Window| {
                window.get_all_by_role(Role::ComboBox).nth(index).unwrap().click();
                settle(window);
            };
            let nodes = |window: &Window| window.get_all_by_role(Role::Button).count();
            let before = nodes(&window);
            click(&mut window);
            assert!(nodes(&window) > before, "box {index} is open");
            click(&mut window);
            assert_eq!(nodes(&window), before, "box {index}: its key");
            click(&mut window);
            click_outside(&mut window);
            assert_eq!(nodes(&window), before, "box {index}: a click outside");
        }
    }
}
