//! Conversion of a status to the state that all antennas share.

use super::{Genius, panel, roles::Roles, settings};
use crate::{
    astro::Angle,
    clock::{Instant, Moment},
    device::{Axis, Drive, Measured, Pointing, settings::HeldGroup},
    protocol::rotator_genius::{Moving, RotatorNumber, Status},
};

impl Genius {
    /// Takes a status. `question_time` is the time of the question that it answers, `sent` the time
    /// of the last question.
    pub(super) fn take_status(
        &mut self,
        status: Status,
        question_time: Instant,
        sent: Instant,
        now: Moment,
    ) {
        let way = now.steady.saturating_duration_since(sent) / 2;
        let roles = Roles::new(self.rotators, &status);
        let axes = roles.axes.map(|number| {
            let rotator = status.rotator(number);
            let is_told = roles.is_clear || !roles.is_ours(number);
            Axis {
                angle_deg: Roles::axis_deg(rotator).filter(|_| is_told),
                motion: number.of_mut(&mut self.turning).look(rotator, now.steady),
                drive: match rotator.moving {
                    Moving::Stopped => Drive::Off,
                    Moving::Clockwise | Moving::CounterClockwise => Drive::On,
                },
                // The unit reports that a rotator is outside its limits, but not on which side. A
                // limit flag would block the way back.
                plus_limit: false,
                minus_limit: false,
            }
        });
        self.state.measured = Some(Measured {
            time: now.utc.checked_sub(way).unwrap_or(now.utc),
            requested: question_time,
            received: now.steady,
            pointing: pointing(axes, roles.is_pair),
            axes,
        });
        self.state.travel_deg = roles.travel_deg(&status);
        self.state.may_turn_either_way = roles.may_turn_over_north(&status);
        self.state.azimuth_limits_deg = roles.azimuth_limits_deg(&status);
        self.state.motion_lock = Some(false);
        let names = RotatorNumber::ALL.map(|number| status.rotator(number).name.as_str());
        self.state.identity = Some(names.join(", "));
        for number in RotatorNumber::ALL {
            let state = self.state.group(settings::group_of(number).key);
            let values = settings::values(&status, number);
            state.last_read = Some(HeldGroup { values, read_at: now.utc });
        }
        let rescue_left = self.rescue_until.map(|end| end.saturating_duration_since(now.steady));
        self.state.show_readings(panel::readings(&status, roles, rescue_left));
        self.state.show_checks(panel::checks(&status, roles));
        self.state.checked_at = Some(now.utc);
        self.status = Some(status);
    }
}

/// Returns the direction of the antenna, as far as its axes report it.
fn pointing([first, second]: [Axis; 2], is_pair: bool) -> Pointing {
    let angle = |axis: Axis| axis.angle_deg.map(Angle::from_degrees);
    Pointing::of_axes(angle(first), angle(second).filter(|_| is_pair))
}
