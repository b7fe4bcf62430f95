//! The tracking window and the clock (sections 8 to 11 and 20).

use super::{
    proof::Proof,
    wish::{Wish, cannot},
};
use crate::{
    astro::time::add_seconds,
    device::{
        UnitClock,
        settings::{Field, Group, Kind, SettleError, Unfit, Value, Values},
    },
    protocol::satrak::{Clock, ClockTime, Setting, StartStopTime, TrackWindow},
};

/// No pass of a satellite that moves is longer, seconds.
const LONGEST_S: i64 = 86_400;
/// The clock of the unit is right within this, seconds: the command has no
/// parts of a second, and the answer takes its way.
const CLOCK_RIGHT_S: f64 = 2.0;

pub(super) static WINDOW: Group = Group {
    key: "window",
    title: "Tracking window",
    is_service: false,
    fields: &[
        Field::edit("start", "Start", Kind::Time)
            .in_unit("UTC")
            .moving()
            .about("The unit tracks from here on while tracking is switched on."),
        Field::edit("stop", "Stop", Kind::Time)
            .in_unit("UTC")
            .moving()
            .about("The unit ends tracking here."),
    ],
};

/// Where the unit's clock is set from.
pub const FROM_THIS_PC: i64 = 0;
/// See [`FROM_THIS_PC`].
pub const FROM_GPS: i64 = 1;

pub(super) static CLOCK: Group = Group {
    key: "clock",
    title: "Clock",
    is_service: false,
    fields: &[
        Field::read("time", "Unit clock", Kind::Time).in_unit("UTC"),
        Field::read(
            "ahead_s",
            "Ahead of this PC",
            Kind::Decimal { least: f64::MIN, most: f64::MAX, places: 1 },
        )
        .in_unit("s"),
        Field::write(
            "set_from",
            "Set from",
            Kind::Choice(&[(FROM_THIS_PC, "This PC"), (FROM_GPS, "GPS")]),
        )
        .moving()
        .about("The unit tracks by its clock."),
    ],
};

pub(super) fn window(window: &StartStopTime) -> Values {
    [("start", Value::Time(window.start)), ("stop", Value::Time(window.stop))].into()
}

pub(super) fn clock(clock: Clock, against_ours: Option<&UnitClock>) -> Values {
    let mut values = Values::from([("time", Value::Time(clock.time))]);
    let tenths = |seconds: f64| (seconds * 10.0).round() / 10.0;
    values.extend(against_ours.map(|it| ("ahead_s", Value::Decimal(tenths(it.ahead_s)))));
    values
}

pub(super) fn write_window(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    let refuse = |field, reason: &str| {
        Err(SettleError::CannotBeSent { field, reason: Unfit::Text(reason.to_owned()) })
    };
    let (start, stop) = (wish.time("start")?, wish.time("stop")?);
    if stop <= wish.utc {
        return refuse("stop", "is over already");
    }
    if stop.as_second() - start.as_second() > LONGEST_S {
        return refuse("stop", "is more than a day after the start");
    }
    TrackWindow::new(start, stop).map(Setting::StartStopTime).map_err(cannot("stop"))
}

/// Sent just after a full second of our clock, for the command has no parts
/// of a second.
pub(super) fn write_clock(wish: &Wish<'_>) -> Result<Setting, SettleError> {
    if wish.code("set_from").unwrap_or(FROM_THIS_PC) == FROM_GPS {
        return Ok(Setting::RtcReupdate);
    }
    let nearest = add_seconds(wish.utc, 0.5);
    ClockTime::new(nearest).map(Setting::Time).map_err(cannot("set_from"))
}

/// GPS knows better than this computer what time it is.
pub(super) fn clock_differing(proof: &Proof<'_>) -> Vec<&'static str> {
    let from_gps = proof.new.get("set_from") == Some(&Value::Choice(FROM_GPS));
    let is_right = proof.ahead_s.is_some_and(|ahead_s| ahead_s.abs() <= CLOCK_RIGHT_S);
    if from_gps || is_right { Vec::new() } else { vec!["time"] }
}
