//! Test fetches of the sources that a unit may use.

use std::{
    net::{SocketAddr, TcpListener},
    sync::Mutex,
    time::Duration,
};

use azel::{
    contract::transfer::{FileProtocol, SatelliteMatch},
    transfer::{
        CancellationToken, ConnectError, ConnectStep, ElementSource, FetchError, Interruption,
        KnownHosts, Limits, Trust, fetch, what_a_unit_sees,
    },
};
use rustls::pki_types::CertificateDer;

use super::{
    ftp_server::{FILE, FtpServer},
    narrow::{Narrow, Then},
    unit::{self, LIMITS, Unit, block_on, elements, peer},
    user::PASSWORD,
};

fn source(protocol: FileProtocol, user: &str, address: SocketAddr) -> ElementSource {
    ElementSource::Server {
        peer: peer(address),
        protocol,
        user: user.to_owned(),
        password: PASSWORD.into(),
        file: FILE.to_owned(),
    }
}

/// Returns trust in the authorities `own` and in no SSH host.
fn trust(own: &[CertificateDer<'static>]) -> Trust {
    Trust { known_hosts: KnownHosts::new("/nowhere/known_hosts"), own_authorities: own.to_vec() }
}

fn get(source: &ElementSource, trust: &Trust, limits: Limits) -> Result<Vec<u8>, FetchError> {
    block_on(fetch(source, trust, limits, &CancellationToken::new())).map(|fetched| fetched.bytes)
}

#[test]
#[ignore = "needs vsftpd and root"]
fn a_file_comes_over_ftp_and_tells_what_the_unit_will_see() {
    let file = elements(400);
    let server = FtpServer::new(file.bytes(), false);
    let source = source(FileProtocol::Ftp, &server.user.name, server.address());
    let bytes = get(&source, &trust(&[]), LIMITS).unwrap();
    assert_eq!(bytes, file.bytes());
    let wanted = &file.objects()[200];
    let view = what_a_unit_sees(&bytes, &wanted.name);
    assert_eq!(view.satellite, SatelliteMatch::Found(wanted.clone()));
    assert_eq!((view.objects, view.is_tle, view.sha256), (400, true, file.hash()));
}

#[test]
#[ignore = "needs vsftpd and root"]
fn a_file_comes_over_ftp_with_tls_from_a_trusted_server_only() {
    let file = elements(400);
    let server = FtpServer::new(file.bytes(), true);
    let secure = source(FileProtocol::FtpTls, &server.user.name, server.address());
    assert_eq!(get(&secure, &trust(&[server.certificate()]), LIMITS).unwrap(), file.bytes());
    let error = get(&secure, &trust(&[]), LIMITS).unwrap_err();
    assert!(matches!(error, FetchError::Tls(_)), "{error}");
    let plain = source(FileProtocol::Ftp, &server.user.name, server.address());
    let error = get(&plain, &trust(&[]), LIMITS).unwrap_err();
    let ConnectError::LoginRefused { .. } = connect_error(&error) else { panic!("{error}") };
}

#[test]
#[ignore = "needs vsftpd and root"]
fn an_ftp_server_that_refuses_is_told_and_no_password_shown() {
    let server = FtpServer::new(b"x", false);
    let wrong = "tr0ub4dor";
    let mut asked = source(FileProtocol::Ftp, &server.user.name, server.address());
    if let ElementSource::Server { password, .. } = &mut asked {
        *password = wrong.into();
    }
    let error = get(&asked, &trust(&[]), LIMITS).unwrap_err();
    let ConnectError::LoginRefused { .. } = connect_error(&error) else { panic!("{error}") };
    let shown = format!("{error} {error:?} {asked:?}");
    assert!(!shown.contains(wrong), "{shown}");

    let mut asked = source(FileProtocol::Ftp, &server.user.name, server.address());
    if let ElementSource::Server { file, .. } = &mut asked {
        "none.txt".clone_into(file);
    }
    let error = get(&asked, &trust(&[]), LIMITS).unwrap_err();
    assert!(matches!(error, FetchError::NoFile), "{error}");
}

#[test]
#[ignore = "needs vsftpd and root"]
fn an_ftp_file_has_a_largest_size() {
    let server = FtpServer::new(&[b'x'; 5000], false);
    let asked = source(FileProtocol::Ftp, &server.user.name, server.address());
    let get = |file_bytes| get(&asked, &trust(&[]), Limits { file_bytes, ..LIMITS });
    assert_eq!(get(5000).unwrap().len(), 5000);
    let error = get(4999).unwrap_err();
    assert!(matches!(error, FetchError::TooLarge(4999)), "{error}");
}

#[test]
#[ignore = "needs vsftpd and root"]
fn an_ftp_server_that_stalls_or_hangs_up_is_left() {
    let server = FtpServer::new(b"x", false);
    let limits =
        Limits { log_in: Duration::from_millis(800), file: Duration::from_millis(800), ..LIMITS };
    let late = Interruption::TimedOut(Duration::from_millis(800));
    // This server is silent from the start.
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let asked = source(FileProtocol::Ftp, "op", silent.local_addr().unwrap());
    let error = get(&asked, &trust(&[]), limits).unwrap_err();
    let ConnectError::Interrupted { step: ConnectStep::Handshake, interruption: by, .. } =
        connect_error(&error)
    else {
        panic!("{error}")
    };
    assert_eq!(*by, late);
    // These links stall or break during the log-in.
    for then in [Then::Stall, Then::Cut] {
        let link = Narrow::new(server.address(), 10, then);
        let asked = source(FileProtocol::Ftp, &server.user.name, link.address());
        let error = get(&asked, &trust(&[]), limits).unwrap_err();
        match (then, connect_error(&error)) {
            (
                Then::Stall,
                ConnectError::Interrupted { step: ConnectStep::LogIn, interruption: by, .. },
            ) => {
                assert_eq!(*by, late);
            }
            (Then::Cut, ConnectError::Failed { step: ConnectStep::LogIn, .. }) => {}
            (_, other) => panic!("{other}"),
        }
    }
}

#[test]
#[ignore = "needs vsftpd and root"]
fn an_ftp_file_that_trickles_is_left() {
    let server = FtpServer::with_options(&vec![b'x'; 1 << 20], false, "local_max_rate=1000\n");
    let asked = source(FileProtocol::Ftp, &server.user.name, server.address());
    let file = Duration::from_millis(1500);
    let error = get(&asked, &trust(&[]), Limits { file, ..LIMITS }).unwrap_err();
    let FetchError::Interrupted(by) = &error else { panic!("{error}") };
    assert_eq!(*by, Interruption::TimedOut(file));
}

#[test]
#[ignore = "needs sshd and root"]
fn a_file_comes_over_ssh_where_the_port_says_so() {
    assert_eq!(FileProtocol::of_port(22), FileProtocol::Sftp);
    let unit = Unit::new();
    let folder = unit.folder();
    let trust = Trust { known_hosts: unit.known.clone(), own_authorities: Vec::new() };
    let mut asked = source(FileProtocol::Sftp, &unit.user.name, unit.address());
    for (path, is_there) in [
        (format!("{}/{}", folder.display(), unit::FILE), true),
        (format!("tle/{}", unit::FILE), true),
        (unit::FILE.to_owned(), false),
    ] {
        if let ElementSource::Server { file, .. } = &mut asked {
            file.clone_from(&path);
        }
        match get(&asked, &trust, LIMITS) {
            Ok(bytes) => assert!(is_there && bytes == unit::OLD, "{path}"),
            Err(error) => assert!(!is_there && matches!(error, FetchError::NoFile), "{error}"),
        }
    }
    let error = get(&asked, &self::trust(&[]), LIMITS).unwrap_err();
    let ConnectError::UnknownHostKey(_) = connect_error(&error) else { panic!("{error}") };
}

fn connect_error(error: &FetchError) -> &ConnectError {
    let FetchError::Connect(error) = error else { panic!("{error}") };
    error
}

/// Lines that the libraries log.
static LOGGED: Mutex<Vec<String>> = Mutex::new(Vec::new());

struct Logger;

impl log::Log for Logger {
    fn enabled(&self, _: &log::Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &log::Record<'_>) {
        LOGGED.lock().unwrap().push(record.args().to_string());
    }

    fn flush(&self) {}
}

#[test]
#[ignore = "needs sshd, vsftpd and root"]
fn no_library_logs_a_password() {
    log::set_logger(&Logger).unwrap();
    log::set_max_level(log::LevelFilter::Trace);
    let server = FtpServer::new(b"x", false);
    let asked = source(FileProtocol::Ftp, &server.user.name, server.address());
    get(&asked, &trust(&[]), LIMITS).unwrap();
    let unit = Unit::new();
    unit.upload(&elements(2)).unwrap();
    log::set_max_level(log::LevelFilter::Off);
    let logged = LOGGED.lock().unwrap().join("\n");
    assert!(logged.contains("Login OK") && logged.contains("userauth_success"), "{logged}");
    assert!(!logged.contains(PASSWORD), "{logged}");
}
