//! Simulated RC2000C on a real socket and a real pseudo-terminal, driven with the codec
//! alone.

use std::time::Duration;

use azel::protocol::{Parity, rc2000c::*};
use azel::sim::rc2000c::{Fault, Mode, Options, Quirk, Simulator};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::time::timeout;

const PATIENCE: Duration = Duration::from_secs(20);

/// Returns options of a fast line, because these tests run in real time.
fn options() -> Options {
    Options { latency: Duration::ZERO, baud: 1_000_000, ..Options::default() }
}

/// One end of a line, with the codec.
struct Line<S> {
    stream: S,
    parity: Parity,
    decoder: Decoder,
    echoes: usize,
}

impl<S: AsyncRead + AsyncWrite + Unpin> Line<S> {
    fn new(stream: S, parity: Parity) -> Self {
        Self { stream, parity, decoder: Decoder::new(Address::FACTORY), echoes: 0 }
    }

    async fn ask(&mut self, request: Request) -> Reply {
        let mut bytes = request.to_bytes(Address::FACTORY);
        self.parity.prepare(&mut bytes);
        self.stream.write_all(&bytes).await.unwrap();
        timeout(PATIENCE, self.reply()).await.unwrap()
    }

    async fn reply(&mut self) -> Reply {
        let mut buffer = [0; 64];
        loop {
            for frame in self.decoder.by_ref().flatten() {
                match Reply::parse(&frame) {
                    Ok(reply) => return reply,
                    Err(ReplyError::Echo { .. }) => self.echoes += 1,
                    Err(error) => panic!("{error}"),
                }
            }
            let count = self.stream.read(&mut buffer).await.unwrap();
            assert!(count > 0, "the line ended");
            self.parity.check(&mut buffer[..count]);
            self.decoder.push(&buffer[..count]);
        }
    }

    async fn status(&mut self) -> Status {
        match self.ask(Request::Query(Query::Status)).await {
            Reply::Status { status, .. } => status,
            other => panic!("{other:?}"),
        }
    }

    /// Asks for the type and a stored satellite, moves there and back, and halts.
    async fn tour(&mut self) {
        let Reply::DeviceType(device) = self.ask(Request::Query(Query::DeviceType)).await else {
            panic!("no device type")
        };
        assert_eq!(device.to_string(), "2KCA 1.4");
        let first = Request::Query(Query::SatelliteName(NameIndex::new(1).unwrap()));
        let Reply::SatelliteName(entry) = self.ask(first).await else { panic!("no name") };
        assert_eq!((entry.count, entry.name.as_str()), (6, "SBS 6"));

        let near = Request::Motion(Motion::AutoMove(AutoMove::position(1540, 740)));
        let Reply::Status { command, status } = self.ask(near).await else { panic!("refused") };
        assert_eq!(command, Command::AutoMove);
        assert!(status.is_moving());
        let arrived = async {
            loop {
                let status = self.status().await;
                if !status.is_moving() {
                    return status;
                }
            }
        };
        let status = timeout(PATIENCE, arrived).await.unwrap();
        assert_eq!(status.azimuth, Position::Counts(1540));
        assert_eq!(status.elevation, Position::Counts(740));

        let jog = Jog::new(Direction::Down, Speed::Slow, MAX_JOG).unwrap();
        let Reply::Status { status, .. } = self.ask(Request::Motion(Motion::Jog(jog))).await else {
            panic!("refused")
        };
        assert_eq!(status.elevation_drive, AxisDrive::Moving(Sense::Negative));
        let Reply::Status { status, .. } = self.ask(Request::Stop).await else { panic!("refused") };
        assert!(!status.is_moving());
    }
}

#[tokio::test]
async fn over_a_raw_tcp_port() {
    let simulator = Simulator::bind(([127, 0, 0, 1], 0).into(), &options()).await.unwrap();
    let address = simulator.local_addr().unwrap();
    let control = simulator.control();
    let server = tokio::spawn(simulator.run());

    let stream = TcpStream::connect(address).await.unwrap();
    let mut line = Line::new(stream, Parity::Port);
    assert_eq!(control.state().mode, Mode::Manual);
    line.tour().await;
    assert_eq!(control.state().mode, Mode::Remote);
    control.set_quirk(Quirk::Echo, true);
    control.set_fault(Fault::Split, true);
    line.tour().await;
    assert!(line.echoes > 4);
    assert_eq!(line.decoder.skipped_bytes(), 0);

    let mut second = TcpStream::connect(address).await.unwrap();
    assert_eq!(second.read(&mut [0; 8]).await.unwrap_or(0), 0, "one master at a time");

    server.abort();
    assert!(server.await.unwrap_err().is_cancelled());
    assert!(TcpStream::connect(address).await.is_err());
}

#[cfg(unix)]
#[tokio::test]
async fn over_a_pseudo_terminal() {
    use azel::sim::rc2000c::PtySimulator;
    use serial2_tokio::SerialPort;

    // Some containers have no pseudo-terminals.
    if !std::path::Path::new("/dev/ptmx").exists() {
        return;
    }
    let simulator = PtySimulator::open(&options()).unwrap();
    let path = simulator.path().to_owned();
    let server = tokio::spawn(simulator.run());

    let mut line = Line::new(SerialPort::open(&path, 9600).unwrap(), Parity::Port);
    line.tour().await;
    drop(line);

    // The next client finds the port open, and speaks with parity.
    let mut line = Line::new(SerialPort::open(&path, 9600).unwrap(), Parity::Software);
    line.tour().await;
    assert_eq!(line.decoder.skipped_bytes(), 0);

    server.abort();
    assert!(server.await.unwrap_err().is_cancelled());
    assert!(line.stream.write_all(b"\x02").await.is_err(), "the port is gone");
}
