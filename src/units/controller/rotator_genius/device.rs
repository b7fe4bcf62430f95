//! [`Device`] and [`Controller`] of a Rotator Genius.

use std::time::Duration;

use super::{
    Genius, PATIENCE, STATUS,
    actions::{ARMED, OTHER, RESCUE},
    exchange::Outstanding,
    orders::in_whole_degrees,
};
use crate::{
    clock::{Instant, Moment},
    device::{
        AntennaState, Controller, ControllerEvent, Device, Extent, Motion, MotionRequest,
        PrepareError, TrackTarget, WireLine,
        panel::{Act, Lead},
        settings::{Change, WriteError},
    },
    protocol::rotator_genius::{Decoder, Request},
};

impl Device for Genius {
    fn link_up(&mut self, now: Moment) {
        self.link_down(now);
        self.state.link_since = Some(now.steady);
        self.state.motion_lock = None;
        self.state.forget_checks();
        self.state.is_other_device = false;
        self.next_poll = Some(now.steady);
    }

    fn link_down(&mut self, now: Moment) {
        self.is_asked = false;
        self.record_unfinished(now);
        if self.decoder.has_noise() {
            self.take_noise(now);
        }
        self.decoder = Decoder::new();
        self.quiet_at = None;
        self.status = None;
        self.turning = Default::default();
        self.next_poll = None;
        self.outstanding = None;
        self.missing.clear();
        self.drain_until = None;
        self.halts.clear();
        self.orders.clear();
        self.disarm();
        self.changes.abandon(&mut self.state, now);
    }

    fn sent(&mut self, bytes: &[u8], now: Moment) {
        self.record_sent(bytes, now);
    }

    fn next_wire_line(&mut self) -> Option<WireLine> {
        self.wire.pop()
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.take_bytes(bytes, now);
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        self.halts.retain(|end| *end > now.steady);
        self.end_unfinished(now);
        if std::mem::take(&mut self.is_rescue_wanted) {
            self.rescue_until = Some(now.steady + ARMED);
            self.look_soon(now);
        }
        if let Some(stop) = self.expire(now) {
            return Some(stop);
        }
        if self.drain_until.take_if(|deadline| now.steady >= *deadline).is_some() {
            self.missing.clear();
        }
        if self.outstanding.is_some() || self.drains_until().is_some() {
            return None;
        }
        let (request, purpose) = self.next_request(now)?;
        self.drain_until = None;
        if request == Request::Read {
            // A session may request an earlier position before the answer comes.
            self.next_poll = Some(now.steady + self.period(now.steady));
        }
        let bytes = request.to_bytes();
        let is_rescue = self.is_rescue_armed(now.steady);
        self.outstanding = Some(Outstanding::new(request, purpose, now, is_rescue));
        Some(bytes)
    }

    fn due(&self, now: Moment) -> Instant {
        let next = match (&self.outstanding, self.drains_until()) {
            (Some(outstanding), _) => Some(self.deadline(outstanding)),
            (None, Some(end)) => Some(end),
            (None, None) if self.has_something_to_send() => Some(now.steady),
            (None, None) => self.next_poll,
        };
        let far = now.steady + Duration::from_hours(1);
        next.into_iter().chain(self.quiet_at).min().unwrap_or(far)
    }

    fn halt(&mut self, _: Extent, now: Moment) -> Vec<u8> {
        self.stop_both(now)
    }

    fn disarm(&mut self) {
        self.rescue_until = None;
        self.is_rescue_wanted = false;
    }

    fn ask_position(&mut self, now: Moment) {
        self.look_soon(now);
    }

    fn watch_closely(&mut self, is_watched: bool) {
        self.is_watched = is_watched;
    }

    fn refuse_change(&mut self, change: Change, write_error: WriteError, now: Moment) {
        self.changes.refuse(change, write_error, &mut self.state, now);
    }

    fn lock_changes(&mut self, are_locked: bool) {
        self.changes.lock(are_locked);
    }

    fn ask(&mut self, question: &str) {
        self.is_asked |= question == STATUS && self.next_poll.is_some();
    }

    fn motion_under_way(&self) -> bool {
        self.motion_waits()
    }

    fn as_sent(&self, motion: Motion) -> Motion {
        in_whole_degrees(motion)
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_event(&mut self) -> Option<ControllerEvent> {
        self.events.pop_front()
    }

    fn patience(&self) -> Duration {
        PATIENCE
    }

    fn poll_period(&self) -> Duration {
        self.rates.period(self.moving())
    }
}

impl Controller for Genius {
    /// Returns `Nowhere`, because no action of this make turns an axis of this antenna to a
    /// direction.
    fn lead_of(&self, _: &Act) -> Lead {
        Lead::Nowhere
    }

    fn prepare(&mut self, target: TrackTarget) {
        let reason = PrepareError::CannotBeSent("the unit does not track by itself".to_owned());
        self.events.push_back(ControllerEvent::NotPrepared(target, reason));
    }

    fn write_settings(&mut self, change: Change, now: Moment) {
        if self.next_poll.is_none() {
            return self.changes.refuse(change, WriteError::NoLink, &mut self.state, now);
        }
        self.changes.push(change, &mut self.state);
    }

    fn objection(&self, origin: &MotionRequest, now: Moment) -> Option<&'static str> {
        self.objection_to(origin, now)
    }

    fn start(&mut self, motion: Motion) {
        // A newer request replaces a request that was not sent yet.
        self.orders.retain(|order| matches!(order.origin, MotionRequest::Action(_)));
        match self.orders_for(motion) {
            Ok(orders) => self.orders.extend(orders),
            Err(reason) => {
                self.events.push_back(ControllerEvent::Refused(motion.into(), reason.to_owned()));
            }
        }
    }

    fn act(&mut self, act: Act) {
        match act.action {
            RESCUE => self.is_rescue_wanted = true,
            OTHER => {
                let origin = MotionRequest::Action(OTHER);
                self.orders.retain(|order| order.origin != origin);
                match self.order_for(&act) {
                    Ok(order) => self.orders.push_back(order),
                    Err(reason) => {
                        self.events.push_back(ControllerEvent::Refused(origin, reason.to_owned()));
                    }
                }
            }
            _ => {}
        }
    }
}
