//! A peer with scripted answers, for cases that the simulated unit cannot play.

use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::{
    clock::Instant,
    contract::driver::Event,
    controller::rotator_genius::Rotators,
    driver::{AntennaHandle, Dial, Stream},
    protocol::rotator_genius::Request,
};
use jiff::Timestamp;
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::sleep,
};

use super::rig::antenna;
use crate::common::{clock::TestClock, rig::session};

/// Replies to a command, each after a delay in milliseconds. An empty reply closes the connection.
pub(super) type Script = Box<dyn FnMut(&str) -> Vec<(u64, Vec<u8>)> + Send>;

/// A session with a scripted peer.
pub(super) struct Scripted {
    pub(super) handle: AntennaHandle,
    received: Arc<Mutex<Vec<(Instant, String)>>>,
    events: Vec<Event>,
}

impl Scripted {
    pub(super) fn start(rotators: Rotators, script: Script) -> Self {
        let (near, far) = tokio::io::duplex(4096);
        let received = Arc::new(Mutex::new(Vec::new()));
        tokio::spawn(serve(far, script, Arc::clone(&received)));
        let mut near = Some(near);
        let dial: Dial = Box::new(move || {
            let near = near.take();
            Box::pin(async move {
                let near = near.ok_or(std::io::ErrorKind::ConnectionRefused)?;
                Ok(Box::new(near) as Box<dyn Stream>)
            })
        });
        let (session, handle) =
            session(&antenna(rotators), dial, TestClock::new(Timestamp::UNIX_EPOCH).clock());
        tokio::spawn(session.run());
        Self { handle, received, events: Vec::new() }
    }

    /// Starts a session with a peer that answers only the first question, with `bytes`.
    pub(super) fn raw(bytes: &'static [u8]) -> Self {
        let mut bytes = Some(bytes);
        let script =
            move |_: &str| bytes.take().map(|bytes| (10, bytes.to_vec())).into_iter().collect();
        Self::start(Rotators::Pair, Box::new(script))
    }

    pub(super) async fn seconds(&mut self, seconds: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(seconds).unwrap();
        while Instant::now() < end {
            sleep(Duration::from_millis(10)).await;
            self.events.extend(std::iter::from_fn(|| self.handle.next_event()));
        }
    }

    pub(super) fn events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    pub(super) fn sent(&self) -> Vec<String> {
        self.received.lock().unwrap().iter().map(|(_, command)| command.clone()).collect()
    }

    /// Returns all commands received except questions.
    pub(super) fn orders(&self) -> Vec<String> {
        self.sent().into_iter().filter(|command| command != "|h").collect()
    }

    /// Returns the times at which the peer received this command.
    pub(super) fn times(&self, command: &str) -> Vec<Instant> {
        let received = self.received.lock().unwrap();
        received.iter().filter(|(_, other)| other == command).map(|(at, _)| *at).collect()
    }
}

async fn serve(
    far: DuplexStream,
    mut script: Script,
    received: Arc<Mutex<Vec<(Instant, String)>>>,
) {
    let (mut reader, writer) = tokio::io::split(far);
    let writer = Arc::new(tokio::sync::Mutex::new(writer));
    let mut pending = Vec::new();
    let mut buffer = [0; 1024];
    loop {
        match reader.read(&mut buffer).await {
            Ok(count) if count > 0 => pending.extend(&buffer[..count]),
            _ => return,
        }
        while let Some(length) = pending.get(1).and_then(|letter| Request::length(*letter))
            && pending.len() >= length
        {
            let command: String = pending.drain(..length).map(char::from).collect();
            received.lock().unwrap().push((Instant::now(), command.clone()));
            for (delay_ms, reply) in script(&command) {
                let writer = Arc::clone(&writer);
                tokio::spawn(async move {
                    sleep(Duration::from_millis(delay_ms)).await;
                    let mut writer = writer.lock().await;
                    // Ignore errors: the session may have ended by then.
                    let _ = if reply.is_empty() {
                        writer.shutdown().await
                    } else {
                        writer.write_all(&reply).await
                    };
                });
            }
        }
    }
}

/// Returns a wide status of a pair, azimuth before elevation: whole degrees, directions of the
/// drives, and the limit byte of the first rotator.
pub(super) fn status(azimuth: u16, elevation: u16, moving: [char; 2], limit: char) -> Vec<u8> {
    let [one, two] = moving;
    let text = format!(
        "|h2\0{azimuth:>3}359  0A{one}   0999999{limit}Tower       \
         {elevation:>3} 90  0E{two}   0999999\0Elevation   "
    );
    text.chars().map(|c| u8::try_from(c).unwrap()).collect()
}

/// Returns the answer of a plain unit to a command, after 10 ms.
pub(super) fn plain(command: &str) -> Vec<(u64, Vec<u8>)> {
    let reply = match command.get(1..2) {
        Some("h") => status(100, 10, ['0', '0'], '\0'),
        Some(letter) => format!("|{letter}K").into_bytes(),
        None => return Vec::new(),
    };
    vec![(10, reply)]
}
