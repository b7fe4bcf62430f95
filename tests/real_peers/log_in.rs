//! Authentication: passwords, private keys, host keys.

use std::{
    fs, io,
    net::TcpListener,
    path::Path,
    process::Command,
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::transfer::{
    ConnectError, ConnectStep, Interruption, KeyFileProblem, Limits, Login, Proof, SecretString,
};

use super::{
    unit::{LIMITS, Unit, elements},
    user::{PASSWORD, run},
};

fn refused(unit: &Unit, login: &Login) -> ConnectError {
    unit.open_as(login, unit.address(), LIMITS).err().expect("this must be refused")
}

#[test]
#[ignore = "needs sshd and root"]
fn a_wrong_password_is_refused_and_not_shown() {
    let unit = Unit::new();
    let wrong = "tr0ub4dor";
    let login = Login { proof: Proof::Password(wrong.into()), ..unit.login() };
    let error = refused(&unit, &login);
    assert!(matches!(error, ConnectError::LoginRefused { .. }), "{error}");
    let shown = format!("{error} {error:?} {login:?}");
    assert!(shown.contains(&unit.user.name), "{shown}");
    assert!(!shown.contains(wrong) && !shown.contains(PASSWORD), "{shown}");
    assert!(unit.open_as(&unit.login(), unit.address(), LIMITS).is_ok());
}

#[test]
#[ignore = "needs sshd and root"]
fn private_keys_open_the_door_with_their_passphrase() {
    let unit = Unit::new();
    for (kind, phrase) in [("ed25519", "open sesame"), ("rsa", ""), ("ecdsa", "open sesame")] {
        let path = unit.home.path().join(format!("key_{kind}"));
        let mut keygen = Command::new("ssh-keygen");
        run(keygen.args(["-q", "-N", phrase, "-t", kind, "-f"]).arg(&path));
        let login = |passphrase: Option<&str>| {
            let passphrase = passphrase.map(SecretString::from);
            let proof = Proof::KeyFile { path: path.clone(), passphrase };
            Login { user: unit.user.name.clone(), proof }
        };
        let right = login(Some(phrase).filter(|phrase| !phrase.is_empty()));
        fs::write(unit.home.path().join("authorized"), "").unwrap();
        let error = refused(&unit, &right);
        assert!(matches!(error, ConnectError::LoginRefused { .. }), "{error}");
        fs::copy(path.with_extension("pub"), unit.home.path().join("authorized")).unwrap();
        let opened = unit.open_as(&right, unit.address(), LIMITS);
        assert!(opened.is_ok(), "{kind}: {:?}", opened.err());
        if phrase.is_empty() {
            continue;
        }
        let problem = |login: &Login| match refused(&unit, login) {
            ConnectError::KeyFile { problem, .. } => problem,
            other => panic!("{other}"),
        };
        assert!(matches!(problem(&login(None)), KeyFileProblem::Locked));
        assert!(matches!(problem(&login(Some("sesame"))), KeyFileProblem::WrongPassphrase));
    }
}

#[test]
#[ignore = "needs sshd and root"]
fn a_file_that_is_no_key_is_told_before_anything_is_sent() {
    let unit = Unit::new();
    let login = |path: &str| {
        let proof = Proof::KeyFile { path: unit.home.path().join(path), passphrase: None };
        Login { proof, ..unit.login() }
    };
    let missing = refused(&unit, &login("none"));
    let is_disk = |problem: &KeyFileProblem| matches!(problem, KeyFileProblem::Disk(_));
    assert!(matches!(&missing, ConnectError::KeyFile { problem, .. } if is_disk(problem)));
    let other = refused(&unit, &login("sshd_config"));
    assert!(
        matches!(&other, ConnectError::KeyFile { problem: KeyFileProblem::Form, .. }),
        "{other}"
    );
}

#[test]
#[ignore = "needs sshd and root"]
fn a_host_key_is_asked_about_pinned_and_then_defended() {
    for kind in ["ed25519", "ecdsa", "rsa"] {
        let unit = Unit::unpinned(kind, "internal-sftp");
        let first = unit.fingerprint();
        let error = refused(&unit, &unit.login());
        let ConnectError::UnknownHostKey(key) = &error else { panic!("{error}") };
        assert_eq!(key.fingerprint(), first);
        unit.known.pin(key).unwrap();
        assert!(unit.open_as(&unit.login(), unit.address(), LIMITS).is_ok());

        unit.make_host_key("ed25519");
        let second = unit.fingerprint();
        let error = refused(&unit, &unit.login());
        let ConnectError::HostKeyChanged { pinned, offered } = &error else { panic!("{error}") };
        assert_eq!((pinned, offered.fingerprint()), (&vec![first.clone()], second.clone()));
        let shown = error.to_string();
        assert!(shown.contains(&first) && shown.contains(&second), "{shown}");
    }
}

#[test]
#[ignore = "needs sshd and root"]
fn a_better_key_beside_the_pinned_one_is_no_change() {
    let unit = Unit::unpinned("ecdsa", "internal-sftp");
    unit.pin();
    let better = unit.home.path().join("better");
    run(Command::new("ssh-keygen").args(["-q", "-N", "", "-t", "ed25519", "-f"]).arg(&better));
    let config = unit.home.path().join("sshd_config");
    let lines = fs::read_to_string(&config).unwrap();
    fs::write(&config, format!("HostKey {}\n{lines}", better.display())).unwrap();
    let opened = unit.open_as(&unit.login(), unit.address(), LIMITS);
    assert!(opened.is_ok(), "{:?}", opened.err());
}

#[test]
#[ignore = "needs sshd and root"]
fn a_server_that_says_nothing_is_left_and_one_that_is_not_there_too() {
    let unit = Unit::new();
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = silent.local_addr().unwrap();
    let log_in = Duration::from_millis(500);
    let limits = Limits { log_in, ..LIMITS };
    let error = unit.open_as(&unit.login(), address, limits).err().unwrap();
    let ConnectError::Interrupted { step, interruption: by, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!((*step, *by), (ConnectStep::Handshake, Interruption::TimedOut(log_in)));
    drop(silent);
    let error = unit.open_as(&unit.login(), address, limits).err().unwrap();
    assert!(matches!(error, ConnectError::Unreachable { .. }), "{error}");
}

/// Log output in memory.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl io::Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Returns the contents of every file below `folder`, one after the other.
fn all_bytes(folder: &Path) -> Vec<u8> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let read = |path: std::path::PathBuf| {
        if path.is_dir() { all_bytes(&path) } else { fs::read(path).unwrap() }
    };
    paths.flat_map(read).collect()
}

#[test]
#[ignore = "needs sshd and root"]
fn no_password_is_left_in_log_or_folder() {
    let unit = Unit::new();
    let (log, wrong) = (Log::default(), "tr0ub4dor");
    let writer = log.clone();
    let subscriber = tracing_subscriber::fmt()
        .with_max_level(tracing::Level::TRACE)
        .with_writer(move || writer.clone())
        .finish();
    tracing::subscriber::with_default(subscriber, || {
        unit.upload(&elements(3)).unwrap();
        let proof = Proof::Password(wrong.into());
        let error = refused(&unit, &Login { proof, ..unit.login() });
        tracing::warn!(%error, ?error, "as the window logs it");
    });
    let mut all = log.0.lock().unwrap().clone();
    assert!(String::from_utf8_lossy(&all).contains("uploaded and verified"));
    all.extend(all_bytes(&unit.home.path().join("console")));
    let all = String::from_utf8_lossy(&all);
    assert!(all.contains("ssh-ed25519") && all.contains("sha256"));
    assert!(!all.contains(PASSWORD) && !all.contains(wrong));
}
