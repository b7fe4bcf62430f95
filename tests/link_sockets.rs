//! Tests of links over real sockets: to a unit, to another server, and to a port without a server.

use std::{
    io::{Read as _, Write as _},
    net::{SocketAddr, TcpListener},
    sync::Arc,
    thread,
};

use azel::{
    clock::Clock,
    contract::driver::{LinkFault, LinkFinding},
    controller::SPECS,
    driver::{Outside, test_link},
    sim::satrak,
    station::{Link, Station},
};
use jiff::Timestamp;

fn loopback() -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], 0))
}

fn runtime() -> tokio::runtime::Runtime {
    tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap()
}

fn test(address: &str) -> LinkFinding {
    let antenna = SPECS[0].antenna("Dish", address);
    runtime().block_on(test_link(&antenna, &Outside::from(Clock::system()), Arc::new(())))
}

#[test]
fn a_unit_on_a_socket_is_reached() {
    let runtime = runtime();
    let options = satrak::Options::new(Station::default().site, Timestamp::now());
    let simulator = runtime.block_on(satrak::Simulator::bind(loopback(), options)).unwrap();
    let address = simulator.local_addr().unwrap().to_string();
    runtime.spawn(simulator.run());
    let finding = test(&address);
    let LinkFinding::Reached { state, .. } = finding else { panic!("{finding:?}") };
    assert!(state.identity.is_some_and(|identity| identity.contains("SATRAK")));
}

#[test]
fn a_port_without_a_server_is_refused() {
    let listener = TcpListener::bind(loopback()).unwrap();
    let address = listener.local_addr().unwrap().to_string();
    drop(listener);
    assert_eq!(test(&address), LinkFinding::NotOpened(LinkFault::Refused));
}

#[test]
fn a_stranger_is_told_by_its_first_words() {
    let listener = TcpListener::bind(loopback()).unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let stranger = thread::Builder::new().name("stranger".to_owned()).spawn(move || {
        let (mut client, _) = listener.accept().unwrap();
        client.write_all(b"SSH-2.0-OpenSSH_9.2\r\n").unwrap();
        let mut asked = Vec::new();
        client.read_to_end(&mut asked).unwrap();
        asked
    });
    let text = "SSH-2.0-OpenSSH_9.2".to_owned();
    assert_eq!(test(&address), LinkFinding::SomethingElse { text });
    let asked = stranger.unwrap().join().unwrap();
    let lines = String::from_utf8(asked).unwrap();
    assert!(lines.lines().all(|line| line.contains('?')), "only questions: {lines}");
}

#[test]
fn a_serial_port_that_is_not_there_is_told() {
    let is_line = |link| matches!(link, Link::Line { .. });
    let spec = SPECS.iter().find(|spec| is_line(spec.link)).unwrap();
    let antenna = spec.antenna("Horn", "/dev/no-such-port-as-this");
    let finding =
        runtime().block_on(test_link(&antenna, &Outside::from(Clock::system()), Arc::new(())));
    assert_eq!(finding, LinkFinding::NotOpened(LinkFault::NoSuchPort));
}
