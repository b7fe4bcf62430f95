//! Plan view: the taken passes and the reasons, the operator's choices, and automatic operation.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract::{
        CatalogState, Command,
        automatic::{DayEvent, DayLine, Flown, Interruption, MissCause, OffBecause, Operation},
        passes::{ListedSatellite, PassListKey},
        rehearsal::{Rehearsed, RehearsedPass},
        schedule::{Planned, Swap},
    },
    export::EventFormat,
    model::{UiCommand, View, export::Export, rehearsal::RehearsalState},
    orbit::Propagator,
    plan::{
        pass_report::LossCause,
        schedule::{Class, Conflict, Entry, LeftOut, LeftOutReason, PassKey as Key, Schedule},
    },
    station::{AntennaId, ChooseBy, Priority, Take},
};
use egui::{Key as Press, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    preferences,
    rig::{self, LARGE, SIZES, Window, settle, window},
    states, wide,
};

fn key((satellite, aos): PassListKey) -> Key {
    Key { satellite, aos }
}

/// Returns a plan in which the antenna takes the first pass and leaves the second out for it, and
/// so on in turn.
pub(crate) fn planned(model: &azel::model::Model) -> Planned {
    let id = model.antennas[0].id();
    let mut schedule = Schedule::default();
    let mut before: Option<Key> = None;
    for (index, predicted) in model
        .pass_lists
        .favourites
        .upcoming(model.now)
        .iter()
        .filter(|predicted| !predicted.is_always_up())
        .enumerate()
    {
        let pass = key(predicted.key());
        if index % 2 == 1 {
            let with = before.unwrap();
            let class = Class::Priority(Priority::default());
            let why = LeftOutReason::Overlaps(Conflict {
                pass: with,
                class,
                missing_s: 482.0,
                others: vec![],
            });
            let by_antenna = vec![(id, why.clone())];
            schedule.left_out.push(LeftOut { pass, reason: why, by_antenna });
            continue;
        }
        schedule.entries.push(Entry {
            pass,
            antenna: id,
            class: Class::Priority(Priority::default()),
            start: predicted.pass.aos.time,
            end: predicted.pass.los.time,
            late_s: 0.0,
            early_s: 0.0,
            counted_s: predicted.pass.duration_s(),
            worth: 1,
            lost: None,
            axes_deg: [[0.0; 2]; 2],
            after: before,
            slew_s: 41.0,
            set_up_s: 12.0,
            spare_s: Some(300.0),
            shared_with: None,
            is_fixed: false,
        });
        before = Some(pass);
    }
    Planned { schedule, revision: 4, made_at: Some(model.now), ..Planned::default() }
}

/// Returns the view with every second pass taken.
pub(crate) fn view(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Plan;
    model.shown_mut().schedule = Arc::new(planned(&model));
    let mut window = window(size, model);
    window.state_mut().commands.clear();
    window
}

#[test]
fn the_spare_time_runs_down_with_the_countdown() {
    let mut window = view(LARGE);
    let model = &mut window.state_mut().model;
    let first = model.schedule.schedule.entries.iter().find(|of| of.start > model.now).unwrap();
    let (key, from) = ((first.pass.satellite, first.pass.aos), first.start);
    model.selected = Some(key);
    // A slew of 41 s and a set-up of 12 s come before the pass.
    for (before_s, spare) in [(600.0, "5:00"), (253.0, "3:20"), (60.0, "0:07"), (50.0, "0:00")] {
        window.state_mut().model.now = add_seconds(from, -before_s);
        settle(&mut window);
        window.get_by_label(&format!("Spare before: {spare}"));
        assert!(painted::texts(&window).contains(&spare.to_owned()), "{spare} in the list");
    }
}

#[test]
fn a_pass_is_known_in_the_schedule_also_where_a_new_list_has_it_earlier_or_later() {
    for shift_s in [0.0, -20.0, 20.0, 59.0] {
        let mut model = rig::model(states::holding());
        let mut planned = planned(&model);
        let schedule = &mut planned.schedule;
        let of_entries = schedule.entries.iter_mut().map(|entry| &mut entry.pass);
        for pass in of_entries.chain(schedule.left_out.iter_mut().map(|left| &mut left.pass)) {
            pass.aos = add_seconds(pass.aos, shift_s);
        }
        model.shown_mut().schedule = Arc::new(planned);
        let keys: Vec<PassListKey> =
            model.planned_passes().iter().map(|planned| planned.predicted.key()).collect();
        assert!(keys.len() > 4);
        for (index, key) in keys.into_iter().enumerate() {
            model.selected = Some(key);
            let all = model.planned_passes();
            for planned in [&all[index], &model.selected_planned().unwrap()] {
                assert_eq!(planned.predicted.key(), key);
                let takes: Vec<u32> =
                    planned.entries.iter().map(|entry| entry.pass.satellite).collect();
                let leaves = planned.left_out.map(|left| left.pass.satellite);
                let expected =
                    if index % 2 == 0 { (vec![key.0], None) } else { (vec![], Some(key.0)) };
                assert_eq!((takes, leaves), expected, "{shift_s} s");
            }
        }
    }
}

fn commands(window: &mut Window) -> Vec<Command> {
    settle(window);
    let commands = std::mem::take(&mut window.state_mut().commands);
    let station = commands.into_iter().filter_map(|command| match command {
        UiCommand::Station(Command::PriceSwap(_)) => None,
        UiCommand::Station(command) => Some(command),
        _ => None,
    });
    station.collect()
}

/// Returns the key of the planned pass at this index.
fn pass(window: &Window, index: usize) -> PassListKey {
    let model = &window.state().model;
    let passes = model.planned_passes();
    passes[index].predicted.key()
}

fn select(window: &mut Window, index: usize) -> PassListKey {
    let key = pass(window, index);
    window.state_mut().model.selected = Some(key);
    settle(window);
    window.state_mut().commands.clear();
    key
}

fn says(window: &Window, words: &str) -> bool {
    window.query_all_by_role(Role::Label).any(|node| {
        let node = node.accesskit_node();
        [node.value(), node.label()].into_iter().flatten().any(|text| text.contains(words))
    })
}

#[test]
fn rows_say_what_is_taken_and_why_others_are_left_out() {
    for size in SIZES {
        let window = view(size);
        let rows: Vec<String> = window
            .query_all_by_role(Role::ListBoxOption)
            .filter_map(|node| node.accesskit_node().label())
            .collect();
        let overlaps = "overlaps by 8:02";
        assert!(rows.iter().any(|row| row.contains("Planned")), "{size:?} {rows:?}");
        assert!(rows.iter().any(|row| row.contains(overlaps) && row.contains("priority 3")));
        assert!(window.query_by_label_contains("STOP").is_some());
    }
}

#[test]
fn many_favourites_leave_ten_rows_to_what_an_antenna_carries_out() {
    for size in [LARGE, [1920.0, 1080.0], [2560.0, 1440.0]] {
        for is_demo in [false, true] {
            let mut model = wide::three();
            model.view = View::Plan;
            model.shown_mut().demo = is_demo;
            model.shown_mut().schedule = Arc::new(planned(&model));
            let CatalogState::Ready(catalog) = &model.catalog else { unreachable!() };
            let moving = catalog.iter().filter(|elements| !elements.is_geosynchronous());
            let listed = moving.filter_map(|elements| {
                let propagator = Propagator::new(elements).ok()?;
                Some(Arc::new(ListedSatellite { elements: elements.clone(), propagator }))
            });
            let satellites: Vec<_> = listed.take(60).collect();
            assert_eq!(satellites.len(), 60);
            model.shown_mut().pass_lists.favourites.satellites = satellites.into();
            let window = window(size, model);
            let list = window.get_by_role_and_label(Role::ListBox, "Satrak, as planned").rect();
            let rows = window.query_all_by_role(Role::ListBoxOption);
            let rows: Vec<_> =
                rows.map(|row| row.rect()).filter(|row| list.contains_rect(*row)).collect();
            let room = list.height() / rows[0].height();
            assert!(room >= 10.0 && rows.len() >= 5, "{size:?}: {room} rows");
            // The favourites keep enough rows to scroll in.
            assert!(list.top() > 0.5 * size[1], "{size:?}: {list:?}");
        }
    }
}

#[test]
fn the_switch_counts_the_rows_that_each_of_its_choices_shows() {
    let mut window = view(LARGE);
    let model = &mut window.state_mut().model;
    let mut planned = planned(model);
    planned.schedule.entries.pop();
    model.shown_mut().schedule = Arc::new(planned);
    settle(&mut window);
    let counts = ["All ", "Taken ", "Left out "].map(|choice| {
        let is_choice = |label: &str| {
            label.strip_prefix(choice).is_some_and(|rest| rest.parse::<usize>().is_ok())
        };
        let node = window
            .query_all_by(|node| node.label().is_some_and(|label| is_choice(&label)))
            .next()
            .unwrap();
        let label = node.accesskit_node().label().unwrap();
        node.click();
        settle(&mut window);
        let count: usize = label[choice.len()..].parse().unwrap();
        // The diagram above has its own options.
        let name = &window.state().model.antennas[0].config.name;
        let list = window
            .query_all_by_role(Role::ListBox)
            .find(|list| list.accesskit_node().label().is_some_and(|it| it.starts_with(name)))
            .unwrap()
            .rect();
        let options = window.query_all_by_role(Role::ListBoxOption);
        let rows = options.filter(|option| list.contains(option.rect().center())).count();
        assert_eq!(rows, count, "{label}");
        count
    });
    assert_eq!(counts[0], counts[1] + counts[2]);
    assert!(counts[1] != counts[2], "{counts:?}");
}

/// Times after midnight would lack their day.
#[test]
fn shortly_before_midnight_the_day_that_begins_is_named() {
    let mut window = view(LARGE);
    let model = &mut window.state_mut().model;
    let day = |at: jiff::Timestamp| at.strftime("%a %-d %b").to_string();
    let to_midnight_s = 86_400 - model.now.as_second().rem_euclid(86_400);
    let late = add_seconds(model.now, to_midnight_s as f64 - 2.0 * 3600.0);
    model.now = late;
    settle(&mut window);
    let texts = painted::texts(&window);
    assert!(texts.contains(&day(add_seconds(late, 7200.0))), "{texts:?}");
}

#[test]
fn a_pass_is_chosen_by_key_and_by_pointer_and_that_is_undone() {
    let mut window = view(LARGE);
    let (satellite, _) = select(&mut window, 0);
    let take = |commands: &[Command]| match commands {
        [Command::ChoosePass { satellite: of, take, .. }] if *of == satellite => *take,
        other => panic!("{other:?}"),
    };
    for (press, wanted) in [(Press::Y, Take::Always), (Press::V, Take::Never)] {
        window.key_press(press);
        let commands = commands(&mut window);
        assert_eq!(take(&commands), Some(wanted));
    }
    window.get_by_role_and_label(Role::RadioButton, "Always").click();
    let asked = commands(&mut window);
    assert_eq!(take(&asked), Some(Take::Always));
    window.get_by_role_and_label(Role::Button, "Undo").click();
    let undone = commands(&mut window);
    assert_eq!(take(&undone), None);
    window.key_press(Press::B);
    assert_eq!(commands(&mut window), [], "it is by plan already");
}

#[test]
fn a_choice_waits_for_edits_of_the_preferences_which_stay() {
    let mut window = view(LARGE);
    select(&mut window, 0);
    window.state_mut().model.view = View::Preferences;
    settle(&mut window);
    preferences::write(&mut window, "Name", "Hilltop");
    window.state_mut().model.view = View::Plan;
    settle(&mut window);
    window.key_press(Press::V);
    assert_eq!(commands(&mut window), []);
    assert!(says(&window, "Not changed: Preferences has unsaved changes."));
    assert!(window.query_by_role_and_label(Role::Button, "Undo").is_none());
    window.state_mut().model.view = View::Preferences;
    settle(&mut window);
    assert!(window.query_all_by_value("Hilltop").next().is_some());
}

#[test]
fn the_price_of_a_pass_is_asked_once_and_a_swap_asks_with_it() {
    let mut window = view(LARGE);
    // Azel has already asked the price of the previous selection.
    let key = pass(&window, 3);
    window.state_mut().model.selected = Some(key);
    settle(&mut window);
    let asked = |command: &&UiCommand| **command == UiCommand::Station(Command::PriceSwap(key));
    assert_eq!(window.state().commands.iter().filter(asked).count(), 1);
    assert!(says(&window, "being worked out"));
    let swap = Swap { pass: key, revision: 4, changes: Some(Vec::new()) };
    window.state_mut().model.shown_mut().swap = Some(Arc::new(swap));
    settle(&mut window);
    assert!(says(&window, "No other pass is lost."));
    window.state_mut().commands.clear();
    window.key_press(Press::S);
    settle(&mut window);
    let price = "No other pass is lost.";
    assert_eq!(window.query_all_by_label_contains(price).count(), 2, "the note and the question");
    window.get_by_role_and_label(Role::Button, "Take it (Enter)").click();
    let commands = commands(&mut window);
    assert!(
        matches!(&commands[..], [Command::ChoosePass { take: Some(Take::Always), .. }]),
        "{commands:?}"
    );
}

#[test]
fn a_pass_that_no_antenna_can_take_is_not_swapped() {
    let mut window = view(LARGE);
    let key = pass(&window, 3);
    window.state_mut().model.selected = Some(key);
    let swap = Swap { pass: key, revision: 4, changes: None };
    window.state_mut().model.shown_mut().swap = Some(Arc::new(swap));
    settle(&mut window);
    assert!(says(&window, "Always is not available: no antenna can track enough of this pass."));
    let always = window.get_by_role_and_label(Role::RadioButton, "Always");
    assert!(always.accesskit_node().is_disabled());
    let swaps = |window: &Window, is_disabled| {
        let buttons = window.get_all_by_role(Role::Button).filter(|button| {
            let button = button.accesskit_node();
            let is_swap = button.label().is_some_and(|label| label.starts_with("Swap for "));
            is_swap && button.is_disabled() == is_disabled
        });
        buttons.map(|button| button.rect().center()).collect::<Vec<_>>()
    };
    let [locked] = swaps(&window, true)[..] else { panic!("one is known to be impossible") };
    window.drag_at(locked);
    window.drop_at(locked);
    assert_eq!(commands(&mut window), []);
    let other = swaps(&window, false)[0];
    window.drag_at(other);
    window.drop_at(other);
    assert!(
        matches!(
            &commands(&mut window)[..],
            [Command::ChoosePass { take: Some(Take::Always), .. }]
        ),
        "each row that is left out has its own"
    );
}

#[test]
fn arrows_go_through_the_passes() {
    let mut window = view(LARGE);
    select(&mut window, 0);
    window.key_press(Press::ArrowRight);
    settle(&mut window);
    let next = UiCommand::SelectPass(pass(&window, 1));
    assert!(window.state().commands.contains(&next));
}

#[test]
fn the_part_of_the_lanes_is_moved_by_arrow_keys_while_its_grip_has_the_focus() {
    let mut window = view(LARGE);
    let part = |window: &Window| {
        let grip = window.get_by_role(Role::Splitter);
        (grip.accesskit_node().label().unwrap_or_default(), grip.rect())
    };
    let (start, place) = part(&window);
    assert_eq!(start, "Part of the lanes, from 10:55:30Z");
    let edges = painted::around(&window, place, 4.0).len();
    window.get_by_role(Role::Splitter).focus();
    settle(&mut window);
    assert!(painted::around(&window, place, 4.0).len() > edges, "no ring");
    for (key, from) in [
        (Press::ArrowRight, "11:55:30Z"),
        (Press::ArrowRight, "12:55:30Z"),
        (Press::ArrowLeft, "11:55:30Z"),
    ] {
        window.key_press(key);
        settle(&mut window);
        assert_eq!(part(&window).0, format!("Part of the lanes, from {from}"));
    }
    assert_eq!(commands(&mut window), [], "the selected pass stays");
}

#[test]
fn rule_and_span_are_chosen_and_undone() {
    let mut window = view(LARGE);
    window.get_by_role_and_label(Role::RadioButton, "48 h").click();
    let Some(Command::SetScheduling(scheduling)) = commands(&mut window).pop() else {
        panic!("no other span");
    };
    assert!((scheduling.span_h - 48.0).abs() < 1e-9, "{scheduling:?}");
    let list = "Choose by, Priority, then elevation";
    window.get_by_role_and_label(Role::ComboBox, list).click();
    settle(&mut window);
    window.get_by_label("Most passes").click();
    let Some(Command::SetScheduling(scheduling)) = commands(&mut window).pop() else {
        panic!("no other rule");
    };
    assert_eq!(scheduling.choose_by, ChooseBy::MostPasses);
    window.get_by_role_and_label(Role::Button, "Undo").click();
    let Some(Command::SetScheduling(scheduling)) = commands(&mut window).pop() else {
        panic!("nothing was undone");
    };
    assert_eq!(scheduling.choose_by, ChooseBy::Elevation);
}

#[test]
fn automatic_operation_takes_a_hold_to_switch_on_and_a_click_to_switch_off() {
    let mut window = view(LARGE);
    let id = window.state().model.antennas[0].id();
    let off = "Automatic operation of Satrak, off: hold 1 s to switch it on";
    window.get_by_role_and_label(Role::Button, off).click();
    assert_eq!(commands(&mut window), [], "a click is not enough");
    window.get_by_role_and_label(Role::Button, off).focus();
    settle(&mut window);
    window.key_down(Press::Space);
    // The hold lasts more than a second of the window's clock.
    window.run_steps(90);
    window.key_up(Press::Space);
    let set = |is_on| Command::SetAutomatic { antenna: id, is_on };
    assert_eq!(commands(&mut window), [set(true)]);
    window.state_mut().model.shown_mut().antennas[0].operation =
        Operation::Suspended { interruption: Interruption::ByHand, start: rig::now() };
    settle(&mut window);
    assert!(window.query_by_label_contains("Suspended").is_some());
    window.get_by_role_and_label(Role::Switch, "Automatic operation of Satrak, on").click();
    assert_eq!(commands(&mut window), [set(false)]);
}

#[test]
fn a_suspended_antenna_goes_on_by_a_button_that_names_the_pass() {
    for view in [View::Plan, View::Operate] {
        let mut window = self::view(LARGE);
        let id = window.state().model.antennas[0].id();
        window.state_mut().model.view = view;
        window.state_mut().model.shown_mut().antennas[0].operation =
            Operation::Suspended { interruption: Interruption::Elsewhere, start: rig::now() };
        settle(&mut window);
        let button = window
            .query_all_by_role(Role::Button)
            .find(|node| {
                node.accesskit_node().label().is_some_and(|text| text.starts_with("Go on with "))
            })
            .unwrap();
        button.click();
        assert_eq!(commands(&mut window), [Command::GoOn(id)], "{view:?}");
        let chip = window.query_by_label_contains("automatic operation suspended");
        assert!(chip.is_some(), "the chip tells it in {view:?}");
    }
}

#[test]
fn what_was_missed_is_told_with_its_cause() {
    let mut window = view(LARGE);
    let id = window.state().model.antennas[0].id();
    let aos = add_seconds(rig::now(), -1800.0);
    let flown = |cause: Option<MissCause>| {
        DayEvent::Flown(Flown {
            pass: (if cause.is_none() { rig::NOAA_20 } else { 25_544 }, aos),
            name: "NOAA 20".to_owned(),
            of_s: 600.0,
            in_beam_s: if cause.is_none() { 600.0 } else { 350.0 },
            proved_at: None,
            cause,
        })
    };
    let line = |what| DayLine { time: rig::now(), antenna: id, event: what };
    window.state_mut().model.shown_mut().day = Arc::new(vec![
        line(flown(None)),
        line(flown(Some(MissCause::Off(OffBecause::Stop)))),
        DayLine {
            antenna: AntennaId(99),
            ..line(flown(Some(MissCause::Lost(LossCause::LinkLost))))
        },
    ]);
    settle(&mut window);
    let rows: Vec<String> = window
        .query_all_by_role(Role::ListBoxOption)
        .filter_map(|node| node.accesskit_node().label())
        .collect();
    let row = |words: &str| rows.iter().filter(|row| row.contains(words)).count();
    assert_eq!(row("Done, 100 % in beam"), 1);
    assert_eq!(row("Missed 4:10 of 10:00. STOP switched it off."), 1, "{rows:?}");
    assert_eq!(row("did not answer"), 0, "it is of another antenna");
}

#[test]
fn without_satellites_or_antennas_the_view_says_what_to_do() {
    let mut window = view(LARGE);
    let model = &mut window.state_mut().model;
    model.shown_mut().antennas.clear();
    model.shown_mut().pass_lists = azel::contract::passes::PassLists::default();
    model.shown_mut().schedule = Arc::default();
    settle(&mut window);
    assert!(says(&window, "No satellite is planned."));
    assert!(says(&window, "No antenna yet."));
    assert!(says(&window, "The passes are being planned."));
}

#[test]
fn limits_of_a_satellite_are_changed_where_it_is_shown() {
    let mut window = view(LARGE);
    let (satellite, _) = select(&mut window, 0);
    window.get_by_role_and_label(Role::ComboBox, "Maximum elevation, any").click();
    settle(&mut window);
    window.get_by_label("from 30°").click();
    let Some(Command::SetPassLimits { numbers, limits }) = commands(&mut window).pop() else {
        panic!("no other limits");
    };
    assert_eq!((numbers, limits.min_max_elevation_deg), (vec![satellite], Some(30.0)));
    Arc::make_mut(&mut window.state_mut().model.shown_mut().station)
        .favourites
        .set_limits(satellite, limits);
    settle(&mut window);
    assert!(window.query_by_label("Maximum elevation, from 30°").is_some());
}

#[test]
fn the_plan_is_saved_to_a_file() {
    for size in rig::sizes() {
        let mut window = view(size);
        window.get_by_role_and_label(Role::ComboBox, "Export the plan").click();
        settle(&mut window);
        window.get_by_label("Plan as iCalendar…").click();
        let wanted = Export::Schedule { format: EventFormat::Ics };
        assert_eq!(rig::asked(&mut window), [UiCommand::Save(wanted)]);
    }
}

#[test]
fn the_arrows_lead_through_a_menu_and_not_through_the_list_behind_it() {
    let mut window = view(LARGE);
    window.get_by_role_and_label(Role::ComboBox, "Export the plan").click();
    settle(&mut window);
    window.state_mut().commands.clear();
    let focused = |window: &Window| {
        window
            .query_all_by_role(Role::Button)
            .find(egui_kittest::Node::is_focused)
            .and_then(|entry| entry.accesskit_node().label())
    };
    for (key, entry) in [
        (Press::ArrowDown, "Hand-over sheet (HTML)…"),
        (Press::ArrowDown, "Plan as a table…"),
        (Press::ArrowDown, "Plan as CSV…"),
        (Press::ArrowUp, "Plan as a table…"),
    ] {
        window.key_press(key);
        settle(&mut window);
        assert_eq!(focused(&window).as_deref(), Some(entry));
    }
    // Without an open menu, this key swaps a pass.
    window.key_press(Press::S);
    settle(&mut window);
    assert_eq!(window.query_all_by_label_contains("Take it (Enter)").count(), 0);
    window.key_press(Press::Enter);
    let wanted = Export::Schedule { format: EventFormat::Table };
    assert_eq!(rig::asked(&mut window), [UiCommand::Save(wanted)], "and no other pass is selected");
}

/// Esc is STOP, so it must not be the only key that closes a menu.
#[test]
fn left_closes_a_menu_and_leaves_the_focus_on_its_opener() {
    let mut window = view(LARGE);
    window.get_by_role_and_label(Role::ComboBox, "Export the plan").click();
    settle(&mut window);
    window.key_press(Press::ArrowDown);
    settle(&mut window);
    window.state_mut().commands.clear();
    window.key_press(Press::ArrowLeft);
    settle(&mut window);
    assert!(window.query_by_label("Plan as CSV…").is_none());
    assert!(window.get_by_role_and_label(Role::ComboBox, "Export the plan").is_focused());
    assert_eq!(rig::asked(&mut window), [], "neither STOP nor another pass");
}

#[test]
fn the_hand_over_sheet_is_saved_to_a_file() {
    for size in rig::sizes() {
        let mut window = view(size);
        window.get_by_role_and_label(Role::ComboBox, "Export the plan").click();
        settle(&mut window);
        window.get_by_label("Hand-over sheet (HTML)…").click();
        assert_eq!(rig::asked(&mut window), [UiCommand::Save(Export::HandOverSheet)]);
    }
}

#[test]
fn the_plan_is_rehearsed_and_what_came_of_it_stands_beside_the_pass_as_a_rehearsal() {
    for size in rig::sizes() {
        let mut window = view(size);
        window.get_by_role_and_label(Role::Button, "Rehearse").click();
        assert_eq!(rig::asked(&mut window), [UiCommand::Rehearse(None)]);
        window.state_mut().model.rehearsal = RehearsalState::UnderWay(0.456);
        settle(&mut window);
        assert!(says(&window, "Rehearsal under way"));
        window.get_by_role_and_label(Role::Button, "Cancel, 45 %").click();
        assert_eq!(rig::asked(&mut window), [UiCommand::EndRehearsal]);
    }
    let mut window = view(LARGE);
    let (satellite, aos) = select(&mut window, 0);
    window.get_by_role_and_label(Role::Button, "Rehearse this pass").click();
    assert_eq!(rig::asked(&mut window), [UiCommand::Rehearse(Some((satellite, aos)))]);
    // The rehearsal takes only the antennas of this pass, or the selected antenna if none takes the
    // pass.
    let model = &window.state().model;
    let entries = &model.schedule.schedule.entries;
    for entry in entries {
        let key = (entry.pass.satellite, entry.pass.aos);
        let own: Vec<_> = entries.iter().filter(|of| of.pass == entry.pass).collect();
        let own: Vec<_> = own.iter().map(|entry| entry.antenna).collect();
        assert_eq!(model.antennas_of(key), own);
    }
    assert!(!entries.is_empty());
    let selected = model.antenna().unwrap().id();
    assert_eq!(model.antennas_of((1, aos)), [selected]);
    let antenna = window.state().model.antennas[0].id();
    let cause = Some(MissCause::Lost(LossCause::LinkLost));
    let flown = Flown {
        pass: (satellite, aos),
        name: "NOAA 20".to_owned(),
        of_s: 600.0,
        in_beam_s: 540.0,
        proved_at: None,
        cause,
    };
    let rehearsed = RehearsedPass {
        antenna,
        antenna_name: "Satrak".to_owned(),
        satellite,
        satellite_name: "NOAA 20".to_owned(),
        aos,
        los: add_seconds(aos, 600.0),
        start: aos,
        end: add_seconds(aos, 600.0),
        promised_s: 600.0,
        is_given_up: false,
        flown: Some(flown),
        off_reason: None,
        report: None,
    };
    let whole = Rehearsed {
        start: rig::now(),
        hours: 24.0,
        seed: 1,
        passes: vec![rehearsed],
        interruptions: Vec::new(),
        left_out: Vec::new(),
    };
    window.state_mut().model.rehearsal =
        RehearsalState::Done { rehearsed: Arc::new(whole), time: rig::now() };
    settle(&mut window);
    assert!(says(&window, "0 of 1 good"));
    let told = "Rehearsal, Satrak: 9:00 of 10:00. 1:00 lost: The unit did not answer.";
    assert!(says(&window, told));
    let key = pass(&window, 2);
    window.state_mut().model.selected = Some(key);
    settle(&mut window);
    assert!(!says(&window, "Rehearsal, Satrak"), "it is of another pass");
    let why = "the rehearsed station broke down".to_owned();
    window.state_mut().model.rehearsal = RehearsalState::Failed(why);
    settle(&mut window);
    assert!(says(&window, "Rehearsal: the rehearsed station broke down"));
}

#[test]
fn tab_leads_from_the_passes_to_automatic_operation_in_a_few_steps() {
    let mut window = view(LARGE);
    window.get_by_role_and_label(Role::ListBox, "Passes by satellite").focus();
    settle(&mut window);
    // The arrow keys stay in the list.
    window.key_press(Press::ArrowDown);
    settle(&mut window);
    assert!(window.get_by_role_and_label(Role::ListBox, "Passes by satellite").is_focused());
    let off = "Automatic operation of Satrak, off: hold 1 s to switch it on";
    let is_there = |window: &Window| window.get_by_role_and_label(Role::Button, off).is_focused();
    let steps = (0..6).find(|_| {
        window.key_press(Press::Tab);
        settle(&mut window);
        is_there(&window)
    });
    assert!(steps.is_some(), "not within six steps");
}
