//! Gives a pass up whose antenna points elsewhere for too long.

use std::time::Duration;

use super::{Event, Session, activity::Activity};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    driver::Safety,
};

/// An alarm is raised for an antenna that has been off its target for this long.
const ALARM_AFTER: Duration = Duration::from_secs(10);
/// The pass is given up after this time.
const GIVE_UP_AFTER: Duration = Duration::from_secs(30);

/// How long an antenna has been off its target.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct OffTarget {
    /// Since when, by how much at the last measurement, and when that was.
    since: Option<(Instant, Angle, Instant)>,
}

impl OffTarget {
    /// Takes the angle off target; `None` on target, or while the antenna cannot be there yet.
    pub(super) fn take(&mut self, off: Option<Angle>, at: Instant) {
        let began = self.since.map_or(at, |(began, ..)| began);
        self.since = off.map(|off| (began, off, at));
    }

    /// The angle off target, degrees, once it has lasted too long to be passed over.
    pub(super) fn missing(&self) -> Option<Angle> {
        self.lasting(ALARM_AFTER)
    }

    /// The angle off target, degrees, once the pass has to be given up.
    fn hopeless(&self) -> Option<Angle> {
        self.lasting(GIVE_UP_AFTER)
    }

    fn lasting(&self, longest: Duration) -> Option<Angle> {
        let (began, off, at) = self.since?;
        (at.saturating_duration_since(began) >= longest).then_some(off)
    }
}

impl Session {
    /// Stops an antenna that stays off the target that it was told to track.
    pub(super) fn watch_pointing(&mut self, now: Moment) {
        let off_target = match &self.activity {
            Activity::ProgramTrack(track) => track.off_target,
            Activity::OnBoardTrack(track) => track.watch.off_target(),
            Activity::Standby | Activity::Manual | Activity::Hold(_) | Activity::GoTo(_) => return,
        };
        if let Some(off) = off_target.hopeless() {
            let off_deg = off.degrees();
            self.give_up(Event::Safety(Safety::OffTarget { off_deg }), now);
        }
    }

    /// Largest angle off target of an antenna that does what it is told.
    pub(super) fn on_target(&self) -> Angle {
        let can = self.variant.capabilities;
        let reported_deg = can.arrives_within_deg + 2.0 * can.standstill.resolution_deg;
        let tolerance_deg = reported_deg + self.figures().tolerance_deg();
        self.setup.ability.half_beam + Angle::from_degrees(tolerance_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_lasts_is_told_and_then_ends_the_pass() {
        let start = Instant::now();
        let after = |s| start + Duration::from_secs(s);
        let off = Some(Angle::from_degrees(5.0));
        let mut off_target = OffTarget::default();
        let mut told = Vec::new();
        for second in 0..40 {
            // In time it is back once.
            off_target.take(off.filter(|_| second != 4), after(second));
            told.push((off_target.missing().is_some(), off_target.hopeless().is_some()));
        }
        assert_eq!(told.iter().position(|(missing, _)| *missing), Some(15));
        assert_eq!(told.iter().position(|(_, hopeless)| *hopeless), Some(35));
        off_target.take(None, after(41));
        assert_eq!((off_target.missing(), off_target.hopeless()), (None, None));
    }
}
