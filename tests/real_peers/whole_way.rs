//! The whole path from the window to the unit's own report: the program against an `sshd`
//! and a simulated unit that reads the same folder.

use std::{
    fs,
    net::SocketAddr,
    path::Path,
    sync::{Arc, LazyLock, Mutex},
    thread,
    time::{Duration, Instant},
};

use azel::{
    app::App,
    clock::Clock,
    contract::{
        CatalogState, Command,
        automatic::DayEvent,
        uploads::{Failure, Stage},
    },
    controller::{SPECS, satrak::ELEMENT_FILE},
    engine::{Settings, uploads::Places},
    model::Model,
    sim::satrak::{Control, Options, Simulator},
    station::{self, Antenna, AntennaId, Station},
    transfer::{Account, KeptFiles, Keyring as _, MemoryKeyring, SecretString},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::{Harness, kittest::Queryable as _};
use jiff::Timestamp;
use tokio::sync::oneshot;

use super::{
    narrow::{Narrow, Then},
    unit::{FILE, LIMITS, OLD, Unit, elements},
    user::PASSWORD,
};

const WRONG: &str = "tr0ub4dor";
const ISS: u32 = 25_544;
const NOAA_20: u32 = 43_013;
const PATIENCE: Duration = Duration::from_mins(1);

/// A unit with files and a protocol, and a window on it.
struct Fixture {
    window: Harness<'static, App>,
    settings: Settings,
    files: Unit,
    control: Control,
    keyring: Arc<MemoryKeyring>,
    folder: tempfile::TempDir,
    _end: oneshot::Sender<()>,
}

impl Fixture {
    fn new(files: Unit, favourites: Vec<u32>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (address, control, end) = simulate(&files);
        let mut antenna = Antenna::satrak("Satrak", &address);
        antenna.connection.put(&ELEMENT_FILE, FILE).unwrap();
        antenna.upkeep.uploads_elements = true;
        let favourites = favourites.into_iter().collect();
        let mut station = Station { antennas: vec![antenna], favourites, ..Station::default() };
        // With this max age of elements, no pass is near at any time of day.
        station.scheduling.max_element_age_d = Some(0.1);
        let path = folder.path().join("station.toml");
        station::save(&station, &path, SPECS).unwrap();
        let keyring = Arc::new(MemoryKeyring::default());
        let places = Places {
            known_hosts: files.known.clone(),
            kept_files: KeptFiles::new(folder.path().join("uploads")),
            keyring: Arc::clone(&keyring) as _,
            session: Arc::default(),
            limits: LIMITS,
        };
        let settings = Settings {
            library: Some(folder.path().join("elements")),
            path: Some(path),
            upload_places: Some(places),
            ..Settings::default()
        };
        let window = window(settings.clone());
        let mut fixture = Self { window, settings, files, control, keyring, folder, _end: end };
        fixture.until_read();
        fixture
    }

    /// Ends the program and starts it again without its typed passwords. `between` may change the
    /// folder of the station in between.
    fn start_again(&mut self, between: impl FnOnce(&Path)) {
        let places = self.settings.upload_places.as_mut().unwrap();
        places.session = Arc::default();
        self.window = window(Settings::default());
        between(self.folder.path());
        self.window = window(self.settings.clone());
        self.until_read();
    }

    fn until_read(&mut self) {
        self.until("the unit is heard and the elements are read", |model| {
            matches!(model.catalog, CatalogState::Ready(_))
                && model.antenna().is_some_and(|antenna| {
                    antenna.snapshot.state.measured.is_some()
                        && antenna.snapshot.state.checked_at.is_some()
                })
        });
    }

    /// Creates a fixture with the upload part open, and everything typed but the password.
    fn typed(files: Unit) -> Self {
        Self::with(files, vec![ISS, NOAA_20])
    }

    fn with(files: Unit, favourites: Vec<u32>) -> Self {
        let address = files.address();
        let mut fixture = Self::new(files, favourites);
        fixture.window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
        fixture.window.run_steps(3);
        fixture.click("Upload to Satrak");
        fixture.write("Port", &address.port().to_string());
        fixture.write("Folder", fixture.files.folder().to_str().unwrap().to_owned().as_str());
        fixture.write("User", &fixture.files.user.name.clone());
        fixture
    }

    fn write(&mut self, field: &str, words: &str) {
        self.window.get_by_role_and_label(Role::TextInput, field).scroll_to_me();
        self.window.run_steps(2);
        self.window.get_by_role_and_label(Role::TextInput, field).focus();
        self.window.run_steps(2);
        self.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.window.event(Event::Text(words.to_owned()));
        self.window.run_steps(2);
    }

    fn click(&mut self, button: &str) {
        self.window.get_by_role_and_label(Role::Button, button).scroll_to_me();
        self.window.run_steps(2);
        self.window.get_by_role_and_label(Role::Button, button).click();
        self.window.run_steps(3);
    }

    fn until(&mut self, what: &str, is_so: impl Fn(&Model) -> bool) {
        let end = Instant::now() + PATIENCE;
        loop {
            self.window.step();
            let model = self.window.state().model();
            if is_so(model) {
                break;
            }
            let stage = &model.uploads.stage;
            assert!(Instant::now() < end, "not in time: {what}, but {stage:?}");
            thread::sleep(Duration::from_millis(5));
        }
        self.window.run_steps(3);
    }

    /// Waits for the end of the upload and returns the shown stage.
    fn end(&mut self) -> Stage {
        self.until("the end", |model| {
            matches!(model.uploads.stage, Stage::Proved(_) | Stage::Failed(_))
        });
        self.window.state().model().uploads.stage.clone()
    }

    fn failure(&mut self) -> Failure {
        match self.end() {
            Stage::Failed(failure) => failure,
            other => panic!("{other:?}"),
        }
    }

    fn assert_proved(&mut self) {
        let stage = self.end();
        assert!(matches!(stage, Stage::Proved(_)), "{stage:?}");
        assert!(self.says("Verified") || self.says("verified"));
    }

    fn says(&self, words: &str) -> bool {
        self.window.query_all_by_label_contains(words).next().is_some()
    }

    /// Waits until Azel asks for the password, types `password` and presses Enter.
    fn log_in(&mut self, password: &str) {
        self.until("the password is asked for", |model| {
            matches!(model.uploads.stage, Stage::AsksForSecret(_))
        });
        self.window.event(Event::Text(password.to_owned()));
        self.window.run_steps(3);
        self.assert_silent();
        self.window.key_press(Key::Enter);
        self.window.run_steps(3);
    }

    /// Checks that no password is exposed to assistive tools.
    fn assert_silent(&self) {
        let told = format!("{:?}", self.window.root());
        let stage = format!("{:?}", self.window.state().model().uploads);
        for secret in [PASSWORD, WRONG] {
            assert!(!told.contains(secret) && !stage.contains(secret));
        }
    }

    fn sent(&self) -> Vec<String> {
        let received = self.control.received().into_iter().map(|(_, frame)| frame);
        received.filter(|frame| frame.contains("SATELLITE=")).collect()
    }
}

fn window(settings: Settings) -> Harness<'static, App> {
    Harness::builder()
        .with_size([1440.0, 3200.0])
        .build_eframe(move |cc| App::new(&cc.egui_ctx, &settings, Clock::system()).unwrap())
}

/// Starts a simulated unit that reads the folder of `files`.
fn simulate(files: &Unit) -> (String, Control, oneshot::Sender<()>) {
    let options = Options {
        element_folder: Some(files.folder()),
        ..Options::new(Station::default().site, Timestamp::now())
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let free = SocketAddr::from(([127, 0, 0, 1], 0));
    let simulator = runtime.block_on(Simulator::bind(free, options)).unwrap();
    let (address, control) = (simulator.local_addr().unwrap(), simulator.control());
    let (end, ended) = oneshot::channel::<()>();
    let run = move || {
        runtime.block_on(async {
            tokio::select! {
                () = simulator.run() => {}
                _ = ended => {}
            }
        });
    };
    thread::Builder::new().name("unit".to_owned()).spawn(run).unwrap();
    (address.to_string(), control, end)
}

#[test]
#[ignore = "needs sshd and root"]
fn from_the_first_click_to_the_unit_s_own_word_and_back() {
    let log = log();
    let mut fixture = Fixture::typed(Unit::unpinned("ed25519", "internal-sftp"));
    fixture.click("Upload and verify");
    fixture.until("the host key is asked about", |model| {
        matches!(model.uploads.stage, Stage::AsksAboutHostKey(_))
    });
    assert!(fixture.says(&fixture.files.fingerprint()), "as ssh-keygen shows it");
    fixture.click("It is the right key");
    fixture.log_in(WRONG);
    fixture.until("it is refused", |model| {
        matches!(&model.uploads.stage, Stage::AsksForSecret(wanted) if wanted.refused.is_some())
    });
    fixture.window.get_by_label("Keep it in the keyring of this computer").click();
    fixture.window.run_steps(2);
    fixture.window.get_by_role(Role::PasswordInput).focus();
    fixture.log_in(PASSWORD);
    fixture.assert_proved();
    let first = fixture.files.files();
    assert!(first.len() == 1 && first[0].1 != OLD);
    // Azel asks the unit for the selected satellite. Until passes are predicted, none is selected,
    // and Azel asks for the first of the file.
    let sent = fixture.sent();
    let asked =
        ["ISS (ZARYA)", "NOAA 20 (JPSS-1)"].map(|name| format!("SATELLITE=,{FILE},{name},1,0"));
    assert!(matches!(&sent[..], [one] if asked.contains(one)), "{sent:?}");
    let account = Account {
        user: fixture.files.user.name.clone(),
        address: fixture.files.address().to_string(),
    };
    fixture.until("the password is kept", |_| true);
    assert!(fixture.keyring.get(&account).unwrap().is_some());

    // Azel uploads another file without a question, and then the first file again.
    fixture.click("Leave out ISS (ZARYA)");
    fixture.click("Upload and verify");
    fixture.assert_proved();
    assert_ne!(fixture.files.files(), first);
    fixture.window.get_by_label_contains("Kept on this computer: ").click();
    fixture.window.run_steps(3);
    let put_back = fixture
        .window
        .get_all_by_role(Role::Button)
        .filter_map(|node| {
            use egui_kittest::kittest::NodeT as _;
            node.accesskit_node().label()
        })
        .filter(|label| label.starts_with("Put back the file") && label.contains("sent from here"))
        .nth(1)
        .unwrap();
    fixture.click(&put_back);
    fixture.click("Put back (Enter)");
    fixture.assert_proved();
    assert!(fixture.says("Rolled back and verified"));
    assert_eq!(fixture.files.files(), first);
    assert_eq!(fixture.sent().len(), 3);
    fixture.assert_silent();
    let mut written = all_bytes(fixture.folder.path());
    written.extend(all_bytes(&fixture.files.home.path().join("console")));
    written.extend_from_slice(&log.0.lock().unwrap());
    let written = String::from_utf8_lossy(&written);
    assert!(written.contains("ssh-ed25519") && written.contains("uploaded and verified"));
    assert!(!written.contains(PASSWORD) && !written.contains(WRONG));
}

#[test]
#[ignore = "needs sshd and root"]
fn the_file_that_was_verified_is_the_one_of_the_next_track() {
    let mut fixture = Fixture::typed(Unit::new());
    fixture.write("File", "oper.txt");
    fixture.click("Upload and verify");
    fixture.log_in(PASSWORD);
    fixture.assert_proved();
    fixture.until("the antenna is set to it", |model| {
        model.station.antennas[0].connection.element_file().as_deref() == Some("oper.txt")
    });
    let text = std::fs::read_to_string(fixture.folder.path().join("station.toml")).unwrap();
    assert!(text.contains("element_file = \"oper.txt\""), "{text}");
    let antenna = fixture.window.state().model().antenna().unwrap();
    assert_eq!(antenna.config.connection.element_file().as_deref(), Some("oper.txt"));
    assert!(antenna.is_live(), "the session goes on");
}

#[test]
#[ignore = "needs sshd and root"]
fn the_rule_repeats_the_upload_once_the_elements_are_too_old() {
    const STATE: &str = "station.automatic.toml";
    let mut fixture = Fixture::typed(Unit::new());
    fixture.click("Upload and verify");
    fixture.until("the password is asked for", |model| {
        matches!(model.uploads.stage, Stage::AsksForSecret(_))
    });
    fixture.window.get_by_label("Keep it in the keyring of this computer").click();
    fixture.window.run_steps(2);
    fixture.window.get_by_role(Role::PasswordInput).focus();
    fixture.log_in(PASSWORD);
    fixture.assert_proved();
    // Move the date of that upload a year back.
    fixture.start_again(|folder| {
        let kept = fs::read_to_string(folder.join(STATE)).unwrap();
        assert!(kept.contains("25544") && !kept.contains(PASSWORD), "{kept}");
        fs::write(folder.join(STATE), kept.replace("\"2026-", "\"2025-")).unwrap();
    });
    let sent_before = fixture.sent().len();
    let client = fixture.window.state().station().client().clone();
    let antenna = AntennaId::FIRST;
    let _ = client.send(Command::SetAutomatic { antenna, is_on: true });
    let is_upload = |what: &DayEvent| matches!(what, DayEvent::ElementsUploaded { file, satellites: 2, .. } if file == FILE);
    fixture.until("the rule", |model| model.day.iter().any(|line| is_upload(&line.event)));
    let model = fixture.window.state().model();
    assert!(matches!(model.uploads.stage, Stage::Proved(_)), "{:?}", model.uploads.stage);
    assert!(model.antenna().unwrap().operation.is_on());
    assert_eq!(fixture.sent().len(), sent_before + 1, "the unit is told to use the file");
    let kept = fs::read_to_string(fixture.folder.path().join(STATE)).unwrap();
    assert!(!kept.contains("\"2025-"), "{kept}");
}

#[test]
#[ignore = "needs sshd and root"]
fn a_changed_host_key_is_refused_and_forgotten_only_on_purpose() {
    let mut fixture = Fixture::typed(Unit::new());
    let before = fixture.files.fingerprint();
    fixture.files.make_host_key("ed25519");
    fixture.click("Upload and verify");
    assert!(fixture.failure().changed_key.is_some());
    assert!(fixture.says(&before) && fixture.says(&fixture.files.fingerprint()));
    fixture.files.assert_as_before();
    fixture.click("Forget the known key…");
    fixture.click("Forget it (Enter)");
    fixture.until("the new key is asked about", |model| {
        matches!(model.uploads.stage, Stage::AsksAboutHostKey(_))
    });
    fixture.click("It is the right key");
    fixture.log_in(PASSWORD);
    fixture.assert_proved();
}

#[test]
#[ignore = "needs sshd and root"]
fn what_goes_wrong_on_the_way_is_told_and_typing_stays() {
    use std::os::unix::fs::PermissionsExt as _;
    let mut fixture = Fixture::typed(Unit::new());
    fixture.click("Upload and verify");
    fs::set_permissions(fixture.files.folder(), fs::Permissions::from_mode(0o555)).unwrap();
    fixture.log_in(PASSWORD);
    let failure = fixture.failure();
    assert!(failure.text.contains("for permission"), "{}", failure.text);
    fixture.files.assert_as_before();
    assert!(fixture.sent().is_empty(), "the unit was told nothing");
    let user = fixture.window.get_by_role_and_label(Role::TextInput, "User").value();
    assert_eq!(user.as_deref(), Some(fixture.files.user.name.as_str()));
    // Azel asks for the password once a session, so this upload needs no further input.
    fs::set_permissions(fixture.files.folder(), fs::Permissions::from_mode(0o755)).unwrap();
    fixture.click("Upload and verify");
    fixture.assert_proved();
}

#[test]
#[ignore = "needs sshd and root"]
fn a_link_that_is_cut_or_stalls_ends_in_an_error_with_the_old_file_there() {
    for then in [Then::Cut, Then::Stall] {
        let many = elements(60).objects().iter().map(|object| object.catalog_number).collect();
        let mut fixture = Fixture::with(Unit::new(), many);
        let link = Narrow::new(fixture.files.address(), 9000, then);
        fixture.files.pin_at(link.address());
        fixture.write("Port", &link.address().port().to_string());
        let account =
            Account { user: fixture.files.user.name.clone(), address: link.address().to_string() };
        fixture.keyring.set(&account, &SecretString::from(PASSWORD)).unwrap();
        fixture.click("Upload and verify");
        let failure = fixture.failure();
        assert!(!failure.is_cancel && failure.text.contains("check the link"), "{}", failure.text);
        let old = fixture.files.files().into_iter().find(|(name, _)| name == FILE);
        assert_eq!(old.unwrap().1, OLD);
        assert!(fixture.sent().is_empty());
    }
}

#[test]
#[ignore = "needs sshd and root"]
fn a_unit_that_does_not_see_the_file_is_no_success() {
    // The unit reads another folder than the upload writes to.
    let mut fixture = Fixture::typed(Unit::new());
    let other = fixture.files.home.path().join("other");
    fs::create_dir(&other).unwrap();
    fixture.files.user.own(&other);
    fixture.write("Folder", other.to_str().unwrap());
    fixture.click("Upload and verify");
    fixture.log_in(PASSWORD);
    let failure = fixture.failure();
    assert!(failure.uploaded.is_some(), "{failure:?}");
    assert!(fixture.says("Not in use: The unit"), "{}", failure.text);
}

/// Returns the log of all threads.
fn log() -> &'static Log {
    static LOG: LazyLock<Log> = LazyLock::new(|| {
        let log = Log::default();
        let writer = log.clone();
        let subscriber = tracing_subscriber::fmt()
            .with_max_level(tracing::Level::TRACE)
            .with_writer(move || writer.clone())
            .finish();
        tracing::subscriber::set_global_default(subscriber).unwrap();
        log
    });
    &LOG
}

/// Log output in memory.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl std::io::Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Returns the contents of every file below `folder`, one after the other.
fn all_bytes(folder: &std::path::Path) -> Vec<u8> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let read = |path: std::path::PathBuf| {
        if path.is_dir() { all_bytes(&path) } else { fs::read(path).unwrap() }
    };
    paths.flat_map(read).collect()
}
