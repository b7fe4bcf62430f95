//! The tracking window and the clock (sections 8 to 11 and 20).

use jiff::Timestamp;

use super::{
    desired::{Desired, cannot},
    proof::Proof,
};
use crate::{
    astro::time::add_seconds,
    device::{
        ClockSetting, LONGEST_WINDOW_S, UnitClock,
        settings::{Field, Group, Key, Unfit, Value, Values, WriteError},
    },
    protocol::satrak::{ClockTime, Reply, Setting, TrackWindow},
};

/// Max error of a correct clock, seconds: the command has no fraction of a second, and the answer
/// takes time to arrive.
const CLOCK_RIGHT_S: f64 = 2.0;

pub const START: Key<Timestamp> = Key::time("start");
pub const STOP: Key<Timestamp> = Key::time("stop");

const FROM_START_TO_STOP: &str = "window";

pub static WINDOW: Group = Group {
    key: "window",
    title: "Tracking window",
    is_service: false,
    fields: &[
        Field::edit(START, "Start")
            .part_of(FROM_START_TO_STOP)
            .in_unit("UTC")
            .moving()
            .description("The unit tracks from here on while tracking is switched on."),
        Field::edit(STOP, "Stop")
            .part_of(FROM_START_TO_STOP)
            .in_unit("UTC")
            .moving()
            .description("The unit ends tracking here."),
    ],
};

/// Source of the unit's clock: this computer.
pub const FROM_THIS_PC: i64 = 0;
/// Source of the unit's clock: GPS.
pub const FROM_GPS: i64 = 1;

const TIME: Key<Timestamp> = Key::time("time");
pub const AHEAD_S: Key<f64> = Key::decimal("ahead_s", f64::MIN, f64::MAX, 1);
const IS_FROM_GPS: Key<bool> = Key::flag("is_from_gps");
pub const SET_FROM: Key<i64> =
    Key::choice("set_from", &[(FROM_THIS_PC, "This PC"), (FROM_GPS, "GPS")]);

pub static CLOCK: Group = Group {
    key: "clock",
    title: "Clock",
    is_service: false,
    fields: &[
        Field::read(TIME, "Unit clock"),
        Field::read(AHEAD_S, "Ahead of this PC").in_unit("s"),
        Field::read(IS_FROM_GPS, "Updated from GPS"),
        Field::write(SET_FROM, "Set from").moving().description("The unit tracks by its clock."),
    ],
};

pub(super) fn window(reply: &Reply) -> Option<Values> {
    let Reply::StartStopTime(window) = reply else { return None };
    Some(Values::from([START.entry(window.start), STOP.entry(window.stop)]))
}

/// Description of the clock setting. Azel does not set the clock of a unit that updates it from
/// GPS, because the unit would overwrite it.
pub(in crate::controller::satrak) static CLOCK_SETTING: ClockSetting = ClockSetting {
    group: CLOCK.key,
    from_here: || Values::from([SET_FROM.entry(FROM_THIS_PC)]),
    is_kept_by_unit: |values| IS_FROM_GPS.get(values) == Some(true),
};

/// Returns the values of a clock reply. [`ahead`] and [`is_from_gps`] have other sources.
pub(super) fn clock(reply: &Reply) -> Option<Values> {
    let Reply::Clock(clock) = reply else { return None };
    Some(Values::from([TIME.entry(clock.time)]))
}

/// Returns the lead of the unit's clock over the computer's as shown, tenths of a second.
pub(in crate::controller::satrak) fn ahead(clock: &UnitClock) -> (&'static str, Value) {
    AHEAD_S.entry((clock.ahead_s * 10.0).round() / 10.0)
}

/// Returns the entry for a clock that the unit updates from GPS. STATUS reports it; TIME does not.
pub(in crate::controller::satrak) fn is_from_gps(is_from_gps: bool) -> (&'static str, Value) {
    IS_FROM_GPS.entry(is_from_gps)
}

pub(super) fn write_window(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    let refuse = |reason: &str| {
        let reason = Unfit::Text(reason.to_owned());
        Err(WriteError::CannotBeSent { field: STOP.name, reason })
    };
    let (start, stop) = (desired.get(&START)?, desired.get(&STOP)?);
    if stop <= desired.utc {
        return refuse("is over already");
    }
    if stop.as_second() - start.as_second() > LONGEST_WINDOW_S {
        return refuse("is more than a day after the start");
    }
    TrackWindow::new(start, stop).map(Setting::StartStopTime).map_err(cannot(STOP.name))
}

/// Returns the command for the clock. Azel sends it just after a full second of the computer's
/// clock, because the command has no fraction of a second.
pub(super) fn write_clock(desired: &Desired<'_>) -> Result<Setting, WriteError> {
    if desired.get(&SET_FROM).unwrap_or(FROM_THIS_PC) == FROM_GPS {
        return Ok(Setting::RtcReupdate);
    }
    let nearest = add_seconds(desired.utc, 0.5);
    ClockTime::new(nearest).map(Setting::Time).map_err(cannot(SET_FROM.name))
}

/// Returns the fields that differ; none for a clock set from GPS, which is more accurate than this
/// computer.
pub(super) fn clock_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    let from_gps = SET_FROM.get(proof.new) == Some(FROM_GPS);
    let is_right = proof.ahead_s.is_some_and(|ahead_s| ahead_s.abs() <= CLOCK_RIGHT_S);
    if from_gps || is_right { Vec::new() } else { vec![TIME.name] }
}
