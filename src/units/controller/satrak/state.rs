//! Conversion of a Satrak's reports to the state that all antennas share.

use jiff::Timestamp;

use super::{
    Satrak, checks,
    settings::{CLOCK, RECEIVER, ahead, group_of, is_from_gps, lock_delay, values_of},
};
use crate::{
    astro::{AzEl, time::seconds_between},
    clock::Moment,
    device::{
        Axis, AxisMotion, Drive, LastSatellite, Measured, Phase, Program, UnitClock,
        settings::{HeldGroup, ReadFailure},
    },
    protocol::satrak::{AxisMotion as UnitMotion, Query, Reply, Status, TrackState},
};

/// Reason for an unreadable state whose numbers seem to contain decimal commas, with advice.
pub(super) const DECIMAL_COMMAS: &str = "The unit seems to write decimal commas. Set it to points.";

impl Satrak {
    /// Takes a reply. `moment` is the time of its question.
    pub(super) fn take_report(&mut self, reply: Reply, moment: Moment, now: Moment) {
        let way = now.steady.saturating_duration_since(moment.steady) / 2;
        let measured_at = now.utc.checked_sub(way).unwrap_or(now.utc);
        if let Reply::Clock(clock) = &reply {
            self.reported.clock = Some(UnitClock {
                ahead_s: seconds_between(measured_at, clock.time),
                error_s: way.as_secs_f64(),
                is_set: clock.is_set(),
                read_at: now.utc,
            });
        }
        self.take_values(&reply, now);
        let (unit, state) = (&mut self.reported, &mut self.state);
        match reply {
            Reply::Version(version) => {
                let firmware = [Some(version.control_unit.as_str()), version.drive_unit.as_deref()];
                let others = version.others.iter().map(String::as_str);
                let words: Vec<&str> = firmware.into_iter().flatten().chain(others).collect();
                state.identity = Some(words.join(", "));
                state.unit_name = Some(version.control_unit);
            }
            Reply::Status(status) => self.take_status(&status, measured_at, moment, now),
            Reply::Faults(faults) => {
                state.show_checks(checks(Some(&faults)));
                state.checked_at = Some(now.utc);
                state.motion_lock = Some(faults.lock_motion());
            }
            Reply::StartStopTime(window) => {
                unit.height_is_of_window &= unit.window == Some(window);
                unit.window = Some(window);
            }
            Reply::Settings(settings) => unit.settings = Some(settings),
            Reply::GpsData(gps) => unit.gps = Some(gps),
            Reply::GpsSettings(settings) => unit.gps_settings = Some(settings),
            Reply::Satellite(satellite) => {
                let name = satellite.name.clone();
                state.last_satellite = Some(LastSatellite { name, read_at: now.utc });
                unit.satellite = Some(satellite);
                unit.height_is_of_window = unit.window.is_some();
            }
            // The other replies concern only the settings.
            _ => {}
        }
        self.state.on_board = self.reported.on_board();
    }

    fn take_values(&mut self, reply: &Reply, now: Moment) {
        let Some((group, mut values)) = values_of(reply) else { return };
        if group.key == CLOCK.key {
            values.extend(self.reported.clock.as_ref().map(ahead));
        }
        let state = self.state.group(group.key);
        state.last_read = Some(HeldGroup { values, read_at: now.utc });
        state.failure = None;
        self.show_gps_state();
    }

    /// Adds the GPS values of a status to the groups in which the operator expects them.
    fn show_gps_state(&mut self) {
        let unit = &self.reported;
        let added = [
            (CLOCK.key, unit.clock_is_from_gps.map(is_from_gps)),
            (RECEIVER.key, unit.gps_lock_delay_s.map(lock_delay)),
        ];
        for (group, entry) in added {
            let Some((key, value)) = entry else { continue };
            let shown = self.state.groups.get(group).and_then(|state| state.last_read.as_ref());
            // An unchanged group stays shared.
            if shown.is_some_and(|held_group| held_group.values.get(key) != Some(&value))
                && let Some(read_group) = &mut self.state.group(group).last_read
            {
                read_group.values.insert(key, value);
            }
        }
    }

    /// Stores the failure of a question; earlier readings stay.
    pub(super) fn take_read_failure(&mut self, query: Query, failure: ReadFailure) {
        if let Some(group) = group_of(query) {
            self.state.group(group.key).failure = Some(failure);
        }
    }

    fn take_status(&mut self, status: &Status, time: Timestamp, moment: Moment, now: Moment) {
        let limits = status.limits;
        self.state.unreadable = None;
        self.state.measured = Some(Measured {
            time,
            requested: moment.steady,
            received: now.steady,
            pointing: AzEl::from_degrees(status.az_deg, status.el_deg).into(),
            axes: [
                axis(status.x_deg, status.x_motion, limits.x_plus, limits.x_minus),
                axis(status.y_deg, status.y_motion, limits.y_plus, limits.y_minus),
            ],
        });
        self.state.program = Some(Program {
            enabled: status.tracking_enabled,
            phase: match status.track_state {
                TrackState::NotInTrackTime => Phase::OutOfWindow,
                TrackState::InTrackTime => Phase::Tracking,
                TrackState::Completed => Phase::Completed,
                TrackState::BeforeStart => Phase::AtStart,
                TrackState::Unknown(code) => Phase::Unknown(code),
            },
            auto: status.auto_track,
        });
        if status.fault && !self.reported.fault_flag {
            // The answer to the next fault question names the fault.
            self.state.motion_lock = None;
        }
        self.reported.fault_flag = status.fault;
        self.reported.clock_is_from_gps = Some(status.rtc_from_gps);
        self.reported.gps_lock_delay_s = Some(status.gps_lock_delay_s);
        self.show_gps_state();
    }
}

fn axis(angle_deg: f64, motion: UnitMotion, plus_limit: bool, minus_limit: bool) -> Axis {
    let motion = match motion {
        UnitMotion::Still => AxisMotion::Still,
        UnitMotion::Positive => AxisMotion::Plus,
        UnitMotion::Negative => AxisMotion::Minus,
        UnitMotion::Unknown(code) => AxisMotion::Unknown(code),
    };
    let drive = if motion == AxisMotion::Still { Drive::Off } else { Drive::On };
    Axis { angle_deg: Some(angle_deg), motion, drive, plus_limit, minus_limit }
}
