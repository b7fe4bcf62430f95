//! [`Device`] and [`Controller`] of a Satrak.

use std::time::Duration;

use super::{
    DRAIN, REPLY, Satrak, checks, exchange::Outstanding, prepare::Preparation,
    schedule::QuerySchedule, settings::Plan, waiting_motion::WaitingMotion, words,
};
use crate::{
    clock::{Instant, Moment},
    device::{
        AntennaState, Controller, ControllerEvent, Device, Extent, Motion, PrepareError,
        TrackTarget, WireLine,
        panel::{Act, Lead},
        settings::{Change, WriteError},
    },
    protocol::satrak::{Decoder, Halt, Request},
};

impl Device for Satrak {
    fn link_up(&mut self, now: Moment) {
        self.link_down(now);
        self.state.link_since = Some(now.steady);
        self.state.motion_lock = None;
        self.state.identity = None;
        // A fault of the previous link may be fixed by now.
        (self.state.checks, self.state.checked_at) = (checks(None).into(), None);
        // The unit may use other data than on the previous link.
        let unit = &mut self.reported;
        (unit.clock, unit.gps, unit.gps_settings) = (None, None, None);
        (unit.clock_is_from_gps, unit.gps_lock_delay_s) = (None, None);
        (unit.settings, unit.satellite, unit.window) = (None, None, None);
        self.state.on_board = unit.on_board();
        self.schedule = Some(QuerySchedule::new(now.steady));
    }

    fn link_down(&mut self, now: Moment) {
        self.record_unfinished(now);
        self.has_heard_frame = false;
        self.decoder = Decoder::new();
        self.schedule = None;
        self.outstanding = None;
        self.drain_until = None;
        self.probe = None;
        self.missing.clear();
        self.late_until = None;
        self.halts.clear();
        self.motion = None;
        self.calm.clear();
        self.fail_preparation(PrepareError::Unanswered);
        self.pending.clear();
        self.slow = None;
        self.changes.abandon(&mut self.state, now);
    }

    fn sent(&mut self, bytes: &[u8], now: Moment) {
        self.record_sent(bytes, now);
    }

    fn next_wire_line(&mut self) -> Option<WireLine> {
        self.wire.pop()
    }

    fn receive(&mut self, bytes: &[u8], now: Moment) {
        self.decoder.push(bytes);
        // Azel takes the lines one by one, because each may change the expected next reply.
        while let Some(line) = self.decoder.next_line() {
            self.record_received(&line, now);
            self.take_line(line.frame, now);
        }
    }

    fn poll(&mut self, now: Moment) -> Option<Vec<u8>> {
        self.halts.retain(|(_, end)| *end > now.steady);
        if let Some(again) = self.expire(now) {
            return Some(again);
        }
        self.expire_slow(now);
        self.changes.begin(&mut self.state, now);
        if let Some(probe) = self.begin_probe(now) {
            return Some(probe);
        }
        if self.is_waiting() || self.drain_until.is_some_and(|deadline| now.steady < deadline) {
            return None;
        }
        if self.drain_until.take().is_some() {
            self.missing.clear();
        }
        let (request, purpose) = self.next_request(now)?;
        let bytes = request.to_bytes();
        self.outstanding = Some(self.outstanding_of(request, purpose, now));
        Some(bytes)
    }

    fn due(&self, now: Moment) -> Instant {
        if let Some(deadline) = self.reply_due() {
            return deadline;
        }
        if let Some(end) = self.drain_until {
            return end;
        }
        let slow = self.slow.as_ref().map(Outstanding::deadline);
        let far = now.steady + Duration::from_hours(1);
        let Some(schedule) = &self.schedule else { return far };
        let waits = self.motion.is_some()
            || !self.calm.is_empty()
            || !self.pending.is_empty()
            || self.preparation.is_some();
        if waits {
            return now.steady;
        }
        let due = schedule.due().into_iter().chain(slow).chain(self.write_due(now));
        due.min().unwrap_or(far)
    }

    fn halt(&mut self, extent: Extent, now: Moment) -> Vec<u8> {
        let ends_track = extent != Extent::Motion || self.program_may_run();
        let ends_auto_track = extent == Extent::Everything;
        self.motion = None;
        let is_sent = self.outstanding.as_ref().is_some_and(Outstanding::is_setting);
        let is_void = self.changes.void_judged(is_sent, &mut self.state, now);
        self.fail_preparation(PrepareError::Stopped);
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
            if is_void {
                outstanding.disown_look();
            }
        }
        self.halts.retain(|(_, end)| *end > now.steady);
        // STOP alone may leave tracking on, and auto-track may switch tracking on again. Either
        // would start the antenna unattended.
        let track = [Halt::TrackOff].into_iter().filter(|_| ends_track);
        let auto_track = [Halt::AutoTrackOff].into_iter().filter(|_| ends_auto_track);
        let halts = [Halt::Stop].into_iter().chain(track).chain(auto_track);
        let deadline = now.steady + REPLY;
        self.halts.extend(halts.clone().map(|halt| (halt, deadline)));
        self.look_soon(now);
        halts.flat_map(|halt| Request::Halt(halt).to_bytes()).collect()
    }

    fn ask_position(&mut self, now: Moment) {
        self.look_soon(now);
    }

    fn watch_closely(&mut self, is_watched: bool) {
        self.is_watched = is_watched;
    }

    fn read_group(&mut self, group: &str) {
        if let Some(plan) = Plan::for_key(group) {
            self.want(plan.query);
        }
    }

    fn refuse_change(&mut self, change: Change, write_error: WriteError, now: Moment) {
        self.changes.refuse(change, write_error, &mut self.state, now);
    }

    fn lock_changes(&mut self, are_locked: bool) {
        self.changes.lock(are_locked);
    }

    fn ask(&mut self, question: &str) {
        if let Some(query) = words::query(question) {
            self.want(query);
        }
    }

    fn disable_auto(&mut self) {
        self.calm.push_back(Halt::AutoTrackOff);
    }

    fn motion_under_way(&self) -> bool {
        self.motion_waits()
    }

    fn state(&self) -> &AntennaState {
        &self.state
    }

    fn next_event(&mut self) -> Option<ControllerEvent> {
        self.events.pop_front()
    }

    fn patience(&self) -> Duration {
        // One question may be lost: allow a poll period, the question, and its retry.
        self.poll_period() + REPLY * 2 + DRAIN
    }

    fn poll_period(&self) -> Duration {
        self.rates.period(self.moving())
    }
}

impl Controller for Satrak {
    fn lead_of(&self, _: &Act) -> Lead {
        Lead::Nowhere
    }

    fn prepare(&mut self, target: TrackTarget) {
        // An answer to a step of the previous preparation must not advance this preparation.
        if let Some(outstanding) = &mut self.outstanding {
            outstanding.disown();
        }
        self.preparation = Some(Preparation::new(target));
    }

    fn write_settings(&mut self, change: Change, now: Moment) {
        if self.schedule.is_none() {
            return self.changes.refuse(change, WriteError::NoLink, &mut self.state, now);
        }
        self.changes.push(change, &mut self.state);
    }

    fn shift_track(&mut self, change: Change, now: Moment) {
        if self.schedule.is_none() {
            return self.changes.refuse(change, WriteError::NoLink, &mut self.state, now);
        }
        self.changes.push_judged(change, &mut self.state);
    }

    fn start(&mut self, motion: Motion) {
        // A newer request replaces a request that was not sent yet.
        self.motion = Some(WaitingMotion::new(motion));
    }
}

#[cfg(test)]
mod tests {
    use super::{super::exchange::Purpose, *};
    use crate::{
        device::settings::{Value, Values},
        protocol::satrak::{Reply, Satellite},
        station::Antenna,
    };

    /// Returns a unit that has answered the first questions, so Azel sends the offset next.
    fn about_to_shift(now: Moment) -> Satrak {
        let poll = Antenna::satrak("Dish", "in memory").poll;
        let mut satrak = Satrak::new(poll, "stations.txt".to_owned());
        satrak.link_up(now);
        let values = [("azimuth_offset_deg", Value::Decimal(0.2))].into();
        let (ticket, group) = (1, "general");
        satrak
            .shift_track(Change { ticket, group, values, expected: None, is_unlocked: false }, now);
        satrak.changes.begin(&mut satrak.state, now);
        satrak.changes.advance(&mut satrak.state, now, |write| write.looked(Values::new()));
        satrak
    }

    #[test]
    fn a_new_link_knows_the_last_satellite_only_as_the_last_one() {
        let now = crate::clock::Clock::system().now();
        let mut satrak = about_to_shift(now);
        let satellite = Satellite {
            file: "stations.txt".to_owned(),
            name: "ISS (ZARYA)".to_owned(),
            period: 1,
            catalog_number: 25_544,
            maximum_elevation_deg: 60.0,
        };
        satrak.take_report(Reply::Satellite(satellite), now, now);
        assert!(satrak.state.on_board.satellite.is_some());
        satrak.link_up(now);
        assert_eq!(satrak.state.on_board.satellite, None);
        let last = satrak.state.last_satellite.as_ref().map(|last| (&*last.name, last.read_at));
        assert_eq!(last, Some(("ISS (ZARYA)", now.utc)));
    }

    #[test]
    fn a_halt_voids_an_offset_until_it_is_sent() {
        let now = crate::clock::Clock::system().now();
        let mut satrak = about_to_shift(now);
        satrak.halt(Extent::Motion, now);
        assert!(satrak.write_request(now).is_none());
        let written = satrak.state.group("general").written.clone().unwrap();
        assert_eq!(written.result, Err(WriteError::Stopped));
        let mut satrak = about_to_shift(now);
        let request = satrak.write_request(now).unwrap();
        satrak.outstanding = Some(satrak.outstanding_of(request, Purpose::WriteSettings, now));
        satrak.halt(Extent::Motion, now);
        assert!(satrak.changes.under_way().is_some(), "it is read back");
    }
}
