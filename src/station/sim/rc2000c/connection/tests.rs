//! Tests with a client on an in-memory stream, in paused time.

mod line;
mod motion;
mod tracking;

use tokio::{io::AsyncReadExt, time::sleep};

use super::*;
use crate::protocol::rc2000c::{
    AutoMove, Motion, Query, ReplyError, Request, SatelliteName, Status,
};
use crate::sim::harness::testing;
use crate::sim::rc2000c::Options;

type Client = testing::Client<Decoder>;

impl Client {
    fn attached(control: &Control) -> Self {
        Self::connect(control, Decoder::new(Address::FACTORY), Decoder::push)
    }

    fn new() -> (Self, Control) {
        let control = Control::new(&Options::default());
        (Self::attached(&control), control)
    }

    async fn send(&mut self, request: Request) {
        self.write(&request.to_bytes(Address::FACTORY)).await;
    }

    async fn ask(&mut self, request: Request) -> Reply {
        self.send(request).await;
        Reply::parse(&self.receive().await.unwrap().unwrap()).unwrap()
    }

    /// Sends the raw characters of a command, and adds the checksum.
    async fn ask_raw(&mut self, command: &[u8]) -> Option<Reply> {
        let mut bytes = command.to_vec();
        bytes.push(checksum(command));
        self.write(&bytes).await;
        self.receive().await.map(|frame| Reply::parse(&frame.unwrap()).unwrap())
    }

    async fn status_after(&mut self, request: Request) -> Status {
        match self.ask(request).await {
            Reply::Status { command, status } => {
                assert_eq!(command, request.command());
                status
            }
            other => panic!("{request:?}: {other:?}"),
        }
    }

    async fn status(&mut self) -> Status {
        self.status_after(Request::Query(Query::Status)).await
    }

    async fn refused(&mut self, request: Request) {
        let code = request.command().code();
        assert_eq!(self.ask(request).await, Reply::Refused { code }, "{request:?}");
    }
}

fn to_satellite(name: &str) -> Request {
    let name = SatelliteName::new(name).unwrap();
    Request::Motion(Motion::AutoMove(AutoMove::satellite(name, None).unwrap()))
}

fn to_position(az_counts: u16, el_counts: u16) -> Request {
    Request::Motion(Motion::AutoMove(AutoMove::position(az_counts, el_counts)))
}

async fn seconds(seconds: f64) {
    sleep(Duration::try_from_secs_f64(seconds).unwrap()).await;
}
