//! The record on disk that an antenna is moved by hand, or is owed a STOP: if this program ends
//! before standstill is proved, the next start sends STOP first.

use std::{io, time::Duration};

use tokio::task::{JoinHandle, spawn_blocking};

use super::{Event, Session};
use crate::{astro::time::seconds_between, clock::Instant, clock::Moment, driver::Safety};

/// A slower disk must not keep the operator from moving the antenna.
const MAX: Duration = Duration::from_millis(300);
/// Interval at which the write is checked.
const LOOK: Duration = Duration::from_millis(2);
/// Above this age the operator is asked: much may have been done at the antenna since.
const OLD_S: f64 = 600.0;

/// The record of one antenna.
#[derive(Debug)]
pub(super) enum Marking {
    None,
    /// Being written.
    Writing {
        since: Instant,
        writing: JoinHandle<io::Result<()>>,
    },
    /// On the disk.
    Marked,
    /// Could not be written, and the operator was told.
    Failed,
    /// Being removed.
    Removing(JoinHandle<()>),
}

impl Session {
    /// Returns `true` if the record is on the disk or cannot be had; begins to write it.
    pub(super) fn is_marked(&mut self, now: Moment) -> bool {
        if self.variant.capabilities.ends_jogs || !self.owed.debts.has_marks() {
            return true;
        }
        self.follow_marking(now)
    }

    /// Records on disk that a STOP is owed. It comes after the bytes of the STOP, which wait for no
    /// disk.
    pub(super) fn record_debt(&mut self, now: Moment) {
        let is_out_of_reach = self.stop.is_under_way() && !self.contact.link.is_open();
        if self.owed.debts.has_marks() && (self.stop.is_pressed() || is_out_of_reach) {
            self.follow_marking(now);
        }
    }

    /// Returns `true` if the record is on the disk or could not be written; else begins to write
    /// it, or waits for that.
    fn follow_marking(&mut self, now: Moment) -> bool {
        match &mut self.owed.marking {
            Marking::Marked | Marking::Failed => true,
            Marking::Writing { since, writing } => {
                let is_late = now.steady.saturating_duration_since(*since) >= MAX;
                if !writing.is_finished() && !is_late {
                    return false;
                }
                // Finished or given up: no wait either way.
                let written = if writing.is_finished() { take_now(writing) } else { None };
                if written.is_some_and(|written| written.is_ok()) {
                    self.owed.marking = Marking::Marked;
                } else {
                    self.owed.marking = Marking::Failed;
                    self.tell(Event::Safety(Safety::NoMark));
                }
                true
            }
            Marking::None | Marking::Removing(_) => {
                let before = match std::mem::replace(&mut self.owed.marking, Marking::None) {
                    Marking::Removing(before) => Some(before),
                    _ => None,
                };
                let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
                let writing = tokio::spawn(async move {
                    // One after the other, or the older removal would remove the newer record.
                    if let Some(before) = before {
                        before.await.ok();
                    }
                    let marked = spawn_blocking(move || debts.mark(&unit, now.utc)).await;
                    marked.unwrap_or_else(|error| Err(io::Error::other(error)))
                });
                self.owed.marking = Marking::Writing { since: now.steady, writing };
                false
            }
        }
    }

    /// When to check again whether the record is on the disk.
    pub(super) fn marking_due(&self, now: Instant) -> Option<Instant> {
        matches!(self.owed.marking, Marking::Writing { .. }).then_some(now + LOOK)
    }

    /// Standstill is proved: nothing is owed to the unit any more.
    pub(super) fn settle_debt(&mut self) {
        self.owed.debts.settle(&self.owed.unit);
        self.owed.left_moving = None;
        let before = match std::mem::replace(&mut self.owed.marking, Marking::None) {
            Marking::None => return,
            removing @ Marking::Removing(_) => {
                self.owed.marking = removing;
                return;
            }
            Marking::Writing { writing, .. } => Some(writing),
            Marking::Marked | Marking::Failed => None,
        };
        let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
        self.owed.marking = Marking::Removing(tokio::spawn(async move {
            if let Some(before) = before {
                before.await.ok();
            }
            spawn_blocking(move || debts.unmark(&unit)).await.ok();
        }));
    }

    /// Waits a moment until records are removed, which the end of the program would cut off.
    pub(super) async fn end_marking(&mut self) {
        if let Marking::Removing(removing) = &mut self.owed.marking {
            // A record that stays costs no more than a STOP at the next start.
            let _ = self.clock.timeout(MAX, removing).await;
        }
        if let Some(removing) = &mut self.owed.unmarking {
            let _ = self.clock.timeout(MAX, removing).await;
        }
    }

    /// Checks what an earlier run left on the unit. If that may be moving, STOP is sent first,
    /// unless the operator must decide.
    pub(super) async fn look_for_mark(&mut self) {
        if !self.owed.debts.has_marks() {
            return;
        }
        let (debts, unit) = (self.owed.debts.clone(), self.owed.unit.clone());
        let looking = spawn_blocking(move || {
            debts.find_shifted(&unit);
            debts.marked(&unit)
        });
        let Ok(Some(since)) = looking.await else { return };
        let now = self.now();
        let asks = self.variant.capabilities.waits_for_word
            || seconds_between(since, now.utc).abs() > OLD_S;
        self.owed.marking = Marking::Marked;
        if asks {
            self.owed.left_moving = Some(since);
            self.publish(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::LeftMoving { since, asks }));
    }

    /// Records on disk that a STOP is owed, for a program that ends before it is proved. A slow
    /// disk holds the STOP up only for a moment; the record is written meanwhile.
    pub(super) async fn mark_debt(&mut self) {
        let (debts, unit, since) =
            (self.owed.debts.clone(), self.owed.unit.clone(), self.now().utc);
        if !debts.has_marks() {
            return;
        }
        let before = match std::mem::replace(&mut self.owed.marking, Marking::None) {
            Marking::Removing(before) => Some(before),
            Marking::Writing { writing, .. } => Some(tokio::spawn(async move {
                writing.await.ok();
            })),
            Marking::None | Marking::Marked | Marking::Failed => None,
        };
        let mark = tokio::spawn(async move {
            // One after the other, or the older removal would remove the newer record.
            if let Some(before) = before {
                before.await.ok();
            }
            spawn_blocking(move || debts.mark(&unit, since)).await
        });
        if matches!(self.clock.timeout(MAX, mark).await, Ok(Ok(Ok(Ok(()))))) {
            self.owed.marking = Marking::Marked;
        }
    }
}

/// The outcome of a task that has ended.
pub(super) fn take_now(ended: &mut JoinHandle<io::Result<()>>) -> Option<io::Result<()>> {
    use std::{
        future::Future as _,
        pin::Pin,
        task::{Context, Poll, Waker},
    };
    match Pin::new(ended).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(outcome) => outcome.ok(),
        Poll::Pending => None,
    }
}

#[cfg(test)]
mod tests;
