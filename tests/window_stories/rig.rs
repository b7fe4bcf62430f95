//! Window without a display on a model made by hand: nothing moves, no clock runs, and the rig
//! collects the operator's commands.

use std::{
    sync::{Arc, OnceLock},
    time::Duration,
};

use azel::{
    astro::time::add_seconds,
    clock::{Instant, Moment},
    contract::{
        CatalogState, Command,
        antenna::AntennaModel,
        driver::{LinkState, Snapshot, TimeSync},
        passes::{ListedSatellite, Observer, PassLists, PredictedPass},
    },
    controller::{SPECS, satrak},
    engine::antenna::{Recent, refresh},
    model::{
        Model, ThemeName, UiCommand, View,
        catalog_table::{Answer, arrange},
        intake::{Intake, Judged, Offer},
        object_detail::{DetailKey, ObjectDetail},
    },
    orbit::{Catalog, PassSearch, Propagator, bundled, passes},
    station::{Antenna, Station},
    ui::{Views, theme},
};
use egui::{
    Event, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, Role, TouchPhase, UiBuilder,
    ViewportId, vec2,
};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use jiff::Timestamp;

/// Default window size and the smallest one, points.
pub(crate) const SIZES: [[f32; 2]; 2] = [LARGE, SMALL];
pub(crate) const LARGE: [f32; 2] = [1440.0, 900.0];
pub(crate) const SMALL: [f32; 2] = [1024.0, 640.0];

/// Returns the sizes for a story that goes the same way in each: the default one, or all with
/// `AZEL_SIZES=all` in the environment. The checks of the layout always use all [`SIZES`].
pub(crate) fn sizes() -> impl Iterator<Item = [f32; 2]> {
    let is_long = std::env::var("AZEL_SIZES").is_ok_and(|sizes| sizes == "all");
    SIZES.into_iter().take(if is_long { SIZES.len() } else { 1 })
}

pub(crate) const NOAA_20: u32 = 43_013;
const FOLLOWED: [u32; 5] = [NOAA_20, 25_544, 59_051, 37_849, 44_334];

/// Window content and the commands of the operator.
pub(crate) struct Story {
    pub(crate) model: Model,
    pub(crate) views: Views,
    pub(crate) commands: Vec<UiCommand>,
}

pub(crate) type Window = Harness<'static, Story>;

/// Returns the time of every story; NOAA 20 is up.
pub(crate) fn now() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

/// Elements, and passes over the site of [`station`], computed once.
struct Orbits {
    catalog: Arc<Catalog>,
    satellites: Vec<Arc<ListedSatellite>>,
    passes: Vec<PredictedPass>,
}

fn orbits() -> &'static Orbits {
    static ORBITS: OnceLock<Orbits> = OnceLock::new();
    ORBITS.get_or_init(|| {
        let catalog = Arc::new(bundled().unwrap());
        let satellites: Vec<Arc<ListedSatellite>> =
            FOLLOWED.map(|number| Arc::new(followed(&catalog, number))).into();
        let mut passes: Vec<PredictedPass> = satellites
            .iter()
            .flat_map(|satellite| predicted_passes(satellite, &station(), now()))
            .collect();
        passes.sort_by_key(|predicted| (predicted.pass.aos.time, predicted.number()));
        // All stories share these paths, together with their drawings.
        for predicted in &passes {
            predicted.path();
        }
        Orbits { catalog, satellites, passes }
    })
}

fn followed(catalog: &Catalog, number: u32) -> ListedSatellite {
    let elements = catalog.get(number).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    ListedSatellite { elements, propagator }
}

/// Returns the passes of the 12 h after `now`, with the one under way.
pub(crate) fn predicted_passes(
    satellite: &Arc<ListedSatellite>,
    station: &Station,
    now: Timestamp,
) -> Vec<PredictedPass> {
    let observer = Arc::new(Observer::from_station(station));
    let (from, to) = (add_seconds(now, -3600.0), add_seconds(now, 12.0 * 3600.0));
    let search = PassSearch {
        aos_elevation: observer.aos_elevation,
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, from, to)
    };
    passes(&satellite.propagator, &search, &|| false)
        .into_iter()
        .filter(|pass| pass.los.time > now)
        .map(|pass| PredictedPass::new(Arc::clone(satellite), pass, Arc::clone(&observer)))
        .collect()
}

/// Returns a station in Istanbul with one Satrak.
pub(crate) fn station() -> Station {
    let antennas = vec![Antenna::satrak("Satrak", "192.168.10.21:4001")];
    let favourites = FOLLOWED.into();
    Station { name: "Şile 1".to_owned(), antennas, favourites, ..Station::default() }
}

/// Returns the snapshot of a new session with its link up.
pub(crate) fn quiet() -> Snapshot {
    let since = Instant::now();
    let mut snapshot = Snapshot::before_anything(LinkState::Up { start: since });
    snapshot.state.link_since = Some(since);
    snapshot
}

/// Returns an antenna that always shows `snapshot`.
pub(crate) fn antenna(config: Antenna, mut snapshot: Snapshot) -> AntennaModel {
    snapshot.state.questions = Arc::clone(&config.controller().state().questions);
    AntennaModel::new(config, Arc::new(snapshot))
}

/// Returns the station with its antenna in the state of `snapshot`, and NOAA 20 selected.
pub(crate) fn model(mut snapshot: Snapshot) -> Model {
    // A Satrak names its checks before the first question.
    if snapshot.state.checks.is_empty() {
        snapshot.state.checks = satrak::checks(None).into();
    }
    let (station, orbits) = (station(), orbits());
    let mut pass_lists = PassLists::default();
    pass_lists.favourites.satellites = orbits.satellites.clone().into();
    pass_lists.favourites.passes = orbits.passes.clone().into();
    let antennas = vec![antenna(station.antennas[0].clone(), snapshot)];
    let at = Moment { utc: now(), steady: Instant::now() };
    let shown = azel::contract::Snapshot {
        time_sync: TimeSync::Synchronised,
        station: Arc::new(station),
        catalog: CatalogState::Ready(Arc::clone(&orbits.catalog)),
        antennas,
        pass_lists,
        ..azel::contract::Snapshot::before_anything(at)
    };
    let mut model = Model::before_anything(at);
    model.take(Arc::new(shown), |_| None);
    model.selected = model.pass_of(NOAA_20).map(PredictedPass::key);
    refresh_antennas(&mut model);
    model.refresh_sky();
    model
}

/// Computes the values that the station adds to the measurements of its antennas.
pub(crate) fn refresh_antennas(model: &mut Model) {
    let shown = Arc::clone(model.shown());
    for antenna in &mut model.shown_mut().antennas {
        refresh(antenna, &mut Recent::default(), shown.station.site, |number| {
            shown.pass_lists.satellite(number)
        });
    }
}

/// Returns the instant `seconds` before the frame of `model`.
pub(crate) fn ago(model: &Model, seconds: u64) -> Instant {
    model.steady - Duration::from_secs(seconds)
}

/// Returns the instant an hour after the frame of `model`.
pub(crate) fn soon(model: &Model) -> Instant {
    model.steady + Duration::from_hours(1)
}

/// Opens the whole window on `model`.
pub(crate) fn window(size: [f32; 2], model: Model) -> Window {
    let story = Story { model, views: Views::default(), commands: Vec::new() };
    let mut window = Harness::builder()
        .with_size(size)
        .with_context_setup(|ctx| theme::install(ctx, ThemeName::Dark))
        .renderer(azel_painter::Painter::default())
        .build_ui_state(
            |ui, story: &mut Story| {
                // The program has no margin around its views.
                let whole = ui.ctx().content_rect();
                ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
                    ui.set_clip_rect(whole);
                    story.views.show(ui, &story.model, &mut story.commands);
                });
                arrange_catalog(story);
            },
            story,
        );
    settle(&mut window);
    window
}

/// Computes the rows of the catalog, as the app does on a thread.
fn arrange_catalog(story: &mut Story) {
    let model = &mut story.model;
    for command in &story.commands {
        if let UiCommand::ShowCatalog(question) = command {
            model.catalog_table.question = question.clone();
        }
    }
    for command in &story.commands {
        if let UiCommand::InspectObject(number) = command {
            model.catalog_table.inspected = Some(*number);
        }
    }
    let is_of_window = |command: &UiCommand| {
        matches!(
            command,
            UiCommand::ShowCatalog(_)
                | UiCommand::InspectObject(_)
                | UiCommand::OfferElements { .. }
                | UiCommand::LeaveElements
        )
    };
    for command in story.commands.extract_if(.., |command| is_of_window(command)) {
        match command {
            UiCommand::OfferElements { offers, is_dropped } => {
                let CatalogState::Ready(catalog) = &model.catalog else { continue };
                let judged = offers.iter().map(|offer| match offer {
                    Offer::Text(text) => Judged::new(text.as_bytes(), Some(catalog)),
                    Offer::File(path) => match std::fs::read(path) {
                        Ok(bytes) => Judged::new(&bytes, Some(catalog)),
                        Err(error) => Judged::Unreadable(error.to_string()),
                    },
                });
                let judged = Some(judged.collect());
                model.intake = Some(Intake { offers, is_dropped, judged });
            }
            UiCommand::LeaveElements => model.intake = None,
            _ => {}
        }
    }
    let shown = Arc::clone(model.shown());
    let CatalogState::Ready(catalog) = &shown.catalog else { return };
    let inputs = model.catalog_table.inputs(catalog, &model.station);
    let is_arranged = |answer: &Answer| answer.inputs == inputs;
    if model.view == View::Elements && !model.catalog_table.answer.as_ref().is_some_and(is_arranged)
    {
        model.catalog_table.answer = Some(arrange(inputs, model.now));
    }
    let inspected = model.catalog_table.inspected.and_then(|number| catalog.get(number));
    let Some(elements) = inspected.filter(|_| model.view == View::Elements) else { return };
    let key = DetailKey::new(elements, &model.station, model.older_sets.as_ref());
    let detail = model.catalog_table.detail.as_ref();
    if !detail.is_some_and(|detail| detail.is_of(&key, model.now)) {
        model.catalog_table.detail = Some(ObjectDetail::new(key, model.now, &|| false));
    }
}

/// Runs frames until nothing changes. It runs at least two, because a story may answer a command
/// after its frame, and at most four, because a bell blinks forever.
pub(crate) fn settle(window: &mut Window) {
    window.step();
    for _ in 0..3 {
        window.step();
        let root = &window.output().viewport_output[&ViewportId::ROOT];
        if root.repaint_delay > Duration::ZERO {
            break;
        }
    }
}

/// Turns the wheel over `at`, by `points` towards the top.
pub(crate) fn scroll(window: &mut Window, at: Pos2, points: f32) {
    window.hover_at(at);
    window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, points),
        modifiers: Modifiers::NONE,
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
    });
    settle(window);
}

/// Returns the commands since the last call.
pub(crate) fn asked(window: &mut Window) -> Vec<UiCommand> {
    settle(window);
    let asked = std::mem::take(&mut window.state_mut().commands);
    for command in &asked {
        // The reader of stations does not know makes that a test describes.
        let is_of_a_toy = |station: &Station| {
            let mut specs = station.antennas.iter().map(|antenna| antenna.connection.spec());
            specs.any(|spec| !SPECS.contains(&spec))
        };
        match command {
            UiCommand::Station(Command::SaveStation(station)) if is_of_a_toy(station) => {}
            UiCommand::Station(command) => drop(crate::common::comes_back(command)),
            _ => {}
        }
    }
    asked
}

/// Returns the commands since the last call, without previews of a direction.
pub(crate) fn sent(window: &mut Window) -> Vec<UiCommand> {
    let mut commands = asked(window);
    commands.retain(|command| {
        let looks = |command: &Command| {
            matches!(command, Command::Antenna(_, azel::contract::driver::Command::Preview(_)))
        };
        !matches!(command, UiCommand::Station(command) if looks(command))
    });
    commands
}

/// Returns `true` if a text of the window, not a control, contains `words`.
pub(crate) fn says(window: &Window, words: &str) -> bool {
    window.query_all_by_role(Role::Label).any(|node| {
        let node = node.accesskit_node();
        node.value().is_some_and(|text| text.contains(words))
    })
}

/// Returns the command to track NOAA 20, with the antenna and pass that every story selects.
pub(crate) fn track_noaa_20() -> UiCommand {
    UiCommand::track_selected(&model(quiet())).expect("a selected pass")
}
