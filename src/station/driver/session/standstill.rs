//! Proof of standstill by angles, independent of the unit's drive reports.

use std::time::Duration;

use crate::{
    clock::Instant,
    device::{Capabilities, Measured},
};

/// Limits within which two positions count as the same.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figures {
    /// Max difference between two angles of a standing axis, degrees.
    tolerance_deg: f64,
    /// Width of the range of readings of a standing axis, degrees.
    rest_width_deg: f64,
    /// Time after which the unit's slowest motion becomes visible.
    gap: Duration,
    /// Number of axes that belong to the antenna.
    axes: usize,
}

impl Figures {
    /// Computes the limits. `sway_deg`: max sway of the standing antenna.
    pub(super) fn new(can: Capabilities, sway_deg: f64) -> Self {
        let tolerance_deg = can.standstill.resolution_deg / 2.0 + sway_deg;
        // Each reading may be rounded by half a step.
        let shows_deg = can.standstill.resolution_deg * 1.5 + sway_deg;
        let gap_s = shows_deg / can.standstill.slowest_deg_s;
        let gap = Duration::try_from_secs_f64(gap_s).unwrap_or(Duration::from_secs(1));
        // An angle between two steps may read as either step.
        let rest_width_deg = can.standstill.resolution_deg + sway_deg;
        Self { tolerance_deg, rest_width_deg, gap, axes: can.axis_count() }
    }

    /// Returns the time between two positions that prove standstill.
    pub(super) fn gap(self) -> Duration {
        self.gap
    }

    /// Returns the max difference between two angles of a standing axis, degrees.
    pub(super) fn tolerance_deg(self) -> f64 {
        self.tolerance_deg
    }

    /// Returns the width of the range of readings of a standing axis, degrees.
    pub(super) fn rest_width_deg(self) -> f64 {
        self.rest_width_deg
    }

    /// Returns `true` if a standing axis may report both angles, degrees.
    pub(super) fn are_same_deg(self, before_deg: f64, after_deg: f64) -> bool {
        wrapped_deg(after_deg - before_deg).abs() <= self.tolerance_deg
    }

    /// Returns the axis with the largest turn between two positions, and the turn in degrees.
    /// Returns `None` if no axis has turned by more than a standing axis may.
    pub(super) fn largest_turn(self, before: &Measured, after: &Measured) -> Option<(usize, f64)> {
        let pairs = before.axes.iter().zip(&after.axes).take(self.axes).enumerate();
        pairs
            .filter_map(|(axis, (before, after))| {
                let turned_deg = wrapped_deg(after.angle_deg? - before.angle_deg?);
                (turned_deg.abs() > self.tolerance_deg).then_some((axis, turned_deg))
            })
            .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))
    }

    /// Returns the first axis without an angle in one of the positions.
    fn blind_axis(self, before: &Measured, after: &Measured) -> Option<usize> {
        let pairs = before.axes.iter().zip(&after.axes).take(self.axes);
        pairs.into_iter().position(|(a, b)| a.angle_deg.is_none() || b.angle_deg.is_none())
    }
}

/// Returns the shorter turn, degrees: a standing axis at north may read 0 or 360.
fn wrapped_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Proof {
    /// Proof by two equal positions.
    Angles,
    /// Proof by the flags of this axis, which has no angle.
    Flags { axis: usize },
}

/// Max normal variation of a reply time.
const UNEVEN: Duration = Duration::from_millis(100);

/// Positions measured since a halt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Looks {
    first: Option<Measured>,
    /// Request time of the last position.
    last: Option<Instant>,
    /// Last position after which another one was requested.
    requested_after: Option<Instant>,
    /// `true` if two positions differed, regardless of the flags.
    turned: bool,
}

impl Looks {
    /// Returns the request time of a position that proves standstill if it equals the first one.
    pub(super) fn next(&self, figures: Figures) -> Option<Instant> {
        let received = |first: &Measured| first.received + figures.gap.saturating_sub(UNEVEN);
        self.first.map(|first| (first.requested + figures.gap).max(received(&first)))
    }

    /// Returns `true` if another STOP could help, because not all positions agree.
    pub(super) fn want_stop(&self) -> bool {
        self.first.is_none() || self.turned
    }

    /// Returns `true` until a request follows the last position. Azel may have sent an earlier
    /// query too soon for a proof.
    pub(super) fn awaits_look(&self) -> bool {
        self.last != self.requested_after
    }

    /// Returns `true` once for each position, when the session must request the next one.
    pub(super) fn is_due(&mut self, figures: Figures, now: Instant) -> bool {
        let is_due = self.awaits_look() && self.next(figures).is_some_and(|time| now >= time);
        if is_due {
            self.requested_after = self.last;
        }
        is_due
    }

    /// Takes a position requested after the halt. `is_at_rest`: the unit's flags report standstill
    /// of all its axes.
    pub(super) fn take(
        &mut self,
        look: Measured,
        is_at_rest: bool,
        link_since: Option<Instant>,
        figures: Figures,
    ) -> Option<Proof> {
        self.last = Some(look.requested);
        // Positions of two links prove nothing, because somebody may have moved the antenna in
        // between.
        let on_link =
            self.first.filter(|first| link_since.is_some_and(|begun| first.requested >= begun));
        let first = on_link.filter(|first| figures.largest_turn(first, &look).is_none());
        self.turned |= on_link.is_some() && first.is_none();
        if !is_at_rest {
            self.first = None;
            return None;
        }
        let first = *self.first.insert(first.unwrap_or(look));
        // The unit may have measured each position at any time between its query and its reply.
        let interval = look.requested.saturating_duration_since(first.requested);
        let apart = look.requested.saturating_duration_since(first.received);
        if interval < figures.gap || apart + UNEVEN < figures.gap {
            return None;
        }
        Some(match figures.blind_axis(&first, &look) {
            None => Proof::Angles,
            Some(axis) => Proof::Flags { axis },
        })
    }
}

/// Watch over an antenna whose flags report standstill.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Rest {
    /// Start of the reported standstill, and the first position that counts.
    resting: Option<(Instant, Option<Measured>)>,
    /// Last motion of Azel that the flags or the angles have shown.
    shown: Option<Instant>,
    is_reported: bool,
}

impl Rest {
    /// Max time for which axes continue after their flags report rest.
    const RUN_OUT: Duration = Duration::from_secs(3);

    /// Takes a position. `began`: start of Azel's last motion. Returns the axis that turns although
    /// the flags report standstill, and its turn in degrees, once per rest.
    pub(super) fn take(
        &mut self,
        look: Measured,
        is_at_rest: bool,
        began: Option<Instant>,
        figures: Figures,
    ) -> Option<(usize, f64)> {
        if !is_at_rest {
            *self = Self { shown: began, ..Self::default() };
            return None;
        }
        let (begun, anchor) = self.resting.get_or_insert((look.requested, None));
        if look.requested.saturating_duration_since(*begun) < Self::RUN_OUT {
            return None;
        }
        let anchor = anchor.get_or_insert(look);
        let turned = figures.largest_turn(anchor, &look)?;
        // A short motion may begin and end between two positions. The axes may continue after it.
        let is_new = began.is_some_and(|began| {
            self.shown < Some(began)
                && look.received > began
                && look.requested.saturating_duration_since(began) < Self::RUN_OUT
        });
        if is_new {
            (self.resting, self.shown) = (Some((look.requested, None)), began);
            return None;
        }
        (!std::mem::replace(&mut self.is_reported, true)).then_some(turned)
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::AzEl,
        controller::satrak,
        device::{Axis, AxisMotion, Drive},
    };

    fn look(start: Instant, at_s: f64, angles_deg: [Option<f64>; 2]) -> Measured {
        let time = start + Duration::try_from_secs_f64(at_s).unwrap();
        let axis = |angle_deg| Axis {
            angle_deg,
            motion: AxisMotion::Still,
            drive: Drive::Off,
            plus_limit: false,
            minus_limit: false,
        };
        Measured {
            time: Timestamp::UNIX_EPOCH,
            requested: time,
            received: time,
            pointing: AzEl::from_degrees(0.0, 0.0).into(),
            axes: angles_deg.map(axis),
        }
    }

    fn figures() -> Figures {
        Figures::new(satrak::VARIANT.capabilities, 0.1)
    }

    fn proof(angles_deg: impl Fn(f64) -> [Option<f64>; 2]) -> Option<(f64, Proof)> {
        let start = Instant::now();
        let mut looks = Looks::default();
        (0..50).find_map(|step| {
            let at_s = f64::from(step) * 0.1;
            let look = look(start, at_s, angles_deg(at_s));
            Some((at_s, looks.take(look, true, Some(start), figures())?))
        })
    }

    #[test]
    fn two_looks_that_agree_prove_standstill() {
        let (at_s, proof) = proof(|_| [Some(10.0), Some(20.0)]).unwrap();
        assert_eq!(proof, Proof::Angles);
        assert!(at_s >= figures().gap().as_secs_f64(), "{at_s}");
    }

    #[test]
    fn the_reply_to_a_repeated_question_is_no_older_than_it_came_in() {
        let start = Instant::now();
        let mut looks = Looks::default();
        let mut take = |asked_s: f64, received_s: f64| {
            let received = start + Duration::try_from_secs_f64(received_s).unwrap();
            let look = Measured { received, ..look(start, asked_s, [Some(10.0), Some(69.0)]) };
            looks.take(look, true, Some(start), figures())
        };
        let gap_s = figures().gap().as_secs_f64();
        assert_eq!(take(0.0, gap_s), None);
        assert_eq!(take(gap_s + 0.01, gap_s + 0.02), None, "measured at once after the first");
        assert_eq!(take(gap_s * 2.0, gap_s * 2.0 + 0.01), Some(Proof::Angles));
    }

    #[test]
    fn the_next_position_is_asked_for_so_that_it_can_prove_standstill() {
        let start = Instant::now();
        let (gap, far) = (figures().gap(), start + Duration::from_mins(1));
        for late in [20, 90, 300, 900].map(Duration::from_millis) {
            let mut looks = Looks::default();
            let late_by = |look: Measured| Measured { received: look.requested + late, ..look };
            let first = late_by(look(start, 0.0, [Some(10.0), Some(69.0)]));
            assert_eq!(looks.take(first, true, Some(start), figures()), None);
            let requested = looks.next(figures()).unwrap();
            assert!(requested >= start + gap && looks.is_due(figures(), far));
            assert!(!looks.is_due(figures(), far), "it has been requested");
            // This query was already sent.
            let early = late_by(look(start, 0.1, [Some(10.0), Some(69.0)]));
            assert_eq!(looks.take(early, true, Some(start), figures()), None);
            assert!(looks.is_due(figures(), far), "another one is needed");
            // This reply arrives at once.
            let next = Measured { requested, received: requested, ..first };
            assert_eq!(looks.take(next, true, Some(start), figures()), Some(Proof::Angles));
        }
    }

    #[test]
    fn an_axis_that_turns_is_never_proved_still() {
        assert_eq!(proof(|at_s| [Some(10.0 + 0.5 * at_s), Some(20.0)]), None);
        assert_eq!(proof(|at_s| [Some(10.0), Some(20.0 - 0.3 * at_s)]), None);
    }

    #[test]
    fn an_axis_without_an_angle_stands_by_its_flags() {
        let (_, proof) = proof(|_| [Some(10.0), None]).unwrap();
        assert_eq!(proof, Proof::Flags { axis: 1 });
    }

    #[test]
    fn an_axis_at_north_may_read_either_end_of_the_turn() {
        let is_even = |at_s: f64| (at_s * 10.0).round() % 2.0 == 0.0;
        let proof = proof(|at_s| [Some(if is_even(at_s) { 0.0 } else { 360.0 }), Some(0.0)]);
        assert!(proof.is_some());
    }

    #[test]
    fn what_turns_at_rest_is_told_once() {
        let start = Instant::now();
        let mut rest = Rest::default();
        let reported: Vec<_> = (0..200)
            .filter_map(|step| {
                let at_s = f64::from(step) * 0.1;
                let look = look(start, at_s, [Some(10.0 + 0.05 * at_s), Some(20.0)]);
                rest.take(look, true, None, figures()).map(|turned| (at_s, turned))
            })
            .collect();
        let [(at_s, (0, _))] = reported[..] else { panic!("{reported:?}") };
        assert!((3.0..8.0).contains(&at_s), "{at_s}");
    }

    /// Returns the times at which the watch reports an axis that turns at rest. The axis starts to
    /// turn after 10 s; Azel starts a motion at 9.95 s. Positions come every 0.1 s.
    fn contradictions_s(first_deg: impl Fn(f64) -> f64) -> Vec<f64> {
        let start = Instant::now();
        let began = start + Duration::from_millis(9950);
        let mut rest = Rest::default();
        (0..200)
            .filter_map(|step| {
                let at_s = f64::from(step) * 0.1;
                let look = look(start, at_s, [Some(first_deg(at_s)), Some(20.0)]);
                let begun = Some(began).filter(|began| *began <= look.requested);
                rest.take(look, true, begun, figures()).map(|_| at_s)
            })
            .collect()
    }

    #[test]
    fn a_step_between_two_positions_is_no_contradiction() {
        let once = contradictions_s(|at_s| 10.0 + f64::from(at_s > 10.15));
        assert!(once.is_empty(), "{once:?}");
        let twice =
            contradictions_s(|at_s| 10.0 + f64::from(at_s > 10.15) + f64::from(at_s > 14.05));
        assert_eq!(twice.len(), 1, "one motion makes one change: {twice:?}");
        let early = contradictions_s(|at_s| 10.0 + f64::from(at_s > 9.85));
        assert_eq!(early.len(), 1, "before the motion: {early:?}");
        let late = contradictions_s(|at_s| 10.0 + f64::from(at_s > 15.05));
        assert_eq!(late.len(), 1, "the motion was over: {late:?}");
    }

    #[test]
    fn a_motion_that_the_flags_hide_is_told() {
        let reported = contradictions_s(|at_s| 10.0 + 2.0 * (at_s - 10.0).max(0.0));
        let [at_s] = reported[..] else { panic!("{reported:?}") };
        assert!((13.0..13.5).contains(&at_s), "{at_s}");
    }
}
