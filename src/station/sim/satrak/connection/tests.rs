//! Tests with a client on an in-memory stream, in paused time.

mod line;
mod motion;
mod tracking;

use std::{collections::BTreeMap, time::Duration};

use jiff::Timestamp;
use tokio::{
    io::AsyncReadExt,
    time::{Instant, sleep},
};

use super::*;
use crate::astro::{Angle, AzEl, Site, time};
use crate::orbit::{Elements, Pass, PassSearch, Propagator, passes, read_elements};
use crate::protocol::satrak::{
    FaultKind, Frame, GpsData, Oddity, Reply as Said, ReplyError, Status, TrackState, UnitTime,
};
use crate::sim::harness::testing;
use crate::sim::satrak::Options;

/// Published elements of the ISS from 2008.
const ISS: &str = "ISS (ZARYA)
1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927
2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537
";

fn site() -> Site {
    Site::new(41.01, 29.17, 100.0).unwrap()
}

fn iss() -> Elements {
    read_elements(ISS).elements.remove(0)
}

fn options(utc_origin: Timestamp) -> Options {
    Options {
        elements: BTreeMap::from([("stations.txt".to_owned(), vec![iss()])]),
        ..Options::new(site(), utc_origin)
    }
}

fn some_day() -> Timestamp {
    "2026-03-17T16:43:00Z".parse().unwrap()
}

type Client = testing::Client<Decoder>;

impl Client {
    fn attached(control: &Control) -> Self {
        Self::connect(control, Decoder::new(), Decoder::push)
    }

    fn new(options: &Options) -> (Self, Control) {
        let control = Control::new(options);
        (Self::attached(&control), control)
    }

    async fn send(&mut self, payload: &str) {
        self.write(&encode(payload)).await;
    }

    async fn ask(&mut self, payload: &str) -> Frame {
        self.send(payload).await;
        self.receive().await.unwrap().unwrap()
    }

    async fn reply(&mut self, payload: &str) -> Said {
        Said::parse(&self.ask(payload).await).unwrap().reply
    }

    async fn done(&mut self, payload: &str) {
        assert_eq!(self.reply(payload).await, Said::Done, "{payload}");
    }

    async fn refused(&mut self, payload: &str, code: &str) {
        assert_eq!(self.reply(payload).await, Said::Refused { code: code.into() }, "{payload}");
    }

    async fn status(&mut self) -> Status {
        match self.reply("STATUS?").await {
            Said::Status(status) => status,
            other => panic!("{other:?}"),
        }
    }

    async fn raw(&mut self, payload: &str) -> String {
        self.send(payload).await;
        let mut buffer = [0; 512];
        let count = self.stream.read(&mut buffer).await.unwrap();
        String::from_utf8(buffer[..count].to_vec()).unwrap()
    }
}

async fn seconds(seconds: u64) {
    sleep(Duration::from_secs(seconds)).await;
}
