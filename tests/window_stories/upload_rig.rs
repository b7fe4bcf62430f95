//! Upload part alone, and common steps of its stories.

use azel::{
    astro::time::add_seconds,
    contract::{
        self,
        transfer::{FileName, KeptFile, Origin, Peer, Progress, TleFile, UploadStep, Uploaded},
        uploads::{Ask, Failure, KeptEntry, Order, Stage, Uploads},
    },
    controller::satrak::ELEMENT_FILES,
    model::{Model, ThemeName, UiCommand},
    ui::{
        theme,
        upload::{self, UploadState},
    },
};
use egui::{Event, Key, Modifiers, Role, UiBuilder};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    rig::{self, NOAA_20},
    states,
};

pub(crate) const ISS: u32 = 25_544;
pub(crate) const FILE: &str = "weather.txt";
pub(crate) const WIDTHS: [f32; 2] = [300.0, 560.0];
pub(crate) const SECRET: &str = "hunter2-password";

pub(crate) struct Part {
    pub(crate) model: Model,
    pub(crate) state: UploadState,
    pub(crate) commands: Vec<UiCommand>,
}

pub(crate) type Window = Harness<'static, Part>;

/// Opens the part alone, with this width.
pub(crate) fn part(width: f32, uploads: Uploads) -> Window {
    let mut model = rig::model(states::holding());
    model.shown_mut().uploads = uploads.into();
    let part = Part { model, state: UploadState::default(), commands: Vec::new() };
    let mut window = Harness::builder()
        .with_size([width, 1800.0])
        .with_context_setup(|ctx| theme::install(ctx, ThemeName::Dark))
        .build_ui_state(
            |ui, part: &mut Part| {
                let whole = ui.ctx().content_rect();
                ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
                    upload::show(ui, &part.model, 0, &mut part.state, &mut part.commands);
                });
            },
            part,
        );
    settle(&mut window);
    window.state_mut().commands.clear();
    window
}

pub(crate) fn settle(window: &mut Window) {
    window.run_steps(4);
}

/// Returns the commands since the last call, except requests for the list of kept files.
pub(crate) fn asked(window: &mut Window) -> Vec<Ask> {
    settle(window);
    let commands = std::mem::take(&mut window.state_mut().commands);
    let ask = |command| match command {
        UiCommand::Station(contract::Command::Upload(Ask::ListKept { .. })) => None,
        UiCommand::Station(contract::Command::Upload(ask)) => Some(ask),
        other => panic!("{other:?}"),
    };
    commands.into_iter().filter_map(ask).collect()
}

pub(crate) fn click(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

pub(crate) fn is_disabled(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

pub(crate) fn write(window: &mut Window, field: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, field).focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.key_press(Key::Backspace);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

pub(crate) fn says(window: &Window, words: &str) -> bool {
    window
        .query_all_by_role(Role::Label)
        .any(|node| node.accesskit_node().value().is_some_and(|text| text.contains(words)))
}

pub(crate) fn peer() -> Peer {
    Peer { host: "192.168.10.21".to_owned(), port: 22 }
}

pub(crate) fn file() -> TleFile {
    let model = rig::model(rig::quiet());
    let azel::contract::CatalogState::Ready(catalog) = &model.catalog else {
        panic!("the bundled elements")
    };
    TleFile::new([ISS, NOAA_20].iter().filter_map(|number| catalog.get(*number)), &ELEMENT_FILES)
        .unwrap()
}

pub(crate) fn uploaded() -> Uploaded {
    let file = file();
    Uploaded {
        unit: peer(),
        file: FileName::new(FILE, &ELEMENT_FILES).unwrap(),
        bytes: file.bytes().len() as u64,
        sha256: file.hash(),
        time: rig::now(),
        objects: file.objects().to_vec(),
    }
}

/// Returns the uploads while an order of the antenna is in `stage`.
pub(crate) fn at(stage: Stage) -> Uploads {
    Uploads { antenna: "Satrak".to_owned(), stage, ..Uploads::default() }
}

pub(crate) fn failed(text: &str) -> Uploads {
    at(Stage::Failed(Failure { text: text.to_owned(), ..Failure::default() }))
}

pub(crate) fn begun(window: &mut Window) -> Order {
    match <[Ask; 1]>::try_from(asked(window)) {
        Ok([Ask::Begin(order)]) => *order,
        other => panic!("{other:?}"),
    }
}

/// Opens the part, and types file and user; the other fields are filled in.
pub(crate) fn typed(width: f32, uploads: Uploads) -> Window {
    let mut window = part(width, uploads);
    write(&mut window, "File", FILE);
    write(&mut window, "User", "op");
    window.state_mut().commands.clear();
    window
}

pub(crate) fn working(step: UploadStep) -> Uploads {
    let progress = Some(Progress { step, done_bytes: 40, file_bytes: 100 });
    at(Stage::Working { progress, is_cancelled: false })
}

pub(crate) fn kept_entry(origin: Origin, hours_ago: f64) -> KeptEntry {
    let file = file();
    let kept = KeptFile {
        unit: peer().to_string(),
        file: FILE.to_owned(),
        sha256: file.hash(),
        bytes: file.bytes().len() as u64,
        time: add_seconds(rig::now(), -hours_ago * 3600.0),
        origin,
    };
    KeptEntry { file: kept, objects: Ok(file.objects().to_vec()) }
}
