//! Connection of one client: requests in, replies out, and failures on the way.

use std::{collections::VecDeque, io, ops::ControlFlow, time::Duration};

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};

use super::{Control, Unit, Wire};
use crate::clock::{Clock, Instant};

/// Timeout for writing to a client that does not read.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// Pause between two pieces with [`Unit::SPLIT`].
const SPLIT_PAUSE: Duration = Duration::from_millis(5);
/// Max number of pending replies; beyond it, the unit reads nothing.
const MAX_WAITING: usize = 64;

impl<U: Unit> Control<U> {
    /// Serves one client until it leaves, is dropped or stops reading.
    pub async fn serve<S>(&self, stream: S) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        serve(self, self.wire(), stream).await
    }
}

/// Serves one client on `wire`, like [`Control::serve`].
pub(in crate::sim) async fn serve<U, S>(
    control: &Control<U>,
    wire: U::Wire,
    stream: S,
) -> io::Result<()>
where
    U: Unit,
    S: AsyncRead + AsyncWrite + Unpin,
{
    let clock = control.clock().clone();
    let replies = Replies { waiting: VecDeque::new(), merge_time: None, clock };
    Connection { control, wire, stream, replies, sent: 0 }.run().await
}

/// Queue of replies, each with its send time.
#[derive(Debug)]
pub struct Replies<R> {
    waiting: VecDeque<(Instant, R)>,
    merge_time: Option<Duration>,
    clock: Clock,
}

impl<R> Replies<R> {
    /// Queues `reply`, to be sent `delay` after the previous reply.
    pub(in crate::sim) fn push(&mut self, reply: R, delay: Duration) {
        let last_due = self.waiting.back().map(|(due, _)| *due);
        let now = self.clock.now().steady;
        let due = match self.merge_time {
            Some(merge_time) => last_due.unwrap_or(now + merge_time),
            None => last_due.unwrap_or(now).max(now) + delay,
        };
        self.waiting.push_back((due, reply));
    }

    /// Queues `reply`, to be sent right after the previous replies.
    pub(in crate::sim) fn push_now(&mut self, reply: R) {
        self.waiting.push_back((self.clock.now().steady, reply));
    }
}

struct Connection<'a, U: Unit, S> {
    control: &'a Control<U>,
    wire: U::Wire,
    stream: S,
    replies: Replies<<U::Wire as Wire<U>>::Reply>,
    /// Number of replies that were sent or lost.
    sent: u64,
}

impl<U: Unit, S: AsyncRead + AsyncWrite + Unpin> Connection<'_, U, S> {
    async fn run(mut self) -> io::Result<()> {
        let mut drops = self.control.drops();
        let mut buffer = [0; 1024];
        let clock = self.control.clock();
        loop {
            let waiting = &self.replies.waiting;
            let due = waiting.front().map(|(due, _)| *due);
            tokio::select! {
                // A fixed order makes events in paused time repeatable.
                biased;
                read = self.stream.read(&mut buffer), if waiting.len() < MAX_WAITING => {
                    let count = read?;
                    if count == 0 {
                        return Ok(());
                    }
                    let switches = self.control.switches();
                    let is_merging = switches.has_fault(U::MERGE);
                    self.replies.merge_time = is_merging.then_some(U::Wire::MERGE_TIME);
                    let bytes = buffer.get_mut(..count).unwrap_or_default();
                    self.wire.take(bytes, self.control, &switches, &mut self.replies);
                }
                () = clock.sleep_until(due.unwrap_or(clock.now().steady)), if due.is_some() => {
                    if clock.timeout(WRITE_TIMEOUT, self.send_due()).await??.is_break() {
                        return Ok(());
                    }
                }
                _ = drops.changed() => return Ok(()),
            }
        }
    }

    async fn send_due(&mut self) -> io::Result<ControlFlow<()>> {
        let switches = self.control.switches();
        let mut bytes = Vec::new();
        let now = self.control.clock().now().steady;
        let is_due = |(due, _): &mut (Instant, _)| *due <= now;
        while let Some((_, reply)) = self.replies.waiting.pop_front_if(is_due) {
            self.sent += 1;
            match self.wire.put(reply, self.sent, &switches) {
                Some(reply) => bytes.extend(reply),
                None => return Ok(ControlFlow::Break(())),
            }
            if !switches.has_fault(U::MERGE) {
                break;
            }
        }
        self.write(&bytes, switches.has_fault(U::SPLIT)).await?;
        Ok(ControlFlow::Continue(()))
    }

    async fn write(&mut self, mut bytes: &[u8], is_split: bool) -> io::Result<()> {
        while !bytes.is_empty() {
            let range = U::Wire::PIECE_BYTES;
            let count = if is_split { self.control.random(&range) } else { u64::MAX };
            let count = usize::try_from(count).unwrap_or(usize::MAX).min(bytes.len());
            let (piece, rest) = bytes.split_at_checked(count).unwrap_or((bytes, &[]));
            self.stream.write_all(piece).await?;
            self.stream.flush().await?;
            bytes = rest;
            if !bytes.is_empty() {
                self.control.clock().sleep(SPLIT_PAUSE).await;
            }
        }
        Ok(())
    }
}
