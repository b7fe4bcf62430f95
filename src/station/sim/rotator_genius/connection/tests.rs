//! Tests with a client on an in-memory stream, in paused time.

mod line;
mod motion;

use std::time::Duration;

use tokio::{io::AsyncReadExt, time::sleep};

use super::*;
use crate::protocol::rotator_genius::{
    Acknowledgement, Configuration, Decoder, Direction, Motion, Moving, Received, Reply as Said,
    Request, Rotator, RotatorKind, RotatorName, RotatorNumber, Status, WholeDegrees,
};
use crate::sim::harness::testing;
use crate::sim::rotator_genius::{Options, Quirk, RotatorOptions};

const ONE: RotatorNumber = RotatorNumber::One;
const TWO: RotatorNumber = RotatorNumber::Two;

type Client = testing::Client<Decoder>;

impl Client {
    fn attached(control: &Control) -> Self {
        Self::connect(control, Decoder::new(), Decoder::push)
    }

    fn new(options: &Options) -> (Self, Control) {
        let control = Control::new(options);
        (Self::attached(&control), control)
    }

    async fn send(&mut self, request: &Request) {
        self.write(&request.to_bytes()).await;
    }

    async fn ask(&mut self, request: Request) -> Said {
        self.send(&request).await;
        match self.receive().await {
            Some(Received::Reply(reply)) => reply,
            other => panic!("{request:?}: {other:?}"),
        }
    }

    /// Returns `true` if the unit's reply to a request accepts it.
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
            Said::Acknowledgement { request: acknowledgement, is_accepted }
                if acknowledgement == expected =>
            {
                is_accepted
            }
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

/// Returns options with an azimuth and an elevation rotator.
fn both_limits() -> Options {
    Options {
        rotators: [RotatorOptions::default(), RotatorOptions::elevation()],
        ..Options::default()
    }
}

async fn seconds(seconds: u64) {
    sleep(Duration::from_secs(seconds)).await;
}
