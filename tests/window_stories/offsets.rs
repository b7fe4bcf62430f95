//! Offsets of a running track.

use std::sync::Arc;

use azel::{
    astro::{Angle, Offset, TrackOffsets},
    contract::{
        self,
        alarms::AlarmKind,
        driver::{
            Command, LeftOffsets, LinkState, OffsetChange, OnBoardView, Refusal, Snapshot,
            UnitOffsetsView,
        },
    },
    device::settings::WriteError,
    model::UiCommand,
    station::{AntennaId, OffsetsSubject},
    ui::words,
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use jiff::SignedDuration;

use crate::window_stories::{
    following,
    on_board::found,
    rig::{self, SIZES, Window, asked, settle},
    states,
};

fn deg(degrees: f64) -> Angle {
    Angle::from_degrees(degrees)
}

fn with(steps: &[Offset]) -> TrackOffsets {
    steps.iter().copied().try_fold(TrackOffsets::NONE, TrackOffsets::plus).unwrap()
}

fn change(change: OffsetChange) -> UiCommand {
    UiCommand::antenna(AntennaId(1), Command::Offset(change))
}

fn step(offset: Offset) -> UiCommand {
    change(OffsetChange::Step(offset))
}

/// Returns a window whose antenna tracks with these offsets, with the section open.
fn opened(size: [f32; 2], offsets: TrackOffsets, line: &str) -> Window {
    let mut window = rig::window(size, following::tracking(offsets));
    window.get_by_role_and_label(Role::Button, line).click();
    settle(&mut window);
    asked(&mut window);
    window
}

fn click(window: &mut Window, name: &str) -> Vec<UiCommand> {
    window.get_by_role_and_label(Role::Button, name).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(Role::Button, name).click();
    asked(window)
}

#[test]
fn each_offset_has_its_value_and_keys_for_less_and_more() {
    let on = with(&[Offset::Time(SignedDuration::from_millis(-300)), Offset::Across(deg(0.25))]);
    for size in rig::sizes() {
        let line = "Offsets: time −0.30 s, across +0.25°";
        let mut window = opened(size, on, line);
        let said = "position by position with offsets.";
        assert!(window.query_all_by_label_contains(said).next().is_some());
        for said in
            ["Time offset: −0.30 s", "Across track offset: +0.25°", "Azimuth offset: +0.00°"]
        {
            window.get_by_label(said);
        }
        let tenth = deg(0.1);
        for (name, offset) in [
            ("Time", Offset::Time(SignedDuration::from_millis(100))),
            ("Along track", Offset::Along(tenth)),
            ("Across track", Offset::Across(tenth)),
            ("Azimuth", Offset::Azimuth(tenth)),
            ("Elevation", Offset::Elevation(tenth)),
        ] {
            assert_eq!(click(&mut window, &format!("{name} offset, more")), [step(offset)]);
            assert_eq!(click(&mut window, &format!("{name} offset, less")), [step(-offset)]);
        }
        assert_eq!(click(&mut window, "All offsets to zero"), [change(OffsetChange::Zero)]);
        assert_eq!(click(&mut window, "Undo the last offset"), [change(OffsetChange::Undo)]);
        window.get_by_role_and_label(Role::RadioButton, "1").click();
        settle(&mut window);
        let whole = step(Offset::Azimuth(deg(1.0)));
        assert_eq!(click(&mut window, "Azimuth offset, more"), std::slice::from_ref(&whole));
        // The keys also use the step of the card.
        window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowRight);
        assert_eq!(asked(&mut window), [whole]);
    }
}

#[test]
fn a_low_card_has_its_folded_lines_in_sight_while_it_tracks() {
    let by_azel = following::tracking(TrackOffsets::NONE);
    let on_board = rig::model(states::tracking(0.0));
    for (model, lines) in [(by_azel, &["Offsets: "][..]), (on_board, &["Travel: ", "Faults: "])] {
        let window = rig::window(rig::SMALL, model);
        for line in lines {
            let mut found = window.query_all_by_label_contains(line);
            let place = found.next().unwrap_or_else(|| panic!("no line {line:?}")).rect();
            assert!(place.bottom() <= rig::SMALL[1], "{line:?} at {place:?}");
        }
    }
}

#[test]
fn they_are_remembered_of_the_satellite_or_the_antenna() {
    let on = with(&[Offset::Along(deg(0.2)), Offset::Elevation(deg(0.3))]);
    for size in rig::sizes() {
        let mut window = opened(size, on, "Offsets: along +0.20°, el +0.30°");
        let keep =
            |of| UiCommand::Station(contract::Command::KeepOffsets { subject: of, offsets: on });
        let of_satellite = "Remember time, along and across the track for NOAA 20";
        assert_eq!(
            click(&mut window, of_satellite),
            [keep(OffsetsSubject::Satellite(rig::NOAA_20))]
        );
        let of_antenna = "Remember azimuth and elevation for Mast";
        assert_eq!(click(&mut window, of_antenna), [keep(OffsetsSubject::Antenna(AntennaId(1)))]);
        let station = std::sync::Arc::make_mut(&mut window.state_mut().model.shown_mut().station);
        station.keep_offsets(OffsetsSubject::Antenna(AntennaId(1)), on);
        settle(&mut window);
        assert_eq!(click(&mut window, &format!("{of_antenna}: remembered already")), []);
    }
}

#[test]
fn without_offsets_there_is_nothing_to_undo_or_to_set_to_zero() {
    for size in rig::sizes() {
        let mut window = opened(size, TrackOffsets::NONE, "Offsets: none");
        assert_eq!(click(&mut window, "All offsets to zero"), []);
        assert_eq!(click(&mut window, "Undo the last offset"), []);
    }
}

#[test]
fn brackets_change_the_time_and_backspace_ends_it() {
    let time = |ms| Offset::Time(SignedDuration::from_millis(ms));
    let mut window = rig::window(SIZES[0], following::tracking(with(&[time(700)])));
    for (modifiers, key, wanted) in [
        (Modifiers::NONE, Key::OpenBracket, time(-100)),
        (Modifiers::NONE, Key::CloseBracket, time(100)),
        (Modifiers::NONE, Key::Backspace, time(-700)),
        (Modifiers::COMMAND, Key::ArrowUp, Offset::Elevation(deg(0.1))),
        (Modifiers::COMMAND, Key::ArrowLeft, Offset::Azimuth(deg(-0.1))),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::ArrowUp, Offset::Along(deg(0.1))),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::ArrowLeft, Offset::Across(deg(-0.1))),
    ] {
        window.key_press_modifiers(modifiers, key);
        assert_eq!(asked(&mut window), [step(wanted)], "{key:?}");
    }
    window.key_press(Key::U);
    assert_eq!(asked(&mut window), [change(OffsetChange::Undo)]);
}

#[test]
fn while_nothing_is_tracked_there_are_none_and_their_keys_are_left_alone() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::manual()));
        assert!(window.query_by_label_contains("Offsets:").is_none());
        window.key_press(Key::CloseBracket);
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn without_a_link_they_are_shown_and_locked_with_the_reason() {
    let mut model = following::tracking(with(&[Offset::Azimuth(deg(0.5))]));
    let steady = model.steady;
    let snapshot = std::sync::Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot);
    snapshot.link = LinkState::Connecting { start: steady };
    let mut window = rig::window(SIZES[1], model);
    window.get_by_role_and_label(Role::Button, "Offsets: az +0.50°").click();
    settle(&mut window);
    asked(&mut window);
    assert_eq!(click(&mut window, "Azimuth offset, more"), []);
    assert!(window.query_all_by_label("Locked: the unit does not answer.").next().is_some());
}

/// Returns an on-board track with these offsets added, of a unit that held -0.5 degrees of azimuth
/// before.
fn on_board(added: TrackOffsets, left: Option<LeftOffsets>) -> Snapshot {
    let mut snapshot = states::tracking(0.04);
    let held = azel::device::Offsets { azimuth_deg: -0.5, ..azel::device::Offsets::default() };
    snapshot.state.on_board.offsets = Some(held);
    snapshot.on_board =
        Some(OnBoardView { found: Arc::new(found(0.0)), missing: None, arrives: None });
    snapshot.unit_offsets = (!added.is_none() || left.is_some()).then_some(UnitOffsetsView {
        offsets: added,
        is_changing: false,
        can_undo: true,
        left,
    });
    snapshot
}

/// Opens the section unless it is open already.
fn unfold(window: &mut Window, line: &str) {
    if window.query_by_label("Azimuth offset, more").is_none() {
        window.get_by_role_and_label(Role::Button, line).click();
        settle(window);
    }
    asked(window);
}

#[test]
fn a_unit_that_tracks_by_itself_has_a_pad_of_what_it_can_hold() {
    let added = with(&[Offset::Azimuth(deg(0.2))]);
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(on_board(added, None)));
        assert!(rig::says(&window, "stored on the unit, and with offsets."));
        unfold(&mut window, "Offsets: az +0.20°");
        assert!(rig::says(&window, "The unit adds in all: az −0.50°."));
        for (name, offset) in
            [("Azimuth", Offset::Azimuth(deg(0.1))), ("Elevation", Offset::Elevation(deg(0.1)))]
        {
            assert_eq!(click(&mut window, &format!("{name} offset, more")), [step(offset)]);
            assert_eq!(click(&mut window, &format!("{name} offset, less")), [step(-offset)]);
        }
        assert_eq!(click(&mut window, "All offsets to zero"), [change(OffsetChange::Zero)]);
        assert_eq!(click(&mut window, "Undo the last offset"), [change(OffsetChange::Undo)]);
        for other in ["Time offset, more", "Along track offset, more"] {
            assert!(window.query_by_label(other).is_none(), "{other}");
        }
        window.key_press(Key::CloseBracket);
        assert_eq!(asked(&mut window), []);
        window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowUp);
        assert_eq!(asked(&mut window), [step(Offset::Elevation(deg(0.1)))]);
    }
}

#[test]
fn an_offset_on_its_way_to_the_unit_is_said_to_be() {
    let mut snapshot = on_board(with(&[Offset::Azimuth(deg(0.2))]), None);
    snapshot.unit_offsets.as_mut().unwrap().is_changing = true;
    let window = rig::window(SIZES[0], rig::model(snapshot));
    window.get_by_role_and_label(Role::Button, "Offsets: az +0.20°, being set");
}

#[test]
fn without_elements_of_what_the_unit_tracks_its_pad_is_locked_with_the_reason() {
    let snapshot = Snapshot { on_board: None, ..on_board(TrackOffsets::NONE, None) };
    let mut window = rig::window(SIZES[1], rig::model(snapshot));
    unfold(&mut window, "Offsets: none");
    assert_eq!(click(&mut window, "Azimuth offset, more"), []);
    assert!(rig::says(&window, "Azel has no elements of what the unit tracks"));
}

#[test]
fn offsets_that_were_left_on_the_unit_are_taken_back_with_one_click() {
    let added = with(&[Offset::Azimuth(deg(0.2))]);
    let at_rest = |left| Snapshot {
        unit_offsets: on_board(added, Some(left)).unit_offsets,
        ..states::holding()
    };
    for left in [
        LeftOffsets::Found { start: rig::now() },
        LeftOffsets::Failed(WriteError::Refused("ERR,4".to_owned())),
        LeftOffsets::Refused(Refusal::PassUnknown),
    ] {
        for size in rig::sizes() {
            let mut window = rig::window(size, rig::model(at_rest(left.clone())));
            assert!(rig::says(&window, "Left on the unit: az +0.20°."));
            assert_eq!(click(&mut window, "Take back az +0.20°"), [change(OffsetChange::Zero)]);
        }
        let said = words::alarm(
            &AlarmKind::OffsetsLeft { offsets: added, reason: left },
            "Dish",
            rig::now(),
        );
        assert!(said.starts_with("The unit of Dish ") && said.contains("az +0.20°"), "{said}");
    }
}
