//! Notices through the desktop, which the operator sets in Preferences, and their notes in the
//! window.

use std::sync::Arc;

use azel::{
    astro::Angle,
    contract::reminders::Reminder,
    desktop::{Missing, Outlets, Sound},
    model::{UiCommand, View},
    station::{AntennaId, HoursOfDay, Notices, Station, Tones},
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::ToSpan as _;

use crate::window_stories::{
    preferences::{form, saved, write},
    rig::{self, SIZES, Window, asked, says, settle},
    states,
};

/// Returns the page of notices.
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
    for size in rig::sizes() {
        let mut window = page(size);
        assert!(!says(&window, "By the local time"), "nothing is quiet");
        choose(&mut window, "Sounds", "Off");
        choose(&mut window, "Quiet hours", "On");
        assert!(says(&window, "By the local time of this computer."));
        write(&mut window, "Quiet from", "21:30");
        let notices = save(&mut window).notices;
        let quiet =
            HoursOfDay { start: HoursOfDay::read_time("21:30").unwrap(), ..HoursOfDay::NIGHT };
        let wanted = Notices { sounds: false, quiet: Some(quiet), ..Notices::default() };
        assert_eq!(notices, wanted);
    }
}

#[test]
fn each_kind_of_notice_gets_a_sound_or_none() {
    for size in rig::sizes() {
        let mut window = page(size);
        choose(&mut window, "Cautions", "None");
        choose(&mut window, "Reminders before passes", "Falling");
        let wanted = Notices {
            caution_tones: Tones::None,
            reminder_tones: Tones::Falling,
            ..Notices::default()
        };
        assert_eq!(save(&mut window).notices, wanted);
        choose(&mut window, "Sounds", "Off");
        let groups = window.query_all_by_role(Role::RadioGroup);
        let mut names = groups.map(|node| node.accesskit_node().label().unwrap_or_default());
        assert!(!names.any(|name| name == "Cautions"), "nothing sounds but a top-priority alarm");
    }
}

#[test]
fn a_wrong_time_says_why_and_cannot_be_saved() {
    let mut window = page(SIZES[0]);
    choose(&mut window, "Quiet hours", "On");
    for (typed, why) in [
        ("25:00", "Quiet from must be a time of day such as 22:00."),
        ("06:00", "Quiet to must differ from Quiet from."),
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
    for size in rig::sizes() {
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

#[test]
fn what_the_desktop_lacks_is_said_where_it_is_set() {
    let mut window = page(SIZES[0]);
    assert!(!says(&window, "Azel cannot play sounds"));
    window.get_by_role_and_label(Role::RadioGroup, "Warnings");
    window.state_mut().model.outlets = Outlets {
        notifications: Some(Missing::Bus("no address".to_owned())),
        sounds: Some(Missing::Elsewhere),
    };
    settle(&mut window);
    assert!(window.query_by_label("Try falling tones").is_none(), "there is nothing to try");
    assert!(window.query_by_role_and_label(Role::RadioGroup, "Warnings").is_none());
    assert!(says(&window, "The desktop shows no notifications: Azel is not running in a desktop"));
    assert!(says(&window, "Start it from the desktop"), "with what to do");
    let raw = "The system answered: no address";
    assert!(!says(&window, raw));
    window.get_by_label_contains("The desktop shows no notifications").hover();
    window.run_steps(8);
    assert!(says(&window, raw), "as it came, where it is asked for");
    assert!(says(
        &window,
        "Azel cannot play sounds: Azel does not support this on this operating system."
    ));
}

#[test]
fn the_desktop_is_tried_without_saving() {
    for size in rig::sizes() {
        let mut window = page(size);
        for (word, sound) in
            [("Try falling tones", Sound::Falling), ("Try rising tones", Sound::Rising)]
        {
            window.get_by_role_and_label(Role::Button, word).click();
            assert_eq!(asked(&mut window), [UiCommand::TryNotice(sound)]);
        }
    }
}

const NOTE: &str = "ISS AOS in 5:00 at 11:20:30Z, max 54°, Satrak can track it.";

/// Returns a window with a reminder of the ISS, in a view.
fn reminded(size: [f32; 2], view: View) -> (Window, Reminder) {
    let mut model = rig::model(states::holding());
    let reminder = Reminder {
        pass: (25_544, model.now + 5.minutes()),
        name: "ISS".to_owned(),
        los: model.now + 15.minutes(),
        max_elevation: Angle::from_degrees(54.2),
        can_track: vec![AntennaId::FIRST],
    };
    model.view = view;
    model.shown_mut().reminders = Arc::new(vec![reminder.clone()]);
    (rig::window(size, model), reminder)
}

#[test]
fn a_reminder_is_a_note_in_every_view_that_covers_neither_stop_nor_the_antenna() {
    for size in SIZES {
        for view in [
            View::Operate,
            View::Elements,
            View::Antennas,
            View::Console,
            View::Map,
            View::Preferences,
        ] {
            let (window, _) = reminded(size, view);
            let note = window.get_by_role_and_label(Role::Label, NOTE).rect();
            let close = window.get_by_label("Close the reminder of ISS").rect();
            let stop = window.get_by_role_and_label(Role::Button, "STOP").rect();
            assert!(close.right() < size[0] - 304.0, "{view:?}: {close}");
            assert!(note.left() > 48.0 && note.top() > stop.bottom() && note.bottom() < size[1]);
            assert!(note.right() <= close.left(), "{view:?}: {note}, {close}");
        }
    }
}

#[test]
fn the_note_leads_to_its_pass_and_can_be_closed() {
    for size in rig::sizes() {
        let (mut window, reminder) = reminded(size, View::Console);
        window.get_by_label("Show the pass of ISS").click();
        let wanted = [UiCommand::SelectPass(reminder.pass), UiCommand::Show(View::Operate)];
        assert_eq!(asked(&mut window), wanted);
        window.get_by_label("Close the reminder of ISS").click();
        settle(&mut window);
        assert!(!says(&window, NOTE));
        // The next pass has its own note.
        let next = Reminder { pass: (25_544, reminder.aos() - 1.second()), ..reminder };
        window.state_mut().model.shown_mut().reminders = Arc::new(vec![next]);
        settle(&mut window);
        assert!(says(&window, "ISS AOS in 4:59"));
    }
}

#[test]
fn a_pass_that_no_antenna_can_track_says_so() {
    let (mut window, reminder) = reminded(SIZES[0], View::Map);
    let reminder = Reminder { can_track: Vec::new(), ..reminder };
    window.state_mut().model.shown_mut().reminders = Arc::new(vec![reminder]);
    settle(&mut window);
    assert!(says(&window, "max 54°, no antenna can track it."));
}

#[test]
fn the_note_ends_with_aos() {
    let (mut window, reminder) = reminded(SIZES[0], View::Operate);
    window.state_mut().model.now = reminder.aos();
    settle(&mut window);
    assert!(!says(&window, "ISS AOS"));
}
