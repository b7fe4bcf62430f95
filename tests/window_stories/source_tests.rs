//! Button "Test from here" beside the form of a unit's source.

use azel::{
    contract::{
        self,
        host_keys::DoubtfulKey,
        source_tests::{SourceOrder, SourceTests, TestAsk, TestStage, TestedSource},
        transfer::{AlgorithmPart, FileProtocol, OldAlgorithm, Peer, UnitView},
    },
    model::{Model, ThemeName, UiCommand},
    orbit::write_tle,
    secret::Secret,
    transfer::what_a_unit_sees,
    ui::{
        source_test::{self, SourceTestState, TypedSource},
        theme,
    },
};
use egui::{Key, Role, UiBuilder};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    rig::{self, NOAA_20},
    states,
};

const NAME: &str = "NOAA 20 (JPSS-1)";
const SECRET: &str = "hunter2-password";
const URL: &str = "https://example.org/weather.txt";

/// Form with both sources typed, one of which is shown.
struct Form {
    model: Model,
    state: SourceTestState,
    commands: Vec<UiCommand>,
    is_web: bool,
    url: String,
    port: String,
}

type Window = Harness<'static, Form>;

fn form(width: f32, is_web: bool, tests: SourceTests) -> Window {
    let mut model = rig::model(states::tracking(0.0));
    model.shown_mut().source_tests = tests.into();
    let form = Form {
        model,
        state: SourceTestState::default(),
        commands: Vec::new(),
        is_web,
        url: URL.to_owned(),
        port: "22".to_owned(),
    };
    let mut window = Harness::builder()
        .with_size([width, 500.0])
        .with_context_setup(|ctx| theme::install(ctx, ThemeName::Dark))
        .build_ui_state(
            |ui, form: &mut Form| {
                let typed = if form.is_web {
                    TypedSource::Web { url: &form.url }
                } else {
                    TypedSource::Server {
                        address: "10.0.1.2",
                        port: &form.port,
                        user: "op",
                        password: SECRET,
                        file: FILE,
                        satellite: NAME,
                    }
                };
                let whole = ui.ctx().content_rect();
                ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
                    source_test::show(
                        ui,
                        &form.model,
                        0,
                        typed,
                        &mut form.state,
                        &mut form.commands,
                    );
                });
            },
            form,
        );
    window.run_steps(4);
    window
}

const FILE: &str = "weather.txt";

fn asked(window: &mut Window) -> Vec<TestAsk> {
    window.run_steps(4);
    let commands = std::mem::take(&mut window.state_mut().commands);
    let ask = |command| match command {
        UiCommand::Station(contract::Command::TestSource(ask)) => ask,
        other => panic!("{other:?}"),
    };
    commands.into_iter().map(ask).collect()
}

fn click(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
}

fn says(window: &Window, words: &str) -> bool {
    window
        .query_all_by_role(Role::Label)
        .any(|node| node.accesskit_node().value().is_some_and(|text| text.contains(words)))
}

fn web_order() -> SourceOrder {
    let source = TestedSource::Web { url: URL.to_owned() };
    SourceOrder { antenna: "Satrak".to_owned(), source, satellite: NAME.to_owned() }
}

fn tested(stage: TestStage) -> SourceTests {
    SourceTests { order: Some(web_order()), stage }
}

#[test]
fn the_typed_address_is_tested_for_the_satellite_that_the_unit_holds() {
    for width in [300.0, 560.0] {
        let mut window = form(width, true, SourceTests::default());
        click(&mut window, "Test from here");
        assert_eq!(asked(&mut window), [TestAsk::Begin(Box::new(web_order()))]);
        window.state_mut().url.clear();
        window.run_steps(2);
        assert!(says(&window, "Cannot be tested yet: the address is missing."));
        let button = window.get_by_role_and_label(Role::Button, "Test from here");
        assert!(button.accesskit_node().is_disabled());
    }
}

#[test]
fn a_server_is_spoken_to_as_its_port_says_or_as_the_operator_wants() {
    let mut window = form(300.0, false, SourceTests::default());
    let source = |protocol| TestedSource::Server {
        peer: Peer { host: "10.0.1.2".to_owned(), port: 22 },
        protocol,
        user: "op".to_owned(),
        password: Secret::new(SECRET),
        file: FILE.to_owned(),
    };
    let order = |protocol| SourceOrder { source: source(protocol), ..web_order() };
    click(&mut window, "Test from here");
    assert_eq!(asked(&mut window), [TestAsk::Begin(Box::new(order(FileProtocol::Sftp)))]);
    let combo = "Protocol of the test, Set by the port";
    window.get_by_role_and_label(Role::ComboBox, combo).click();
    window.run_steps(3);
    window.get_by_label("FTP with TLS").click();
    window.run_steps(3);
    click(&mut window, "Test from here");
    let begin = TestAsk::Begin(Box::new(order(FileProtocol::FtpTls)));
    assert!(!format!("{begin:?}").contains(SECRET));
    assert_eq!(asked(&mut window), [begin]);
    assert!(!format!("{:?}", window.root()).contains(SECRET));
    window.state_mut().port = "x".to_owned();
    window.run_steps(2);
    assert!(says(&window, "the port is not a number"));
}

fn seen(view: Box<UnitView>, old_algorithms: Vec<OldAlgorithm>) -> TestStage {
    TestStage::Seen { view, time: rig::now(), old_algorithms }
}

#[test]
fn a_test_names_old_algorithms_of_the_server() {
    let view = Box::new(what_a_unit_sees(b"<html>gone</html>", NAME));
    let name = "diffie-hellman-group14-sha1".to_owned();
    let old = OldAlgorithm { part: AlgorithmPart::KeyExchange, name };
    for (list, is_named) in [(vec![old], true), (Vec::new(), false)] {
        let window = form(300.0, true, tested(seen(view.clone(), list)));
        let words = "Connected with the old key exchange diffie-hellman-group14-sha1";
        assert_eq!(says(&window, words), is_named);
    }
}

#[test]
fn what_the_unit_will_see_is_told() {
    let model = rig::model(rig::quiet());
    let azel::contract::CatalogState::Ready(catalog) = &model.catalog else {
        panic!("the bundled elements")
    };
    let mut bytes = Vec::new();
    write_tle(catalog.get(NOAA_20), &mut bytes).unwrap();
    for width in [300.0, 560.0] {
        let view = Box::new(what_a_unit_sees(&bytes, NAME));
        let mut window = form(width, true, tested(seen(view, Vec::new())));
        assert!(says(&window, "The unit will find NOAA 20 (JPSS-1) (43013), elements of"));
        assert!(says(&window, "1 objects, SHA-256"));
        window.state_mut().url.push('x');
        window.run_steps(2);
        assert!(says(&window, "Tested before the fields above were changed."));
    }
    let view = Box::new(what_a_unit_sees(b"<html>gone</html>", NAME));
    let window = form(300.0, true, tested(seen(view, Vec::new())));
    assert!(says(&window, "The unit will not find NOAA 20 (JPSS-1)"));
    assert!(says(&window, "The file is not in TLE format"));
}

#[test]
fn a_test_under_way_can_be_cancelled_and_a_failure_says_why() {
    let mut window = form(300.0, true, tested(TestStage::Working));
    click(&mut window, "Cancel test");
    assert_eq!(asked(&mut window), [TestAsk::Cancel]);
    let text = "the server answered 404 instead of the file; check the address".to_owned();
    let window = form(300.0, true, tested(TestStage::Failed { text, changed_key: None }));
    assert!(says(&window, "The server answered 404 instead of the file; check the address."));
}

#[test]
fn host_keys_are_asked_about_as_for_uploads() {
    let key = DoubtfulKey {
        address: "10.0.1.2".to_owned(),
        algorithm: "ssh-ed25519".to_owned(),
        fingerprint: "SHA256:new".to_owned(),
        pinned: Vec::new(),
    };
    let mut window = form(300.0, true, tested(TestStage::AsksAboutHostKey(key.clone())));
    assert!(says(&window, "SHA256:new"));
    click(&mut window, "It is the right key");
    assert_eq!(asked(&mut window), [TestAsk::TrustHostKey]);
    window.key_press(Key::Escape);
    assert_eq!(asked(&mut window), [TestAsk::Cancel]);
    let changed_key = Some(DoubtfulKey { pinned: vec!["SHA256:old".to_owned()], ..key });
    let stage = TestStage::Failed { text: "changed".to_owned(), changed_key };
    let mut window = form(300.0, true, tested(stage));
    assert!(says(&window, "SHA256:old") && says(&window, "SHA256:new"));
    click(&mut window, "Forget the known key…");
    window.run_steps(3);
    click(&mut window, "Forget it (Enter)");
    assert_eq!(asked(&mut window), [TestAsk::ForgetHostKey]);
}
