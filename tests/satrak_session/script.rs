//! A peer with scripted answers, for cases that the simulated unit cannot play.

use std::{
    sync::{Arc, Mutex},
    time::Duration,
};

use azel::{
    clock::Instant,
    contract::driver::Event,
    driver::{AntennaHandle, Dial, Stream},
    protocol::satrak::{Decoder, encode},
};
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::sleep,
};

use super::scene::{antenna, options, session};
use crate::common::clock::TestClock;

/// A status of a unit at standstill.
pub(super) const STILL: &str = "STATUS?,0,299.49,34.35,0,0,0,0,0,0,0,0,0,0,80.0,35.0,0";

/// Replies to a payload, each after a delay in milliseconds.
pub(super) type Script = Box<dyn FnMut(&str) -> Vec<(u64, String)> + Send>;

/// A session with a scripted peer.
pub(super) struct Scripted {
    pub(super) handle: AntennaHandle,
    received: Arc<Mutex<Vec<String>>>,
    events: Vec<Event>,
}

impl Scripted {
    pub(super) fn start(script: Script) -> Self {
        let (near, far) = tokio::io::duplex(4096);
        let received = Arc::new(Mutex::new(Vec::new()));
        tokio::spawn(serve(far, script, Arc::clone(&received)));
        Self::over(near, received)
    }

    /// Starts a session with a peer that answers only the first question, with `bytes`.
    pub(super) fn raw(bytes: Vec<u8>) -> Self {
        let (near, mut far) = tokio::io::duplex(4096);
        tokio::spawn(async move {
            let mut buffer = [0; 1024];
            if far.read(&mut buffer).await.is_ok() {
                sleep(Duration::from_millis(10)).await;
                far.write_all(&bytes).await.unwrap();
            }
            // Keep the link open until the session leaves it.
            while far.read(&mut buffer).await.is_ok_and(|count| count > 0) {}
        });
        Self::over(near, Arc::default())
    }

    fn over(near: DuplexStream, received: Arc<Mutex<Vec<String>>>) -> Self {
        let mut near = Some(near);
        let dial: Dial = Box::new(move || {
            let near = near.take();
            Box::pin(async move {
                let near = near.ok_or(std::io::ErrorKind::ConnectionRefused)?;
                Ok(Box::new(near) as Box<dyn Stream>)
            })
        });
        let (session, handle) =
            session(&antenna(), dial, TestClock::new(options().utc_origin).clock());
        tokio::spawn(session.run());
        Self { handle, received, events: Vec::new() }
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

    pub(super) fn sent(&self, word: &str) -> Vec<String> {
        let received = self.received.lock().unwrap();
        received.iter().filter(|payload| payload.starts_with(word)).cloned().collect()
    }
}

async fn serve(far: DuplexStream, mut script: Script, received: Arc<Mutex<Vec<String>>>) {
    let (mut reader, writer) = tokio::io::split(far);
    let writer = Arc::new(tokio::sync::Mutex::new(writer));
    let mut decoder = Decoder::new();
    let mut buffer = [0; 1024];
    loop {
        match reader.read(&mut buffer).await {
            Ok(count) if count > 0 => decoder.push(&buffer[..count]),
            _ => return,
        }
        for frame in decoder.by_ref().flatten() {
            let payload = frame.redacted().into_owned();
            received.lock().unwrap().push(payload.clone());
            for (delay_ms, reply) in script(&payload) {
                let writer = Arc::clone(&writer);
                tokio::spawn(async move {
                    sleep(Duration::from_millis(delay_ms)).await;
                    // Ignore errors: the session may have ended by then.
                    let _ = writer.lock().await.write_all(&encode(&reply)).await;
                });
            }
        }
    }
}

/// Returns the answer of a plain unit to a payload, after 10 ms.
pub(super) fn plain(payload: &str) -> Vec<(u64, String)> {
    let reply = match payload {
        "STATUS?" => STILL.to_owned(),
        "VERSION?" => "VERSION?,CU,DU".to_owned(),
        "ERRSTATUS?" => "ERRSTATUS?,0,0,0,0,0,0,0,0,0,0,0,0".to_owned(),
        question if question.ends_with('?') => format!("{question},ERR,1"),
        order => format!("{}=,OK", order.split('=').next().unwrap_or_default()),
    };
    vec![(10, reply)]
}
