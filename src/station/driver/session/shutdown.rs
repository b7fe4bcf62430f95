//! End of a session, which stops motions first.

use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt, ReadHalf, WriteHalf};

use super::{
    Session,
    io_loop::{CONNECT, MIN_WAIT, STOP_RETRY, WRITE},
};
use crate::{clock::Instant, driver::Stream};

/// Timeout of standstill at the end of a session, besides the time of its proof.
const STANDSTILL_WITHIN: Duration = Duration::from_millis(1500);

impl Session {
    /// Ends a session and any jog. Waits until all debts are settled, or until the timeout.
    pub(super) async fn shut_down(
        &mut self,
        reader: &mut ReadHalf<Box<dyn Stream>>,
        writer: &mut WriteHalf<Box<dyn Stream>>,
    ) {
        let start = self.now();
        let is_held = self.commanded.key.pressed().is_some();
        self.commanded.key.end();
        if is_held || self.commanded.activity.is_queued() {
            self.halt_quietly(start);
        }
        let mut buffer = [0; 4096];
        let clock = self.clock.clone();
        let deadline = start.steady + STANDSTILL_WITHIN + self.figures().gap();
        while (self.is_in_debt() || self.owes_offsets()) && self.now().steady < deadline {
            let now = self.now();
            // The other checks of a session could start a motion again.
            self.watch_auto_track(now);
            self.watch_unit_offsets(now);
            if let Err(loss) = self.send(writer).await {
                return tracing::error!(
                    antenna = self.setup.name(),
                    ?loss,
                    "the last STOP was not written"
                );
            }
            tokio::select! {
                biased;
                read = reader.read(&mut buffer) => match read {
                    Ok(count @ 1..) => {
                        let now = self.now();
                        let bytes = buffer.get(..count).unwrap_or_default();
                        self.gate.device().receive(bytes, now);
                        self.record();
                        self.watch_halt(now);
                    }
                    _ => break,
                },
                () = clock.sleep_until(self.next_update(deadline)) => {
                    let now = self.now();
                    self.watch_halt(now);
                }
            }
        }
        if self.stop.is_under_way() {
            tracing::error!(antenna = self.setup.name(), "standstill was not proved at the end");
        }
        // Close in order, so that the last bytes are not lost.
        let _ = clock.timeout(WRITE, writer.shutdown()).await;
    }

    /// Returns the time of the next output or check.
    fn next_update(&mut self, deadline: Instant) -> Instant {
        let now = self.now();
        let due = self.gate.device().due(now).max(now.steady + MIN_WAIT);
        deadline.min(self.halt_due().map_or(due, |halt| halt.min(due)))
    }

    /// Settles the debts after the station has dropped this antenna: retries until they are
    /// settled, or until another session of the unit takes them over.
    pub(super) async fn pay_debts(&mut self) {
        while self.is_in_debt() && !self.owed.debts().is_relieved(self.stop.is_under_way()) {
            if let Ok(Ok(stream)) = self.clock.timeout(CONNECT, self.contact.dial()).await {
                let (mut reader, mut writer) = tokio::io::split(stream);
                let now = self.now();
                self.gate.device().link_up(now);
                self.contact.set_connected(now.steady);
                self.owed.record_auto_track_request(None);
                if self.stop.is_under_way() {
                    // The STOP also goes out first on this link.
                    self.halt_quietly(now);
                }
                self.shut_down(&mut reader, &mut writer).await;
                let now = self.now();
                self.gate.device().link_down(now);
            }
            if self.is_in_debt() {
                let now = self.now();
                self.record_debt(now);
                self.clock.sleep(STOP_RETRY).await;
            }
        }
    }

    fn is_in_debt(&self) -> bool {
        self.stop.is_under_way() || self.owed.debts().owes_auto_track_off()
    }
}
