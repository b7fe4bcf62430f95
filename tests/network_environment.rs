//! Environment variables of the network: certificate authorities and proxies. The program runs with
//! them in a process of its own, against servers on loopback.

use std::{
    io::{self, BufRead as _, BufReader, Read as _, Write as _},
    net::{Ipv4Addr, TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{Arc, mpsc},
    thread,
    time::{Duration, Instant},
};

use azel::{
    contract::transfer::{FileProtocol, Peer},
    controller::SPECS,
    library::{Library, Limits, save_sources},
    orbit::{FetchProblem, RefreshHours, Source, SourcePlace, bundled, write_omm_json},
    station::{self, Station},
    transfer::{self, CancellationToken, ElementSource, FetchError},
};
use rustls::{
    ServerConfig, ServerConnection, StreamOwned,
    crypto::ring,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject as _},
};

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_mins(2);
/// Pause between two looks at the library of the program.
const LOOK: Duration = Duration::from_millis(50);
const OBJECTS: usize = 5;
/// Variables that the machine of the test may have set.
const VARIABLES: [&str; 10] = [
    "ALL_PROXY",
    "all_proxy",
    "HTTPS_PROXY",
    "https_proxy",
    "HTTP_PROXY",
    "http_proxy",
    "NO_PROXY",
    "no_proxy",
    "SSL_CERT_FILE",
    "SSL_CERT_DIR",
];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/https").join(name)
}

fn authority() -> String {
    data("authority.pem").display().to_string()
}

/// Starts a thread that ends with the process.
fn spawn(name: &str, work: impl FnOnce() + Send + 'static) {
    thread::Builder::new().name(name.to_owned()).spawn(work).unwrap();
}

fn tls() -> Arc<ServerConfig> {
    let chain = vec![CertificateDer::from_pem_file(data("server.pem")).unwrap()];
    let key = PrivateKeyDer::from_pem_file(data("server.key")).unwrap();
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .unwrap()
        .with_no_client_auth()
        .with_single_cert(chain, key);
    Arc::new(config.unwrap())
}

/// Reads lines up to an empty one, and no byte after it.
fn head(stream: &mut impl io::Read) -> io::Result<String> {
    let mut text = Vec::new();
    while !text.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte)?;
        text.extend(byte);
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// Starts a server of elements, certified by the authority of the tests. Returns its port.
fn serve_elements() -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    let catalog = bundled().unwrap();
    let mut body = Vec::new();
    write_omm_json(catalog.iter().take(OBJECTS), &mut body).unwrap();
    let config = tls();
    let answer = move |stream: TcpStream| -> io::Result<()> {
        let connection = ServerConnection::new(config.clone()).map_err(io::Error::other)?;
        let mut stream = StreamOwned::new(connection, stream);
        head(&mut stream)?;
        let length = body.len();
        write!(stream, "HTTP/1.1 200 OK\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n")?;
        stream.write_all(&body)?;
        stream.conn.send_close_notify();
        stream.flush()
    };
    spawn("elements", move || {
        for stream in listener.incoming().map_while(Result::ok) {
            // Ignore errors: a client that rejects the certificate leaves early.
            let _ = answer(stream);
        }
    });
    port
}

/// A proxy that leads every connection to one port of this computer.
struct Proxy {
    port: u16,
    /// Targets that clients named, in the form `host:port`.
    targets: mpsc::Receiver<String>,
}

impl Proxy {
    /// Starts a proxy; `greet` reads the target from a client and accepts it.
    fn start(server: u16, greet: fn(&mut TcpStream) -> io::Result<String>) -> Self {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let (named, targets) = mpsc::sync_channel(10);
        let lead = move |mut near: TcpStream| -> io::Result<()> {
            let target = greet(&mut near)?;
            named.send(target).map_err(io::Error::other)?;
            let mut far = TcpStream::connect((Ipv4Addr::LOCALHOST, server))?;
            let (mut from_near, mut to_far) = (near.try_clone()?, far.try_clone()?);
            spawn("to-server", move || {
                let _ = io::copy(&mut from_near, &mut to_far);
            });
            io::copy(&mut far, &mut near).map(drop)
        };
        spawn("proxy", move || {
            for stream in listener.incoming().map_while(Result::ok) {
                // Ignore errors: a client may leave at any time.
                let _ = lead(stream);
            }
        });
        Self { port, targets }
    }

    fn socks(server: u16) -> Self {
        Self::start(server, socks5)
    }

    fn http(server: u16) -> Self {
        Self::start(server, http_connect)
    }

    fn targets(&self) -> Vec<String> {
        self.targets.try_iter().collect()
    }
}

fn refused(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why)
}

/// Accepts a SOCKS5 client without log-in and returns its target. RFC 1928 has the greeting in
/// section 3, the request in section 4 and the reply in section 6.
fn socks5(stream: &mut TcpStream) -> io::Result<String> {
    let mut greeting = [0; 2];
    stream.read_exact(&mut greeting)?;
    let [version, count] = greeting;
    let mut methods = vec![0; count.into()];
    stream.read_exact(&mut methods)?;
    if version != 5 || !methods.contains(&0) {
        return Err(refused("no greeting of SOCKS5 without log-in"));
    }
    stream.write_all(&[5, 0])?;
    let mut request = [0; 4];
    stream.read_exact(&mut request)?;
    let host = match request {
        [5, 1, 0, 1] => {
            let mut address = [0; 4];
            stream.read_exact(&mut address)?;
            Ipv4Addr::from(address).to_string()
        }
        [5, 1, 0, 3] => {
            let mut length = [0];
            stream.read_exact(&mut length)?;
            let mut name = vec![0; length[0].into()];
            stream.read_exact(&mut name)?;
            String::from_utf8_lossy(&name).into_owned()
        }
        _ => return Err(refused("no request to connect")),
    };
    let mut port = [0; 2];
    stream.read_exact(&mut port)?;
    stream.write_all(&[5, 0, 0, 1, 0, 0, 0, 0, 0, 0])?;
    Ok(format!("{host}:{}", u16::from_be_bytes(port)))
}

/// Accepts a CONNECT request (RFC 9110, section 9.3.6) and returns its target.
fn http_connect(stream: &mut TcpStream) -> io::Result<String> {
    let head = head(stream)?;
    let target = head.strip_prefix("CONNECT ").and_then(|rest| rest.split(' ').next());
    let target = target.ok_or_else(|| refused("not CONNECT"))?.to_owned();
    stream.write_all(b"HTTP/1.1 200 Connected\r\n\r\n")?;
    Ok(target)
}

/// Running program, which ends with the test.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        // The program may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs `azel serve` with `environment` on a station with one source, until the program has asked
/// the source's server. Returns the number of objects.
fn fetched(url: &str, environment: &[(&str, &str)]) -> Result<usize, FetchProblem> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("station.toml");
    station::save(&Station::default(), &file, SPECS).unwrap();
    let place = SourcePlace::Web(url.to_owned());
    let sources = [Source { name: "Own".to_owned(), place, refresh: Some(RefreshHours::from(2)) }];
    save_sources(&sources, &folder.path().join("sources.toml")).unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_azel"));
    for variable in VARIABLES {
        program.env_remove(variable);
    }
    program
        .env("HOME", folder.path())
        .env("XDG_RUNTIME_DIR", folder.path().join("runtime"))
        .env("XDG_DATA_HOME", folder.path().join("data"))
        .env("XDG_CONFIG_HOME", folder.path().join("config"))
        // Keep the alarms of a test from the desktop and the speakers of its user.
        .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere")
        .env("PATH", "")
        .envs(environment.iter().copied())
        .args(["serve", "--station"])
        .arg(&file)
        .stdout(Stdio::null());
    let _program = Program(program.spawn().unwrap());
    let library = folder.path().join("data/azel/elements");
    let until = Instant::now() + PATIENCE;
    loop {
        let (_, reports) = Library::open(&library, Limits::default()).unwrap().load(&sources);
        if let Some(problem) = &reports[0].fetch_problem {
            return Err(problem.clone());
        }
        if reports[0].as_of.is_some() {
            return Ok(reports[0].objects());
        }
        assert!(Instant::now() < until, "the server was not asked");
        thread::sleep(LOOK);
    }
}

#[test]
fn a_private_authority_is_trusted_once_ssl_cert_file_names_it() {
    let url = format!("https://localhost:{}/own.json", serve_elements());
    assert_eq!(fetched(&url, &[("SSL_CERT_FILE", &*authority())]), Ok(OBJECTS));
    let problem = fetched(&url, &[]).unwrap_err();
    assert_eq!(problem, FetchProblem::UnknownAuthority);
    let text = problem.to_string();
    assert!(text.contains("certificate") && text.contains("authority"), "{text}");
}

#[test]
fn a_socks_proxy_leads_to_other_computers() {
    let server = serve_elements();
    let proxy = Proxy::socks(server);
    let authority = authority();
    // Azel looks up names itself for SOCKS5, and leaves them to the proxy for SOCKS5h. RFC 5737
    // reserves the address for documents, so no network reaches it.
    for (scheme, host) in [("socks5", "192.0.2.7"), ("socks5h", "elements.example")] {
        let url = format!("https://{host}:{server}/own.json");
        let address = format!("{scheme}://127.0.0.1:{}", proxy.port);
        let environment = [("ALL_PROXY", &*address), ("SSL_CERT_FILE", &*authority)];
        assert_eq!(fetched(&url, &environment), Ok(OBJECTS), "{scheme}");
        assert_eq!(proxy.targets(), [format!("{host}:{server}")]);
    }
}

#[test]
fn an_http_proxy_leads_to_other_computers() {
    let server = serve_elements();
    let proxy = Proxy::http(server);
    let authority = authority();
    let url = format!("https://elements.example:{server}/own.json");
    let address = format!("http://127.0.0.1:{}", proxy.port);
    for variable in ["HTTPS_PROXY", "https_proxy", "ALL_PROXY"] {
        let environment = [(variable, &*address), ("SSL_CERT_FILE", &*authority)];
        assert_eq!(fetched(&url, &environment), Ok(OBJECTS), "{variable}");
        assert_eq!(proxy.targets(), [format!("elements.example:{server}")]);
    }
}

/// Azel takes 0.0.0.0 for another computer, and Linux connects it to this one. The test therefore
/// needs no name server.
#[cfg(target_os = "linux")]
#[test]
fn no_proxy_names_hosts_that_are_reached_without_one() {
    let server = serve_elements();
    let authority = authority();
    let url = format!("https://0.0.0.0:{server}/own.json");
    for (proxy, scheme) in [(Proxy::socks(server), "socks5"), (Proxy::http(server), "http")] {
        let address = format!("{scheme}://127.0.0.1:{}", proxy.port);
        for (hosts, is_led) in [("elements.example", true), ("elements.example, 0.0.0.0", false)] {
            let environment =
                [("ALL_PROXY", &*address), ("NO_PROXY", hosts), ("SSL_CERT_FILE", &*authority)];
            assert_eq!(fetched(&url, &environment), Ok(OBJECTS), "{scheme}, {hosts}");
            assert_eq!(!proxy.targets().is_empty(), is_led, "{scheme}, {hosts}");
        }
    }
}

#[test]
fn a_proxy_that_does_not_answer_is_named_without_its_log_in() {
    // No proxy listens on port 1.
    let environment = [("ALL_PROXY", "http://op:word@127.0.0.1:1")];
    let problem = fetched("https://elements.example/own.json", &environment).unwrap_err();
    let FetchProblem::Unreachable(why) = &problem else { panic!("{problem}") };
    assert!(why.contains("through the proxy 127.0.0.1:1"), "{why}");
    assert!(!why.contains("word"), "{why}");
}

#[test]
fn a_server_on_this_computer_is_reached_without_a_proxy() {
    let server = serve_elements();
    let proxy = Proxy::http(server);
    let url = format!("https://127.0.0.1:{server}/own.json");
    let address = format!("http://127.0.0.1:{}", proxy.port);
    let authority = authority();
    let environment = [("ALL_PROXY", &*address), ("SSL_CERT_FILE", &*authority)];
    assert_eq!(fetched(&url, &environment), Ok(OBJECTS));
    assert!(proxy.targets().is_empty());
}

/// Environment variable with the port of the FTP server, for the child process of a test.
const FTP_PORT: &str = "AZEL_TEST_FTP_PORT";

/// Starts an FTP server that wants TLS (RFC 4217) and refuses every log-in. Returns its port.
fn serve_ftp() -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    let config = tls();
    let answer = move |mut stream: TcpStream| -> io::Result<()> {
        stream.write_all(b"220 ready\r\n")?;
        let mut line = String::new();
        BufReader::new(stream.try_clone()?).read_line(&mut line)?;
        stream.write_all(b"234 TLS\r\n")?;
        let connection = ServerConnection::new(config.clone()).map_err(io::Error::other)?;
        let mut stream = BufReader::new(StreamOwned::new(connection, stream));
        line.clear();
        while stream.read_line(&mut line)? > 0 {
            let answer = if line.starts_with("PBSZ") || line.starts_with("PROT") {
                "200 well\r\n"
            } else {
                "530 no\r\n"
            };
            stream.get_mut().write_all(answer.as_bytes())?;
            line.clear();
        }
        Ok(())
    };
    spawn("ftp", move || {
        for stream in listener.incoming().map_while(Result::ok) {
            // Ignore errors: a client that rejects the certificate leaves early.
            let _ = answer(stream);
        }
    });
    port
}

/// Each process reads the authorities only once, so the test fetches in a child process.
#[test]
fn ftp_with_tls_trusts_the_authorities_of_ssl_cert_file() {
    if let Ok(port) = std::env::var(FTP_PORT) {
        return ftp_is_trusted(port.parse().unwrap());
    }
    let port = serve_ftp().to_string();
    for (is_trusted, file) in [(true, Some(authority())), (false, None)] {
        let mut process = Command::new(std::env::current_exe().unwrap());
        process.env_remove("SSL_CERT_FILE").env_remove("SSL_CERT_DIR").env(FTP_PORT, &port);
        process.envs(file.map(|file| ("SSL_CERT_FILE", file)));
        let name = "network_environment::ftp_with_tls_trusts_the_authorities_of_ssl_cert_file";
        let output = process.args(["--exact", name]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.success(), is_trusted, "{said}");
        assert!(is_trusted || said.contains("UnknownIssuer"), "{said}");
    }
}

/// Checks that a fetch gets as far as the log-in.
fn ftp_is_trusted(port: u16) {
    let source = ElementSource::Server {
        peer: Peer { host: "localhost".to_owned(), port },
        protocol: FileProtocol::FtpTls,
        user: "op".to_owned(),
        password: "word".into(),
        file: "own.tle".to_owned(),
    };
    let known_hosts = transfer::KnownHosts::new("/nowhere/known_hosts");
    let trust = transfer::Trust { known_hosts, own_authorities: Vec::new() };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let (limits, cancel) = (transfer::Limits::default(), CancellationToken::new());
    let error = runtime.block_on(transfer::fetch(&source, &trust, limits, &cancel)).unwrap_err();
    let is_refused =
        matches!(&error, FetchError::Connect(transfer::ConnectError::LoginRefused { .. }));
    assert!(is_refused, "{error}");
}
