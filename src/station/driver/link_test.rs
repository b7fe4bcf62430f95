//! Link test: sends a unit the first queries of its controller, then disconnects.

use std::{io, sync::Arc, time::Duration};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

use super::{
    Outside, Stream, UnitLock,
    session::{CONNECT, MIN_WAIT, WRITE, error_text},
};
use crate::{
    clock::Clock,
    contract::driver::{LinkFault, LinkFinding},
    device::Device,
    station::{Antenna, Link, check_address},
};

/// Max duration of the queries.
const ASKING: Duration = Duration::from_secs(2);
/// Time after the first reply for further queries.
const MORE: Duration = Duration::from_millis(1200);
/// Max number of bytes recorded from an unknown device.
const HEARD: usize = 256;
/// Max number of displayed characters from an unknown device.
const SHOWN: usize = 40;

/// Queries the unit of `antenna` for two seconds at most; sends only queries.
pub async fn test_link(
    antenna: &Antenna,
    outside: &Outside,
    lock: Arc<dyn UnitLock>,
) -> LinkFinding {
    // This side of a controller can neither start a motion nor write a setting.
    let mut device: Box<dyn Device> = antenna.controller();
    let mut dial = (outside.dial)(antenna, lock);
    let connection = &antenna.connection;
    let is_line = matches!(connection.spec().link, Link::Line { .. });
    // The dialler of a serial server switches the parity guess after a link without any fitting
    // byte.
    let tries = if is_line && check_address(&connection.address).is_ok() { 2 } else { 1 };
    let mut finding = LinkFinding::Silent;
    for _ in 0..tries {
        finding = match outside.clock.timeout(CONNECT, dial()).await {
            Err(_) => LinkFinding::NotOpened(LinkFault::NobodyThere),
            Ok(Err(error)) => LinkFinding::NotOpened(link_fault(&error)),
            Ok(Ok(stream)) => talk(device.as_mut(), stream, &outside.clock, ASKING / tries).await,
        };
        if !matches!(finding, LinkFinding::Silent | LinkFinding::SomethingElse { .. }) {
            break;
        }
    }
    finding
}

async fn talk(
    device: &mut dyn Device,
    stream: Box<dyn Stream>,
    clock: &Clock,
    longest: Duration,
) -> LinkFinding {
    let (mut reader, mut writer) = tokio::io::split(stream);
    let (mut buffer, mut heard) = ([0; 1024], Vec::new());
    let start = clock.now();
    let mut deadline = start.steady + longest;
    let (mut sent, mut replied) = (None, None);
    let mut is_open = true;
    device.link_up(start);
    while is_open {
        let now = clock.now();
        if now.steady >= deadline {
            break;
        }
        while let Some(bytes) = device.poll(now) {
            let written = clock.timeout(WRITE, writer.write_all(&bytes)).await;
            is_open &= matches!(written, Ok(Ok(())));
            device.sent(&bytes, now);
            sent = sent.or(Some(now.steady));
        }
        let due = device.due(now).max(now.steady + MIN_WAIT).min(deadline);
        tokio::select! {
            read = reader.read(&mut buffer) => {
                let bytes = buffer.get(..read.unwrap_or(0)).unwrap_or_default();
                is_open &= !bytes.is_empty();
                heard.extend(bytes.iter().take(HEARD.saturating_sub(heard.len())));
                let now = clock.now();
                device.receive(bytes, now);
                if replied.is_none() && device.state().traffic.replies > 0 {
                    replied = Some(now.steady);
                    deadline = deadline.min(now.steady + MORE);
                }
            }
            () = clock.sleep_until(due) => {}
        }
        // This link has no reader of its wire lines.
        while device.next_wire_line().is_some() {}
    }
    // The unit may have disconnected first.
    let _ = clock.timeout(WRITE, writer.shutdown()).await;
    device.link_down(clock.now());
    match (sent, replied) {
        (Some(sent), Some(replied)) => LinkFinding::Reached {
            after: replied.saturating_duration_since(sent),
            state: Box::new(device.state().clone()),
        },
        _ if !heard.is_empty() => LinkFinding::SomethingElse { text: printable(&heard) },
        _ if is_open => LinkFinding::Silent,
        _ => LinkFinding::Closed,
    }
}

fn printable(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let is_shown = |letter: &char| letter.is_ascii_graphic() || *letter == ' ';
    let first = text.split(['\r', '\n']).map(str::trim).find(|line| !line.is_empty());
    first.unwrap_or_default().chars().filter(is_shown).take(SHOWN).collect()
}

fn link_fault(error: &io::Error) -> LinkFault {
    match error.kind() {
        io::ErrorKind::ConnectionRefused => LinkFault::Refused,
        io::ErrorKind::TimedOut
        | io::ErrorKind::HostUnreachable
        | io::ErrorKind::NetworkUnreachable => LinkFault::NobodyThere,
        io::ErrorKind::NotFound => LinkFault::NoSuchPort,
        io::ErrorKind::PermissionDenied => LinkFault::NotPermitted,
        io::ErrorKind::ResourceBusy => LinkFault::Busy,
        _ => LinkFault::Other(error_text(error)),
    }
}
