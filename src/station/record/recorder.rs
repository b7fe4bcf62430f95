//! Station's side of its record.

use std::{
    io,
    path::PathBuf,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use tokio::runtime::Handle;

use super::{
    Entry, PassNote, Picture,
    intake::{Order, RecordedSession, Shared, locked},
    writer::Writer,
};
use crate::{clock::Clock, contract::record::Status, job, station::Retention};

/// Max number of orders that wait for the writer. A turn of the station makes about ten.
const ORDERS: usize = 4096;
/// Timeout for the last write when the station ends.
const FAREWELL: Duration = Duration::from_secs(2);

/// Recorder of a station. Dropping it writes pending data.
pub struct Recorder {
    /// Channel to the writer; `None` once the recorder ends.
    orders: Option<mpsc::SyncSender<Order>>,
    shared: Arc<Shared>,
    ended: mpsc::Receiver<()>,
    /// `true` if the last picture was dropped for lack of room.
    is_cut: AtomicBool,
    /// `true` if the station's time stops during a write, as in a rehearsal.
    is_in_place: bool,
}

impl Recorder {
    /// Starts recording into the file at `path` on its own thread. The recorder keeps retrying a
    /// file that cannot be written.
    pub fn start(path: PathBuf, clock: Clock, keeping: Retention) -> io::Result<Self> {
        let (orders, inbox) = mpsc::sync_channel(ORDERS);
        let (tell_ended, ended) = mpsc::sync_channel(1);
        let shared = Arc::new(Shared {
            status: Mutex::new(Status { path, ..Status::default() }),
            begun: Mutex::default(),
            keeping: Mutex::new(keeping),
            turned_away: AtomicU64::default(),
            not_filmed: AtomicU64::default(),
        });
        let writer = Writer::new(clock, Arc::clone(&shared));
        // Enter the station's runtime: the writer uses its time, which may be paused.
        let runtime = Handle::try_current();
        thread::Builder::new().name("azel-record".to_owned()).spawn(move || {
            let _entered = runtime.as_ref().map(Handle::enter);
            writer.run(&inbox);
            let _ = tell_ended.send(());
        })?;
        let is_in_place = job::is_in_place();
        Ok(Self { orders: Some(orders), shared, ended, is_cut: AtomicBool::default(), is_in_place })
    }

    /// Records an entry. An entry without room is dropped and counted.
    pub fn note(&self, entry: Entry) {
        self.order(Order::Entry(Box::new(entry)));
    }

    /// Records a pass. A pass without room is dropped and counted.
    pub fn note_pass(&self, pass: PassNote) {
        self.order(Order::Pass(Box::new(pass)));
    }

    /// Films a picture. A picture without room is dropped and counted.
    pub fn film(&self, picture: Arc<dyn Picture>) {
        let is_after_cut = self.is_cut.load(Ordering::Relaxed);
        let has_room = self.order(Order::Picture { picture, is_after_cut });
        self.is_cut.store(!has_room, Ordering::Relaxed);
        if self.is_in_place {
            self.flush();
        }
    }

    /// Queues an order. Returns `false` if there is no room.
    fn order(&self, order: Order) -> bool {
        let Some(orders) = &self.orders else { return false };
        let Err(mpsc::TrySendError::Full(order)) = orders.try_send(order) else { return true };
        let missed = match order {
            Order::Picture { .. } => &self.shared.not_filmed,
            _ => &self.shared.turned_away,
        };
        missed.fetch_add(1, Ordering::Relaxed);
        false
    }

    /// Records a session from its start: its lines and measured positions.
    pub fn follow(&self, session: RecordedSession) {
        locked(&self.shared.begun).push(session);
    }

    /// Sets the retention of the record's parts.
    pub fn keep(&self, keeping: Retention) {
        *locked(&self.shared.keeping) = keeping;
    }

    pub fn status(&self) -> Status {
        locked(&self.shared.status).clone()
    }

    /// Waits until all queued data is written or has failed.
    pub fn flush(&self) {
        let (done, wait) = mpsc::sync_channel(1);
        if let Some(orders) = &self.orders
            && orders.send(Order::Flush(done)).is_ok()
        {
            // A writer that broke down drops its sender, which ends this wait.
            let _ = wait.recv();
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.orders = None;
        if self.ended.recv_timeout(FAREWELL).is_err() {
            tracing::error!("the last seconds are not in the record: the disk takes too long");
        }
    }
}
