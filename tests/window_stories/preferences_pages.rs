//! Pages of the preferences: search, order, counts, and the effects of their edits.

use std::{sync::Arc, time::Duration};

use azel::{
    astro::{PointingModel, Term},
    contract::{
        self,
        alarms::AlarmKind,
        claim::HeldBy,
        driver::{Intent, LinkFinding, Snapshot},
        link_tests::{LinkTest, LinkTestStage},
        record::{
            FittedNoise, FittedTerm, Peak, PeakBody, PeakChange, Peaks, PointingFit, PointingFitted,
        },
    },
    device::{OnBoard, Place},
    engine::alarms::KeepAlarms,
    model::{Model, UiCommand, View, effects},
    plan::pointing::Kind,
    station::{Antenna, AntennaId, Station},
    ui::theme,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    makes,
    preferences::{antenna_form, asked, form, open, saved, write},
    rig::{self, LARGE, SIZES, SMALL, Window, says, settle},
    states,
};

const FIND: &str = "Find a setting";

fn type_words(window: &mut Window, words: &str) {
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

fn press(window: &mut Window, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(role, name).click();
    settle(window);
}

/// Returns the page that is chosen in the list.
fn shown(window: &Window) -> String {
    let mut pages = window.query_all_by_role(Role::RadioButton);
    let list = |node: &egui_kittest::Node<'_>| node.rect().left() < 80.0;
    let is_on = |node: &egui_kittest::Node<'_>| {
        node.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    let chosen = pages.find(|node| list(node) && is_on(node));
    chosen.and_then(|node| node.accesskit_node().label()).expect("a chosen page")
}

#[test]
fn ctrl_f_finds_a_setting_on_another_page_and_enter_goes_to_its_field() {
    for size in SIZES {
        let mut window = form(size);
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        type_words(&mut window, "park az");
        window.get_by_role_and_label(Role::ListBoxOption, "Park azimuth, Satrak");
        window.key_press(Key::Enter);
        settle(&mut window);
        let field = window.get_by_role_and_label(Role::TextInput, "Park azimuth");
        assert!(field.is_focused() && field.rect().bottom() < size[1] - 48.0, "in sight");
        type_words(&mut window, "123");
        let value = window.get_by_role_and_label(Role::TextInput, "Park azimuth").value();
        assert_eq!(value.as_deref(), Some("123"), "typed over the old value");
        assert_eq!(shown(&window), "Satrak");
    }
}

#[test]
fn arrow_keys_and_clicks_choose_a_search_result() {
    for size in rig::sizes() {
        let mut window = form(size);
        press(&mut window, Role::TextInput, FIND);
        type_words(&mut window, "poll");
        let rows = ["Poll at rest, Satrak", "Poll while moving, Satrak"];
        for row in rows {
            window.get_by_role_and_label(Role::ListBoxOption, row);
        }
        window.key_press(Key::ArrowDown);
        settle(&mut window);
        window.key_press(Key::Enter);
        settle(&mut window);
        let field = window.get_by_role_and_label(Role::TextInput, "Poll while moving");
        assert!(field.is_focused());

        press(&mut window, Role::TextInput, FIND);
        type_words(&mut window, "nowhere");
        assert!(says(&window, "No setting has that name."));
        press(&mut window, Role::Button, "Clear the search");
        press(&mut window, Role::TextInput, FIND);
        type_words(&mut window, "sun avoid");
        press(&mut window, Role::ListBoxOption, "Sun avoidance, Horizon and keep-outs");
        window.get_by_role_and_label(Role::CheckBox, "Keep antennas away from the Sun");
    }
}

#[test]
fn ctrl_tab_goes_through_all_pages_and_round() {
    for size in rig::sizes() {
        let mut window = form(size);
        let mut pages = Vec::new();
        for _ in 0..8 {
            pages.push(shown(&window));
            window.key_press_modifiers(Modifiers::COMMAND, Key::Tab);
            settle(&mut window);
        }
        let wanted = [
            "Site",
            "Horizon and keep-outs",
            "Satrak",
            "Satellites and priorities",
            "Automation rules",
            "Alarms and sounds",
            "Appearance",
            "Site",
        ];
        assert_eq!(pages, wanted);
    }
}

#[test]
fn edits_and_unusable_fields_of_each_page_are_counted_and_ctrl_enter_saves_them_all() {
    for size in rig::sizes() {
        let mut window = form(size);
        write(&mut window, "Altitude", "12");
        open(&mut window, "Satrak");
        write(&mut window, "Beamwidth", "1.7");
        write(&mut window, "Poll while moving", "11");
        assert!(says(&window, "Site: 1 edited") && says(&window, "Satrak: 2 edited, 1 not valid"));
        assert!(says(&window, "3 changes in 2 sections"));
        window.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
        assert_eq!(asked(&mut window), [], "a field is not valid");
        press(&mut window, Role::Button, "Use 10");
        assert!(says(&window, "All fields are valid."));
        assert!(says(&window, "Satrak does not move. Saving reconnects it."));
        window.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
        let station = saved(asked(&mut window));
        assert!((station.site.altitude_m() - 12.0).abs() < 1e-9);
        assert!((station.antennas[0].beam_width_deg - 1.7).abs() < 1e-9);
        assert!((station.antennas[0].poll.moving_hz - 10.0).abs() < 1e-9);
    }
}

#[test]
fn a_field_says_what_it_was_and_no_row_moves_when_it_is_wrong() {
    for size in SIZES {
        let mut window = form(size);
        let below = |window: &Window| {
            window.get_by_role_and_label(Role::TextInput, "Elevation floor").rect()
        };
        let before = below(&window);
        write(&mut window, "Latitude", "91");
        assert!(says(&window, "Latitude must be a number from −90 to 90°."));
        assert_eq!(below(&window), before);
        press(&mut window, Role::Button, "Use 90");
        assert!(says(&window, "Edited, was 41.02"));
    }
}

/// Unfolds the preview if it is folded.
fn unfold(window: &mut Window) {
    let fold = window.query_all_by_role(Role::Button).find(|node| {
        node.accesskit_node().label().is_some_and(|name| name.starts_with("What this changes"))
    });
    if let Some(fold) = fold {
        fold.click();
    }
    settle(window);
}

#[test]
fn what_an_edit_changes_of_the_passes_is_asked_for_and_shown_beside_what_was() {
    for size in rig::sizes() {
        let mut model: Model = rig::model(states::holding());
        let config = Antenna { id: AntennaId(1), ..Antenna::genius("Genius", "tower:9006") };
        model.shown_mut().antennas = vec![rig::antenna(config.clone(), rig::quiet())];
        Arc::make_mut(&mut model.shown_mut().station).antennas = vec![config];
        model.view = View::Preferences;
        let mut window = rig::window(size, model);
        open(&mut window, "Genius");
        unfold(&mut window);
        assert!(says(&window, "Being worked out."));
        rig::asked(&mut window);
        write(&mut window, "Azimuth to", "180");
        let commands = rig::asked(&mut window);
        let question = commands.into_iter().rev().find_map(|command| match command {
            UiCommand::ShowTracked(question) => Some(*question),
            _ => None,
        });
        let question = question.expect("the page asks");
        let passes = window.state().model.pass_lists.favourites.passes.clone();
        let ways = effects::ways::<effects::mounts::Question>(&passes, &|| false);
        let effect = effects::Effect::new(question.clone(), &ways, 0);
        let (was, new) = (effect.before, effect.after);
        assert!(new.whole < was.whole, "{was:?} {new:?}");
        let model = &mut window.state_mut().model;
        model.mount_effects.ask(question, model.steady);
        model.mount_effects.effect = Some(effect);
        settle(&mut window);
        let row = format!("Tracked in full: was {}, new {}", was.whole, new.whole);
        assert!(says(&window, &row), "{row}");
        window.get_by_label_contains("fewer than as saved.");
        window.get_by_label_contains("of the circle cannot be reached.");
        assert_eq!(rig::asked(&mut window), [], "asked once");
    }
}

#[test]
fn the_site_shows_the_sun_and_how_far_the_place_of_each_unit_is() {
    for size in SIZES {
        let held = states::holding();
        let mut state = held.state.clone();
        let place = Place { latitude_deg: 41.02, longitude_deg: 29.5, step_deg: 0.01 };
        state.on_board = OnBoard { place: Some(place), ..OnBoard::default() };
        let mut model = rig::model(Snapshot { state, ..held });
        model.view = View::Preferences;
        let mut window = rig::window(size, model);
        unfold(&mut window);
        window.get_by_label_contains("There the Sun is now");
        window.get_by_label_contains("km from the position that Satrak reports.");
        write(&mut window, "Longitude, east", "29.5");
        window.get_by_label_contains("Agrees with the position that Satrak reports: 0.0 km apart.");
    }
}

#[test]
fn a_travel_beyond_that_of_the_unit_is_told_before_saving() {
    let mut held = rig::quiet();
    held.state.travel_deg = [Some((0.0, 400.0)), None];
    let mut model: Model = rig::model(states::holding());
    let config = Antenna { id: AntennaId(1), ..Antenna::genius("Genius", "tower:9006") };
    model.shown_mut().antennas = vec![rig::antenna(config.clone(), held)];
    Arc::make_mut(&mut model.shown_mut().station).antennas = vec![config];
    model.view = View::Preferences;
    let mut window = rig::window(LARGE, model);
    open(&mut window, "Genius");
    write(&mut window, "Azimuth to", "445");
    assert!(says(&window, "Genius: the unit itself turns its azimuth from 0° to 400°"));
}

#[test]
fn enter_in_a_field_of_the_page_is_not_meant_for_the_search() {
    let mut window = form(LARGE);
    press(&mut window, Role::TextInput, FIND);
    type_words(&mut window, "poll");
    window.get_by_role_and_label(Role::TextInput, "Altitude").focus();
    settle(&mut window);
    window.key_press(Key::Enter);
    settle(&mut window);
    window.get_by_role_and_label(Role::ListBoxOption, "Poll while moving, Satrak");
}

#[test]
fn the_settings_of_a_unit_lead_to_the_page_of_its_antenna() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        model.view = View::Antennas;
        let mut window = rig::window(size, model);
        press(&mut window, Role::Button, "Mount and connection");
        assert!(asked(&mut window).contains(&UiCommand::Show(View::Preferences)));
        window.state_mut().model.view = View::Preferences;
        settle(&mut window);
        assert_eq!(shown(&window), "Satrak");
    }
}

#[test]
fn a_station_without_an_antenna_says_how_to_add_one() {
    let mut model = rig::model(states::holding());
    model.shown_mut().antennas.clear();
    Arc::make_mut(&mut model.shown_mut().station).antennas.clear();
    model.view = View::Preferences;
    let window = rig::window(SMALL, model);
    assert!(says(&window, "No antenna yet. Add one."));
    window.get_by_role_and_label(Role::ComboBox, "Add an antenna");
}

#[test]
fn the_local_time_is_taken_out_of_the_top_bar() {
    let mut window = form(LARGE);
    assert!(says(&window, "local time"));
    open(&mut window, "Appearance");
    window.get_by_role_and_label(Role::RadioButton, "Not shown").click();
    let [UiCommand::SetAppearance(appearance)] = asked(&mut window)[..] else {
        panic!("no appearance")
    };
    assert!(!appearance.local_time);
    window.state_mut().model.appearance = appearance;
    settle(&mut window);
    assert!(!says(&window, "local time"));
    window.get_by_label_contains("2026-08-12");
}

#[test]
fn the_list_stands_at_the_left_and_the_bar_is_low_in_the_smallest_window() {
    let mut window = antenna_form(SMALL);
    let row = window.get_by_role_and_label(Role::RadioButton, "Site").rect();
    let save = window.get_by_role_and_label(Role::Button, "Save and use").rect();
    assert!(row.width() <= 160.0 && SMALL[1] - save.center().y < 25.0, "{row:?} {save:?}");
    let field = window.get_by_role_and_label(Role::TextInput, "Name").rect();
    unfold(&mut window);
    let after = window.get_by_role_and_label(Role::TextInput, "Name").rect();
    assert!(after.top() > field.top(), "the preview is above the first card");
}

#[test]
fn the_outcome_of_a_test_moves_no_field() {
    let mut window = antenna_form(SMALL);
    let name = window.get_by_role_and_label(Role::TextInput, "Name").rect();
    window.get_by_role_and_label(Role::Button, "Test link").click();
    let commands = asked(&mut window);
    let [UiCommand::Station(contract::Command::TestLink(antenna))] = &commands[..] else {
        panic!("{commands:?}")
    };
    let finding = LinkFinding::Reached { state: Box::default(), after: Duration::from_millis(12) };
    for (stage, words) in [
        (LinkTestStage::Working, "Asking "),
        (LinkTestStage::Done { finding, time: rig::now() }, "Reached, 12 ms"),
    ] {
        let test = LinkTest { antenna: (**antenna).clone(), stage };
        window.state_mut().model.shown_mut().link_tests = Arc::new(vec![test]);
        settle(&mut window);
        assert!(says(&window, words), "{words}");
        assert_eq!(window.get_by_role_and_label(Role::TextInput, "Name").rect(), name);
    }
}

#[test]
fn an_edit_is_marked_by_its_border_and_the_focus_by_a_ring_and_an_invalid_field_says_why_below() {
    for size in SIZES {
        let mut window = form(size);
        let field = |window: &Window, name: &str| {
            window.get_by_role_and_label(Role::TextInput, name).rect()
        };
        let t = theme::tokens(&window.ctx);
        // Returns two flags: the border of an unedited field, and the border of an edited field.
        let border = |window: &Window| {
            let colours = painted::around(window, field(window, "Latitude"), 1.5);
            [colours.contains(&t.edge), colours.contains(&t.sat)]
        };
        let has_ring = |window: &Window| {
            let ring = field(window, "Latitude").expand(2.0);
            painted::around(window, ring, 0.5).contains(&t.sat)
        };
        assert_eq!((border(&window), has_ring(&window)), ([true, false], false));
        window.get_by_role_and_label(Role::TextInput, "Latitude").focus();
        settle(&mut window);
        assert_eq!((border(&window), has_ring(&window)), ([true, false], true), "looked at");
        write(&mut window, "Latitude", "47");
        assert_eq!((border(&window), has_ring(&window)), ([false, true], true), "edited");
        window.get_by_role_and_label(Role::TextInput, "Name").focus();
        settle(&mut window);
        assert_eq!((border(&window), has_ring(&window)), ([false, true], false), "left");
        write(&mut window, "Latitude", "91");
        let why = "Latitude must be a number from −90 to 90°. Use 90.";
        assert!(says(&window, why), "below the field that has the focus");
        window.get_by_role_and_label(Role::TextInput, "Name").focus();
        settle(&mut window);
        assert!(!says(&window, why), "the findings have it, the field is left alone");
    }
}

#[test]
fn a_station_without_a_record_says_whether_another_azel_keeps_it() {
    let mut window = form(LARGE);
    assert!(says(&window, "Nothing is recorded: this user has no folder for records."));
    let model = &mut window.state_mut().model;
    let now = model.now;
    model.shown_mut().alarms.raise(None, AlarmKind::StationElsewhere(HeldBy::Azel(None)), now);
    settle(&mut window);
    let kept = "Nothing is recorded from here: the Azel that has this station open records it.";
    assert!(says(&window, kept));
}

#[test]
fn a_moved_site_shows_its_passes_beside_those_of_the_saved_one() {
    for size in rig::sizes() {
        let mut window = form(size);
        window.state_mut().model.shown_mut().pass_lists.favourites.made_at = Some(rig::now());
        unfold(&mut window);
        assert!(says(&window, "Being worked out."));
        write(&mut window, "Latitude", "70");
        let commands = rig::asked(&mut window);
        let question = commands.into_iter().rev().find_map(|command| match command {
            UiCommand::ShowMoved(question) => Some(*question),
            _ => None,
        });
        let question = question.expect("the page asks");
        assert_ne!(question.before, question.after);
        let effect = effects::Effect::new(question.clone(), &Arc::default(), 0);
        let (was, new) = (effect.before, effect.after);
        assert_ne!(was.count, new.count, "{was:?} {new:?}");
        let model = &mut window.state_mut().model;
        model.site_effects.ask(question, model.steady);
        model.site_effects.effect = Some(effect);
        settle(&mut window);
        let row = format!("Passes: was {}, new {}", was.count, new.count);
        assert!(says(&window, &row), "{row}");
        assert_eq!(rig::asked(&mut window), [], "asked once");
    }
}

#[test]
fn the_station_file_is_told_with_its_age_and_its_folder_opened() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        model.view = View::Preferences;
        model.stations.open = Some("/home/ops/.config/azel/station.toml".into());
        model.shown_mut().station_saved_at = Some(model.now);
        let mut window = rig::window(size, model);
        let now = azel::ui::format::moment(rig::now(), rig::now());
        let file = format!("Station file: /home/ops/.config/azel/station.toml, saved {now}");
        assert!(says(&window, &file), "{file}");
        rig::asked(&mut window);
        press(&mut window, Role::Button, "Open folder");
        let folder = "/home/ops/.config/azel".into();
        assert_eq!(rig::asked(&mut window), [UiCommand::OpenFolder(folder)]);
        window.state_mut().model.shown_mut().station_saved_at = None;
        settle(&mut window);
        assert!(says(&window, "station.toml, not saved yet"));
    }
}

#[test]
fn each_word_of_elevation_is_explained_at_its_field() {
    for size in rig::sizes() {
        let mut window = form(size);
        assert!(says(&window, "A pass begins and ends there."));
        assert!(says(&window, "A pass whose maximum stays below it is not listed."));
        open(&mut window, "Satrak");
        assert!(says(&window, "The antenna is never sent below it."));
    }
}

#[test]
fn a_pointing_model_is_fitted_to_the_record_and_filled_in_and_used_only_once_saved() {
    for size in rig::sizes() {
        let mut model = makes::model(makes::pair(), makes::pair_at(Intent::Standby));
        let mut station = Station::clone(&model.station);
        let antenna = Antenna::clone(&model.antennas[0].config);
        let (id, name) = (antenna.id, antenna.name.clone());
        station.antennas = vec![antenna];
        (model.shown_mut().station, model.view) = (Arc::new(station), View::Preferences);
        let mut window = rig::window(size, model);
        open(&mut window, &name);
        press(&mut window, Role::Button, "Fit to recorded passes");
        let fit = |without| UiCommand::Station(contract::Command::FitPointing(id, without));
        assert_eq!(asked(&mut window), [fit(Vec::new())]);
        let term = |term| {
            let value = match term {
                Term::AzimuthOffset => Some(1.23456),
                Term::TiltEast => Some(-0.00002),
                _ => None,
            };
            let not_told_from = if value.is_none() { vec![Term::AzimuthOffset] } else { vec![] };
            FittedTerm { term, value, half_of_95_percent: value.map(|_| 0.02), not_told_from }
        };
        let noise = FittedNoise { kind: Kind::Satellite, points: 340, noise_deg: 0.0312 };
        let terms = Term::ALL.map(term).into();
        let found = PointingFit { passes: 12, noise: vec![noise], excluded: Vec::new(), terms };
        let tell = |window: &mut Window, found| {
            let fitted = PointingFitted { antenna: id, found };
            window.state_mut().model.shown_mut().pointing_fitted = Some(Arc::new(fitted));
            settle(window);
        };
        tell(&mut window, Some(Err("2 usable points are too few in 1 recorded passes".into())));
        assert!(says(&window, "No model: 2 usable points are too few in 1 recorded passes."));
        tell(&mut window, Some(Ok(found.clone())));
        let words = "12 passes, 340 points, each axis within 0.031° of the model (1 σ).";
        assert!(says(&window, words));
        assert!(says(&window, "0.0200°") && says(&window, "Some terms may as well be zero."));
        assert!(says(&window, "Sag cannot be told from azimuth offset in these passes"));
        press(&mut window, Role::Button, "Fit without them");
        assert_eq!(asked(&mut window), [fit(vec![Term::TiltEast])]);
        let (mut terms, without) = (found.terms, vec![Term::TiltEast]);
        terms.retain(|of| of.term != Term::TiltEast);
        terms.push(FittedTerm {
            term: Term::TiltEast,
            value: None,
            half_of_95_percent: None,
            not_told_from: Vec::new(),
        });
        tell(&mut window, Some(Ok(PointingFit { excluded: without, terms, ..found })));
        assert!(says(&window, "Left at 0, as you wanted: tilt to the east."));
        assert!(!says(&window, "Tilt to the east cannot be told from"));
        assert!(window.query_by_label("Fit without them").is_none());
        press(&mut window, Role::Button, "Fill in");
        assert!(asked(&mut window).is_empty(), "nothing is used yet");
        let field = window.get_by_role_and_label(Role::TextInput, "Azimuth offset");
        assert_eq!(field.value().as_deref(), Some("1.2346"));
        press(&mut window, Role::Button, "Save and use");
        let saved = saved(asked(&mut window));
        let expected = PointingModel { azimuth_offset_deg: 1.2346, ..PointingModel::default() };
        assert_eq!(saved.antennas[0].pointing_model, expected);
    }
}

#[test]
fn a_peak_is_entered_as_measured_now_or_as_typed_and_removed() {
    for size in rig::sizes() {
        let mut model = makes::model(makes::pair(), makes::pair_at(Intent::Standby));
        let mut station = Station::clone(&model.station);
        let antenna = Antenna::clone(&model.antennas[0].config);
        let (id, name) = (antenna.id, antenna.name.clone());
        station.antennas = vec![antenna];
        (model.shown_mut().station, model.view) = (Arc::new(station), View::Preferences);
        let pointing = model.antennas[0].snapshot.state.measured.unwrap().pointing;
        let deg = |of: Option<azel::astro::Angle>| of.unwrap().degrees();
        let now = model.now;
        let mut window = rig::window(size, model);
        open(&mut window, &name);
        assert!(says(&window, "Nothing is recorded: no peak can be kept."));
        says_why(&mut window, "Add peak", "Nothing is recorded.");
        window.state_mut().model.shown_mut().record = Some(Arc::default());
        settle(&mut window);
        press(&mut window, Role::Button, "Add peak");
        let measured = Peak {
            body: PeakBody::Sun,
            time: now,
            azimuth_deg: deg(pointing.azimuth),
            elevation_deg: deg(pointing.elevation),
        };
        let change = |change| UiCommand::Station(contract::Command::ChangePeaks(id, change));
        assert_eq!(asked(&mut window), [change(PeakChange::Added(measured))]);
        press(&mut window, Role::RadioButton, "Moon");
        let at = now - jiff::SignedDuration::from_hours(1);
        let typed =
            [("Time of the peak", format!("{at:.0}")), ("Azimuth at the peak", "120.5".to_owned())];
        for (field, text) in typed {
            write(&mut window, field, &text);
        }
        assert!(says(&window, "Type the elevation that the antenna showed at the peak."));
        write(&mut window, "Elevation at the peak", "31");
        press(&mut window, Role::Button, "Add peak");
        let typed =
            Peak { body: PeakBody::Moon, time: at, azimuth_deg: 120.5, elevation_deg: 31.0 };
        assert_eq!(asked(&mut window), [change(PeakChange::Added(typed))]);
        let mut peaks = Peaks::default();
        peaks.change(id, PeakChange::Added(typed));
        peaks.change(AntennaId(99), PeakChange::Added(measured));
        window.state_mut().model.shown_mut().peaks = Arc::new(peaks);
        settle(&mut window);
        let row = format!("Moon, {}: az 120.50°, el 31.00°", azel::ui::format::moment(at, now));
        assert!(says(&window, &row), "{row}");
        press(&mut window, Role::Button, &format!("Remove the peak of {row}"));
        assert_eq!(asked(&mut window), [change(PeakChange::Removed(typed))]);
        let replay = super::replay::model().replay;
        window.state_mut().model.replay = replay;
        settle(&mut window);
        for button in ["Add peak", &format!("Remove the peak of {row}"), "Fit to recorded passes"] {
            says_why(&mut window, button, "Replay. Leave it first.");
        }
    }
}

/// Checks that a locked button shows its reason under the pointer.
fn says_why(window: &mut Window, button: &str, why: &str) {
    window.get_by_role_and_label(Role::Button, button).scroll_to_me();
    settle(window);
    window.get_by_role_and_label(Role::Button, button).hover();
    settle(window);
    assert!(says(window, why), "{button}");
    window.hover_at(egui::pos2(1.0, 1.0));
    settle(window);
}
