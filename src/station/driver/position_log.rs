//! Log of the last measured positions of one antenna. The session writes positions and the record
//! reads the new ones; neither waits longer than a copy of a few numbers takes.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use crate::device::Measured;

/// Max number of stored positions: nearly a quarter of an hour at ten a second. A power of two, to
/// which a `VecDeque` grows.
const MAX: usize = 8192;

/// Log of one antenna, shared by its session and its readers. Numbers count from 0 without gaps.
#[derive(Debug, Clone, Default)]
pub struct PositionLog(Arc<Mutex<Ring>>);

#[derive(Debug, Default)]
struct Ring {
    positions: VecDeque<Measured>,
    next: u64,
}

impl PositionLog {
    /// Adds a position unless it equals the last position.
    pub(crate) fn push(&self, measured: Measured) {
        let mut ring = self.ring();
        if ring.positions.back().is_some_and(|last| last.received == measured.received) {
            return;
        }
        ring.next += 1;
        // Remove first, so that the memory never exceeds `MAX` positions.
        if ring.positions.len() == MAX {
            ring.positions.pop_front();
        }
        ring.positions.push_back(measured);
    }

    /// Returns the positions from `number` on, oldest first, and the number of the first returned
    /// position. That number exceeds `number` if older positions are gone.
    pub fn read_from(&self, number: u64) -> (u64, Vec<Measured>) {
        let ring = self.ring();
        let oldest = ring.next - ring.positions.len() as u64;
        let skip = usize::try_from(number.saturating_sub(oldest)).unwrap_or(usize::MAX);
        (number.max(oldest), ring.positions.iter().skip(skip).copied().collect())
    }

    /// Returns `true` if both logs belong to the same session.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    fn ring(&self) -> MutexGuard<'_, Ring> {
        // A position is whole or absent, even after a panic of a thread.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use jiff::Timestamp;

    use super::*;
    use crate::{
        clock::Instant,
        device::{Axis, AxisMotion, Drive, Pointing},
    };

    fn positions(count: usize) -> impl Iterator<Item = Measured> {
        let mut received = Instant::now();
        std::iter::repeat_with(move || {
            received += Duration::from_millis(100);
            let axis = Axis {
                angle_deg: Some(1.0),
                motion: AxisMotion::Still,
                drive: Drive::Off,
                plus_limit: false,
                minus_limit: false,
            };
            Measured {
                time: Timestamp::UNIX_EPOCH,
                requested: received,
                received,
                pointing: Pointing { azimuth: None, elevation: None },
                axes: [axis; 2],
            }
        })
        .take(count)
    }

    #[test]
    fn a_reader_gets_each_position_once_and_in_order() {
        let log = PositionLog::default();
        for measured in positions(3) {
            log.push(measured);
            log.push(measured);
        }
        let (first, read) = log.read_from(1);
        assert_eq!((first, read.len()), (1, 2));
        assert!(read[0].received < read[1].received);
        assert_eq!(log.read_from(3), (3, Vec::new()));
    }

    #[test]
    fn a_reader_learns_how_many_positions_it_has_missed() {
        let log = PositionLog::default();
        positions(MAX + 5).for_each(|measured| log.push(measured));
        let (first, read) = log.read_from(2);
        assert_eq!((first, read.len()), (5, MAX));
    }
}
