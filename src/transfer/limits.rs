//! No step waits for ever, and every wait can be cancelled.

use std::{future::Future, time::Duration};

use tokio_util::sync::CancellationToken;

/// How long the steps of a transfer may take, and how much may come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Until a host has taken the connection.
    pub connect: Duration,
    /// Until both sides agree on how to talk; the same again for the log-in.
    pub log_in: Duration,
    /// Until one request is answered.
    pub request: Duration,
    /// For one whole file, one way.
    pub file: Duration,
    /// The largest file that is taken.
    pub file_bytes: u64,
}

impl Default for Limits {
    /// For slow units on slow radio links: 10 s, 20 s, 10 s, 2 min, 16 MB.
    fn default() -> Self {
        Self {
            connect: Duration::from_secs(10),
            log_in: Duration::from_secs(20),
            request: Duration::from_secs(10),
            file: Duration::from_mins(2),
            file_bytes: 16 << 20,
        }
    }
}

/// Why a wait ended without an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Interruption {
    /// Nobody wants the answer any more.
    #[error("cancelled")]
    Cancelled,
    /// The time limit, which stands here, is over.
    #[error("no answer within {} s", .0.as_secs_f64())]
    TimedOut(Duration),
}

/// Waits for `work`, at most `limit`, and not beyond `cancel`.
pub(super) async fn within<T>(
    limit: Duration,
    cancel: &CancellationToken,
    work: impl Future<Output = T>,
) -> Result<T, Interruption> {
    tokio::select! {
        biased;
        () = cancel.cancelled() => Err(Interruption::Cancelled),
        done = tokio::time::timeout(limit, work) => done.map_err(|_| Interruption::TimedOut(limit)),
    }
}

#[cfg(test)]
mod tests {
    use std::future::pending;

    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_wait_ends_by_answer_by_limit_or_by_cancel() {
        let limit = Duration::from_millis(1500);
        let cancel = CancellationToken::new();
        assert_eq!(within(limit, &cancel, async { 7 }).await, Ok(7));
        let late = within(limit, &cancel, pending::<()>()).await.unwrap_err();
        assert_eq!(late, Interruption::TimedOut(limit));
        assert_eq!(late.to_string(), "no answer within 1.5 s");
        cancel.cancel();
        assert_eq!(within(limit, &cancel, async { 7 }).await, Err(Interruption::Cancelled));
    }
}
