//! Timeouts and cancellation: every wait has a timeout and can be cancelled.

use std::{future::Future, time::Duration};

use tokio_util::sync::CancellationToken;

/// Timeouts and size limit of a transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Timeout for a host to accept the connection.
    pub connect: Duration,
    /// Timeout for the negotiation of the protocol, and again for the log-in.
    pub log_in: Duration,
    /// Timeout for the answer to one request.
    pub request: Duration,
    /// Timeout for one whole file in one direction.
    pub file: Duration,
    /// Max size of a file, bytes.
    pub file_bytes: u64,
}

impl Default for Limits {
    /// Returns limits for slow units on slow radio links: 10 s, 20 s, 10 s, 2 min, 16 MB.
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

/// Reason why a wait ended without an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Interruption {
    #[error("cancelled")]
    Cancelled,
    /// The wait exceeded this timeout.
    #[error("no answer within {} s", .0.as_secs_f64())]
    TimedOut(Duration),
}

/// Waits for `work` until the timeout `limit` or the cancellation.
pub(super) async fn with_timeout<T>(
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
        assert_eq!(with_timeout(limit, &cancel, async { 7 }).await, Ok(7));
        let late = with_timeout(limit, &cancel, pending::<()>()).await.unwrap_err();
        assert_eq!(late, Interruption::TimedOut(limit));
        assert_eq!(late.to_string(), "no answer within 1.5 s");
        cancel.cancel();
        assert_eq!(with_timeout(limit, &cancel, async { 7 }).await, Err(Interruption::Cancelled));
    }
}
