//! Delivery of STOP to the processes that drive antennas of this station. One thread serves all
//! antennas; presses for one antenna coalesce until the last one is sent.

use std::{collections::BTreeMap, io, sync::Arc, thread};

use tokio::{
    runtime::Handle,
    sync::{oneshot, watch},
    task::JoinSet,
};
use tokio_util::task::TaskTracker;

use super::{
    Client,
    claim::LockFolders,
    reach::{Outcome, holders, outcome},
    socket::{Answer, Ask},
};
use crate::station::AntennaId;

/// Address of a STOP.
#[derive(Debug, Clone)]
pub(super) struct Press {
    /// Lock of the other process.
    pub(super) lock: String,
    /// Name of the antenna, if the other process has no name for it.
    pub(super) antenna: String,
}

/// Courier that delivers STOPs. After its drop, it still delivers STOPs already under way.
pub(super) struct Courier {
    folders: Arc<LockFolders>,
    client: Client,
    /// Last press for each antenna.
    presses: BTreeMap<AntennaId, watch::Sender<Press>>,
    runtime: Handle,
    deliveries: TaskTracker,
    _end: oneshot::Sender<()>,
}

impl Courier {
    pub(super) fn start(folders: LockFolders, client: Client) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let handle = runtime.handle().clone();
        let deliveries = TaskTracker::new();
        let (end, ended) = oneshot::channel::<()>();
        let at_end = deliveries.clone();
        thread::Builder::new().name("azel-stop-elsewhere".to_owned()).spawn(move || {
            runtime.block_on(async {
                // Both results mean that the courier was dropped.
                let _ = ended.await;
                at_end.close();
                at_end.wait().await;
            });
        })?;
        Ok(Self {
            folders: Arc::new(folders),
            client,
            presses: BTreeMap::new(),
            runtime: handle,
            deliveries,
            _end: end,
        })
    }

    pub(super) fn press(&mut self, antenna: AntennaId, press: Press) {
        if let Some(presses) = self.presses.get(&antenna) {
            presses.send_replace(press);
            return;
        }
        let (send, presses) = watch::channel(press);
        let delivery =
            Delivery { folders: Arc::clone(&self.folders), client: self.client.clone(), presses };
        self.deliveries.spawn_on(delivery.run(), &self.runtime);
        self.presses.insert(antenna, send);
    }
}

/// Delivery of the presses for one antenna.
struct Delivery {
    folders: Arc<LockFolders>,
    client: Client,
    presses: watch::Receiver<Press>,
}

impl Delivery {
    async fn run(mut self) {
        loop {
            let answers = self.deliver().await;
            // A new press goes out at once, and its answer then replaces the pending one.
            let is_stopped = tokio::select! {
                is_stopped = are_stopped(answers) => is_stopped,
                more = self.presses.changed() => match more {
                    Ok(()) => continue,
                    Err(_) => return,
                },
            };
            if !is_stopped {
                self.client.urgent().is_stop_lost = true;
            }
            if self.presses.changed().await.is_err() {
                return;
            }
        }
    }

    /// Sends STOP to each holder of the lock, and returns the pending answers.
    async fn deliver(&mut self) -> JoinSet<Outcome> {
        let Press { lock, antenna } = self.presses.borrow_and_update().clone();
        let mut answers = JoinSet::new();
        for holder in holders(&self.folders, &lock).await {
            let name = holder.antenna().unwrap_or(&antenna).to_owned();
            let ask = Ask::Stop { antenna: Some(name) };
            let delivered = holder.deliver(&ask).await;
            answers.spawn(async { outcome(Some(holder), ask, delivered).await.outcome });
        }
        answers
    }
}

/// Returns `true` if there is an answer and every answer proves standstill.
async fn are_stopped(answers: JoinSet<Outcome>) -> bool {
    let outcomes = answers.join_all().await;
    let is_proved = |outcome: &Outcome| match outcome {
        Outcome::Answered(Answer::Stopped(stopped)) => stopped.iter().all(|stopped| stopped.proved),
        Outcome::Answered(
            Answer::Status(_)
            | Answer::Automatic { .. }
            | Answer::LockOut { .. }
            | Answer::Refused(_),
        )
        | Outcome::Signalled
        | Outcome::NotReached(_) => {
            tracing::error!(?outcome, "STOP to the other Azel is not confirmed");
            false
        }
    };
    !outcomes.is_empty() && outcomes.iter().all(is_proved)
}
