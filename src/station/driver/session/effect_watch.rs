//! Stop of motions without effect.

use super::{
    Session,
    activity::{Activity, SlewStage},
    effect::{Approach, RequestedMotion},
};
use crate::{
    clock::Moment,
    contract::driver::{Event, Safety},
    device::Measured,
    name::Name,
};

impl Session {
    /// Stops a motion without effect.
    pub(super) fn watch_effect(&mut self, now: Moment) {
        let Some(look) = self.gate.state().measured else { return };
        if !self.observed.effects.is_new(&look) {
            return;
        }
        let (requested, figures, can) =
            (self.requested_motion(&look), self.figures(), self.setup.can());
        let suspects = self.gate.suspects(now);
        let missing = self.observed.effects.failed_axis(&look, requested, suspects, can, figures);
        if let Some(axis) = missing {
            self.end_without_effect(can.axes.get(axis).copied(), now);
        }
    }

    /// Stops a motion without effect, and reports it.
    pub(super) fn end_without_effect(&mut self, axis: Option<Name>, now: Moment) {
        if self.commanded.key.pressed().is_some() {
            self.commanded.key.spend();
            self.halt_quietly(now);
        } else {
            self.halt(now);
        }
        self.tell(Event::Safety(Safety::NoEffect { axis }));
    }

    /// Returns the motion of Azel that must show in the angles.
    fn requested_motion(&self, look: &Measured) -> RequestedMotion {
        // A halt ends the expected motion, and without a link no angle would show it.
        if self.stop.is_under_way() || !self.contact.is_open() {
            return RequestedMotion::Nothing;
        }
        if let Some(jog) = self.commanded.key.started() {
            let rates_deg_s = jog.rates_deg_s();
            return RequestedMotion::Jog {
                rates_deg_s,
                is_at_end: self.is_at_own_end(look, rates_deg_s),
            };
        }
        let slew = self.commanded.activity.slew();
        let is_slew = slew.is_some_and(|slew| matches!(slew.stage, SlewStage::UnderWay { .. }));
        let is_track = matches!(self.commanded.activity, Activity::ProgramTrack(_));
        if !is_slew && !is_track {
            return RequestedMotion::Nothing;
        }
        let [(from_deg, to_deg), _] = self.gate.bounds().mount().travel_deg();
        RequestedMotion::Approach(Approach {
            is_slew,
            to_deg: self.gate.sent_to_deg(),
            rates_deg_s: self.setup.track_config().rates_deg_s(),
            may_turn_either_way: self.gate.state().may_turn_either_way,
            has_one_turn: to_deg - from_deg <= 360.0,
        })
    }

    /// Returns `true` for each axis that stands at an end of the unit's own travel and is jogged
    /// towards it.
    fn is_at_own_end(&self, look: &Measured, rates_deg_s: [f64; 2]) -> [bool; 2] {
        let can = self.setup.can();
        let near_deg = can.arrives_within_deg + 2.0 * can.standstill.resolution_deg;
        let travel_deg = self.gate.state().travel_deg;
        let mut is_at_end = [false; 2];
        let axes = look.axes.iter().zip(travel_deg).zip(rates_deg_s);
        for (is_at_end, ((axis, travel_deg), rate)) in is_at_end.iter_mut().zip(axes) {
            let Some((angle_deg, (from_deg, to_deg))) = axis.angle_deg.zip(travel_deg) else {
                continue;
            };
            let left_deg = if rate > 0.0 { to_deg - angle_deg } else { angle_deg - from_deg };
            *is_at_end = left_deg <= near_deg;
        }
        is_at_end
    }
}
