//! Locked-out unit: it receives only queries and STOP, from any requester. Before that, Azel stops
//! the unit and keeps it from starting on its own.

use super::{Session, activity::Activity, contact::LinkNeed, locking::LockStep};
use crate::{
    clock::Moment,
    contract::driver::{Command, Event, LockedOut, Offline, Refusal},
    station::LockOut,
};

impl Session {
    /// Starts the session with a locked-out unit if `lock_out` is set.
    #[must_use]
    pub fn with_lock_out(mut self, lock_out: Option<LockOut>) -> Self {
        if let Some(lock_out) = lock_out {
            let now = self.now();
            // A query would take the panel from the person who works on the unit.
            if self.setup.can().waits_for_word {
                self.contact.want(LinkNeed::No);
                self.contact.close();
            }
            self.put_lock_out(lock_out, now);
            let (lock_out, locking) = (self.gate.lock_out().cloned(), self.is_being_locked_out());
            let link = self.contact.link().clone();
            self.wires.show_lock_out(lock_out, locking, link);
        }
        self
    }

    /// Locks the unit out after stopping its motion.
    pub(super) fn lock_out(&mut self, lock_out: LockOut, now: Moment) {
        if self.gate.lock_out().is_some() {
            self.gate.set_lock_out(Some(lock_out));
            return;
        }
        let may_move = self.may_move() || self.is_active() || self.is_unproved();
        // Somebody else may control a released unit that Azel did not move.
        let is_left_to_others = self.contact.link_need() == LinkNeed::No && !self.is_unproved();
        if may_move && !is_left_to_others {
            self.halt(now);
            if self.contact.link_need() == LinkNeed::No {
                self.contact.want(LinkNeed::ForStop);
            }
        }
        self.commanded.activity = Activity::Standby;
        self.put_lock_out(lock_out, now);
        self.leave_panel();
        // Without a link, Azel cannot prove that the unit would not start on its own.
        let is_unseen = self.setup.can().has_program && !self.contact.is_open();
        if is_unseen && self.owed.locking.report() == LockStep::Report {
            self.tell(Event::LockOutUnproved);
        }
    }

    /// Restricts the link to STOP if a query would take the panel of the unit from the person who
    /// works on it.
    fn leave_panel(&mut self) {
        if self.setup.can().waits_for_word && self.contact.link_need() == LinkNeed::Yes {
            self.contact.want(LinkNeed::ForStop);
        }
    }

    fn put_lock_out(&mut self, lock_out: LockOut, now: Moment) {
        self.gate.set_lock_out(Some(lock_out));
        self.owed.locking.begin(self.setup.can().has_program, now.steady);
    }

    pub(super) fn unlock(&mut self) {
        self.gate.set_lock_out(None);
        self.owed.locking.end();
    }

    pub(super) fn is_being_locked_out(&self) -> bool {
        self.owed.locking.is_under_way(self.stop.is_under_way())
    }

    /// Returns `true` if the lock-out forbids the command, and informs the operator.
    pub(super) fn lock_out_forbids(&mut self, command: &Command) -> bool {
        let Some(lock_out) = self.gate.lock_out() else { return false };
        let refusal = match command.row().locked_out {
            LockedOut::Taken => None,
            LockedOut::Refused => Some(Refusal::from(lock_out)),
            // Without a link, no such command reaches the gate.
            LockedOut::RefusedAtTheGate => {
                let is_refused_here =
                    command.row().offline == Offline::Refused && !self.contact.is_open();
                is_refused_here.then(|| Refusal::from(lock_out))
            }
            LockedOut::TakesPanel => {
                let operator = lock_out.operator.clone();
                let takes_panel = self.setup.can().waits_for_word;
                takes_panel.then_some(Refusal::PanelLockedOut { operator })
            }
        };
        let Some(refusal) = refusal else { return false };
        self.tell(Event::NotSent(refusal));
        true
    }

    /// Keeps the unit from starting on its own, and checks it.
    pub(super) fn watch_lock_out(&mut self, now: Moment) {
        let is_unread = self.contact.is_unread();
        match self.owed.locking.next(self.gate.state(), is_unread, now.steady) {
            LockStep::Wait => {}
            LockStep::SwitchOff => self.gate.device().disable_auto(),
            LockStep::Report => self.tell(Event::LockOutUnproved),
        }
    }
}
