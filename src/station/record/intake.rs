//! Orders to the writer of the record, and the state that it shares with the recorder.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, atomic::AtomicU64, mpsc};

use super::{Entry, PassNote, Picture};
use crate::{
    clock::Moment,
    contract::{driver::WireLog, record::Status},
    driver::PositionLog,
    station::{AntennaId, Retention},
};

/// One order to the writer.
pub(super) enum Order {
    Entry(Box<Entry>),
    Pass(Box<PassNote>),
    Picture {
        picture: Arc<dyn Picture>,
        /// There was no room for the one before.
        is_after_cut: bool,
    },
    /// Write at once, then answer.
    Flush(mpsc::SyncSender<()>),
}

/// A session to be recorded.
pub struct RecordedSession {
    /// When it began.
    pub moment: Moment,
    pub antenna: AntennaId,
    /// Name of the antenna.
    pub name: String,
    /// Key of its make.
    pub make: &'static str,
    pub wire: WireLog,
    pub positions: PositionLog,
}

/// State that both ends share.
pub(super) struct Shared {
    pub(super) status: Mutex<Status>,
    /// Sessions that the writer does not know of yet.
    pub(super) begun: Mutex<Vec<RecordedSession>>,
    pub(super) keeping: Mutex<Retention>,
    /// Entries for which there was no room.
    pub(super) turned_away: AtomicU64,
    /// Pictures for which there was no room.
    pub(super) not_filmed: AtomicU64,
}

/// Locks what both ends share. No code panics while it holds the lock.
pub(super) fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Counts of items that could not be recorded since the last write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Missed {
    pub(super) entries: u64,
    pub(super) positions: u64,
    pub(super) frames: u64,
    pub(super) pictures: u64,
}
