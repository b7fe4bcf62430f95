//! Replay of the record.

use std::{sync::Arc, time::Duration};

use azel::{
    app::App,
    astro::{Angle, time::add_seconds},
    contract::{
        Command,
        driver::{self, Intent, StopState},
        record::PassTimes,
    },
    controller::SPECS,
    device::AxisMotion,
    engine::Settings,
    model::{
        Model, UiCommand, View,
        replay::{
            JumpNews, ReplayCommand, ReplayEnd, ReplayProblem, Replayed, Stretch, StretchPass,
        },
    },
    station::{self, AntennaId},
};
use egui::{Key, Modifiers, Role};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    every_view::painted,
    extremes::{nothing_is_cut, nothing_overlaps},
    rig::{self, NOAA_20, SIZES, SMALL, Window, asked, sent, settle},
    states,
    unit::{RealWindow, Unit, clock_from, step_until, wait_until},
};

/// Returns the model of a running replay.
pub(crate) fn model() -> Model {
    let mut model = rig::model(states::manual());
    let at = model.now;
    let stretch = Stretch {
        name: "NOAA 20".to_owned(),
        pass: Some(StretchPass { id: 7, satellite: NOAA_20, antenna: AntennaId(1) }),
        start: add_seconds(at, -300.0),
        end: add_seconds(at, 600.0),
    };
    let passes = vec![times(&model, "NOAA 20", -200.0)];
    model.replay = Some(Replayed { speed: 10, passes, ..Replayed::begin(stretch, at) });
    model
}

/// Returns a pass of ten minutes that begins `begins_s` after the shown moment.
fn times(model: &Model, name: &str, begins_s: f64) -> PassTimes {
    let at = |second: f64| add_seconds(model.now, begins_s + second);
    PassTimes {
        name: name.to_owned(),
        aos: at(0.0),
        tca: Some(at(290.0)),
        los: at(600.0),
        lost: vec![(at(100.0), at(130.0)), (at(500.0), at(501.0))],
    }
}

fn replayed(command: ReplayCommand) -> UiCommand {
    UiCommand::Replay(command)
}

fn click(window: &mut Window, name: &str) -> Vec<UiCommand> {
    window.state_mut().commands.clear();
    window.get_by_role_and_label(Role::Button, name).click();
    asked(window)
}

#[test]
fn a_replay_is_marked_in_every_view_and_its_strip_plays_it() {
    for size in SIZES {
        for view in [View::Operate, View::Plan, View::Console, View::Record, View::Map] {
            let mut model = model();
            model.view = view;
            model.refresh_sky();
            let mut window = rig::window(size, model);
            window.get_by_label_contains("Replay, 11:15:30Z of NOAA 20, plays at 10×.");
            let full = "STOP stops the live antennas.";
            let says_stop =
                |words: &&String| *words == full || size == SMALL && *words == "STOP is live";
            let texts = painted::texts(&window);
            assert!(texts.iter().any(|words| says_stop(&words)), "{size:?} {view:?}: {texts:?}");
            window.get_by_label(full);
            let cut = painted::cut(&window);
            assert!(
                !cut.iter().any(|words| words.starts_with("STOP")),
                "{size:?} {view:?}: {cut:?}"
            );
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
            let event = |is_next| replayed(ReplayCommand::Event { is_next });
            assert_eq!(click(&mut window, "Previous event (comma)"), [event(false)]);
            assert_eq!(click(&mut window, "Next event (full stop)"), [event(true)]);
            // Operate leaves the strip of a small window too little room.
            if size != SMALL || view != View::Operate {
                let pass = |is_next| replayed(ReplayCommand::Pass { is_next });
                assert_eq!(click(&mut window, "Previous pass"), [pass(false)]);
                assert_eq!(click(&mut window, "Next pass"), [pass(true)]);
            }
            window.get_by_label("NOAA 20: AOS 11:12:10Z, TCA 11:17:00Z, LOS 11:22:10Z, 0:31 lost");
            let pause = [replayed(ReplayCommand::PlayOrPause)];
            assert_eq!(click(&mut window, "Pause (Space)"), pause);
            let back = [replayed(ReplayCommand::Speed(-10))];
            assert_eq!(click(&mut window, "Play backward"), back);
            let leave = if size == SMALL { "Leave (Q)" } else { "Leave replay (Q)" };
            assert_eq!(click(&mut window, leave), [UiCommand::LeaveReplay]);
        }
    }
}

#[test]
fn stop_is_there_and_all_that_would_act_is_locked_or_refused() {
    for size in rig::sizes() {
        let mut window = rig::window(size, model());
        for mode in ["Standby", "Manual", "Position", "Track"] {
            let node = window.get_by_role_and_label(Role::RadioButton, mode);
            assert!(node.accesskit_node().is_disabled(), "{mode}");
        }
        let locked = format!("Replay. Leave it to command {}.", rig_name(&window));
        window.get_by_label(&locked);
        let auto_track = window.get_by_role_and_label(Role::Button, "Auto-track: switch on");
        assert!(auto_track.accesskit_node().is_disabled());
        let refused = "Not done: this is a replay. Leave it first.";
        for view in [View::Antennas, View::Elements, View::Plan, View::Operate] {
            window.state_mut().model.view = view;
            settle(&mut window);
            assert!(window.query_by_label(refused).is_none(), "{view:?}: nobody asked anything");
        }
        for key in [Key::T, Key::K, Key::G, Key::M, Key::A] {
            window.key_press(key);
            assert_eq!(sent(&mut window), [], "{key:?}");
            assert!(window.query_by_label("Cancel").is_none(), "{key:?}: nothing is asked");
        }
        window.get_by_label(refused);
        window.state_mut().commands.clear();
        window.get_by_role_and_label(Role::Button, "STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}

fn rig_name(window: &Window) -> String {
    window.state().model.antenna().unwrap().config.name.clone()
}

#[test]
fn what_commands_an_antenna_in_other_views_is_locked_too() {
    for size in SIZES {
        let mut window = rig::window(size, model());
        let name = rig_name(&window);
        let is_locked = |window: &Window, role: Role, label: &str| {
            let found: Vec<bool> = window
                .query_all_by_role(role)
                .filter(|node| {
                    node.accesskit_node().label().is_some_and(|of| of.starts_with(label))
                })
                .map(|node| node.accesskit_node().is_disabled())
                .collect();
            assert!(!found.is_empty() && found.iter().all(|of| *of), "{size:?} {label}: {found:?}");
        };
        let show = |window: &mut Window, view| {
            window.state_mut().model.view = view;
            settle(window);
        };
        let says_why = |window: &mut Window, role, label: &str| {
            window.get_by_role_and_label(role, label).hover();
            settle(window);
            assert!(rig::says(window, "Replay. Leave it first."), "{size:?} {label}");
            window.hover_at(egui::pos2(1.0, 1.0));
            settle(window);
        };
        // A small window has a drawer instead.
        if size == rig::LARGE {
            is_locked(&window, Role::Button, "Save passes to a file");
            is_locked(&window, Role::ComboBox, "Elevation floor");
            is_locked(&window, Role::RadioButton, "All");
        }
        show(&mut window, View::Plan);
        is_locked(&window, Role::Button, &format!("Automatic operation of {name}, off"));
        is_locked(&window, Role::Button, "Rehearse");
        is_locked(&window, Role::ComboBox, "Choose by");
        is_locked(&window, Role::ComboBox, "Export the plan");
        is_locked(&window, Role::RadioButton, "12 h");
        says_why(&mut window, Role::Button, "Rehearse");
        says_why(&mut window, Role::RadioButton, "12 h");
        show(&mut window, View::Elements);
        is_locked(&window, Role::Button, "Add a source");
        is_locked(&window, Role::Button, "Read again");
        if size == rig::LARGE {
            is_locked(&window, Role::Button, "Remove from favourites");
        }
        says_why(&mut window, Role::Button, "Add a source");
        show(&mut window, View::Preferences);
        is_locked(&window, Role::Button, "Save and use");
        show(&mut window, View::Antennas);
        is_locked(&window, Role::Button, "Apply");
        show(&mut window, View::Console);
        is_locked(&window, Role::Button, "Send");
        assert!(rig::says(&window, &format!("Replay. Leave it to command {name}.")));
    }
}

#[test]
fn the_card_says_what_the_live_antenna_does_meanwhile() {
    for size in SIZES {
        let mut model = model();
        let replied = model.steady;
        model.steady += Duration::from_millis(400);
        Arc::make_mut(&mut model.shown_mut().antennas[0].snapshot).state.traffic.last_reply =
            Some(replied);
        let window = rig::window(size, model);
        let name = rig_name(&window);
        window.get_by_label_contains(&format!("{name}, as recorded at 11:15:30Z, "));
        if size != SMALL {
            let texts = painted::texts(&window);
            assert!(texts.iter().any(|words| words == "as recorded at 11:15:30Z"), "{texts:?}");
        }
        window.get_by_label("Live now, not recorded");
        let line = format!("{name}: Holding at ");
        window.get_by_label_contains(&line);
        window.get_by_label("Next: no pass is planned");
        assert!(window.query_by_label_contains("Jog ").is_none(), "nothing moves by hand");
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|words| words == "LIVE"), "{texts:?}");
        let has_age = |of: &String| of.starts_with("Holding at ") && of.ends_with(" s ago");
        assert!(texts.iter().any(has_age), "{texts:?}");
        nothing_is_cut(&window, size);
        nothing_overlaps(&window);
    }
}

#[test]
fn several_passes_are_named_below_the_bar_and_one_has_its_events() {
    let mut window = rig::window(rig::LARGE, model());
    let has = |window: &Window, words: &str| painted::texts(window).iter().any(|of| of == words);
    for words in ["AOS", "TCA", "LOS"] {
        assert!(has(&window, words), "{words}");
    }
    let model = &mut window.state_mut().model;
    let second = times(model, "METOP-B", 400.0);
    model.replay.as_mut().unwrap().passes.push(second);
    settle(&mut window);
    assert!(has(&window, "METOP-B") && !has(&window, "TCA"));
}

#[test]
fn a_jump_over_what_was_not_filmed_is_told() {
    for size in SIZES {
        let mut model = model();
        let at = model.now;
        let (from, until) = (add_seconds(at, -86_400.0), add_seconds(at, -60.0));
        model.replay.as_mut().unwrap().news = Some(JumpNews::Skipped { start: from, end: until });
        model.view = View::Plan;
        let mut window = rig::window(size, model);
        let whole = "There is no film of 11 Aug 11:15:30Z to 12 Aug 11:14:30Z: ";
        window.get_by_label_contains(whole);
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|of| of == "Skipped 23 h 59 min: no film."), "{texts:?}");
        let replay = window.state_mut().model.replay.as_mut().unwrap();
        (replay.news, replay.problem) =
            (None, Some(ReplayProblem::NoFilm { start: from, end: until }));
        settle(&mut window);
        window.get_by_label_contains(whole);
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|of| of == "No film here, for 23 h 59 min."), "{texts:?}");
    }
}

#[test]
fn a_replay_that_reads_no_more_says_why_and_what_to_do() {
    for size in SIZES {
        let mut model = model();
        let replay = model.replay.as_mut().unwrap();
        let why = "the work failed inside Azel".to_owned();
        (replay.plays, replay.problem) = (false, Some(ReplayProblem::NotRead(why)));
        model.view = View::Plan;
        let window = rig::window(size, model);
        window.get_by_label(
            "Nothing more of the record is read. The work failed inside Azel. Leave the replay (Q) \
             and begin it again.",
        );
        let texts = painted::texts(&window);
        assert!(texts.iter().any(|of| of == "Reading failed: leave it (Q)."), "{texts:?}");
    }
}

#[test]
fn where_there_is_nothing_to_go_to_that_is_told() {
    for size in SIZES {
        for view in [View::Operate, View::Plan] {
            for (news, told) in [
                (JumpNews::NoPass { is_next: true }, "No later pass is recorded."),
                (JumpNews::NoEvent { is_next: false }, "No earlier event is recorded."),
            ] {
                let mut model = model();
                model.view = view;
                model.replay.as_mut().unwrap().news = Some(news);
                model.refresh_sky();
                let window = rig::window(size, model);
                let texts = painted::texts(&window);
                assert!(texts.iter().any(|of| of == told), "{size:?} {view:?}: {texts:?}");
                window.get_by_label(told);
            }
        }
    }
}

#[test]
fn why_a_replay_has_ended_stands_until_the_operator_closes_it() {
    for size in SIZES {
        for view in [View::Operate, View::Plan, View::Console] {
            let mut model = rig::model(states::holding());
            model.view = view;
            model.refresh_sky();
            let from = add_seconds(model.now, 119.0);
            let (antenna, satellite) = ("Dish".to_owned(), "METOP-B".to_owned());
            model.replay_end = Some(ReplayEnd::Pass { antenna, satellite, start: from });
            let mut window = rig::window(size, model);
            window.get_by_label("Replay ended: Dish is to track METOP-B in 1:59.");
            let place = |window: &Window| window.get_by_label_contains("Replay ended: ").rect();
            let before = place(&window);
            let model = &mut window.state_mut().model;
            model.now = add_seconds(from, 600.0);
            model.steady += Duration::from_secs(719);
            settle(&mut window);
            window.get_by_label("Replay ended: Dish was to track METOP-B from 11:17:29Z on.");
            assert_eq!(place(&window), before, "nothing moves by itself");
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
            assert_eq!(click(&mut window, "Close"), [UiCommand::CloseReplayEnd]);
            window.state_mut().model.replay_end = None;
            settle(&mut window);
            assert!(window.query_by_label_contains("Replay ended").is_none());
            assert!(window.query_by_label_contains("The demo has ended").is_none());
        }
    }
}

#[test]
fn the_keys_of_a_replay_come_before_those_of_the_view() {
    for view in [View::Operate, View::Plan, View::Map, View::Record] {
        let mut shown = model();
        shown.view = view;
        shown.refresh_sky();
        let mut window = rig::window(rig::LARGE, shown);
        let at = window.state().model.now;
        let stretch = window.state().model.replay.as_ref().unwrap().stretch.clone();
        let _ = asked(&mut window);
        let by = |by_s| replayed(ReplayCommand::To(add_seconds(at, by_s)));
        let keys = [
            (Modifiers::NONE, Key::ArrowLeft, by(-1.0)),
            (Modifiers::NONE, Key::ArrowRight, by(1.0)),
            (Modifiers::SHIFT, Key::ArrowLeft, by(-10.0)),
            (Modifiers::SHIFT, Key::ArrowRight, by(10.0)),
            (Modifiers::NONE, Key::Home, replayed(ReplayCommand::To(stretch.start))),
            (Modifiers::NONE, Key::End, replayed(ReplayCommand::To(stretch.end))),
            (Modifiers::NONE, Key::Space, replayed(ReplayCommand::PlayOrPause)),
            (Modifiers::NONE, Key::Comma, replayed(ReplayCommand::Event { is_next: false })),
            (Modifiers::NONE, Key::Period, replayed(ReplayCommand::Event { is_next: true })),
            (Modifiers::NONE, Key::Q, UiCommand::LeaveReplay),
        ];
        for (modifiers, key, command) in keys {
            window.key_press_modifiers(modifiers, key);
            assert_eq!(asked(&mut window), [command], "{view:?} {key:?}");
        }
    }
}

#[test]
fn the_speed_is_one_of_five() {
    let mut window = rig::window(rig::LARGE, model());
    for speed in [1, 5, 20, 60] {
        window.state_mut().commands.clear();
        window.get_by_role_and_label(Role::RadioButton, &format!("{speed}×")).click();
        assert_eq!(asked(&mut window), [replayed(ReplayCommand::Speed(speed))]);
    }
    // A narrow strip shows only the current speed, which steps to the next.
    let mut window = rig::window(SMALL, model());
    assert_eq!(click(&mut window, "10×"), [replayed(ReplayCommand::Speed(20))]);
}

#[test]
fn the_moment_is_moved_by_the_bar_and_the_keys() {
    for size in SIZES {
        let mut window = rig::window(size, model());
        let at = window.state().model.now;
        let bar = window.get_by_role_and_label(Role::Slider, "Moment of the replay, 11:15:30Z");
        let rect = bar.rect();
        bar.focus();
        settle(&mut window);
        window.state_mut().commands.clear();
        let to = |by_s| replayed(ReplayCommand::To(add_seconds(at, by_s)));
        window.key_press(Key::ArrowRight);
        assert_eq!(asked(&mut window), [to(1.0)]);
        window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
        assert_eq!(asked(&mut window), [to(-10.0)]);
        window.key_press(Key::Home);
        assert_eq!(asked(&mut window), [to(-300.0)]);
        window.key_press(Key::End);
        assert_eq!(asked(&mut window), [to(600.0)]);
        window.drag_at(rect.left_center());
        window.drop_at(rect.left_center());
        assert!(asked(&mut window).contains(&to(-300.0)));
    }
}

/// Opens the real window on a station with a unit, and a record.
fn open(folder: &tempfile::TempDir, unit: &Unit) -> RealWindow {
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let settings = Settings {
        path: Some(path),
        library: Some(folder.path().join("elements")),
        records: Some(folder.path().join("records")),
        dead_man: Some(env!("CARGO_BIN_EXE_azel").into()),
        ..Settings::default()
    };
    let clock = clock_from(rig::now());
    Harness::builder()
        .with_size(rig::LARGE)
        .build_eframe(move |cc| App::new(&cc.egui_ctx, &settings, clock).unwrap())
}

fn again(window: &RealWindow) -> &Model {
    window.state().replay().unwrap()
}

#[test]
fn while_the_record_is_shown_again_no_command_passes_and_stop_reaches_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let unit = Unit::start(rig::now());
    let mut window = open(&folder, &unit);
    let measured = |model: &Model| {
        model.antenna().is_some_and(|antenna| antenna.snapshot.state.measured.is_some())
    };
    step_until(&mut window, "the antenna", measured);
    let id = window.state().model().antenna().unwrap().id();
    let moves = |model: &Model| {
        let measured = model.antenna().and_then(|antenna| antenna.snapshot.state.measured);
        measured.is_some_and(|at| at.axes.iter().any(|axis| axis.motion != AxisMotion::Still))
    };
    let client = window.state().station().client().clone();
    let to = |deg| Some(Angle::from_degrees(deg));
    let go = driver::Command::Position { azimuth: to(90.0), elevation: to(30.0) };
    step_until(&mut window, "motion", |model| {
        let is_idle = model.antenna().is_some_and(|of| of.snapshot.intent != Intent::Position);
        if is_idle {
            client.send(Command::Antenna(id, go.clone())).unwrap();
        }
        moves(model)
    });
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num7);
    step_until(&mut window, "the record", |model| {
        model.view == View::Record && model.record.is_some()
    });
    window.get_by_role_and_label(Role::Button, "Replay the last hour").click();
    wait_until("the replay", || {
        window.step();
        window.state().replay().is_some()
    });
    // The last hour began before the record.
    wait_until("the first moment", || {
        window.step();
        again(&window).replay.as_ref().is_some_and(|replay| replay.problem.is_some())
    });
    window.step();
    // The station writes film within a second, so the words depend on its progress.
    let told = match again(&window).replay.as_ref().and_then(|replay| replay.problem.clone()) {
        Some(ReplayProblem::NoFilm { .. }) => "stands. No film here, for ",
        _ => "stands. Nothing was recorded at this moment.",
    };
    window.get_by_label_contains(told);
    // Azel writes a new event within a second.
    wait_until("the first event", || {
        window.key_press(Key::Period);
        window.step();
        let model = again(&window);
        model.replay.as_ref().is_some_and(|replay| replay.problem.is_none())
    });
    wait_until("the antenna as it was", || {
        window.key_press(Key::Period);
        window.step();
        again(&window).antenna().is_some()
    });
    window.get_by_role_and_label(Role::Button, "Next pass").click();
    wait_until("the word that no pass was tracked", || {
        window.step();
        again(&window).replay.as_ref().unwrap().news == Some(JumpNews::NoPass { is_next: true })
    });
    let shown = again(&window);
    assert!(shown.now < window.state().model().now);
    assert!(shown.antenna().unwrap().snapshot.intent != Intent::Position, "it stood then");
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num1);
    window.step();
    for key in [Key::T, Key::K] {
        window.key_press(key);
        window.step();
        window.key_press(Key::Enter);
        window.step();
    }
    assert!(window.state().replay().is_some());
    let live = window.state().model().antenna().unwrap();
    assert_eq!(live.snapshot.intent, Intent::Position, "the live station goes on");
    window.key_press(Key::Escape);
    window.step();
    assert!(window.state().replay().is_none());
    window.get_by_label_contains("Replay ended: STOP was pressed.");
    step_until(&mut window, "standstill", |model| {
        let antenna = model.antenna().unwrap();
        matches!(antenna.snapshot.stop, StopState::Stopped { .. })
    });
    assert_eq!(window.state().model().view, View::Operate, "the view stays");
    assert!(!moves(window.state().model()));
    let is_told = |window: &RealWindow| window.query_by_label_contains("Replay ended").is_some();
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num1);
    window.step();
    assert!(is_told(&window), "the same view");
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num2);
    window.run_steps(2);
    assert!(!is_told(&window), "another view");
}
