//! A locked-out unit: it gets only questions and STOP, whoever asks. Before that, Azel stops it and
//! keeps it from starting on its own.

use std::{sync::Arc, time::Duration};

use super::{Session, activity::Activity, wanted::Wanted};
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Command, Event, LinkState, LockedOut, Offline, Refusal},
    station::LockOut,
};

/// Time limit until auto-track is read back as off.
const READ_BACK: Duration = Duration::from_secs(10);

/// Progress of a lock-out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Locking {
    since: Instant,
    /// Auto-track was switched off on this link.
    is_asked: bool,
    /// The unit reported that it does not start on its own.
    is_proved: bool,
    /// It was proved once: since then the person who works on it may have switched it on.
    was_proved: bool,
    /// The operator knows that it cannot be read back.
    is_told: bool,
}

impl Session {
    /// With a unit that may be locked out from the beginning.
    #[must_use]
    pub fn locked_out(mut self, lock_out: Option<LockOut>) -> Self {
        if let Some(lock_out) = lock_out {
            let now = self.now();
            // Nobody takes the panel from the person who works on the unit.
            if self.variant.capabilities.waits_for_word {
                (self.contact.wanted, self.contact.link) = (Wanted::No, LinkState::Off);
            }
            self.put_lock_out(lock_out, now);
            let (lock_out, locking) = (self.gate.lock_out().cloned(), self.is_being_locked_out());
            let link = self.contact.link.clone();
            self.wires.snapshots.send_modify(|held| {
                let held = Arc::make_mut(held);
                (held.lock_out, held.locking) = (lock_out, locking);
                held.link.clone_from(&link);
            });
        }
        self
    }

    /// Locks the unit out. A motion is stopped first.
    pub(super) fn lock_out(&mut self, lock_out: LockOut, now: Moment) {
        if self.gate.lock_out().is_some() {
            self.gate.set_lock_out(Some(lock_out));
            return;
        }
        let may_move = self.may_move() || self.active() || self.is_unproved();
        let is_left_to_others = self.contact.wanted == Wanted::No && !self.is_unproved();
        if may_move && !is_left_to_others {
            self.halt(now);
            if self.contact.wanted == Wanted::No {
                self.contact.wanted = Wanted::ForStop;
            }
        }
        self.activity = Activity::Standby;
        self.put_lock_out(lock_out, now);
        self.leave_panel();
        if self.variant.capabilities.has_program && !self.contact.link.is_open() {
            self.tell_unproved();
        }
    }

    /// Where a question would take the panel of the unit from the person who works on it, only
    /// STOP is sent from now on.
    fn leave_panel(&mut self) {
        if self.variant.capabilities.waits_for_word && self.contact.wanted == Wanted::Yes {
            self.contact.wanted = Wanted::ForStop;
        }
    }

    fn put_lock_out(&mut self, lock_out: LockOut, now: Moment) {
        self.gate.set_lock_out(Some(lock_out));
        self.locking = Some(Locking {
            since: now.steady,
            is_asked: false,
            was_proved: false,
            is_proved: !self.variant.capabilities.has_program,
            is_told: false,
        });
    }

    pub(super) fn unlock(&mut self) {
        self.gate.set_lock_out(None);
        self.locking = None;
    }

    pub(super) fn is_being_locked_out(&self) -> bool {
        self.locking.is_some_and(|locking| !locking.is_proved) || self.locking_stops()
    }

    fn locking_stops(&self) -> bool {
        self.locking.is_some() && self.stop.is_under_way()
    }

    /// Returns `true` if the lock-out forbids the command, and tells the operator.
    pub(super) fn lock_out_forbids(&mut self, command: &Command) -> bool {
        let Some(lock_out) = self.gate.lock_out() else { return false };
        let refusal = match command.row().locked_out {
            LockedOut::Taken => None,
            LockedOut::Refused => Some(Refusal::from(lock_out)),
            // Without a link nothing gets that far.
            LockedOut::RefusedAtTheGate => {
                let is_refused_here =
                    command.row().offline == Offline::Refused && !self.contact.link.is_open();
                is_refused_here.then(|| Refusal::from(lock_out))
            }
            LockedOut::TakesPanel => {
                let by = lock_out.by.clone();
                let takes_panel = self.variant.capabilities.waits_for_word;
                takes_panel.then_some(Refusal::PanelLockedOut { by })
            }
        };
        let Some(refusal) = refusal else { return false };
        self.tell(Event::NotSent(refusal));
        true
    }

    /// Keeps the unit from starting on its own and checks it: once on each link, and not again
    /// after it was proved.
    pub(super) fn watch_lock_out(&mut self, now: Moment) {
        let Some(locking) = &mut self.locking else { return };
        if !self.variant.capabilities.has_program {
            return;
        }
        if self.contact.unread {
            locking.is_asked = false;
            return;
        }
        let state = self.gate.state();
        let is_new = state.measured.is_some_and(|measured| measured.asked > locking.since);
        if !is_new {
            return;
        }
        match state.program.and_then(|program| program.auto) {
            Some(false) => {
                (locking.is_proved, locking.was_proved, locking.is_told) = (true, true, false);
            }
            Some(true) if locking.is_proved => {
                locking.is_proved = false;
                self.tell_unproved();
            }
            _ if !locking.is_asked && !locking.was_proved => {
                locking.is_asked = true;
                locking.since = now.steady;
                self.gate.device().disable_auto();
            }
            _ if now.steady.saturating_duration_since(locking.since) >= READ_BACK => {
                self.tell_unproved();
            }
            _ => {}
        }
    }

    fn tell_unproved(&mut self) {
        let Some(locking) = &mut self.locking else { return };
        if !std::mem::replace(&mut locking.is_told, true) {
            self.tell(Event::LockOutUnproved);
        }
    }
}
