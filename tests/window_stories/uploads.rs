//! Uploads of elements to a unit: choices, texts, questions and reports.

use std::sync::Arc;

use azel::{
    contract::{
        self, CatalogState,
        transfer::{AlgorithmPart, FileObject, OldAlgorithm, Origin, Peer, UploadStep},
        uploads::{Ask, Cargo, Failure, KeptEntry, KeptFiles, Proved, Stage, Uploads, Warning},
    },
    controller::satrak::ELEMENT_FILES,
    device::HeldSatellite,
    model::{Model, UiCommand, View},
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, NOAA_20},
    states,
    upload_rig::{
        FILE, ISS, WIDTHS, Window, asked, at, begun, click, failed, is_disabled, kept_entry, part,
        peer, says, settle, typed, uploaded, working, write,
    },
};

#[test]
fn what_is_followed_is_sent_to_where_the_antenna_is() {
    for width in WIDTHS {
        let mut window = part(width, Uploads::default());
        assert!(says(&window, "5 satellites to send"));
        assert!(is_disabled(&window, "Upload and verify"));
        assert!(says(&window, "Enter the name of the file on the unit to upload."));
        write(&mut window, "File", FILE);
        click(&mut window, &format!("Take the factory user {}", ELEMENT_FILES.factory_user));
        click(&mut window, "Upload and verify");
        let order = begun(&mut window);
        assert_eq!((order.unit, order.user.as_str()), (peer(), ELEMENT_FILES.factory_user));
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
        click(&mut window, "Upload and verify");
        let order = begun(&mut window);
        assert_eq!(order.satellite, Some(ISS));
        let Cargo::New(file) = order.cargo else { panic!("{:?}", order.cargo) };
        assert!(file.objects().iter().any(|object| object.catalog_number == 57_166));
        assert!(file.objects().iter().all(|object| object.catalog_number != NOAA_20));
        write(&mut window, "Add a satellite", "no such thing");
        assert!(says(&window, "No other object has this number or name."));
        click(&mut window, "Use the favourites");
        assert!(window.query_by_label("Leave out NOAA 20 (JPSS-1)").is_some());
    }
}

#[test]
fn the_satellite_on_the_unit_stays_marked_until_the_operator_marks_another() {
    const SUOMI: u32 = 37_849;
    let mut window = typed(WIDTHS[0], Uploads::default());
    let holds = |window: &mut Window, catalog_number, name: &str| {
        let antenna = window.state_mut().model.shown_mut().antennas.first_mut().unwrap();
        let name = name.to_owned();
        let held = HeldSatellite { catalog_number, name, maximum_elevation_deg: None };
        Arc::make_mut(&mut antenna.snapshot).state.on_board.satellite = Some(held);
        settle(window);
    };
    let to_follow = |window: &mut Window| {
        click(window, "Upload and verify");
        begun(window).satellite
    };
    let unread = "The satellite on the unit has not been read yet.";
    assert!(says(&window, unread));
    holds(&mut window, ISS, "ISS (ZARYA)");
    assert_eq!(to_follow(&mut window), Some(ISS));
    assert!(!says(&window, "The unit holds") && !says(&window, unread));
    holds(&mut window, 38_771, "METOP-B");
    assert_eq!(to_follow(&mut window), Some(NOAA_20), "what it holds is not in the file");
    window.state_mut().model.catalog_table.inspected = Some(57_166);
    settle(&mut window);
    assert_eq!(to_follow(&mut window), Some(NOAA_20), "nor is the selected satellite");
    window.state_mut().model.catalog_table.inspected = Some(SUOMI);
    settle(&mut window);
    assert_eq!(to_follow(&mut window), Some(SUOMI), "the selected satellite is in it");
    assert!(says(&window, "The unit holds METOP-B now, and will follow the one marked here."));
    let radio = "The unit follows ISS (ZARYA)";
    window.get_by_role_and_label(Role::RadioButton, radio).click();
    settle(&mut window);
    holds(&mut window, NOAA_20, "NOAA 20 (JPSS-1)");
    assert_eq!(to_follow(&mut window), Some(ISS), "the operator has marked it");
    assert!(says(&window, "The unit holds NOAA 20 (JPSS-1) now"));
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
    model.shown_mut().catalog = azel::contract::CatalogState::Ready(std::sync::Arc::new(catalog));
    Arc::make_mut(&mut model.shown_mut().station).favourites.mark(340_000, true);
    settle(&mut window);
    assert!(says(&window, "Object 340000: a TLE carries"));
    assert!(is_disabled(&window, "Upload and verify"));
    click(&mut window, "Leave out NEW ONE");
    assert!(!is_disabled(&window, "Upload and verify"));
}

#[test]
fn each_field_says_what_is_missing() {
    let mut window = typed(WIDTHS[0], Uploads::default());
    for (field, wrong, problem, right) in [
        ("File", "a/b", "slash", FILE),
        ("Folder", "", "Enter the folder on the unit to upload.", "/svs/satrak/tle"),
        ("Host", "", "Enter the unit's host name or IP address, without spaces.", "unit.local"),
        ("Port", "0", "Enter a port from 1 to 65535.", "2222"),
        ("User", "", "Enter the unit's user name to upload.", "op"),
    ] {
        write(&mut window, field, wrong);
        assert!(says(&window, problem) && is_disabled(&window, "Upload and verify"), "{field}");
        write(&mut window, field, right);
        assert!(!is_disabled(&window, "Upload and verify"), "{field}");
    }
    window.get_by_role_and_label(Role::RadioButton, "Key file").click();
    settle(&mut window);
    assert!(says(&window, "Enter the path of the key file to upload."));
    write(&mut window, "Key file", "/home/op/key");
    click(&mut window, "Upload and verify");
    let order = begun(&mut window);
    assert_eq!(order.key_file, Some("/home/op/key".into()));
    assert_eq!(order.unit, Peer { host: "unit.local".to_owned(), port: 2222 });
}

#[test]
fn proof_is_told_with_file_hash_time_and_ages() {
    let uploaded = uploaded();
    let satellite: FileObject = uploaded.objects[1].clone();
    let proved = Proved { uploaded, satellite, time: rig::now() };
    let old = OldAlgorithm { part: AlgorithmPart::HostKey, name: "ssh-rsa".to_owned() };
    for width in WIDTHS {
        let uploads = Uploads {
            warnings: vec![Warning::FactoryPassword, Warning::OldAlgorithms(vec![old.clone()])],
            ..at(Stage::Proved(Box::new(proved.clone())))
        };
        let mut window = part(width, uploads);
        let hash = proved.uploaded.sha256.to_string();
        for words in [
            "Verified 11:15:30Z",
            "The unit uses weather.txt and has found NOAA 20 (JPSS-1) (43013) in it.",
            &hash,
            "192.168.10.21:22",
            "ISS (ZARYA) 1 d 7 h old",
            "factory password of every unit",
            "Connected with the old host key type ssh-rsa",
        ] {
            assert!(says(&window, words), "{words}");
        }
        click(&mut window, "Close");
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
        "the user may not do this in the folder",
    ] {
        let mut window = typed(WIDTHS[0], Uploads::default());
        window.state_mut().model.shown_mut().uploads = failed(words).into();
        settle(&mut window);
        assert!(says(&window, words.get(1..).unwrap()), "{words}");
        let user = window.get_by_role_and_label(Role::TextInput, "User").value();
        assert_eq!(user.as_deref(), Some("op"));
        click(&mut window, "Upload and verify");
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
    assert!(!says(&window, "Verified"));
}

#[test]
fn what_was_there_before_is_listed_and_put_back_when_asked_twice() {
    let list = vec![kept_entry(Origin::Uploaded, 2.0), kept_entry(Origin::Found, 50.0)];
    for width in WIDTHS {
        let of = (peer().to_string(), FILE.to_owned());
        let kept = KeptFiles { origin: of, list: Some(Ok(list.clone())) };
        let mut window = typed(width, Uploads { kept_files: kept, ..Uploads::default() });
        assert!(!says(&window, "sent from here"));
        click(&mut window, "Kept on this computer: 2 files");
        assert!(says(&window, "Wed 2026-08-12 09:15:30Z") && says(&window, "sent from here"));
        let back = put_back("Mon 2026-08-10 09:15:30Z, was on the unit", &list[1]);
        click(&mut window, &back);
        assert_eq!(asked(&mut window), [], "asked first");
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), []);
        click(&mut window, &back);
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
    let ask = UiCommand::Station(contract::Command::Upload(Ask::ListKept {
        unit: unit.clone(),
        file: FILE.to_owned(),
    }));
    assert!(window.state().commands.contains(&ask));
    let of = (unit, FILE.to_owned());
    Arc::make_mut(&mut window.state_mut().model.shown_mut().uploads).kept_files =
        KeptFiles { origin: of.clone(), list: None };
    settle(&mut window);
    assert!(says(&window, "The list is being read."));
    let problem = Some(Err("the list of kept files cannot be read".to_owned()));
    Arc::make_mut(&mut window.state_mut().model.shown_mut().uploads).kept_files =
        KeptFiles { origin: of, list: problem };
    settle(&mut window);
    assert!(says(&window, "The list of kept files cannot be read."));
}

#[test]
fn an_order_of_another_antenna_is_told_and_waited_for() {
    let uploads = Uploads { antenna: "North".to_owned(), ..working(UploadStep::Write) };
    let window = typed(WIDTHS[0], uploads);
    assert!(says(&window, "An upload to North is under way."));
    assert!(is_disabled(&window, "Upload and verify"));
}

#[test]
fn without_elements_an_old_file_can_still_be_put_back() {
    let mut window = typed(WIDTHS[0], Uploads::default());
    window.state_mut().model.shown_mut().catalog = azel::contract::CatalogState::Failed;
    let of = (peer().to_string(), FILE.to_owned());
    let entry = kept_entry(Origin::Found, 2.0);
    let back = put_back("Wed 2026-08-12 09:15:30Z, was on the unit", &entry);
    let list = Some(Ok(vec![entry]));
    Arc::make_mut(&mut window.state_mut().model.shown_mut().uploads).kept_files =
        KeptFiles { origin: of, list };
    settle(&mut window);
    click(&mut window, "Kept on this computer: 1 file");
    assert!(is_disabled(&window, "Upload and verify"));
    assert!(!is_disabled(&window, &back));
}

/// Returns the name of the key that puts `entry` back. The name tells two files of the same second
/// apart.
fn put_back(origin: &str, entry: &KeptEntry) -> String {
    let hash = entry.file.sha256.to_string();
    format!("Put back the file of {origin}, {}", &hash[..12])
}

#[test]
fn nothing_is_wider_than_its_place() {
    let uploaded = uploaded();
    let satellite = uploaded.objects[0].clone();
    let proved = Proved { uploaded, satellite, time: rig::now() };
    for width in WIDTHS {
        let of = (peer().to_string(), FILE.to_owned());
        let kept = KeptFiles { origin: of, list: Some(Ok(vec![kept_entry(Origin::Found, 2.0)])) };
        let stage = Stage::Proved(Box::new(proved.clone()));
        let mut window = typed(width, Uploads { kept_files: kept, ..at(stage) });
        click(&mut window, "Kept on this computer: 1 file");
        for role in [Role::Button, Role::TextInput, Role::RadioButton, Role::Label] {
            for node in window.query_all_by_role(role) {
                let rect = node.rect();
                assert!(rect.right() <= width + 0.5, "{width} {:?}", node.accesskit_node().label());
            }
        }
    }
}

#[test]
fn the_elements_view_opens_the_part_in_place_of_the_inspector() {
    for size in rig::SIZES {
        let mut model = rig::model(states::holding());
        model.view = View::Elements;
        let mut window = rig::window(size, model);
        if size == rig::SMALL {
            window.get_by_role_and_label(Role::Button, "Details").click();
            rig::settle(&mut window);
        }
        window.get_by_role_and_label(Role::Button, "Upload to Satrak").click();
        rig::settle(&mut window);
        assert!(rig::says(&window, "Upload elements to Satrak"));
        window.get_by_role_and_label(Role::Button, "Back to the elements").click();
        rig::settle(&mut window);
        assert!(!rig::says(&window, "Upload elements to Satrak"));
    }
}

/// Opens the Elements view with the upload, in the smallest window.
fn opened_small(uploads: Uploads) -> rig::Window {
    let mut model = rig::model(states::holding());
    model.shown_mut().uploads = uploads.into();
    opened(rig::SMALL, model)
}

/// Opens the Elements view with the upload.
fn opened(size: [f32; 2], mut model: Model) -> rig::Window {
    model.view = View::Elements;
    let mut window = rig::window(size, model);
    if size == rig::SMALL {
        window.get_by_role_and_label(Role::Button, "Details").click();
        rig::settle(&mut window);
    }
    window.get_by_role_and_label(Role::Button, "Upload to Satrak").click();
    rig::settle(&mut window);
    window
}

#[test]
fn the_form_is_in_sight_above_a_list_of_a_hundred_satellites() {
    const SATELLITES: usize = 101;
    for size in rig::SIZES {
        let mut model = rig::model(states::holding());
        let CatalogState::Ready(catalog) = &model.catalog else { panic!("there are elements") };
        let others = catalog.iter().map(azel::orbit::Elements::catalog_number);
        let others = others.filter(|number| *number != NOAA_20);
        // The file always contains the inspected object.
        let numbers: Vec<u32> = [NOAA_20].into_iter().chain(others).take(SATELLITES).collect();
        let favourites = &mut Arc::make_mut(&mut model.shown_mut().station).favourites;
        *favourites = favourites.with_numbers(&numbers);
        let mut window = opened(size, model);
        let whole = egui::Rect::from_min_size(egui::Pos2::ZERO, size.into());
        let button = window.get_by_role_and_label(Role::Button, "Upload and verify").rect();
        let above_button = whole.with_max_y(button.top());
        for field in ["File", "Folder", "Host", "Port", "User"] {
            let place = window.get_by_role_and_label(Role::TextInput, field).rect();
            assert!(above_button.contains_rect(place), "{size:?} {field} {place:?}");
        }
        let head = window.get_by_label_contains(" satellites to send");
        assert_eq!(
            head.accesskit_node().value().as_deref(),
            Some("101 satellites to send"),
            "{size:?}"
        );
        // An earlier file is not behind the list either.
        let of = (peer().to_string(), FILE.to_owned());
        let kept = KeptFiles { origin: of, list: Some(Ok(vec![kept_entry(Origin::Found, 2.0)])) };
        Arc::make_mut(&mut window.state_mut().model.shown_mut().uploads).kept_files = kept;
        window.get_by_role_and_label(Role::TextInput, "File").focus();
        rig::settle(&mut window);
        window.event(egui::Event::Text(FILE.to_owned()));
        rig::settle(&mut window);
        let top = |label: &str| window.get_by_label_contains(label).rect().top();
        let last = numbers.last().and_then(|number| {
            let CatalogState::Ready(catalog) = &window.state().model.catalog else { return None };
            Some(catalog.get(*number)?.name().to_owned())
        });
        let last = format!("Leave out {}", last.expect("it has elements"));
        assert!(top("Kept on this computer") < top(&last), "{size:?}");
        let search = window.get_by_role_and_label(Role::TextInput, "Add a satellite").rect();
        assert!(search.bottom() < top(&last) - 50.0 * 24.0, "{size:?} {search:?}");
    }
}

#[test]
fn the_button_and_the_proof_are_in_sight_in_the_smallest_window() {
    let whole = egui::Rect::from_min_size(egui::Pos2::ZERO, rig::SMALL.into());
    let window = opened_small(Uploads::default());
    let button = window.get_by_role_and_label(Role::Button, "Upload and verify").rect();
    assert!(whole.contains_rect(button), "{button:?}");
    let uploaded = uploaded();
    let satellite: FileObject = uploaded.objects[1].clone();
    let proved = Proved { uploaded, satellite, time: rig::now() };
    let window = opened_small(at(Stage::Proved(Box::new(proved))));
    let proof = window.get_by_label_contains("Verified 11:15:30Z").rect();
    assert!(whole.contains_rect(proof), "{proof:?}");
}
