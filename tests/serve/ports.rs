//! Programs of this computer that point antennas through real sockets.

use std::{
    io::{Read as _, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    process::Command as Process,
    time::Duration,
};

use azel::{
    contract::{
        Command,
        control::{Party, PortState},
    },
    engine::{Client, Handle},
    station::{NetworkPort, Station},
};

use super::{ANY_PORT, Units, id, is_measured, named, wait_for};

/// Adds a network port for the Satrak to the station.
fn open_port(station: &mut Station, listen: SocketAddr, allowed: &[&str]) {
    let allowed = allowed.iter().map(|address| address.parse().unwrap()).collect();
    let antenna = station.antennas[0].id;
    station.network_ports.push(NetworkPort { antenna, listen, allowed });
}

fn listening(client: &Client) -> SocketAddr {
    wait_for("the port", || match &named(&client.snapshot(), "Dish").control.port {
        PortState::Listening(address) => Some(*address),
        PortState::Closed | PortState::Failed(_) => None,
    })
}

fn ask(stream: &mut TcpStream, line: &str) -> String {
    stream.write_all(format!("{line}\n").as_bytes()).unwrap();
    let mut buffer = [0; 256];
    let count = stream.read(&mut buffer).unwrap();
    String::from_utf8(buffer[..count].to_vec()).unwrap()
}

#[test]
fn a_program_that_asks_is_named_and_points_once_control_is_handed_over() {
    let units = Units::start(|station| open_port(station, ANY_PORT.into(), &[]));
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    wait_for("the Satrak", || is_measured(client, "Dish"));
    let mut stream = TcpStream::connect(listening(client)).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    assert_eq!(ask(&mut stream, "P 100 40"), "RPRT -9\n");
    let program = wait_for("the request", || {
        let snapshot = client.snapshot();
        let asking = named(&snapshot, "Dish").control.clients.first()?.clone();
        asking.asks_since.map(|_| asking)
    });
    assert_eq!(program.address, stream.local_addr().unwrap());
    if cfg!(target_os = "linux") {
        let own = std::fs::read_to_string("/proc/self/comm").unwrap();
        assert_eq!(program.program.as_deref(), Some(own.trim()));
    }
    let antenna = id(client, "Dish");
    let hand_over = Command::HandOver { antenna, client: program.address, always: true };
    client.send(hand_over).unwrap();
    wait_for("control", || {
        let party = named(&client.snapshot(), "Dish").control.party;
        (party == Some(Party::Program(program.address))).then_some(())
    });
    assert_eq!(ask(&mut stream, "P 100 40"), "RPRT 0\n");
    wait_for("motion", || (!units.all_stand()).then_some(()));
    // Azel saves the decision in the station file.
    let file = std::fs::read_to_string(units.path()).unwrap();
    assert!(file.contains("allowed = [\"127.0.0.1\"]"), "{file}");
    drop(stream);
    wait_for("nobody in control", || {
        named(&client.snapshot(), "Dish").control.party.is_none().then_some(())
    });
}

#[test]
fn a_port_that_another_program_has_is_told_and_tried_again() {
    let other = TcpListener::bind(SocketAddr::from(ANY_PORT)).unwrap();
    let taken = other.local_addr().unwrap();
    let units = Units::start(|station| open_port(station, taken, &[]));
    let (station, _wake, _woken) = units.open();
    wait_for("the failure", || {
        let snapshot = station.client().snapshot();
        matches!(named(&snapshot, "Dish").control.port, PortState::Failed(_)).then_some(())
    });
    drop(other);
    assert_eq!(listening(station.client()), taken);
}

#[test]
fn the_port_belongs_to_the_azel_that_drives_the_antenna() {
    let units = Units::start(|station| open_port(station, ANY_PORT.into(), &[]));
    let (first, _wake, _woken) = units.open();
    let (second, _second_wake, _second_woken) = units.open();
    listening(first.client());
    wait_for("the other Azel", || {
        named(&second.client().snapshot(), "Dish").held_by.is_some().then_some(())
    });
    let port = |station: &Handle| named(&station.client().snapshot(), "Dish").control.port.clone();
    assert_eq!(port(&second), PortState::Closed);
    drop(first);
    listening(second.client());
}

#[test]
#[ignore = "needs Hamlib's rotctl"]
fn hamlibs_rotctl_points_an_antenna() {
    let units = Units::start(|station| open_port(station, ANY_PORT.into(), &["127.0.0.1"]));
    let (station, _wake, _woken) = units.open();
    let client = station.client();
    wait_for("the Satrak", || is_measured(client, "Dish"));
    let address = listening(client).to_string();
    let rotctl = |commands: &[&str]| {
        let mut rotctl = Process::new("rotctl");
        let output = rotctl.args(["-m", "2", "-r", &address]).args(commands).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{commands:?}: {output:?}");
        text
    };
    assert_eq!(rotctl(&["_"]).trim(), "Dish");
    let measured = || {
        let pointing = named(&client.snapshot(), "Dish").snapshot.state.measured?.pointing;
        Some((pointing.azimuth?.degrees(), pointing.elevation?.degrees()))
    };
    rotctl(&["P", "100", "40"]);
    wait_for("the target", || {
        let (azimuth_deg, elevation_deg) = measured()?;
        ((azimuth_deg - 100.0).abs() < 1.0 && (elevation_deg - 40.0).abs() < 1.0).then_some(())
    });
    let shown: Vec<f64> =
        (rotctl(&["p"]).split_whitespace()).filter_map(|word| word.parse().ok()).collect();
    assert!((shown[0] - 100.0).abs() < 1.0 && (shown[1] - 40.0).abs() < 1.0, "{shown:?}");
    rotctl(&["K"]);
    wait_for("the way to park", || (!units.all_stand()).then_some(()));
    rotctl(&["S"]);
    wait_for("standstill", || units.all_stand().then_some(()));
}
