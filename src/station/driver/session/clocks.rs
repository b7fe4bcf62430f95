//! Notices that the computer's clock was set, or that the computer has slept.

use std::time::Duration;

use super::{Session, jog::JogKey};
use crate::{
    astro::time::seconds_between,
    clock::Moment,
    contract::driver::{Event, LinkLoss, Safety},
    driver::before_sleep::Awake,
};

/// Largest change between two looks of a clock that is kept right, seconds.
const STEP_S: f64 = 0.5;
/// A shorter sleep is ignored.
const NAP: Duration = Duration::from_secs(1);

#[derive(Debug, Clone, Copy)]
pub(super) struct Clocks {
    at: Moment,
    asleep: Duration,
}

impl Session {
    /// Ends motions by hand: during the sleep nothing would.
    pub(super) fn before_sleep(&mut self, awake: Awake, now: Moment) {
        if let Some(jog) = self.key.held() {
            let rates_deg_s = jog.rates_deg_s;
            self.halt_quietly(now);
            self.key = JogKey::Spent(rates_deg_s);
            self.tell(Event::Safety(Safety::EndedForSleep));
        }
        self.awake = Some(awake);
        self.let_sleep(now);
    }

    /// Lets the computer sleep once no halt is under way.
    pub(super) fn let_sleep(&mut self, _: Moment) {
        if !self.stop.is_under_way() {
            self.awake = None;
        }
    }

    /// Compares the clocks with each other. After a sleep the link is opened anew: old
    /// positions look fresh, because the steady clock stood still.
    pub(super) fn watch_clocks(&mut self, now: Moment) -> Option<LinkLoss> {
        let look = Clocks { at: now, asleep: self.clock.asleep() };
        let before = self.contact.clocks.replace(look)?;
        let lasted = look.asleep.saturating_sub(before.asleep);
        let steady = now.steady.saturating_duration_since(before.at.steady);
        let expected_s = (steady + lasted).as_secs_f64();
        let by_s = seconds_between(before.at.utc, now.utc) - expected_s;
        if by_s.abs() > STEP_S {
            self.tell(Event::Safety(Safety::ClockStepped { by_s, time: Some(now.utc) }));
            self.suspend_following(steady, now);
        }
        if lasted < NAP {
            return None;
        }
        self.tell(Event::Safety(Safety::Slept { lasted }));
        self.contact.slept += lasted;
        self.gate.watch_anew();
        self.contact.link.is_open().then_some(LinkLoss::Slept)
    }
}
