//! What is told through the desktop: set in Preferences, and noted in the window.

use azel::station::{Notices, QuietHours, Station};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::{form, saved, write},
    rig::{SIZES, Window, asked, says, settle},
};

/// The page of notices.
fn page(size: [f32; 2]) -> Window {
    let mut window = form(size);
    window.get_by_role_and_label(Role::RadioButton, "Alarms and sounds").click();
    settle(&mut window);
    window
}

/// Chooses `word` in the field `label`.
fn choose(window: &mut Window, label: &str, word: &str) {
    let group = window.get_by_role_and_label(Role::RadioGroup, label).rect();
    let buttons = window.get_all_by_role_and_label(Role::RadioButton, word);
    let of_group = buttons.into_iter().find(|node| group.contains(node.rect().center()));
    of_group.expect("such a choice").click();
    settle(window);
}

fn mark_iss(window: &mut Window) {
    window.get_by_role_and_label(Role::CheckBox, "ISS (ZARYA), 25544").scroll_to_me();
    settle(window);
    window.get_by_role_and_label(Role::CheckBox, "ISS (ZARYA), 25544").click();
    settle(window);
}

fn save(window: &mut Window) -> Station {
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    saved(asked(window))
}

#[test]
fn notifications_sounds_and_quiet_hours_are_set() {
    for size in SIZES {
        let mut window = page(size);
        assert!(!says(&window, "By the local time"), "nothing is quiet");
        choose(&mut window, "Sounds", "Off");
        choose(&mut window, "Quiet hours", "On");
        assert!(says(&window, "By the local time of this computer."));
        write(&mut window, "Quiet from", "21:30");
        let notices = save(&mut window).notices;
        let quiet =
            QuietHours { from: QuietHours::read_time("21:30").unwrap(), ..QuietHours::USUAL };
        let wanted = Notices { sounds: false, quiet: Some(quiet), ..Notices::default() };
        assert_eq!(notices, wanted);
    }
}

#[test]
fn a_wrong_time_says_why_and_cannot_be_saved() {
    let mut window = page(SIZES[0]);
    choose(&mut window, "Quiet hours", "On");
    for (typed, why) in [
        ("25:00", "Quiet from must be a time of the day such as 22:00."),
        ("06:00", "Quiet to must be another time than Quiet from."),
    ] {
        write(&mut window, "Quiet from", typed);
        assert!(says(&window, why), "{typed}");
        let save = window.get_by_role_and_label(Role::Button, "Save and use");
        assert!(save.accesskit_node().is_disabled());
    }
    choose(&mut window, "Quiet hours", "Off");
    assert_eq!(asked(&mut window), []);
}

#[test]
fn a_favourite_is_marked_for_a_reminder() {
    for size in SIZES {
        let mut window = page(size);
        write(&mut window, "Remind before AOS", "10");
        mark_iss(&mut window);
        let notices = save(&mut window).notices;
        assert_eq!((notices.reminder_min, notices.reminders), (10.0, [25_544].into()));
        mark_iss(&mut window);
        write(&mut window, "Remind before AOS", "5");
        assert!(says(&window, "Nothing to save."));
    }
}
