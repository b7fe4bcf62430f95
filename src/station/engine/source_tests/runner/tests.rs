use std::{
    io::{Read as _, Write as _},
    net::TcpListener,
    sync::mpsc,
    thread,
    time::Duration,
};

use super::*;
use crate::{
    contract::{source_tests::TestedSource, transfer::SatelliteMatch},
    orbit::{bundled, write_tle},
    transfer::{KeptFiles, KnownHosts, Limits, MemoryKeyring},
};

const NOAA_20: u32 = 43_013;

/// Returns a runner, its displayed state, and a channel that receives its wakes.
fn runner(folder: &tempfile::TempDir) -> (Runner, SourceTests, mpsc::Receiver<()>) {
    let places = Places {
        known_hosts: KnownHosts::new(folder.path().join("known_hosts")),
        kept_files: KeptFiles::new(folder.path().join("uploads")),
        keyring: Arc::new(MemoryKeyring::default()),
        session: Arc::default(),
        limits: Limits { connect: Duration::from_secs(2), ..Limits::default() },
    };
    let (send, woken) = mpsc::sync_channel(16);
    let wake: Wake = Arc::new(move || {
        // Several wakes count as one.
        let _ = send.try_send(());
    });
    (Runner::new(Some(places), Clock::system(), wake), SourceTests::default(), woken)
}

fn begin(url: String, satellite: &str) -> TestAsk {
    let source = TestedSource::Web { url };
    let (antenna, satellite) = ("Satrak".to_owned(), satellite.to_owned());
    TestAsk::Begin(Box::new(SourceOrder { antenna, source, satellite }))
}

/// Serves `body` for one request.
fn serve(body: Vec<u8>) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/weather.txt", listener.local_addr().unwrap());
    let answer = move || {
        let (mut stream, _) = listener.accept().unwrap();
        let _ = stream.read(&mut [0; 4096]).unwrap();
        let head = format!("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n", body.len());
        stream.write_all(&[head.as_bytes(), &body].concat()).unwrap();
    };
    thread::Builder::new().name("server".to_owned()).spawn(answer).unwrap();
    url
}

fn wait(runner: &mut Runner, shown: &mut SourceTests, woken: &mpsc::Receiver<()>) {
    while shown.stage == TestStage::Working {
        woken.recv_timeout(Duration::from_secs(20)).unwrap();
        runner.poll(shown);
    }
}

#[test]
fn a_source_is_seen_as_the_unit_will_see_it() {
    let folder = tempfile::tempdir().unwrap();
    let (mut runner, mut shown, woken) = runner(&folder);
    let mut body = Vec::new();
    let catalog = bundled().unwrap();
    write_tle(catalog.get(NOAA_20), &mut body).unwrap();
    runner.ask(begin(serve(body), "NOAA 20 (JPSS-1)"), &mut shown);
    assert_eq!(shown.stage, TestStage::Working);
    wait(&mut runner, &mut shown, &woken);
    let TestStage::Seen { view, .. } = &shown.stage else { panic!("{:?}", shown.stage) };
    assert!(
        matches!(&view.satellite, SatelliteMatch::Found(object) if object.catalog_number == NOAA_20)
    );
}

#[test]
fn what_is_wrong_with_a_source_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (mut runner, mut shown, woken) = runner(&folder);
    runner.ask(begin("gopher://x".to_owned(), "A"), &mut shown);
    wait(&mut runner, &mut shown, &woken);
    assert!(matches!(&shown.stage, TestStage::Failed { text, .. } if text.contains("https")));
    let mut homeless = Runner { places: None, ..runner };
    homeless.ask(begin("http://127.0.0.1/".to_owned(), "A"), &mut shown);
    assert!(matches!(&shown.stage, TestStage::Failed { text, .. } if text.contains("no folder")));
}

#[test]
fn a_test_can_be_cancelled_and_only_one_runs() {
    let folder = tempfile::tempdir().unwrap();
    let (mut runner, mut shown, woken) = runner(&folder);
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/", silent.local_addr().unwrap());
    runner.ask(begin(url, "A"), &mut shown);
    runner.ask(begin("http://127.0.0.1/other".to_owned(), "B"), &mut shown);
    assert_eq!(shown.order.as_ref().unwrap().satellite, "A");
    runner.ask(TestAsk::Cancel, &mut shown);
    wait(&mut runner, &mut shown, &woken);
    assert!(matches!(&shown.stage, TestStage::Failed { text, .. } if text.contains("cancelled")));
}
