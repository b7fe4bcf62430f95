//! End of motions before the computer sleeps, or after a step of its clock.

use super::Session;
use crate::{
    clock::Moment,
    contract::driver::{Event, LinkLoss, Safety},
    driver::before_sleep::Awake,
};

impl Session {
    /// Ends manual motions, because the session cannot end them during the sleep.
    pub(super) fn before_sleep(&mut self, awake: Awake, now: Moment) {
        if let Some(jog) = self.commanded.key.pressed() {
            let rates_deg_s = jog.rates_deg_s();
            self.halt_quietly(now);
            // A key that is still down after the sleep must not move the antenna.
            self.commanded.key.spend_rates(rates_deg_s);
            self.tell(Event::Safety(Safety::EndedForSleep));
        }
        self.stop.keep_awake(awake);
        self.let_sleep(now);
    }

    /// Lets the computer sleep once no halt is under way.
    pub(super) fn let_sleep(&mut self, _: Moment) {
        self.stop.let_sleep();
    }

    /// Compares the clocks with each other. After a sleep, reopens the link: old positions look
    /// fresh, because the steady clock paused.
    pub(super) fn watch_clocks(&mut self, now: Moment) -> Option<LinkLoss> {
        let change = self.contact.clocks.compare(now, self.clock.asleep())?;
        if let Some(by_s) = change.stepped_s {
            self.tell(Event::Safety(Safety::ClockStepped { by_s, time: Some(now.utc) }));
            // Tracked positions depend on UTC, and only the operator knows which of the two times
            // is right.
            self.suspend_following(change.steady, now);
        }
        let lasted = change.slept?;
        self.tell(Event::Safety(Safety::Slept { lasted }));
        self.contact.add_sleep(lasted);
        self.gate.restart_watch();
        self.contact.is_open().then_some(LinkLoss::Slept)
    }
}
