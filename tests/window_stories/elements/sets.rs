//! Stored sets of one object, and the older one that the operator uses.

use std::sync::Arc;

use azel::{
    contract::{
        self, CatalogState,
        older_sets::{OlderSet, OlderSets, SetChoice},
        sources::{SourceWork, Sources},
    },
    controller::SPECS,
    model::{Model, UiCommand},
    orbit::{Elements, Source, SourcePlace, read_elements, write_omm_json},
    station,
    ui::format,
};
use egui::{Key, Role};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};
use jiff::Timestamp;

use super::{
    adding::{epoch_of_noaa_20, newer_elements, week_later},
    click,
    detail::detail,
    view, write,
};
use crate::window_stories::{
    rig::{self, NOAA_20, Window, asked, says, settle},
    unit::{RealWindow, Unit, clock_from, open, step_until},
};

/// Returns the catalogue's elements of NOAA 20 with this epoch.
fn with_epoch(model: &Model, epoch: &str) -> Elements {
    let CatalogState::Ready(catalog) = &model.catalog else { unreachable!() };
    let mut text = Vec::new();
    write_omm_json([catalog.get(NOAA_20).unwrap()], &mut text).unwrap();
    let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
    list[0]["EPOCH"] = epoch.into();
    read_elements(&list.to_string()).elements.remove(0)
}

/// Shows the given sets of NOAA 20 as sets that are not in use.
fn hold(window: &mut Window, sets: impl IntoIterator<Item = Elements>) {
    let of_weather = |elements| OlderSet { elements, source: "weather".to_owned() };
    let sets = sets.into_iter().map(of_weather).collect();
    let older = OlderSets { catalog_number: NOAA_20, sets };
    window.state_mut().model.shown_mut().older_sets = Some(Arc::new(older));
    settle(window);
}

/// Opens the menu of the set whose row begins with `row`.
fn open_menu(window: &mut Window, row: &str) {
    let row = window.get_by(|node| {
        node.role() == Role::Button && node.label().unwrap_or_default().starts_with(row)
    });
    row.scroll_to_me();
    row.click();
    settle(window);
}

fn use_set(choice: SetChoice) -> UiCommand {
    UiCommand::Station(contract::Command::UseSet(choice))
}

#[test]
fn an_older_set_stands_against_the_one_in_use_and_is_used_after_a_question() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Stored sets, differences from the one in use at "));
        let older = with_epoch(&window.state().model, "2026-08-10T02:04:00");
        let epoch = older.epoch();
        hold(&mut window, [older]);
        asked(&mut window);
        let row = "Set of 10 Aug 02:04Z from weather: ";
        open_menu(&mut window, row);
        assert!(says(&window, "Mean motion"), "a click shows its elements");
        click(&mut window, "Use this set\u{2026}");
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "Use the set of 10 Aug 02:04Z for NOAA 20"));
        assert!(says(&window, "At the next pass, "), "with what it changes");
        assert!(says(&window, "than half the beamwidth of "));
        assert!(says(&window, "until newer elements arrive or you end it."));
        window.key_press(Key::Enter);
        let choice = SetChoice::Older { catalog_number: NOAA_20, epoch };
        assert_eq!(asked(&mut window), [use_set(choice)]);
    }
}

#[test]
fn while_an_older_set_is_in_use_it_is_told_and_the_newest_is_one_click_away() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let model = &mut window.state_mut().model;
        let older = with_epoch(model, "2026-08-10T02:04:00");
        let CatalogState::Ready(catalog) = &mut model.shown_mut().catalog else { unreachable!() };
        let newest = catalog.get(NOAA_20).unwrap().clone();
        Arc::make_mut(catalog).use_in_place(older, "weather");
        write(&mut window, "Search the catalogue", "43013");
        window.get_by_label_contains("from weather, an older set by choice, next pass ");
        detail(&mut window, size);
        hold(&mut window, [newest]);
        asked(&mut window);
        assert!(says(&window, "older set, weather"));
        assert!(says(&window, "Not in use: the newest, "));
        click(&mut window, "Use the newest");
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "Use the newest set of "));
        window.key_press(Key::Enter);
        let choice = SetChoice::Newest { catalog_number: NOAA_20 };
        assert_eq!(asked(&mut window), [use_set(choice)]);

        let sources = Sources { work: SourceWork::Reading, ..Sources::default() };
        window.state_mut().model.shown_mut().sources = Arc::new(sources);
        settle(&mut window);
        let button = window.get_by_role_and_label(Role::Button, "Use the newest");
        assert!(button.accesskit_node().is_disabled(), "it would not be taken now");
    }
}

#[test]
fn a_set_between_the_older_one_in_use_and_the_newest_is_not_called_the_newest() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let model = &mut window.state_mut().model;
        let in_use = with_epoch(model, "2026-08-03T02:04:00");
        let between = with_epoch(model, "2026-08-05T02:04:00");
        let CatalogState::Ready(catalog) = &mut model.shown_mut().catalog else { unreachable!() };
        let newest = catalog.get(NOAA_20).unwrap().clone();
        Arc::make_mut(catalog).use_in_place(in_use, "weather");
        detail(&mut window, size);
        let (epoch, newest_epoch) = (between.epoch(), newest.epoch());
        assert!(newest_epoch > epoch);
        hold(&mut window, [newest, between]);
        asked(&mut window);
        open_menu(&mut window, "Set of 5 Aug 02:04Z from weather: ");
        click(&mut window, "Use this set\u{2026}");
        assert!(says(&window, "Use the set of 5 Aug 02:04Z for NOAA 20"));
        window.key_press(Key::Enter);
        let choice = SetChoice::Older { catalog_number: NOAA_20, epoch };
        assert_eq!(asked(&mut window), [use_set(choice)]);

        let row = format!("Set of {} from weather: ", format::minute(newest_epoch, rig::now()));
        open_menu(&mut window, &row);
        click(&mut window, "Use the newest set\u{2026}");
        window.key_press(Key::Enter);
        let choice = SetChoice::Newest { catalog_number: NOAA_20 };
        assert_eq!(asked(&mut window), [use_set(choice)]);
    }
}

fn with_order(window: &mut Window, order: &[&str]) {
    let station = Arc::make_mut(&mut window.state_mut().model.shown_mut().station);
    let order = order.iter().map(|name| (*name).to_owned()).collect();
    station.favourites.set_sources(NOAA_20, order);
    settle(window);
}

/// Returns the line of the sources, which opens the menu of their order.
fn sources_line(window: &Window) -> Node<'_> {
    window.get_by(|node| {
        let label = node.label().unwrap_or_default();
        node.role() == Role::ComboBox && label.starts_with("Sources: ")
    })
}

#[test]
fn the_order_of_sources_is_shown_with_the_source_in_use_and_set_by_a_menu() {
    for size in rig::sizes() {
        let named = |name: &str| {
            let source = Source { name: name.to_owned(), ..Source::satnogs() };
            let report = super::report(&source, 71);
            (source, report)
        };
        let mut window = view(size, vec![named("own"), named("web")]);
        detail(&mut window, size);
        let order = |order: &[&str]| {
            let sources = order.iter().map(|name| (*name).to_owned()).collect();
            [UiCommand::Station(contract::Command::SetSourceOrder { satellite: NOAA_20, sources })]
        };
        for (present, choice, wanted) in [
            (&[][..], "own first", &["own"][..]),
            (&["own"], "web first", &["web", "own"]),
            (&["web", "own"], "own first", &["own", "web"]),
            (&["own", "web"], "Newest of all sources", &[]),
        ] {
            with_order(&mut window, present);
            asked(&mut window);
            sources_line(&window).click();
            settle(&mut window);
            click(&mut window, choice);
            assert_eq!(asked(&mut window), order(wanted));
        }
        with_order(&mut window, &["own", "web"]);
        let line = "Sources: own, then web, then the newest";
        window.get_by_role_and_label(Role::ComboBox, line);
    }
}

fn send(window: &RealWindow, command: contract::Command) {
    assert!(window.state().station().client().send(command).is_ok());
}

#[test]
fn a_preferred_source_is_used_until_its_elements_lag_and_over_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(week_later());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the elements", |model| epoch_of_noaa_20(model).is_some());
    let own = newer_elements(&folder);
    let web = folder.path().join("web.json");
    let text = std::fs::read_to_string(&own).unwrap();
    std::fs::write(&web, text.replace("08-14T", "08-17T")).unwrap();
    for (name, path) in [("own", &own), ("web", &web)] {
        let place = SourcePlace::File(path.clone());
        let source = Source { name: name.to_owned(), place, refresh: None };
        send(&window, contract::Command::AddSource(source));
        step_until(&mut window, "the source", |model| {
            model.sources.is_free() && model.sources.list.iter().any(|known| known.name == name)
        });
    }
    let at = |day: u32| format!("2026-08-{day}T00:00:00Z").parse::<Timestamp>().ok();
    step_until(&mut window, "the newest set", |model| epoch_of_noaa_20(model) == at(17));
    let sources = vec!["own".to_owned()];
    send(&window, contract::Command::SetSourceOrder { satellite: NOAA_20, sources });
    step_until(&mut window, "the preferred set", |model| epoch_of_noaa_20(model) == at(14));
    drop(window);

    let file = std::fs::read_to_string(&settings).unwrap();
    assert!(file.contains("sources = [\"own\"]"), "{file}");
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the elements again", |model| epoch_of_noaa_20(model).is_some());
    assert_eq!(epoch_of_noaa_20(window.state().model()), at(14), "from the first reading");
    std::fs::write(&web, text.replace("08-14T", "08-18T")).unwrap();
    let read = contract::Command::RefreshSources { names: vec!["web".to_owned()], forced: false };
    send(&window, read);
    step_until(&mut window, "the next source", |model| epoch_of_noaa_20(model) == at(18));
}

#[test]
fn an_older_set_is_used_over_the_next_start_until_a_newer_one_comes() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(week_later());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the elements", |model| epoch_of_noaa_20(model).is_some());
    let bundled = epoch_of_noaa_20(window.state().model());
    let own = newer_elements(&folder);
    let source =
        Source { name: "own".to_owned(), place: SourcePlace::File(own.clone()), refresh: None };
    send(&window, contract::Command::AddSource(source));
    let newer: Option<Timestamp> = "2026-08-14T00:00:00Z".parse().ok();
    step_until(&mut window, "the newer set", |model| epoch_of_noaa_20(model) == newer);

    send(&window, contract::Command::ListOlderSets(NOAA_20));
    step_until(&mut window, "the older set", |model| {
        model.older_sets.as_ref().is_some_and(|older| !older.sets.is_empty())
    });
    let epoch = bundled.unwrap();
    let choice = SetChoice::Older { catalog_number: NOAA_20, epoch };
    send(&window, contract::Command::UseSet(choice));
    step_until(&mut window, "the older set in use", |model| epoch_of_noaa_20(model) == bundled);
    let has_newest = |model: &Model| {
        let older = model.older_sets.as_ref();
        older.is_some_and(|older| older.sets.iter().any(|set| Some(set.elements.epoch()) == newer))
    };
    step_until(&mut window, "the newest among the others", has_newest);
    drop(window);

    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the older set again", |model| epoch_of_noaa_20(model) == bundled);
    let text = std::fs::read_to_string(&own).unwrap();
    std::fs::write(&own, text.replace("08-14T", "08-15T")).unwrap();
    let read = contract::Command::RefreshSources { names: vec!["own".to_owned()], forced: false };
    send(&window, read);
    let newest: Option<Timestamp> = "2026-08-15T00:00:00Z".parse().ok();
    step_until(&mut window, "the newest set", |model| epoch_of_noaa_20(model) == newest);
}
