//! Orders to the writer of the record, and state that the writer shares with the recorder.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, atomic::AtomicU64, mpsc};

use super::{Entry, PassNote, Picture};
use crate::{
    clock::Moment,
    contract::{driver::WireLog, record::Status},
    driver::PositionLog,
    station::{AntennaId, Retention},
};

/// Order to the writer.
pub(super) enum Order {
    Entry(Box<Entry>),
    Pass(Box<PassNote>),
    Picture {
        picture: Arc<dyn Picture>,
        /// `true` if the previous picture was dropped for lack of room.
        is_after_cut: bool,
    },
    /// Request for an immediate write and an answer.
    Flush(mpsc::SyncSender<()>),
}

/// Session to record.
pub struct RecordedSession {
    /// Start of the session.
    pub moment: Moment,
    pub antenna: AntennaId,
    /// Name of the antenna.
    pub name: String,
    /// Key of the antenna's make.
    pub make: &'static str,
    pub wire: WireLog,
    pub positions: PositionLog,
}

/// State that recorder and writer share.
pub(super) struct Shared {
    pub(super) status: Mutex<Status>,
    /// Sessions that the writer has not taken yet.
    pub(super) begun: Mutex<Vec<RecordedSession>>,
    pub(super) keeping: Mutex<Retention>,
    /// Number of entries dropped for lack of room.
    pub(super) turned_away: AtomicU64,
    /// Number of pictures dropped for lack of room.
    pub(super) not_filmed: AtomicU64,
}

/// Locks shared state. No code panics while it holds this lock, so poisoning can be ignored.
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
