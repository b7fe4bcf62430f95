//! The end of a session: what may move is stopped first.

use std::time::Duration;

use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, ReadHalf, WriteHalf},
    time::{sleep_until, timeout},
};

use super::{
    Session,
    converse::{CONNECT, HURRY, LEAST_WAIT, WRITE},
};
use crate::driver::Stream;

/// How long the end of a session waits for standstill.
const GOODBYE: Duration = Duration::from_millis(1500);

impl Session {
    /// The last words of a session: a jog must not outlive it. Stays until
    /// standstill is proved or it has taken too long.
    pub(super) async fn say_goodbye(
        &mut self,
        reader: &mut ReadHalf<Box<dyn Stream>>,
        writer: &mut WriteHalf<Box<dyn Stream>>,
    ) {
        let start = self.now();
        if self.jog.take().is_some() || self.waiting.is_some() {
            self.halt_quietly(start);
        }
        let mut buffer = [0; 4096];
        let until = tokio::time::Instant::now() + GOODBYE;
        while self.halting.is_some() && tokio::time::Instant::now() < until {
            if let Err(loss) = self.send(writer).await {
                return tracing::error!(
                    antenna = self.name,
                    ?loss,
                    "the last STOP was not written"
                );
            }
            tokio::select! {
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
                () = sleep_until(self.next_look(until)) => {
                    let now = self.now();
                    self.watch_halt(now);
                }
            }
        }
        if self.halting.is_some() {
            tracing::error!(antenna = self.name, "standstill was not proved at the end");
        }
        // The socket is closed in order, so that the last bytes are not cut off.
        let _ = timeout(WRITE, writer.shutdown()).await;
    }

    /// When the goodbye has something to send or to look at.
    fn next_look(&mut self, until: tokio::time::Instant) -> tokio::time::Instant {
        let now = self.now();
        let due = self.gate.device().due(now).max(now.steady + LEAST_WAIT);
        until.min(self.halt_due().map_or(due, |halt| halt.min(due)).into())
    }

    /// The session ends while a stop is owed and there is no link.
    pub(super) async fn last_attempt(&mut self) {
        let until = tokio::time::Instant::now() + CONNECT;
        while tokio::time::Instant::now() < until {
            if let Ok(Ok(stream)) = timeout(CONNECT, (self.dial)()).await {
                let (mut reader, mut writer) = tokio::io::split(stream);
                let now = self.now();
                self.gate.device().link_up(now);
                self.halt_quietly(now);
                return self.say_goodbye(&mut reader, &mut writer).await;
            }
            tokio::time::sleep(HURRY).await;
        }
        tracing::error!(antenna = self.name, "the last STOP could not be sent: no link");
    }
}
