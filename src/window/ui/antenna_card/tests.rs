use super::*;
use crate::{
    device::{JogSpeeds, panel::Check},
    ui::widgets::{
        axes_table::{AxisRow, WantedColumn},
        jog_pad::{JogDirection, JogKeys},
        link_chip::LinkGlyph,
        sentence::{SentenceKind, Span},
        testing::{self, bold, plain},
    },
};
use egui::{Event, Role};
use egui_kittest::{Harness, kittest::Queryable as _};

const SPANS: [Span<'_>; 3] = [
    plain("Tracking "),
    bold("NOAA 20"),
    plain(
        " with the elements stored on the unit. The antenna is 0.04° off the predicted path, \
         inside its 0.88° beam. At LOS it stops and holds.",
    ),
];

const fn travel(name: &str, position_deg: f64) -> TravelModel<'_> {
    TravelModel {
        name,
        scale_deg: (0.0, 180.0),
        travel_deg: (6.0, 174.0),
        position_deg: Some(position_deg),
        is_old: false,
        decimals: 1,
        lower_limit: false,
        upper_limit: false,
        turns: false,
    }
}

const TRAVEL: [TravelModel<'_>; 2] = [travel("X", 82.9), travel("Y", 37.8)];

static CHECKS: [Check; 2] = [
    Check::new("Power", CheckState::Good, ""),
    Check::new("Drive X", CheckState::Fault, "Look at the drive cabinet."),
];

fn model() -> CardModel<'static> {
    CardModel {
        header: HeaderModel {
            takes_panel: false,
            in_maintenance: false,
            alarm: None,
            recorded: None,
            name: "Satrak",
            second_line: "3.0 m X/Y, on-board tracking",
            link: LinkGlyph::Live,
            status: LinkStatus::Connected,
        },
        sentence: Sentence { kind: SentenceKind::Tracking, spans: &SPANS },
        axes: AxesTable {
            wanted_column: WantedColumn::Command,
            decimals: 2,
            predicted_decimals: 2,
            age: None,
            axes: &[
                AxisRow {
                    name: "Az",
                    wanted_deg: Some(185.55),
                    actual_deg: Some(185.51),
                    error_deg: Some(-0.04),
                    rate_deg_s: Some(0.14),
                },
                AxisRow {
                    name: "El",
                    wanted_deg: None,
                    actual_deg: None,
                    error_deg: None,
                    rate_deg_s: None,
                },
            ],
        },
        beam: Some(BeamModel { error_deg: Some(0.04), half_beam_deg: 0.44 }),
        travel: &TRAVEL,
        modes: ModeModel {
            offered: &mode_selector::ALL,
            current: Some(Intent::Track),
            is_foreign: false,
            is_locked: false,
            pending: None,
        },
        track: Some(TrackModel {
            head: "On the unit",
            held: "NOAA 20",
            selected: Some("METEOR-M2 4"),
            tracks_selected: false,
            refusal: None,
            misses: None,
            nothing_left: None,
            note: None,
            auto_track: Some(true),
            parks_at: "",
            ends: None,
            follow: None,
        }),
        offsets: None,
        drive: DriveModel {
            keys: JogKeys::Xy { x_plus: "E", x_minus: "W", y_plus: "N", y_minus: "S" },
            is_tracking: false,
            jog_locked: None,
            jog_note: None,
            unguarded: None,
            blocked: &[],
            real_deg_s: Some(0.48),
            speeds: JogSpeeds::AnyRate,
            max_deg_s: 3.0,
            max_step_deg: Some(5.0),
            go_to_locked: None,
            azimuth_range_deg: (0.0, 360.0),
            elevation_range_deg: Some((0.0, 90.0)),
            commanded_deg: (Some(185.5), Some(37.4)),
            commanded_decimals: 2,
            stop_note: None,
        },
        readings: &[],
        faults: Some(FaultsModel { is_known: true, checks: &CHECKS, checked_at: "11:06:08Z" }),
        more: MoreModel::default(),
        lock_out: None,
        asks_standing: None,
        asks_unseen: None,
        way_out: None,
        offer: None,
        automatic: None,
        go_on: None,
        live: None,
        others: &[],
    }
}

struct Story {
    model: CardModel<'static>,
    state: CardState,
    actions: Vec<CardAction>,
}

const LARGE: [f32; 2] = [WIDTH, 844.0];
const SMALL: [f32; 2] = [SMALL_WIDTH, 592.0];

fn card(size: [f32; 2], model: &CardModel<'static>) -> Harness<'static, Story> {
    let story = Story { model: *model, state: CardState::default(), actions: Vec::new() };
    let mut window = testing::window(size, story, |ui, story| {
        let rect = ui.ctx().content_rect();
        story.actions.extend(show(ui, rect, &story.model, &mut story.state));
    });
    window.run();
    window
}

#[test]
fn the_card_fits_both_windows_without_scrolling() {
    for size in [LARGE, SMALL] {
        let window = card(size, &model());
        let last = if size == LARGE {
            window.get_by_label("Details of the checks").rect()
        } else {
            window.get_by_label_contains("Faults: 1 fault").rect()
        };
        assert!(last.bottom() <= size[1], "{size:?}: {last:?}");
        let jog = window.get_by_label("Jog Y−").rect();
        assert!(jog.bottom() < size[1] && jog.top() > 0.0);
    }
}

#[test]
fn missing_numbers_are_said_to_be_missing() {
    let window = card(LARGE, &model());
    window.get_by_label("El: Command not known, actual not known, error not known, rate not known");
}

#[test]
fn a_mode_goes_out_at_once() {
    let mut window = card(LARGE, &model());
    window.get_by_role_and_label(Role::RadioButton, "Manual").click();
    window.run();
    assert_eq!(window.state().actions, [CardAction::SetMode(Intent::Manual)]);
}

#[test]
fn park_has_to_be_held() {
    let mut window = card(LARGE, &model());
    window.get_by_role_and_label(Role::RadioButton, "Park").click();
    window.run();
    assert!(window.state().actions.is_empty());
    let hold = window.get_by_label("Hold 1 s to park").rect().center();
    window.drag_at(hold);
    window.run_steps(6);
    window.drop_at(hold);
    window.run_steps(2);
    assert_eq!(window.state().actions, [CardAction::SetMode(Intent::Park)]);
    assert!(window.query_by_label("Hold 1 s to park").is_none());
}

#[test]
fn a_jog_comes_every_frame_and_its_release_once() {
    let mut window = card(LARGE, &model());
    let at = window.get_by_label("Jog X−").rect().center();
    window.drag_at(at);
    window.run_steps(3);
    window.drop_at(at);
    window.run_steps(3);
    let jog = CardAction::Jog { x: -1, y: 0, rate_deg_s: 0.5 };
    let actions = &window.state().actions;
    assert!(actions.len() >= 3, "{actions:?}");
    assert_eq!(actions.last(), Some(&CardAction::JogReleased));
    assert!(actions[..actions.len() - 1].iter().all(|action| *action == jog), "{actions:?}");
}

#[test]
fn losing_the_window_releases_the_jog() {
    let mut window = card(LARGE, &model());
    window.drag_at(window.get_by_label("Jog Y+").rect().center());
    window.run_steps(2);
    window.input_mut().focused = false;
    window.event(Event::WindowFocused(false));
    window.run_steps(2);
    assert_eq!(window.state().actions.last(), Some(&CardAction::JogReleased));
}

#[test]
fn hiding_the_card_releases_the_jog_once() {
    let mut window = card(LARGE, &model());
    window.drag_at(window.get_by_label("Jog Y+").rect().center());
    window.run_steps(2);
    assert_eq!(window.state_mut().state.hide(), Some(CardAction::JogReleased));
    assert_eq!(window.state_mut().state.hide(), None);
    window.state_mut().actions.clear();
    window.run_steps(2);
    assert!(window.state().actions.is_empty(), "only a new press moves it again");
}

#[test]
fn a_lock_says_why_and_stops_jog_and_go_to() {
    let reason = "Locked while tracking. Choose Manual or Position.";
    let mut model = model();
    model.drive.jog_locked = Some(reason);
    model.drive.go_to_locked = Some(reason);
    let mut window = card(SMALL, &model);
    window.get_by_label(reason);
    window.drag_at(window.get_by_label("Jog X+").rect().center());
    window.run_steps(2);
    assert!(window.state().actions.is_empty());
}

#[test]
fn a_limit_leaves_the_other_directions() {
    let mut model = model();
    model.drive.blocked = &[JogDirection::XPlus];
    let mut window = card(LARGE, &model);
    let at = window.get_by_label("Jog X+").rect().center();
    window.drag_at(at);
    window.run_steps(2);
    window.drop_at(at);
    window.run_steps(2);
    assert!(window.state().actions.is_empty());
}

#[test]
fn a_refused_direction_says_why_below_the_fields() {
    let mut window = card(LARGE, &model());
    window.get_by_label("Go to azimuth, degrees").focus();
    window.run();
    window.get_by_label("Go to azimuth, degrees").type_text("400");
    window.run();
    window.get_by_role_and_label(Role::Button, "Go to").click();
    window.run();
    window.get_by_label("Azimuth 400 is outside 0° to 360°.");
    assert_eq!(window.state().state.drive.go_to.azimuth, "400");
}

#[test]
fn track_and_auto_track_are_one_click() {
    let mut window = card(LARGE, &model());
    window.get_by_label("On the unit: NOAA 20");
    window.get_by_role_and_label(Role::Button, "Track METEOR-M2 4").click();
    window.run();
    window.get_by_role_and_label(Role::Button, "Auto-track: switch off").click();
    window.run();
    let wanted = [CardAction::TrackSelected, CardAction::SetAutoTrack(false)];
    assert_eq!(window.state().actions, wanted);
}

#[test]
fn what_the_unit_tracks_already_has_no_button() {
    let mut model = model();
    model.track = Some(TrackModel {
        held: "NOAA 20",
        selected: Some("NOAA 20"),
        tracks_selected: true,
        ..TrackModel::default()
    });
    let window = card(LARGE, &model);
    assert!(window.query_by_label("Track NOAA 20").is_none());
    window.get_by_label("Selected and tracked: NOAA 20");
}

#[test]
fn what_the_unit_cannot_take_is_refused_with_its_reason() {
    let reason = "The catalogue number has six digits. Satrak cannot take it.";
    let mut model = model();
    model.track = Some(TrackModel {
        selected: Some("NEW 1"),
        refusal: Some(reason),
        ..TrackModel::default()
    });
    let mut window = card(SMALL, &model);
    window.get_by_label(reason);
    window.get_by_role_and_label(Role::Button, "Track NEW 1").click();
    window.run();
    assert!(window.state().actions.is_empty());
}

#[test]
fn folds_open_in_a_small_window() {
    let mut window = card(SMALL, &model());
    assert!(window.query_by_label("Travel X 82.9°").is_none());
    window.get_by_label("Travel: X 82.9°  Y 37.8°").click();
    window.run();
    window.get_by_label("Travel X 82.9°");
    assert!(window.state().state.travel_open);
}

#[test]
fn the_list_of_checks_says_what_to_do() {
    let mut window = card(LARGE, &model());
    window.get_by_label("1 fault. Drive X.");
    window.get_by_label("Details of the checks").click();
    window.run();
    window.get_by_label("Drive X: fault. Look at the drive cabinet.");
    window.get_by_label("Power: good.");
}
