//! Options of a simulated Rotator Genius.

use std::collections::BTreeSet;
use std::io;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::time::Duration;

use super::{Control, Fault, Quirk, Simulator, unit::RotatorGenius};
use crate::sim::{Mechanics, harness::Switches};
use crate::{
    clock::Clock,
    protocol::rotator_genius::{RotatorKind, WholeDegrees},
};

/// Options of a simulated unit.
#[derive(Debug, Clone)]
pub struct Options {
    pub rotators: [RotatorOptions; 2],
    /// Imperfections of both rotators.
    pub mechanics: Mechanics,
    /// Oddities of the unit.
    pub quirks: BTreeSet<Quirk>,
    /// Failures of the unit and its line.
    pub faults: BTreeSet<Fault>,
    /// Delay between a command and its reply, evenly distributed.
    pub reply_delay: RangeInclusive<Duration>,
    /// Max number of clients; the unit closes further connections at once.
    pub max_clients: usize,
    /// Seed of all randomness.
    pub seed: u64,
}

/// Options of a rotator at the start.
#[derive(Debug, Clone)]
pub struct RotatorOptions {
    /// Name; the unit sends 12 Latin-1 characters of it.
    pub name: String,
    pub kind: RotatorKind,
    /// Angle at the start.
    pub position: WholeDegrees,
    /// End of the travel clockwise.
    pub limit_cw: WholeDegrees,
    /// End of the travel counter-clockwise.
    pub limit_ccw: WholeDegrees,
    /// Reported "Offset", degrees, -180 to 180. The position already includes it.
    pub offset_deg: i16,
    /// Degrees before a target at which the drive switches off. From full rate, the rotator coasts
    /// 2 degrees.
    pub stop_offset_deg: u8,
    /// Full rate, degrees per second.
    pub full_rate_deg_s: f64,
    /// `true` if the rotator has a sensor; without it, the rotator cannot be moved.
    pub has_sensor: bool,
}

impl Default for Options {
    /// Returns options like the recorded units: an azimuth rotator at 173 degrees, and a second one
    /// without a sensor. One client, replies after 5 to 30 ms.
    fn default() -> Self {
        let name = "Rotator 2".to_owned();
        let second = RotatorOptions { name, has_sensor: false, ..RotatorOptions::default() };
        Self {
            rotators: [RotatorOptions::default(), second],
            mechanics: Mechanics::default(),
            quirks: BTreeSet::new(),
            faults: BTreeSet::new(),
            reply_delay: Duration::from_millis(5)..=Duration::from_millis(30),
            max_clients: 1,
            seed: 1,
        }
    }
}

impl Default for RotatorOptions {
    /// Returns an azimuth rotator at 173 degrees, with limits at 0 and 359 degrees and 4 degrees
    /// per second.
    fn default() -> Self {
        Self {
            name: "Tower".to_owned(),
            kind: RotatorKind::Azimuth,
            position: WholeDegrees::saturating(173),
            limit_cw: WholeDegrees::saturating(359),
            limit_ccw: WholeDegrees::saturating(0),
            offset_deg: 0,
            stop_offset_deg: 2,
            full_rate_deg_s: 4.0,
            has_sensor: true,
        }
    }
}

impl RotatorOptions {
    /// Returns an elevation rotator at the horizon, with limits at 0 and 90 degrees.
    pub fn elevation() -> Self {
        Self {
            name: "Elevation".to_owned(),
            kind: RotatorKind::Elevation,
            position: WholeDegrees::saturating(0),
            limit_cw: WholeDegrees::saturating(90),
            ..Self::default()
        }
    }
}

impl Control {
    /// Creates a unit that starts now, without a port: see [`Self::serve`].
    pub fn new(options: &Options) -> Self {
        Self::on_clock(options, Clock::system())
    }

    /// Creates a unit like [`Self::new`] that runs by `clock`.
    pub fn on_clock(options: &Options, clock: Clock) -> Self {
        let Options { quirks, faults, reply_delay, seed, .. } = options;
        let switches = Switches { quirks: quirks.clone(), faults: faults.clone() };
        Self::start(RotatorGenius::new(options), switches, reply_delay.clone(), *seed, clock)
    }
}

impl Simulator {
    /// Starts a unit and listens; port 0 selects a free port. A real unit uses 9006.
    pub async fn bind(address: SocketAddr, options: Options) -> io::Result<Self> {
        Self::listen(address, Control::new(&options), options.max_clients).await
    }
}

#[cfg(test)]
mod tests {
    use tokio::{
        io::{AsyncReadExt, AsyncWriteExt},
        net::TcpStream,
    };

    use super::*;
    use crate::protocol::rotator_genius::{
        Acknowledgement, Decoder, Motion, Received, Reply, Request, RotatorNumber, Status,
    };

    /// Returns the reply to a request; `None` if the unit closes the connection instead.
    async fn ask(stream: &mut TcpStream, request: Request) -> Option<Reply> {
        stream.write_all(&request.to_bytes()).await.ok()?;
        let mut decoder = Decoder::new();
        let mut buffer = [0; 256];
        loop {
            match decoder.next() {
                Some(Received::Reply(reply)) => return Some(reply),
                Some(other) => panic!("{other:?}"),
                None => {}
            }
            let count = stream.read(&mut buffer).await.ok().filter(|count| *count > 0)?;
            decoder.push(&buffer[..count]);
        }
    }

    async fn status(stream: &mut TcpStream) -> Option<Status> {
        match ask(stream, Request::Read).await? {
            Reply::Status(status) => Some(status),
            other @ Reply::Acknowledgement { .. } => panic!("{other:?}"),
        }
    }

    #[tokio::test]
    async fn a_device_on_a_socket_outlives_its_clients() {
        let no_delay = Duration::ZERO..=Duration::ZERO;
        let options = Options { reply_delay: no_delay, ..Options::default() };
        let simulator = Simulator::bind(([127, 0, 0, 1], 0).into(), options).await.unwrap();
        let address = simulator.local_addr().unwrap();
        let control = simulator.control();
        let server = tokio::spawn(simulator.run());

        let mut first = TcpStream::connect(address).await.unwrap();
        assert_eq!(status(&mut first).await.unwrap().rotators[0].name, "Tower");
        let mut second = TcpStream::connect(address).await.unwrap();
        assert_eq!(status(&mut second).await, None);

        let rotator = RotatorNumber::One;
        let target = WholeDegrees::saturating(300);
        let go_to = Request::Motion(Motion::GoTo { rotator, target });
        let acknowledgement = Acknowledgement::GoTo { target: None };
        let accepted = Reply::Acknowledgement { request: acknowledgement, is_accepted: true };
        assert_eq!(ask(&mut first, go_to).await, Some(accepted));
        drop(first);
        let served_again = async {
            loop {
                let mut client = TcpStream::connect(address).await.unwrap();
                if let Some(status) = status(&mut client).await {
                    return status;
                }
                tokio::task::yield_now().await;
            }
        };
        let status = tokio::time::timeout(Duration::from_secs(10), served_again).await.unwrap();
        assert_eq!(status.rotator(rotator).target, Some(target));
        assert_eq!(control.state().rotator(rotator).target, Some(target));

        server.abort();
        assert!(server.await.unwrap_err().is_cancelled());
        assert!(TcpStream::connect(address).await.is_err());
    }
}
