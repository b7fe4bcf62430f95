//! Preview of a direction before the antenna goes there: by a click in the sky, or by the fields.

use std::sync::Arc;

use azel::{
    astro::{Angle, AzEl},
    contract::driver::{Command, Intent, LinkState, Preview, Refusal, Snapshot, Way},
    device::Pointing,
    model::UiCommand,
    station::AntennaId,
};
use egui::{Key, Role, vec2};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, LARGE, Window, asked, settle},
    sky::zenith,
    states,
};

fn antenna(command: Command) -> UiCommand {
    UiCommand::antenna(AntennaId(1), command)
}

/// Clicks in the empty south, and returns the direction that Azel judges.
fn click_the_south(window: &mut Window) -> Pointing {
    let at = zenith(window) + vec2(0.0, 60.0);
    window.drag_at(at);
    window.drop_at(at);
    let commands = asked(window);
    let [UiCommand::Station(azel::contract::Command::Antenna(AntennaId(1), command))] =
        &commands[..]
    else {
        panic!("{commands:?}")
    };
    let Command::Preview(Some(to)) = command else { panic!("{command:?}") };
    assert_eq!(to.azimuth, Some(Angle::from_degrees(180.0)));
    *to
}

/// Gives the session's answer to the window.
fn answer(window: &mut Window, to: Pointing, way: Result<Way, Refusal>) {
    let shown = &mut window.state_mut().model.shown_mut().antennas[0].snapshot;
    let preview = Some(Arc::new(Preview { target: to, way }));
    *shown = Arc::new(Snapshot { preview, ..Snapshot::clone(shown) });
    settle(window);
}

fn clear() -> Way {
    let path = vec![AzEl::from_degrees(343.1, 5.0), AzEl::from_degrees(180.0, 60.0)];
    Way { path, arrives_s: Some(33.2), is_round_a_corner: false }
}

fn note(window: &Window) -> Option<String> {
    use egui_kittest::kittest::NodeT as _;
    window.query_by_label_contains("Satrak to 180")?.accesskit_node().value()
}

#[test]
fn a_click_in_the_sky_is_judged_told_and_only_then_sent() {
    for size in rig::sizes() {
        for before in [states::holding(), states::manual()] {
            let mut window = rig::window(size, rig::model(before));
            let to = click_the_south(&mut window);
            assert!(note(&window).unwrap().ends_with("The path is being checked."));
            window.get_by_role_and_label(Role::Button, "Point here").click();
            assert_eq!(asked(&mut window), [], "not before the way is known");
            answer(&mut window, to, Ok(clear()));
            let told = note(&window).unwrap();
            assert!(told.ends_with("Arrives in about 0:34. The path is clear."), "{told}");
            window.get_by_role_and_label(Role::Button, "Point here").click();
            let Pointing { azimuth, elevation } = to;
            let go = antenna(Command::Position { azimuth, elevation });
            let end = antenna(Command::Preview(None));
            assert_eq!(asked(&mut window), [go, end]);
            assert_eq!(note(&window), None);
        }
    }
}

#[test]
fn before_the_position_is_read_a_click_in_the_sky_sends_nothing() {
    let mut window = rig::window(LARGE, rig::model(rig::quiet()));
    let to = click_the_south(&mut window);
    answer(&mut window, to, Ok(clear()));
    assert!(note(&window).unwrap().ends_with("Locked: the position is not read yet."));
    window.get_by_role_and_label(Role::Button, "Point here").click();
    assert_eq!(asked(&mut window), []);
}

#[test]
fn enter_sends_what_was_clicked_and_esc_drops_it() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    let to = click_the_south(&mut window);
    answer(&mut window, to, Ok(clear()));
    assert!(window.get_by_role_and_label(Role::Button, "Point here").is_focused());
    window.key_press(Key::Escape);
    // The window sends STOP as well; the view moves nothing.
    assert_eq!(asked(&mut window), [antenna(Command::Preview(None))]);
    assert_eq!(note(&window), None);

    let to = click_the_south(&mut window);
    answer(&mut window, to, Ok(clear()));
    window.key_press(Key::Enter);
    let Pointing { azimuth, elevation } = to;
    let go = antenna(Command::Position { azimuth, elevation });
    assert_eq!(asked(&mut window), [go, antenna(Command::Preview(None))]);
}

#[test]
fn a_limit_in_the_way_is_named_and_nothing_is_sent() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        let to = click_the_south(&mut window);
        let limit = Refusal::Travel { axis: "Y", asked_deg: 171.0, from_deg: 10.0, to_deg: 170.0 };
        answer(&mut window, to, Err(limit));
        let told = note(&window).unwrap();
        assert!(
            told.ends_with(
                "Not possible: Y would have to go to 171.0°, beyond its travel of 10.0° to 170.0°."
            ),
            "{told}"
        );
        window.get_by_role_and_label(Role::Button, "Point here").click();
        assert_eq!(asked(&mut window), []);
        window.get_by_role_and_label(Role::Button, "Drop").click();
        assert_eq!(asked(&mut window), [antenna(Command::Preview(None))]);
        assert_eq!(note(&window), None);
    }
}

#[test]
fn what_a_track_would_lose_is_asked_once_more() {
    let mut window = rig::window(LARGE, rig::model(states::tracking(0.0)));
    let to = click_the_south(&mut window);
    answer(&mut window, to, Ok(clear()));
    assert!(note(&window).unwrap().ends_with("It ends the track of NOAA 20."));
    window.get_by_role_and_label(Role::Button, "Point here").click();
    assert_eq!(asked(&mut window), [antenna(Command::Preview(None))]);
    window.get_by_label_contains("Going to a direction ends that.");
    window.key_press(Key::Enter);
    let Pointing { azimuth, elevation } = to;
    assert_eq!(asked(&mut window), [antenna(Command::Position { azimuth, elevation })]);
}

#[test]
fn without_a_link_a_click_says_so_and_asks_nobody() {
    let mut model = rig::model(rig::quiet());
    let off = Snapshot::before_anything(LinkState::Off);
    model.shown_mut().antennas[0].snapshot = Arc::new(off);
    let mut window = rig::window(LARGE, model);
    let at = zenith(&window) + vec2(0.0, 60.0);
    window.drag_at(at);
    window.drop_at(at);
    assert_eq!(asked(&mut window), []);
    assert!(note(&window).unwrap().ends_with("Locked: not connected."));
}

#[test]
fn what_is_typed_is_judged_as_it_stands_until_it_is_sent() {
    for size in rig::sizes() {
        let snapshot = Snapshot { intent: Intent::Position, ..states::holding() };
        let mut window = rig::window(size, rig::model(snapshot));
        for (field, words) in
            [("Go to azimuth, degrees", "180"), ("Go to elevation, degrees", "60")]
        {
            window.get_by_label(field).focus();
            settle(&mut window);
            window.get_by_label(field).type_text(words);
            settle(&mut window);
        }
        let to: Pointing = AzEl::from_degrees(180.0, 60.0).into();
        let commands = asked(&mut window);
        assert_eq!(commands.last(), Some(&antenna(Command::Preview(Some(to)))), "{commands:?}");
        assert!(commands.iter().all(|command| !command.is_void_after_stop()), "{commands:?}");
        answer(&mut window, to, Ok(clear()));
        assert!(note(&window).unwrap().ends_with("Arrives in about 0:34. The path is clear."));
        assert!(window.query_by_label("Point here").is_none(), "Enter twice goes");
        window.key_press(Key::Enter);
        settle(&mut window);
        window.key_press(Key::Enter);
        let Pointing { azimuth, elevation } = to;
        let go = antenna(Command::Position { azimuth, elevation });
        assert_eq!(asked(&mut window), [go, antenna(Command::Preview(None))]);
        assert_eq!(note(&window), None);
    }
}

#[test]
fn another_antenna_or_view_ends_what_is_looked_at() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    click_the_south(&mut window);
    window.state_mut().model.view = azel::model::View::Console;
    assert_eq!(asked(&mut window), [antenna(Command::Preview(None))]);
    window.state_mut().model.view = azel::model::View::Operate;
    assert_eq!(asked(&mut window), []);
    assert_eq!(note(&window), None);
}

#[test]
fn the_drawer_lets_neither_click_nor_wheel_through_to_the_sky() {
    let mut window = rig::window(rig::SMALL, rig::model(states::holding()));
    let before = window.get_by_label_contains("EUTELSAT 7C, azimuth").rect();
    window.key_press(Key::P);
    settle(&mut window);
    let title = window.get_by_label_contains("Next passes, ").rect();
    let at = title.left_bottom() + vec2(20.0, 2.0);
    window.hover_at(at);
    settle(&mut window);
    rig::scroll(&mut window, at, 200.0);
    window.drag_at(at);
    window.drop_at(at);
    assert_eq!(asked(&mut window), []);
    assert_eq!(window.get_by_label_contains("EUTELSAT 7C, azimuth").rect(), before);
}
