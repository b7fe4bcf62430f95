//! Metrics through real sockets, and Prometheus.

use std::{
    fs,
    io::{Read as _, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    path::Path,
    process::{Child, Command as Process, Stdio},
    time::{Duration, Instant},
};

use azel::{
    contract::{
        alarms::{Alarm, AlarmKind},
        control::PortState,
    },
    engine::Client,
    sim::satrak,
    station::{MetricsPort, Station},
};

use super::{ANY_PORT, Served, Units, is_measured, wait_for};

/// Sets the port for metrics of a station.
fn open_port(station: &mut Station, listen: impl Into<SocketAddr>) {
    station.metrics = Some(MetricsPort { listen: listen.into(), ..MetricsPort::default() });
}

fn listening(client: &Client) -> SocketAddr {
    wait_for("the port", || match client.snapshot().metrics {
        PortState::Listening(address) => Some(address),
        PortState::Closed | PortState::Failed(_) => None,
    })
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    stream
}

/// Sends bytes and returns the whole response.
fn ask(address: SocketAddr, request: &[u8]) -> String {
    let mut stream = connect(address);
    stream.write_all(request).unwrap();
    let mut response = String::new();
    stream.read_to_string(&mut response).unwrap();
    response
}

fn scrape(address: SocketAddr) -> String {
    let response = ask(address, b"GET /metrics HTTP/1.1\r\nHost: azel\r\n\r\n");
    assert!(response.starts_with("HTTP/1.1 200 OK\r\n"), "{response}");
    assert!(response.ends_with("# EOF\n"), "{response}");
    response
}

#[test]
fn metrics_are_off_by_default() {
    let units = Units::start(|_| {});
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    wait_for("the dish", || is_measured(client, "Dish"));
    assert_eq!(client.snapshot().metrics, PortState::Closed);
}

#[test]
fn a_flood_of_scrapes_gets_one_text_a_second() {
    let units = Units::start(|station| open_port(station, ANY_PORT));
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    wait_for("the dish", || is_measured(client, "Dish"));
    let address = listening(client);
    assert!(address.ip().is_loopback());
    let begun = Instant::now();
    let mut texts: Vec<String> = (0..50).map(|_| scrape(address)).collect();
    let seconds = begun.elapsed().as_secs() as usize;
    texts.dedup();
    assert!(texts.len() <= seconds + 2, "{} texts in {seconds} s", texts.len());
    assert!(texts[0].contains("\nazel_link_state{antenna=\"Dish\",make="), "{}", texts[0]);
}

#[test]
fn silent_and_garbage_clients_lock_nobody_out() {
    let units = Units::start(|station| open_port(station, ANY_PORT));
    let (station, _wake, _woken) = units.open();
    let address = listening(station.client());
    let silent: Vec<TcpStream> = (0..20).map(|_| connect(address)).collect();
    let begun = Instant::now();
    scrape(address);
    assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    let garbage = ask(address, &[0xff; 4096]);
    assert!(garbage.starts_with("HTTP/1.1 400 "), "{garbage}");
    // The oldest connections made room for the newer ones.
    let mut first = &silent[0];
    assert!(matches!(first.read(&mut [0; 1]), Ok(0) | Err(_)));
    scrape(address);
}

#[test]
fn a_port_that_another_program_has_is_reported_and_tried_again() {
    let other = TcpListener::bind(SocketAddr::from(ANY_PORT)).unwrap();
    let taken = other.local_addr().unwrap();
    let units = Units::start(|station| open_port(station, taken));
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    wait_for("the failure", || {
        matches!(client.snapshot().metrics, PortState::Failed(_)).then_some(())
    });
    wait_for("the dish", || is_measured(client, "Dish"));
    drop(other);
    assert_eq!(listening(client), taken);
    scrape(taken);
}

#[test]
fn the_network_gets_no_metrics_without_permission() {
    let units = Units::start(|_| {});
    let text = fs::read_to_string(units.path()).unwrap();
    let added = "[metrics]\nlisten = \"0.0.0.0:0\" # the office\n";
    fs::write(units.path(), format!("{text}\n{added}")).unwrap();
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    let says_so =
        |alarm: &Alarm| matches!(&alarm.kind, AlarmKind::Setting(note) if note.place == "metrics");
    wait_for("the alarm", || client.snapshot().alarms.list().iter().any(says_so).then_some(()));
    wait_for("the dish", || is_measured(client, "Dish"));
    assert_eq!(client.snapshot().metrics, PortState::Closed);
    drop(station);
    let allowed = added.replace(" # the office", "\nopen_to_network = true");
    fs::write(units.path(), format!("{text}\n{allowed}")).unwrap();
    let (station, _wake, _woken) = units.open();
    assert!(listening(station.client()).ip().is_unspecified());
}

#[test]
fn the_port_belongs_to_the_azel_that_has_the_station() {
    let units = Units::start(|station| open_port(station, ANY_PORT));
    let (first, _wake, _woken) = units.open();
    let (second, _second_wake, _second_woken) = units.open();
    listening(first.client());
    wait_for("the other Azel", || {
        let snapshot = second.client().snapshot();
        snapshot.antennas.first()?.held_by.is_some().then_some(())
    });
    assert_eq!(second.client().snapshot().metrics, PortState::Closed);
    drop(first);
    listening(second.client());
}

/// A Prometheus that scrapes one address.
struct Prometheus {
    process: Child,
    address: SocketAddr,
}

impl Prometheus {
    /// Starts Prometheus with the alert rules of this tree, which fire after a second.
    fn start(folder: &Path, target: SocketAddr) -> Self {
        let rules = include_str!("../../assets/monitoring/azel.rules.yml");
        let quick = rules.lines().map(|line| match line.trim_start() {
            wait if wait.starts_with("for: ") => line.replace(wait, "for: 1s"),
            _ => line.to_owned(),
        });
        fs::write(folder.join("azel.rules.yml"), quick.collect::<Vec<_>>().join("\n")).unwrap();
        let config = format!(
            "global: {{scrape_interval: 1s, scrape_timeout: 1s, evaluation_interval: 1s}}\n\
             rule_files: [azel.rules.yml]\n\
             scrape_configs: [{{job_name: azel, static_configs: [{{targets: [\"{target}\"]}}]}}]\n"
        );
        fs::write(folder.join("prometheus.yml"), config).unwrap();
        // Prometheus cannot report a port that it chose.
        let free = TcpListener::bind(SocketAddr::from(ANY_PORT)).unwrap();
        let address = free.local_addr().unwrap();
        drop(free);
        let process = Process::new("prometheus")
            .current_dir(folder)
            .arg("--config.file=prometheus.yml")
            .arg("--storage.tsdb.path=tsdb")
            .arg(format!("--web.listen-address={address}"))
            .stdout(Stdio::null())
            .stderr(fs::File::create(folder.join("log")).unwrap())
            .spawn()
            .expect("Debian's package prometheus");
        Self { process, address }
    }

    fn get(&self, path: &str) -> Option<serde_json::Value> {
        let mut stream = TcpStream::connect(self.address).ok()?;
        stream.set_read_timeout(Some(Duration::from_secs(5))).ok()?;
        let request = format!("GET {path} HTTP/1.0\r\n\r\n");
        stream.write_all(request.as_bytes()).ok()?;
        let mut response = String::new();
        stream.read_to_string(&mut response).ok()?;
        serde_json::from_str(response.split_once("\r\n\r\n")?.1).ok()
    }

    /// Returns the state of an alert; `None` unless it is pending or fires.
    fn alert(&self, name: &str) -> Option<String> {
        let alerts = self.get("/api/v1/alerts")?;
        let alerts = alerts["data"]["alerts"].as_array()?.clone();
        let alert = alerts.into_iter().find(|alert| alert["labels"]["alertname"] == name)?;
        alert["state"].as_str().map(str::to_owned)
    }
}

impl Drop for Prometheus {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[test]
#[ignore = "needs Prometheus"]
fn prometheus_scrapes_and_an_alert_fires_and_clears() {
    let monitoring = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/monitoring");
    for arguments in [["check", "rules", "azel.rules.yml"], ["test", "rules", "azel.test.yml"]] {
        let mut promtool = Process::new("promtool");
        let output = promtool.current_dir(&monitoring).args(arguments).output().unwrap();
        assert!(output.status.success(), "{output:?}");
    }
    let free = TcpListener::bind(SocketAddr::from(ANY_PORT)).unwrap();
    let target = free.local_addr().unwrap();
    drop(free);
    let units = Units::start(|station| open_port(station, target));
    let served = Served::start(&units);
    served.until(|line| line["antenna"] == "Dish" && line["about"] == "motion");
    let folder = tempfile::tempdir().unwrap();
    let prometheus = Prometheus::start(folder.path(), target);
    wait_for("a scrape", || {
        let found = prometheus.get("/api/v1/targets")?;
        let target = &found["data"]["activeTargets"][0];
        (target["health"] == "up" && target["lastError"] == "").then_some(())
    });
    wait_for("the azimuth", || {
        let found = prometheus.get("/api/v1/query?query=azel_azimuth_degrees")?;
        let series = found["data"]["result"].as_array()?.clone();
        series.iter().any(|sample| sample["metric"]["antenna"] == "Dish").then_some(())
    });
    let metadata = prometheus.get("/api/v1/targets/metadata?metric=azel_azimuth_degrees").unwrap();
    assert_eq!(metadata["data"][0]["unit"], "degrees", "{metadata}");
    assert_eq!(prometheus.alert("AzelLinkDown"), None);
    units.dish.set_fault(satrak::Fault::Silence, true);
    wait_for("the alert", || (prometheus.alert("AzelLinkDown")? == "firing").then_some(()));
    units.dish.set_fault(satrak::Fault::Silence, false);
    wait_for("its end", || prometheus.alert("AzelLinkDown").is_none().then_some(()));
}
