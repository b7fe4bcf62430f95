//! [`Device`] and [`Controller`] of an RC2000C.

use std::time::Duration;

use super::{
    DEVICE_TYPE, HeldJog, Past, RENEWAL, Rc2000c, STATUS, SatelliteNames, VARIANT,
    exchange::{Outstanding, Purpose},
    refusal::is_tracking,
};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    device::{
        AntennaState, Controller, ControllerEvent, Device, Extent, Finding, Motion, MotionRequest,
        PrepareError, TrackTarget, WireLine,
        panel::{Act, Lead},
    },
    protocol::rc2000c::{
        AutoMove, Decoder, Motion as UnitMotion, PolarizationMotion, Request, Speed, Status,
    },
};

impl Device for Rc2000c {
    fn link_up(&mut self, now: Moment) {
        (self.is_status_asked, self.is_device_asked) = (false, false);
        self.link_down(now);
        self.state.link_since = Some(now.steady);
        self.state.motion_lock = None;
        self.state.checked_at = None;
        self.state.program = None;
        self.state.identity = None;
        self.status = None;
        self.past = Past::default();
        self.device = None;
        self.is_offline = false;
        self.wants_device = true;
        self.names = SatelliteNames::default();
        self.poll_at = Some(now.steady);
        self.refresh_panel();
    }

    fn link_down(&mut self, now: Moment) {
        self.record_noise(Finding::Unfinished, now);
        self.heard_at = None;
        self.decoder = Decoder::new(self.address);
        self.poll_at = None;
        self.gap_until = None;
        self.outstanding = None;
        self.missing.clear();
        self.drain_until = None;
        self.halt = None;
        self.orders.clear();
        self.jog = None;
        self.wants_device = false;
        self.holds_polarization = false;
    }

    fn sent(&mut self, bytes: &[u8], now: Moment) {
        self.record_sent(bytes, now);
    }

    fn next_wire_line(&mut self) -> Option<WireLine> {
        self.wire.pop()
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.hear(bytes, now);
        let skipped_before = self.decoder.skipped_bytes();
        self.decoder.push(bytes);
        while let Some(frame) = self.decoder.next() {
            self.take_frame(frame, now);
        }
        if self.decoder.skipped_bytes() > skipped_before {
            self.state.traffic.last_unreadable = Some(now.steady);
        }
        self.limit_noise(now);
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        if self.silent_at().is_some_and(|instant| now.steady >= instant) {
            for frame in self.decoder.line_is_quiet() {
                self.take_frame(frame, now);
            }
            self.record_noise(Finding::NoHeader, now);
            self.heard_at = None;
        }
        if let Some(again) = self.expire(now) {
            return Some(again);
        }
        if self.drain_until.take_if(|end| now.steady >= *end).is_some() {
            self.missing.clear();
        }
        if !self.is_free() || self.quiet_until().is_some_and(|deadline| now.steady < deadline) {
            return None;
        }
        let (request, purpose) = self.next_request(now)?;
        (self.gap_until, self.drain_until) = (None, None);
        self.outstanding = Some(Outstanding::new(request, purpose, self.line, now));
        Some(request.to_bytes(self.address))
    }

    fn due(&self, now: Moment) -> Instant {
        let far = now.steady + Duration::from_hours(1);
        let waits = self.halt.as_ref().or(self.outstanding.as_ref());
        let deadline = waits.map(|sent| self.deadline(sent));
        let next = self.is_free().then(|| self.next_due(now)).flatten();
        deadline.into_iter().chain(self.silent_at()).chain(next).min().unwrap_or(far)
    }

    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8> {
        self.orders.clear();
        self.jog = None;
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
        }
        let stands = |status: &Status| status.polarization_motion == PolarizationMotion::Still;
        // The halt of a jog must not undo the request that STOP has made.
        self.holds_polarization |=
            extent != Extent::Motion && !self.status.as_ref().is_some_and(stands);
        self.halt = Some(Outstanding::new(Request::Stop, Purpose::Halt, self.line, now));
        self.look_soon(now);
        Request::Stop.to_bytes(self.address)
    }

    fn halt_patience(&self) -> Duration {
        self.line.halt_wait()
    }

    fn ask_position(&mut self, now: Moment) {
        self.look_soon(now);
    }

    fn watch_closely(&mut self, is_watched: bool) {
        self.is_watched = is_watched;
    }

    fn prompt(&self) -> Duration {
        self.line.longest_prompt()
    }

    fn ask(&mut self, question: &str) {
        self.is_status_asked |= question == STATUS && self.poll_at.is_some();
        self.is_device_asked |= question == DEVICE_TYPE && self.poll_at.is_some();
    }

    fn motion_under_way(&self) -> bool {
        let is_sent = self.outstanding.as_ref().is_some_and(Outstanding::is_order);
        is_sent || !self.orders.is_empty() || self.jog.is_some()
    }

    /// Returns the motion as Azel sends it. A move always contains both axes: an axis that should
    /// stay gets its last position.
    fn as_sent(&self, motion: Motion) -> Motion {
        let Motion::Position { azimuth, elevation } = motion else { return motion };
        let status = self.status.as_ref();
        let counts = self.axes.counts(azimuth, elevation, status, &self.mount);
        let degrees = counts.ok().and_then(|counts| self.axes.degrees(counts));
        let [first, second] = degrees.unwrap_or_default().map(|deg| deg.map(Angle::from_degrees));
        Motion::Position { azimuth: first.or(azimuth), elevation: second.or(elevation) }
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_event(&mut self) -> Option<ControllerEvent> {
        self.events.pop_front()
    }

    fn patience(&self) -> Duration {
        // The limit covers a question and its two repetitions, in addition to the poll period.
        self.poll_period() + self.line.longest_wait() * 3
    }

    fn poll_period(&self) -> Duration {
        self.rates.period(self.moving())
    }
}

impl Rc2000c {
    /// Returns `true` if no reply is expected.
    fn is_free(&self) -> bool {
        self.outstanding.is_none() && self.halt.is_none()
    }

    /// Returns the time at which Azel gives up an unfinished frame.
    fn silent_at(&self) -> Option<Instant> {
        self.heard_at.map(|instant| instant + self.line.silence())
    }

    /// Returns the time of the next transmission if nothing is outstanding.
    fn next_due(&self, now: Moment) -> Option<Instant> {
        let poll_at = self.poll_at?;
        let is_asked = self.wants_device
            || self.is_status_asked
            || self.may_ask_device()
            || self.next_name().is_some();
        let instant = match self.jog {
            _ if !self.orders.is_empty() => now.steady,
            Some(jog) => jog.sent.map_or(now.steady, |sent| sent + RENEWAL),
            None if is_asked => now.steady,
            None => poll_at,
        };
        Some(instant.max(self.quiet_until().unwrap_or(instant)))
    }
}

impl Controller for Rc2000c {
    fn objection(&self, origin: &MotionRequest, _now: Moment) -> Option<&'static str> {
        self.objection_to(origin)
    }

    fn lead_of(&self, act: &Act) -> Lead {
        self.lead(act)
    }

    fn prepare(&mut self, target: TrackTarget) {
        let reason = PrepareError::CannotBeSent("it holds no elements".to_owned());
        self.events.push_back(ControllerEvent::NotPrepared(target, reason));
    }

    fn start(&mut self, motion: Motion) {
        // A newer request replaces a request that was not sent yet.
        self.orders.clear();
        match motion {
            Motion::Jog { x_deg_s, y_deg_s } if x_deg_s == 0.0 || y_deg_s == 0.0 => {
                let rate_deg_s = x_deg_s.abs().max(y_deg_s.abs());
                let named = VARIANT.capabilities.jog.nearest(rate_deg_s, self.maximum_rate_deg_s);
                let speed =
                    if named == Some(super::spec::FAST) { Speed::Fast } else { Speed::Slow };
                let direction = self.axes.direction(x_deg_s, y_deg_s);
                self.jog = Some(HeldJog { motion, direction, speed, sent: None });
            }
            Motion::Position { azimuth, elevation } => {
                let request = if self.status.as_ref().is_some_and(is_tracking) {
                    Err("TRACK is active on the unit".to_owned())
                } else {
                    let status = self.status.as_ref();
                    let counts = self.axes.counts(azimuth, elevation, status, &self.mount);
                    counts.map(|[az_counts, el_counts]| {
                        let target = AutoMove::position(az_counts, el_counts);
                        Request::Motion(UnitMotion::AutoMove(target))
                    })
                };
                self.order(motion.into(), request);
            }
            Motion::Jog { .. }
            | Motion::Step { .. }
            | Motion::StartProgram
            | Motion::EnableAuto => {
                self.order(motion.into(), Err("the controller cannot do this".to_owned()));
            }
        }
    }

    fn act(&mut self, act: Act) {
        self.act_on(&act);
    }
}
