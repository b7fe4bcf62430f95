use std::path::PathBuf;

use super::*;
use crate::{
    contract::{
        transfer::{
            AlgorithmPart, FileName, FileObject, KeptFile, OldAlgorithm, Origin, Peer, Progress,
            TleFile, UploadStep,
        },
        uploads::Busy,
    },
    controller::satrak::ELEMENT_FILES,
    device::settings::Hindrance,
    engine::uploads::old_algorithms,
    transfer::ConnectError,
};

const ISS: u32 = 25_544;
const NOAA_20: u32 = 43_013;

fn peer() -> Peer {
    Peer { host: "192.168.10.21".to_owned(), port: 22 }
}

fn order() -> Order {
    let catalog = crate::orbit::bundled().unwrap();
    let file =
        TleFile::new([ISS, NOAA_20].iter().filter_map(|one| catalog.get(*one)), &ELEMENT_FILES)
            .unwrap();
    Order {
        antenna: "Satrak".to_owned(),
        takes: &ELEMENT_FILES,
        unit: peer(),
        folder: "/svs/satrak/tle".to_owned(),
        file: FileName::new("active.txt", &ELEMENT_FILES).unwrap(),
        user: "op".to_owned(),
        key_file: None,
        cargo: Cargo::New(file),
        satellite: Some(NOAA_20),
        is_unattended: false,
    }
}

fn now() -> Timestamp {
    "2026-08-12T11:15:30Z".parse().unwrap()
}

fn uploaded() -> Box<Uploaded> {
    let Cargo::New(file) = order().cargo else { panic!() };
    Box::new(Uploaded {
        unit: peer(),
        file: FileName::new("active.txt", &ELEMENT_FILES).unwrap(),
        bytes: file.bytes().len() as u64,
        sha256: file.hash(),
        time: now(),
        objects: file.objects().to_vec(),
    })
}

fn report(outcome: Outcome) -> Report {
    let (keyring_problem, old_algorithms) = (None, Vec::new());
    Report { outcome, is_logged_in: true, is_factory: false, keyring_problem, old_algorithms }
}

/// Order with its displayed state.
#[derive(Default)]
struct Fixture {
    flow: Flow,
    shown: Uploads,
    unit: UnitNow,
}

impl Fixture {
    fn begin(&mut self) -> Option<Next> {
        self.flow.begin(order(), &self.unit, &mut self.shown)
    }

    fn begin_unattended(&mut self) -> Option<Next> {
        let order = Order { is_unattended: true, ..order() };
        self.flow.begin(order, &self.unit, &mut self.shown)
    }

    fn reported(&mut self, outcome: Outcome) -> Option<Next> {
        self.flow.reported(report(outcome), &self.unit, &mut self.shown)
    }

    /// Checks that tracking and auto-track end before the unit uses the file.
    fn assert_rests_before_it_is_told(&mut self, go_on: impl FnOnce(&mut Self) -> Option<Next>) {
        self.unit.hindrance = Some(Hindrance::Tracks);
        assert!(matches!(go_on(self), Some(Next::Rest)));
        assert!(self.flow.rested(&self.unit).is_none());
        (self.unit.hindrance, self.unit.busy) = (None, None);
        selection(self.flow.rested(&self.unit));
        assert!(self.flow.rested(&self.unit).is_none(), "once");
    }

    fn failure(&self) -> &Failure {
        let Stage::Failed(failure) = &self.shown.stage else { panic!("{:?}", self.shown.stage) };
        failure
    }
}

fn assert_runs(next: Option<Next>) -> Errand {
    let Some(Next::Run(errand)) = next else { panic!("nothing runs") };
    *errand
}

fn selection(next: Option<Next>) -> Selection {
    let Some(Next::Select(selection)) = next else { panic!("nothing is selected") };
    selection
}

#[test]
fn green_comes_after_the_unit_has_named_the_satellite_and_not_before() {
    let mut fixture = Fixture::default();
    assert_runs(fixture.begin());
    assert!(matches!(fixture.shown.stage, Stage::Working { .. }));
    assert!(fixture.begin().is_none(), "one at a time");
    let selection = selection(fixture.reported(Outcome::Uploaded(uploaded())));
    assert_eq!(
        (selection.file.as_str(), selection.satellite.catalog_number),
        ("active.txt", NOAA_20)
    );
    assert!(matches!(fixture.shown.stage, Stage::Selecting(_)));
    fixture.flow.selected(Ok(()), now(), &mut fixture.shown);
    let Stage::Proved(proved) = &fixture.shown.stage else { panic!("{:?}", fixture.shown.stage) };
    assert_eq!(proved.satellite.catalog_number, NOAA_20);
    assert_eq!(proved.uploaded, *uploaded());
}

#[test]
fn a_unit_that_does_not_find_the_satellite_is_no_success() {
    let mut fixture = Fixture::default();
    fixture.begin();
    fixture.reported(Outcome::Uploaded(uploaded()));
    fixture.flow.selected(Err("satellite not found".to_owned()), now(), &mut fixture.shown);
    let failure = fixture.failure();
    assert_eq!(failure.text, "satellite not found");
    assert_eq!(failure.uploaded, Some(uploaded()));
    assert_runs(fixture.begin());
}

#[test]
fn a_unit_that_tracks_is_left_alone_until_the_operator_agrees() {
    let mut fixture = Fixture::default();
    fixture.unit.busy = Some(Busy::Tracks);
    assert!(fixture.begin().is_none());
    assert_eq!(fixture.shown.stage, Stage::AsksAboutTracking(Busy::Tracks));
    assert!(!fixture.flow.cancel(&mut fixture.shown));
    assert!(fixture.failure().is_cancel);

    fixture.begin();
    assert_runs(fixture.flow.agree(&fixture.unit, &mut fixture.shown));
    fixture
        .assert_rests_before_it_is_told(|fixture| fixture.reported(Outcome::Uploaded(uploaded())));
}

#[test]
fn tracking_that_began_meanwhile_or_a_stop_asks_again() {
    let mut fixture = Fixture::default();
    fixture.begin();
    fixture.unit.busy = Some(Busy::MayTrack);
    assert!(fixture.reported(Outcome::Uploaded(uploaded())).is_none());
    assert_eq!(fixture.shown.stage, Stage::AsksAboutTracking(Busy::MayTrack));
    fixture.assert_rests_before_it_is_told(|fixture| {
        fixture.flow.agree(&fixture.unit, &mut fixture.shown)
    });
    fixture.unit.busy = Some(Busy::MayTrack);
    fixture.flow.selected(Ok(()), now(), &mut fixture.shown);

    fixture.begin();
    assert_runs(fixture.flow.agree(&fixture.unit, &mut fixture.shown));
    fixture.flow.stopped();
    assert!(fixture.reported(Outcome::Uploaded(uploaded())).is_none());
    assert!(matches!(fixture.shown.stage, Stage::AsksAboutTracking(_)));
    fixture.flow.cancel(&mut fixture.shown);
    assert_eq!(fixture.failure().uploaded, Some(uploaded()), "the file is there all the same");
}

#[test]
fn a_password_is_asked_for_and_asked_again_when_it_is_wrong() {
    let mut fixture = Fixture::default();
    assert_eq!(assert_runs(fixture.begin()).secret, None);
    fixture.reported(Outcome::Secret { refused: None });
    let Stage::AsksForSecret(request) = &fixture.shown.stage else { panic!() };
    assert_eq!((request.user.as_str(), request.address.as_str()), ("op", "192.168.10.21:22"));
    let wrong = Secret::new("tr0ub4dor");
    let errand = assert_runs(fixture.flow.type_secret(wrong.clone(), true, &mut fixture.shown));
    assert_eq!(errand.secret, Some(wrong));
    fixture.reported(Outcome::Secret { refused: Some("log-in refused".to_owned()) });
    let Stage::AsksForSecret(request) = &fixture.shown.stage else { panic!() };
    assert_eq!(request.refused.as_deref(), Some("log-in refused"));
    assert!(!format!("{:?}", fixture.shown).contains("tr0ub4dor"));
    let right = Secret::new("hunter2");
    assert_runs(fixture.flow.type_secret(right.clone(), true, &mut fixture.shown));
    assert_eq!(fixture.flow.secret_to_keep(), Some(right));
    assert_eq!(fixture.flow.secret_to_keep(), None, "kept once");
    fixture.reported(Outcome::Secret { refused: None });
    fixture.flow.cancel(&mut fixture.shown);
    assert!(fixture.failure().is_cancel);
}

#[test]
fn a_missing_keyring_is_remembered_while_the_password_is_typed_again() {
    let mut fixture = Fixture::default();
    fixture.begin();
    let keyring_problem = Some("no keyring".to_owned());
    let first = Report { keyring_problem, ..report(Outcome::Secret { refused: None }) };
    fixture.flow.reported(first, &fixture.unit, &mut fixture.shown);
    fixture.flow.type_secret(Secret::new("tr0ub4dor"), false, &mut fixture.shown);
    fixture.reported(Outcome::Secret { refused: Some("log-in refused".to_owned()) });
    let Stage::AsksForSecret(request) = &fixture.shown.stage else { panic!() };
    assert_eq!(request.keyring_problem.as_deref(), Some("no keyring"));
}

#[test]
fn a_secret_without_a_tick_is_not_kept() {
    let mut fixture = Fixture::default();
    fixture.begin();
    fixture.reported(Outcome::Secret { refused: None });
    fixture.flow.type_secret(Secret::new("hunter2"), false, &mut fixture.shown);
    assert_eq!(fixture.flow.secret_to_keep(), None);
}

fn offered() -> Box<OfferedKey> {
    Box::new(OfferedKey::example(&peer().host, peer().port))
}

#[test]
fn a_new_host_key_is_the_operator_s_to_trust() {
    let mut fixture = Fixture::default();
    fixture.begin();
    fixture.reported(Outcome::HostKey(ConnectError::UnknownHostKey(offered())));
    let Stage::AsksAboutHostKey(key) = &fixture.shown.stage else { panic!() };
    assert!(key.fingerprint.starts_with("SHA256:") && !key.is_changed());
    let Some(Next::Decide(Decision::Trust(key))) = fixture.flow.trust(&mut fixture.shown) else {
        panic!()
    };
    assert_eq!(key, offered());
    assert_runs(fixture.flow.decided(Ok(()), &mut fixture.shown));

    fixture.reported(Outcome::HostKey(ConnectError::UnknownHostKey(offered())));
    fixture.flow.cancel(&mut fixture.shown);
    assert!(fixture.failure().is_cancel && fixture.flow.trust(&mut fixture.shown).is_none());
}

#[test]
fn a_changed_host_key_is_refused_until_the_old_one_is_forgotten() {
    let mut fixture = Fixture::default();
    fixture.begin();
    let pinned = vec!["SHA256:old".to_owned()];
    fixture.reported(Outcome::HostKey(ConnectError::HostKeyChanged { pinned, offered: offered() }));
    let failure = fixture.failure();
    assert!(failure.text.contains("SHA256:old"), "{}", failure.text);
    assert!(failure.changed_key.as_ref().unwrap().is_changed());
    assert!(fixture.flow.trust(&mut fixture.shown).is_none(), "there is no way past it");
    let next = fixture.flow.forget_host(&mut fixture.shown);
    assert!(matches!(next, Some(Next::Decide(Decision::Forget(host))) if host == peer()));
    assert_runs(fixture.flow.decided(Ok(()), &mut fixture.shown));
    // No host key was refused, so there is no key to forget.
    assert!(fixture.flow.forget_host(&mut fixture.shown).is_none());
}

#[test]
fn known_hosts_that_cannot_be_written_end_it() {
    let mut fixture = Fixture::default();
    fixture.begin();
    fixture.reported(Outcome::HostKey(ConnectError::UnknownHostKey(offered())));
    fixture.flow.trust(&mut fixture.shown);
    assert!(fixture.flow.decided(Err("disk".to_owned()), &mut fixture.shown).is_none());
    assert_eq!(fixture.failure().text, "disk");
}

#[test]
fn a_cancel_is_told_until_the_file_takes_its_place() {
    let mut fixture = Fixture::default();
    fixture.begin();
    let stage = |step| Stage::Working {
        progress: Some(Progress { step, done_bytes: 0, file_bytes: 9 }),
        is_cancelled: false,
    };
    fixture.shown.stage = stage(UploadStep::Replace);
    assert!(!fixture.flow.cancel(&mut fixture.shown));
    fixture.shown.stage = stage(UploadStep::Write);
    assert!(fixture.flow.cancel(&mut fixture.shown));
    assert!(!fixture.flow.cancel(&mut fixture.shown), "once is enough");
    fixture.reported(Outcome::Cancelled("the unit has its old file".to_owned()));
    assert!(fixture.failure().is_cancel && fixture.failure().text.contains("old file"));
}

#[test]
fn old_algorithms_of_the_host_stay_beside_the_outcome() {
    let mut fixture = Fixture::default();
    fixture.begin();
    let old =
        |name: &str| vec![OldAlgorithm { part: AlgorithmPart::KeyExchange, name: name.to_owned() }];
    for (outcome, name) in [
        (Outcome::Secret { refused: None }, "diffie-hellman-group1-sha1"),
        (Outcome::Uploaded(uploaded()), "diffie-hellman-group14-sha1"),
    ] {
        let report = Report { old_algorithms: old(name), ..report(outcome) };
        fixture.flow.reported(report, &fixture.unit, &mut fixture.shown);
        assert_eq!(fixture.shown.warnings, [Warning::OldAlgorithms(old(name))]);
    }
    fixture.flow.selected(Ok(()), now(), &mut fixture.shown);
    assert!(matches!(fixture.shown.stage, Stage::Proved(_)));
    assert_eq!(old_algorithms(&fixture.shown), old("diffie-hellman-group14-sha1"));
    fixture.begin();
    assert!(old_algorithms(&fixture.shown).is_empty());
}

#[test]
fn the_factory_s_password_is_warned_about_once() {
    let mut fixture = Fixture::default();
    fixture.begin();
    for _ in 0..2 {
        let outcome = Outcome::Failed("full".to_owned());
        let report = Report { is_factory: true, ..report(outcome) };
        fixture.flow.reported(report, &fixture.unit, &mut fixture.shown);
    }
    assert_eq!(fixture.shown.warnings, [Warning::FactoryPassword]);
    fixture.begin();
    assert!(fixture.shown.warnings.is_empty());
}

#[test]
fn a_roll_back_takes_the_satellite_that_the_unit_holds_or_the_first() {
    let kept_file = KeptFile {
        unit: peer().to_string(),
        file: "active.txt".to_owned(),
        sha256: uploaded().sha256,
        bytes: 1,
        time: now(),
        origin: Origin::Found,
    };
    for (current, picked) in [(Some(NOAA_20), NOAA_20), (Some(7), ISS), (None, ISS)] {
        let mut fixture = Fixture::default();
        fixture.unit.current = current;
        let back = Order { cargo: Cargo::Kept(kept_file.clone()), satellite: None, ..order() };
        assert_runs(fixture.flow.begin(back, &fixture.unit, &mut fixture.shown));
        assert!(fixture.shown.is_roll_back);
        let selection = selection(fixture.reported(Outcome::Uploaded(uploaded())));
        assert_eq!(selection.satellite.catalog_number, picked);
    }
    let mut fixture = Fixture::default();
    fixture.begin();
    let empty = Box::new(Uploaded { objects: Vec::<FileObject>::new(), ..*uploaded() });
    assert!(fixture.reported(Outcome::Uploaded(empty)).is_none());
    assert!(fixture.failure().uploaded.is_some());
}

#[test]
fn a_passphrase_is_kept_under_its_key_file() {
    let key_file = Some(PathBuf::from("/home/op/key"));
    let account = account(&Order { key_file, ..order() });
    assert_eq!(account.to_string(), "/home/op/key@192.168.10.21:22");
}

/// Returns a fixture whose antenna a rule may use.
fn idle() -> Fixture {
    Fixture { unit: UnitNow { is_idle: true, ..UnitNow::default() }, ..Fixture::default() }
}

#[test]
fn an_unattended_order_fails_while_its_antenna_is_in_use() {
    let in_use: [fn(&mut UnitNow); 3] = [
        |unit| unit.is_idle = false,
        |unit| unit.hindrance = Some(Hindrance::Tracks),
        |unit| unit.locked_out = Some("Eva: grease".to_owned()),
    ];
    for change in in_use {
        let mut fixture = idle();
        change(&mut fixture.unit);
        assert!(fixture.begin_unattended().is_none());
        assert!(fixture.failure().uploaded.is_none());

        let mut fixture = idle();
        assert_runs(fixture.begin_unattended());
        change(&mut fixture.unit);
        assert!(fixture.reported(Outcome::Uploaded(uploaded())).is_none());
        assert!(fixture.failure().uploaded.is_some(), "the file is on the unit");
    }
    let mut fixture = idle();
    assert_runs(fixture.begin_unattended());
    selection(fixture.reported(Outcome::Uploaded(uploaded())));
}

#[test]
fn an_unattended_order_asks_for_no_password_and_no_host_key() {
    for refused in [None, Some("wrong".to_owned())] {
        let mut fixture = idle();
        assert_runs(fixture.begin_unattended());
        assert!(fixture.reported(Outcome::Secret { refused: refused.clone() }).is_none());
        assert!(fixture.failure().text.contains(refused.as_deref().unwrap_or("keyring")));
    }
    let pinned = vec!["SHA256:old".to_owned()];
    for error in [
        ConnectError::UnknownHostKey(offered()),
        ConnectError::HostKeyChanged { pinned, offered: offered() },
    ] {
        let mut fixture = idle();
        assert_runs(fixture.begin_unattended());
        assert!(fixture.reported(Outcome::HostKey(error)).is_none());
        assert!(matches!(fixture.shown.stage, Stage::Failed(_)));
    }
}
