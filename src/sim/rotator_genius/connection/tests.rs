//! A client at the other end of a stream in memory, in paused time.

mod line;
mod motion;

use std::time::Duration;

use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::{sleep, timeout},
};

use super::*;
use crate::protocol::rotator_genius::{
    Acknowledgement, Configuration, Decoder, Direction, Motion, Moving, Received, Reply as Said,
    Request, Rotator, RotatorKind, RotatorName, RotatorNumber, Status, WholeDegrees,
};
use crate::sim::rotator_genius::{Options, Quirk, RotatorOptions};

const ONE: RotatorNumber = RotatorNumber::One;
const TWO: RotatorNumber = RotatorNumber::Two;

struct Client {
    stream: DuplexStream,
    decoder: Decoder,
}

impl Client {
    fn of(control: &Control) -> Self {
        let (stream, other) = tokio::io::duplex(4096);
        let control = control.clone();
        tokio::spawn(async move { control.serve(other).await });
        Self { stream, decoder: Decoder::new() }
    }

    fn new(options: &Options) -> (Self, Control) {
        let control = Control::new(options);
        (Self::of(&control), control)
    }

    async fn send(&mut self, request: &Request) {
        self.stream.write_all(&request.to_bytes()).await.unwrap();
    }

    /// The next that comes within 2 s and before the connection ends.
    async fn receive(&mut self) -> Option<Received> {
        let mut buffer = [0; 512];
        loop {
            if let Some(received) = self.decoder.next() {
                return Some(received);
            }
            let read = timeout(Duration::from_secs(2), self.stream.read(&mut buffer)).await;
            match read {
                Ok(Ok(count)) if count > 0 => self.decoder.push(&buffer[..count]),
                _ => return None,
            }
        }
    }

    async fn ask(&mut self, request: Request) -> Said {
        self.send(&request).await;
        match self.receive().await {
            Some(Received::Reply(reply)) => reply,
            other => panic!("{request:?}: {other:?}"),
        }
    }

    /// Whether the device accepts a request, in the reply that belongs to it.
    async fn accepts(&mut self, request: Request) -> bool {
        let expected = match &request {
            Request::Stop => Acknowledgement::Stop,
            Request::Motion(Motion::GoTo { .. }) => Acknowledgement::GoTo { target: None },
            Request::Motion(Motion::Rotate { direction: Direction::Clockwise, .. }) => {
                Acknowledgement::RotateClockwise
            }
            Request::Motion(Motion::Rotate { .. }) => Acknowledgement::RotateCounterClockwise,
            Request::Configure(_) => Acknowledgement::Configure,
            Request::Read => panic!("a read has no acknowledgement"),
        };
        match self.ask(request).await {
            Said::Acknowledgement { to, is_accepted } if to == expected => is_accepted,
            other => panic!("{other:?}"),
        }
    }

    async fn status(&mut self) -> Status {
        match self.ask(Request::Read).await {
            Said::Status(status) => status,
            other @ Said::Acknowledgement { .. } => panic!("{other:?}"),
        }
    }

    async fn rotator(&mut self, number: RotatorNumber) -> Rotator {
        self.status().await.rotator(number).clone()
    }
}

fn angle(degrees: u16) -> WholeDegrees {
    WholeDegrees::new(degrees).unwrap()
}

fn go_to(rotator: RotatorNumber, degrees: u16) -> Request {
    Request::Motion(Motion::GoTo { rotator, target: angle(degrees) })
}

fn rotate(rotator: RotatorNumber, direction: Direction) -> Request {
    Request::Motion(Motion::Rotate { rotator, direction })
}

/// Azimuth and elevation.
fn both() -> Options {
    Options {
        rotators: [RotatorOptions::default(), RotatorOptions::elevation()],
        ..Options::default()
    }
}

async fn seconds(seconds: u64) {
    sleep(Duration::from_secs(seconds)).await;
}
