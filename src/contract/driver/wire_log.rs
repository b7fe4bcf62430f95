//! The last lines of one antenna's link. The session writes lines, and the window reads new lines.
//! The lock is held only for moving a few pointers.

use std::{
    collections::VecDeque,
    fmt,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use serde::{Deserialize, Serialize};

use crate::device::WireLine;

/// Max number of kept lines.
pub const MAX_LINES: usize = 20_000;
/// Max size of all lines together, bytes.
const MAX_BYTES: usize = 4 * 1024 * 1024;
/// Max number of lines per read, to keep the lock short.
const MAX_READ: usize = 1000;

/// A line with its number in the log. Numbers count from 0 without gaps.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recorded {
    /// Number among all lines since the start.
    pub number: u64,
    pub line: WireLine,
}

/// The log of one antenna, shared by its session and the window.
#[derive(Clone, Default)]
pub struct WireLog(Arc<Mutex<Ring>>);

/// Test that returns `true` for a line that a reader waits for.
pub type IsAwaited = Arc<dyn Fn(&Arc<Recorded>) -> bool + Send + Sync>;

#[derive(Default)]
struct Ring {
    lines: VecDeque<Arc<Recorded>>,
    bytes: usize,
    next: u64,
    /// Test of a reader who has read everything and waits for such lines.
    is_awaited: Option<IsAwaited>,
}

impl Ring {
    fn from(&self, number: u64) -> Vec<Arc<Recorded>> {
        let first = self.next - self.lines.len() as u64;
        let skip = usize::try_from(number.saturating_sub(first)).unwrap_or(usize::MAX);
        self.lines.iter().skip(skip).take(MAX_READ).cloned().collect()
    }
}

impl WireLog {
    /// Adds a line and drops the oldest lines beyond the limits. Returns `true` if a reader waits
    /// for the line.
    pub fn push(&self, line: WireLine) -> bool {
        let mut ring = self.ring();
        ring.bytes += line.bytes.len();
        let recorded = Arc::new(Recorded { number: ring.next, line });
        ring.next += 1;
        ring.lines.push_back(Arc::clone(&recorded));
        while ring.lines.len() > MAX_LINES || ring.bytes > MAX_BYTES {
            let Some(oldest) = ring.lines.pop_front() else { break };
            ring.bytes -= oldest.line.bytes.len();
        }
        let Some(is_awaited) = ring.is_awaited.clone() else { return false };
        drop(ring);
        // A reader who has read again since then already has the line.
        is_awaited(&recorded)
            && self.ring().is_awaited.take_if(|now| Arc::ptr_eq(now, &is_awaited)).is_some()
    }

    /// Returns up to 1,000 lines from `number` on, oldest first; empty without newer lines. The
    /// next line that matches `is_awaited` wakes the station.
    pub fn read_from(&self, number: u64, is_awaited: IsAwaited) -> Vec<Arc<Recorded>> {
        let mut ring = self.ring();
        let lines = ring.from(number);
        ring.is_awaited = (lines.len() < MAX_READ).then_some(is_awaited);
        lines
    }

    /// Returns the same lines, for a reader who polls and needs no wake-up.
    pub fn copy_from(&self, number: u64) -> Vec<Arc<Recorded>> {
        self.ring().from(number)
    }

    /// Returns `true` if nobody else holds the log, because its session has ended.
    pub fn is_alone(&self) -> bool {
        Arc::strong_count(&self.0) == 1
    }

    /// Returns the number of the next line.
    pub fn next_number(&self) -> u64 {
        self.ring().next
    }

    /// Returns `true` if both are the log of the same session.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    fn ring(&self) -> MutexGuard<'_, Ring> {
        // Every change of the ring is complete even if a thread panics, so a poisoned lock is
        // usable.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for WireLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WireLog").field("next", &self.next_number()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Direction, Finding};

    fn line(length: usize) -> WireLine {
        WireLine {
            time: jiff::Timestamp::UNIX_EPOCH,
            direction: Direction::Sent,
            bytes: vec![b'x'; length].into(),
            length,
            is_shortened: false,
            finding: Finding::Good,
            meaning: None,
            reply_after: None,
            is_poll: false,
        }
    }

    fn numbers(log: &WireLog, first: u64) -> Vec<u64> {
        log.copy_from(first).iter().map(|recorded| recorded.number).collect()
    }

    #[test]
    fn a_reader_gets_each_line_once_and_in_order() {
        let log = WireLog::default();
        for _ in 0..3 {
            log.push(line(1));
        }
        assert_eq!(numbers(&log, 0), [0, 1, 2]);
        assert_eq!(numbers(&log, 2), [2]);
        assert_eq!(numbers(&log, 3), [0; 0]);
        log.push(line(1));
        assert_eq!(numbers(&log, 3), [3]);
        assert_eq!(numbers(&log, 99), [0; 0]);
    }

    #[test]
    fn the_oldest_lines_go_when_there_are_too_many() {
        let log = WireLog::default();
        for _ in 0..MAX_LINES + 5 {
            log.push(line(1));
        }
        assert_eq!(numbers(&log, 0).first(), Some(&5));
        let mut next = 0;
        let mut count = 0;
        while let Some(last) = log.copy_from(next).last() {
            count += numbers(&log, next).len();
            next = last.number + 1;
        }
        assert_eq!((count, next), (MAX_LINES, MAX_LINES as u64 + 5));
    }

    #[test]
    fn the_oldest_lines_go_when_they_are_too_long() {
        let log = WireLog::default();
        let long = MAX_BYTES / 4;
        for _ in 0..5 {
            log.push(line(long));
        }
        assert_eq!(numbers(&log, 0), [1, 2, 3, 4]);
    }

    #[test]
    fn only_a_reader_who_has_read_everything_is_woken_and_once() {
        let log = WireLog::default();
        assert!(!log.push(line(1)), "nobody looks");
        log.read_from(0, Arc::new(|_| true));
        assert!(log.push(line(1)));
        assert!(!log.push(line(1)));
    }

    #[test]
    fn a_reader_is_woken_by_a_line_that_he_waits_for() {
        let log = WireLog::default();
        log.read_from(0, Arc::new(|recorded| recorded.line.length > 1));
        assert!(!log.push(line(1)));
        assert!(log.push(line(2)));
        assert!(!log.push(line(2)));
    }

    #[test]
    fn a_reader_who_comes_back_while_a_line_is_judged_is_not_woken_by_it() {
        let log = WireLog::default();
        let reads = log.clone();
        let reading = move |_: &Arc<Recorded>| {
            assert_eq!(reads.read_from(0, Arc::new(|_| true)).len(), 1);
            true
        };
        log.read_from(0, Arc::new(reading));
        assert!(!log.push(line(1)));
        assert!(log.push(line(1)));
    }
}
