//! Connections of all ports, for the station. A line changes only its connection's entry, so any
//! number of lines causes no work for the station.

use std::{
    net::SocketAddr,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use tokio::sync::Notify;

use super::MAX_CONNECTIONS;
use crate::{clock::Instant, job::Wake, station::AntennaId};

/// Min silence after which a connection makes room for a new one at a full port.
const MAKES_ROOM: Duration = Duration::from_mins(1);

/// Connection of a port.
#[derive(Clone)]
pub(in crate::engine) struct Entry {
    number: u64,
    pub(in crate::engine) antenna: AntennaId,
    pub(in crate::engine) peer: SocketAddr,
    pub(in crate::engine) program: Option<String>,
    pub(in crate::engine) last_line: Option<(String, Instant)>,
    /// Time of the last line, or of the start.
    heard: Instant,
    end: Arc<Notify>,
}

/// List of connections.
#[derive(Clone)]
pub(in crate::engine) struct Board {
    entries: Arc<Mutex<Vec<Entry>>>,
    numbers: Arc<AtomicU64>,
    wake: Wake,
}

impl Board {
    /// Creates an empty board, which calls `wake` when a connection begins or ends.
    pub(in crate::engine) fn new(wake: Wake) -> Self {
        Self { entries: Arc::default(), numbers: Arc::default(), wake }
    }

    fn entries(&self) -> MutexGuard<'_, Vec<Entry>> {
        // No code panics while it holds this lock, so the data is valid even if poisoned.
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn wake(&self) {
        (self.wake)();
    }

    /// Returns the current connections to an antenna.
    pub(in crate::engine) fn connections(&self, antenna: AntennaId) -> Vec<Entry> {
        let entries = self.entries();
        entries.iter().filter(|entry| entry.antenna == antenna).cloned().collect()
    }

    /// Ends all connections to an antenna.
    pub(super) fn close(&self, antenna: AntennaId) {
        for entry in self.entries().iter().filter(|entry| entry.antenna == antenna) {
            entry.end.notify_one();
        }
    }

    /// Returns a place for a new connection; `None` if active connections occupy all places.
    pub(in crate::engine) fn seat(
        &self,
        antenna: AntennaId,
        peer: SocketAddr,
        program: Option<String>,
        now: Instant,
    ) -> Option<Seat> {
        let number = self.numbers.fetch_add(1, Ordering::Relaxed);
        let end = Arc::new(Notify::new());
        {
            let mut entries = self.entries();
            let others = entries.iter().filter(|entry| entry.antenna == antenna);
            if others.clone().count() >= MAX_CONNECTIONS {
                let silent = others.min_by_key(|entry| entry.heard)?;
                if now.saturating_duration_since(silent.heard) < MAKES_ROOM {
                    return None;
                }
                silent.end.notify_one();
                let silent = silent.number;
                entries.retain(|entry| entry.number != silent);
            }
            let end = Arc::clone(&end);
            let entry = Entry { number, antenna, peer, program, last_line: None, heard: now, end };
            entries.push(entry);
        }
        self.wake();
        Some(Seat { board: self.clone(), number, antenna, peer, end })
    }
}

/// Place of one connection. Dropping it removes the connection from the board.
pub(in crate::engine) struct Seat {
    board: Board,
    number: u64,
    pub(super) antenna: AntennaId,
    pub(super) peer: SocketAddr,
    end: Arc<Notify>,
}

impl Seat {
    /// Notes a line as the last one of the connection.
    pub(super) fn heard(&self, line: &str, now: Instant) {
        let mut entries = self.board.entries();
        if let Some(entry) = entries.iter_mut().find(|entry| entry.number == self.number) {
            entry.last_line = Some((line.to_owned(), now));
            entry.heard = now;
        }
    }

    /// Waits until the connection must end.
    pub(super) async fn ended(&self) {
        self.end.notified().await;
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.board.entries().retain(|entry| entry.number != self.number);
        self.board.wake();
    }
}
