//! Elements on their way to a unit: what is chosen, typed, asked and told.

use azel::{
    app::{
        Model, UiCommand, View,
        host_keys::DoubtfulKey,
        uploads::{
            Ask, Busy, Cargo, Failure, Kept, KeptEntry, Order, Proved, SecretWanted, Stage,
            Uploads, Warning,
        },
    },
    astro::time::add_seconds,
    driver::files::{
        FACTORY_USER, FileName, FileObject, KeptFile, Origin, Peer, Progress, TleFile, UploadStep,
        Uploaded,
    },
    secret::Secret,
    ui::{
        theme,
        tokens::ThemeName,
        upload::{self, UploadState},
    },
};
use egui::{Event, Key, Modifiers, Role, UiBuilder};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::{
    rig::{self, NOAA_20},
    states,
};

const ISS: u32 = 25_544;
const FILE: &str = "weather.txt";
const WIDTHS: [f32; 2] = [300.0, 560.0];
const SECRET: &str = "hunter2-password";

struct Part {
    model: Model,
    state: UploadState,
    commands: Vec<UiCommand>,
}

type Window = Harness<'static, Part>;

/// The part alone, as wide as this.
fn part(width: f32, uploads: Uploads) -> Window {
    let mut model = rig::model(states::holding());
    model.uploads = uploads;
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

fn settle(window: &mut Window) {
    window.run_steps(4);
}

/// What was asked for since the last time, but the list of what is kept.
fn asked(window: &mut Window) -> Vec<Ask> {
    settle(window);
    let commands = std::mem::take(&mut window.state_mut().commands);
    let ask = |command| match command {
        UiCommand::Upload(Ask::ListKept { .. }) => None,
        UiCommand::Upload(ask) => Some(ask),
        other => panic!("{other:?}"),
    };
    commands.into_iter().filter_map(ask).collect()
}

fn click(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

fn is_disabled(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

fn write(window: &mut Window, field: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, field).focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.key_press(Key::Backspace);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

fn says(window: &Window, words: &str) -> bool {
    window
        .query_all_by_role(Role::Label)
        .any(|node| node.accesskit_node().value().is_some_and(|text| text.contains(words)))
}

fn peer() -> Peer {
    Peer { host: "192.168.10.21".to_owned(), port: 22 }
}

fn file() -> TleFile {
    let azel::app::model::CatalogState::Ready(catalog) = rig::model(rig::quiet()).catalog else {
        panic!("the bundled elements")
    };
    TleFile::of([ISS, NOAA_20].iter().filter_map(|number| catalog.get(*number))).unwrap()
}

fn uploaded() -> Uploaded {
    let file = file();
    Uploaded {
        unit: peer(),
        file: FileName::new(FILE).unwrap(),
        bytes: file.bytes().len() as u64,
        sha256: file.hash(),
        at: rig::now(),
        objects: file.objects().to_vec(),
    }
}

/// The part while an order of the antenna is in `stage`.
fn at(stage: Stage) -> Uploads {
    Uploads { antenna: "Satrak".to_owned(), stage, ..Uploads::default() }
}

fn failed(text: &str) -> Uploads {
    at(Stage::Failed(Failure { text: text.to_owned(), ..Failure::default() }))
}

fn begun(window: &mut Window) -> Order {
    match <[Ask; 1]>::try_from(asked(window)) {
        Ok([Ask::Begin(order)]) => *order,
        other => panic!("{other:?}"),
    }
}

/// File and user are typed; the rest is there.
fn typed(width: f32, uploads: Uploads) -> Window {
    let mut window = part(width, uploads);
    write(&mut window, "File", FILE);
    write(&mut window, "User", "op");
    window.state_mut().commands.clear();
    window
}

#[test]
fn what_is_followed_is_sent_to_where_the_antenna_is() {
    for width in WIDTHS {
        let mut window = part(width, Uploads::default());
        assert!(says(&window, "5 satellites to send"));
        assert!(is_disabled(&window, "Upload and prove"));
        assert!(says(&window, "Not to be sent yet"));
        write(&mut window, "File", FILE);
        click(&mut window, &format!("Take the factory user {FACTORY_USER}"));
        click(&mut window, "Upload and prove");
        let order = begun(&mut window);
        assert_eq!((order.unit, order.user.as_str()), (peer(), FACTORY_USER));
        assert_eq!((order.antenna.as_str(), order.file.as_str()), ("Satrak", FILE));
        assert_eq!(order.satellite, Some(NOAA_20), "the first of them");
        let Cargo::New(file) = order.cargo else { panic!("{:?}", order.cargo) };
        assert_eq!(file.objects().len(), 5);
    }
}

#[test]
fn satellites_are_added_left_out_and_marked() {
    for width in WIDTHS {
        let mut window = typed(width, Uploads::default());
        click(&mut window, "Leave out NOAA 20 (JPSS-1)");
        assert!(says(&window, "4 satellites to send"));
        write(&mut window, "Add a satellite", "57166");
        let add = "Add METEOR-M2 3";
        let button = window
            .query_all_by_role(Role::Button)
            .find_map(|node| node.accesskit_node().label().filter(|label| label.starts_with(add)));
        click(&mut window, &button.expect("such an object"));
        assert!(says(&window, "5 satellites to send"));
        let radio = "The unit follows ISS (ZARYA)";
        window.get_by_role_and_label(Role::RadioButton, radio).click();
        settle(&mut window);
        click(&mut window, "Upload and prove");
        let order = begun(&mut window);
        assert_eq!(order.satellite, Some(ISS));
        let Cargo::New(file) = order.cargo else { panic!("{:?}", order.cargo) };
        assert!(file.objects().iter().any(|object| object.catalog_number == 57_166));
        assert!(file.objects().iter().all(|object| object.catalog_number != NOAA_20));
        write(&mut window, "Add a satellite", "no such thing");
        assert!(says(&window, "No other object has this number or name."));
        click(&mut window, "Take the followed ones");
        assert!(window.query_by_label("Leave out NOAA 20 (JPSS-1)").is_some());
    }
}

#[test]
fn an_object_that_a_tle_cannot_carry_is_refused_at_its_line_before_anything_is_tried() {
    let mut window = typed(WIDTHS[0], Uploads::default());
    let text = "[{\"OBJECT_NAME\":\"NEW ONE\",\"NORAD_CAT_ID\":340000,\
                \"EPOCH\":\"2026-08-11T00:00:00\",\"MEAN_MOTION\":14.19,\"ECCENTRICITY\":0.0001,\
                \"INCLINATION\":98.7,\"RA_OF_ASC_NODE\":0,\"ARG_OF_PERICENTER\":0,\
                \"MEAN_ANOMALY\":0,\"BSTAR\":0}]";
    let mut catalog = azel::orbit::bundled().unwrap();
    catalog.merge(azel::orbit::read_elements(text), "own");
    let model = &mut window.state_mut().model;
    model.catalog = azel::app::model::CatalogState::Ready(std::sync::Arc::new(catalog));
    model.station.favourites.push(340_000);
    settle(&mut window);
    assert!(says(&window, "Object 340000: a TLE carries"));
    assert!(is_disabled(&window, "Upload and prove"));
    click(&mut window, "Leave out NEW ONE");
    assert!(!is_disabled(&window, "Upload and prove"));
}

#[test]
fn each_field_says_what_is_missing() {
    let mut window = typed(WIDTHS[0], Uploads::default());
    for (field, wrong, problem, right) in [
        ("File", "a/b", "slash", FILE),
        ("Folder", "", "the folder is missing", "/svs/satrak/tle"),
        ("Host", "", "the host is missing", "unit.local"),
        ("Port", "0", "the port is no number", "2222"),
        ("User", "", "the user is missing", "op"),
    ] {
        write(&mut window, field, wrong);
        assert!(says(&window, problem) && is_disabled(&window, "Upload and prove"), "{field}");
        write(&mut window, field, right);
        assert!(!is_disabled(&window, "Upload and prove"), "{field}");
    }
    window.get_by_role_and_label(Role::RadioButton, "Key file").click();
    settle(&mut window);
    assert!(says(&window, "the path of the key file is missing"));
    write(&mut window, "Key file", "/home/op/key");
    click(&mut window, "Upload and prove");
    let order = begun(&mut window);
    assert_eq!(order.key_file, Some("/home/op/key".into()));
    assert_eq!(order.unit, Peer { host: "unit.local".to_owned(), port: 2222 });
}

#[test]
fn a_new_host_is_asked_about_with_its_fingerprint() {
    let key = DoubtfulKey {
        address: "192.168.10.21".to_owned(),
        algorithm: "ssh-ed25519".to_owned(),
        fingerprint: "SHA256:abc".to_owned(),
        pinned: Vec::new(),
    };
    for width in WIDTHS {
        let mut window = part(width, at(Stage::AsksAboutHostKey(key.clone())));
        for words in ["192.168.10.21 is new here", "ssh-ed25519", "SHA256:abc"] {
            assert!(says(&window, words), "{words}");
        }
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [], "not by a careless key");
        click(&mut window, "It is the right key");
        assert_eq!(asked(&mut window), [Ask::TrustHostKey]);
        click(&mut window, "No");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), [Ask::Cancel]);
    }
}

#[test]
fn a_changed_host_key_is_shown_with_both_and_forgotten_on_purpose_only() {
    let changed_key = Some(DoubtfulKey {
        address: "192.168.10.21".to_owned(),
        algorithm: "ssh-ed25519".to_owned(),
        fingerprint: "SHA256:new".to_owned(),
        pinned: vec!["SHA256:old".to_owned()],
    });
    let failure = Failure { text: "changed".to_owned(), changed_key, ..Failure::default() };
    let mut window = part(WIDTHS[0], at(Stage::Failed(failure)));
    for words in ["Refused: the host key", "SHA256:old", "SHA256:new", "ssh-keygen -l"] {
        assert!(says(&window, words), "{words}");
    }
    click(&mut window, "Forget the known key…");
    assert_eq!(asked(&mut window), []);
    click(&mut window, "Cancel");
    assert_eq!(asked(&mut window), []);
    click(&mut window, "Forget the known key…");
    click(&mut window, "Forget it (Enter)");
    assert_eq!(asked(&mut window), [Ask::ForgetHostKey]);
}

fn wanted() -> SecretWanted {
    SecretWanted {
        user: "op".to_owned(),
        address: "192.168.10.21:22".to_owned(),
        is_passphrase: false,
        refused: None,
        keyring_problem: None,
    }
}

fn type_secret(window: &mut Window) {
    window.event(Event::Text(SECRET.to_owned()));
    settle(window);
    let told = format!("{:?}", window.root());
    assert!(!told.contains(SECRET), "who listens to the window hears it");
}

#[test]
fn a_password_is_asked_for_masked_and_kept_only_with_a_tick() {
    for width in WIDTHS {
        let mut window = part(width, at(Stage::AsksForSecret(wanted())));
        assert!(is_disabled(&window, "Log in (Enter)"));
        type_secret(&mut window);
        window.key_press(Key::Enter);
        let secret = Secret::new(SECRET);
        assert_eq!(asked(&mut window), [Ask::Secret { secret: secret.clone(), keep: false }]);
        type_secret(&mut window);
        window.get_by_role(Role::CheckBox).click();
        settle(&mut window);
        click(&mut window, "Log in (Enter)");
        assert_eq!(asked(&mut window), [Ask::Secret { secret, keep: true }]);
        let field = egui::Id::unique("password field");
        let held = egui::text_edit::TextEditState::load(&window.ctx, field).unwrap();
        assert!(!format!("{:?}", held.undoer()).contains(SECRET), "it cannot be undone back");
        type_secret(&mut window);
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        let field = window.get_by_role(Role::PasswordInput);
        assert_eq!(field.value().as_deref().unwrap_or_default(), "", "forgotten");
    }
}

#[test]
fn a_wrong_password_is_told_and_without_a_keyring_it_is_said_how_long_it_lasts() {
    let wanted = SecretWanted {
        refused: Some("log-in refused for user op".to_owned()),
        keyring_problem: Some("there is no keyring on this computer".to_owned()),
        ..wanted()
    };
    let mut window = part(WIDTHS[0], at(Stage::AsksForSecret(wanted)));
    assert!(says(&window, "Log-in refused for user op."));
    assert!(says(&window, "There is no keyring on this computer."));
    assert!(says(&window, "once in each session"));
    assert!(window.query_by_role(Role::CheckBox).is_none());
    click(&mut window, "Cancel");
    assert_eq!(asked(&mut window), [Ask::Cancel]);
}

#[test]
fn the_operator_agrees_before_the_unit_s_tracking_ends() {
    for (busy, words) in
        [(Busy::Tracks, "Its tracking ends"), (Busy::MayTrack, "the antenna may move")]
    {
        let mut window = part(WIDTHS[0], at(Stage::AsksAboutTracking(busy)));
        assert!(says(&window, words));
        click(&mut window, "Go on (Enter)");
        assert_eq!(asked(&mut window), [Ask::AgreeToTracking]);
        click(&mut window, "No");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
    }
}

fn working(step: UploadStep) -> Uploads {
    let progress = Some(Progress { step, done_bytes: 40, file_bytes: 100 });
    at(Stage::Working { progress, is_cancelled: false })
}

#[test]
fn each_step_is_shown_and_can_be_cancelled_until_the_file_takes_its_place() {
    for width in WIDTHS {
        let mut window = part(width, working(UploadStep::Write));
        assert!(says(&window, "4 Write the new file beside it"));
        window.get_by_role(Role::ProgressIndicator);
        click(&mut window, "Cancel upload");
        assert_eq!(asked(&mut window), [Ask::Cancel]);
        assert!(is_disabled(&window, "Upload and prove"));

        let window = part(width, working(UploadStep::Replace));
        assert!(is_disabled(&window, "Cancel upload"));
        assert!(says(&window, "From here on it is carried to its end."));

        let window = part(width, at(Stage::Selecting(Box::new(uploaded()))));
        assert!(says(&window, "8 Tell the unit"));
        assert!(window.query_by_label_contains("Proved").is_none(), "not yet");
    }
}

#[test]
fn proof_is_told_with_file_hash_time_and_ages() {
    let uploaded = uploaded();
    let satellite: FileObject = uploaded.objects[1].clone();
    let proved = Proved { uploaded, satellite, at: rig::now() };
    for width in WIDTHS {
        let uploads = Uploads {
            warnings: vec![Warning::FactoryPassword],
            ..at(Stage::Proved(Box::new(proved.clone())))
        };
        let mut window = part(width, uploads);
        let hash = proved.uploaded.sha256.to_string();
        for words in [
            "Proved 11:15:30Z",
            "The unit uses weather.txt and has found NOAA 20 (JPSS-1) (43013) in it.",
            &hash,
            "192.168.10.21:22",
            "ISS (ZARYA) 31 h 40 min old",
            "every unit has from its maker",
        ] {
            assert!(says(&window, words), "{words}");
        }
        click(&mut window, "Done reading");
        assert_eq!(asked(&mut window), [Ask::Dismiss]);
    }
}

#[test]
fn what_went_wrong_is_told_and_what_was_typed_stays() {
    for words in [
        "its disk has 0 bytes left; remove files there that are not needed (the unit has its old \
         file, nothing was changed)",
        "the connection was lost; check the link and try again",
        "no answer within 10 s; check the link and try again",
        "the user has no right to do this in the folder",
    ] {
        let mut window = typed(WIDTHS[0], Uploads::default());
        window.state_mut().model.uploads = failed(words);
        settle(&mut window);
        assert!(says(&window, words.get(1..).unwrap()), "{words}");
        let user = window.get_by_role_and_label(Role::TextInput, "User").value();
        assert_eq!(user.as_deref(), Some("op"));
        click(&mut window, "Upload and prove");
        assert_eq!(begun(&mut window).user, "op");
    }
}

#[test]
fn a_cancel_and_a_satellite_that_was_not_found_are_told_apart_from_success() {
    let text = "cancelled; the unit has its old file".to_owned();
    let failure = Failure { text, is_cancel: true, ..Failure::default() };
    let window = part(WIDTHS[0], at(Stage::Failed(failure)));
    assert!(says(&window, "Cancelled; the unit has its old file."));

    let text = "the unit does not find the satellite in the file".to_owned();
    let uploaded = Some(Box::new(uploaded()));
    let failure = Failure { text, uploaded, ..Failure::default() };
    let window = part(WIDTHS[0], at(Stage::Failed(failure)));
    assert!(says(&window, "Not in use: The unit does not find the satellite in the file."));
    assert!(says(&window, "The new file is on the unit, read back and compared."));
    assert!(!says(&window, "Proved"));
}

fn kept_entry(origin: Origin, hours_ago: f64) -> KeptEntry {
    let file = file();
    let kept = KeptFile {
        unit: peer().to_string(),
        file: FILE.to_owned(),
        sha256: file.hash(),
        bytes: file.bytes().len() as u64,
        at: add_seconds(rig::now(), -hours_ago * 3600.0),
        origin,
    };
    KeptEntry { file: kept, objects: Ok(file.objects().to_vec()) }
}

#[test]
fn what_was_there_before_is_listed_and_put_back_when_asked_twice() {
    let list = vec![kept_entry(Origin::Uploaded, 2.0), kept_entry(Origin::Found, 50.0)];
    for width in WIDTHS {
        let of = (peer().to_string(), FILE.to_owned());
        let kept = Kept { of, list: Some(Ok(list.clone())) };
        let mut window = typed(width, Uploads { kept, ..Uploads::default() });
        assert!(says(&window, "Wed 2026-08-12 09:15:30Z") && says(&window, "sent from here"));
        let back = "Put back the file of Mon 2026-08-10 09:15:30Z, was on the unit";
        click(&mut window, back);
        assert_eq!(asked(&mut window), [], "asked first");
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), []);
        click(&mut window, back);
        click(&mut window, "Put back (Enter)");
        let order = begun(&mut window);
        assert_eq!(order.cargo, Cargo::Kept(list[1].file.clone()));
    }
}

#[test]
fn the_list_of_what_is_kept_is_asked_for_once_the_file_is_known() {
    let mut window = part(WIDTHS[0], Uploads::default());
    write(&mut window, "File", FILE);
    let unit = peer().to_string();
    let ask = UiCommand::Upload(Ask::ListKept { unit: unit.clone(), file: FILE.to_owned() });
    assert!(window.state().commands.contains(&ask));
    let of = (unit, FILE.to_owned());
    window.state_mut().model.uploads.kept = Kept { of: of.clone(), list: None };
    settle(&mut window);
    assert!(says(&window, "The list is being read."));
    let problem = Some(Err("the list of kept files cannot be read".to_owned()));
    window.state_mut().model.uploads.kept = Kept { of, list: problem };
    settle(&mut window);
    assert!(says(&window, "The list of kept files cannot be read."));
}

#[test]
fn an_order_of_another_antenna_is_told_and_waited_for() {
    let uploads = Uploads { antenna: "North".to_owned(), ..working(UploadStep::Write) };
    let window = typed(WIDTHS[0], uploads);
    assert!(says(&window, "Files are on their way to North."));
    assert!(is_disabled(&window, "Upload and prove"));
}

#[test]
fn without_elements_an_old_file_can_still_be_put_back() {
    let mut window = typed(WIDTHS[0], Uploads::default());
    window.state_mut().model.catalog = azel::app::model::CatalogState::Failed;
    let of = (peer().to_string(), FILE.to_owned());
    let list = Some(Ok(vec![kept_entry(Origin::Found, 2.0)]));
    window.state_mut().model.uploads.kept = Kept { of, list };
    settle(&mut window);
    assert!(is_disabled(&window, "Upload and prove"));
    let back = "Put back the file of Wed 2026-08-12 09:15:30Z, was on the unit";
    assert!(!is_disabled(&window, back));
}

#[test]
fn nothing_is_wider_than_its_place() {
    let uploaded = uploaded();
    let satellite = uploaded.objects[0].clone();
    let proved = Proved { uploaded, satellite, at: rig::now() };
    for width in WIDTHS {
        let of = (peer().to_string(), FILE.to_owned());
        let kept = Kept { of, list: Some(Ok(vec![kept_entry(Origin::Found, 2.0)])) };
        let stage = Stage::Proved(Box::new(proved.clone()));
        let window = typed(width, Uploads { kept, ..at(stage) });
        for role in [Role::Button, Role::TextInput, Role::RadioButton, Role::Label] {
            for node in window.query_all_by_role(role) {
                let rect = node.rect();
                assert!(rect.right() <= width + 0.5, "{width} {:?}", node.accesskit_node().label());
            }
        }
    }
}

#[test]
fn the_elements_view_opens_the_part_in_place_of_the_catalogue() {
    for size in rig::SIZES {
        let mut model = rig::model(states::holding());
        model.view = View::Elements;
        let mut window = rig::window(size, model);
        window.get_by_role_and_label(Role::Button, "Upload to unit…").click();
        rig::settle(&mut window);
        assert!(rig::says(&window, "Elements to Satrak"));
        window.get_by_role_and_label(Role::Button, "Back to the catalogue").click();
        rig::settle(&mut window);
        assert!(!rig::says(&window, "Elements to Satrak"));
    }
}
