//! Automatic end of a replay, in favour of the live station.

#[cfg(test)]
mod tests;

use jiff::Timestamp;

use crate::{
    astro::time::add_seconds,
    contract::alarms::{Alarm, Priority},
    model::{
        Model,
        replay::{ENDS_BEFORE_PASS_S, ReplayEnd},
    },
    plan::schedule::Entry,
    ui::words,
};

/// Returns the reason why a replay that began at `begun_at` ends automatically.
pub(super) fn why_over(begun_at: Timestamp, live: &Model) -> Option<ReplayEnd> {
    let is_grave = |alarm: &Alarm| {
        alarm.priority() == Priority::First && !alarm.acknowledged && alarm.last > begun_at
    };
    if live.alarms.list().iter().any(is_grave) {
        return Some(ReplayEnd::Alarm);
    }
    let is_near = |entry: &&Entry| {
        let ends_at = add_seconds(entry.start, -ENDS_BEFORE_PASS_S);
        begun_at < ends_at && ends_at <= live.now && live.now < entry.start
    };
    let entry = live.schedule.schedule.entries.iter().find(is_near)?;
    let satellite = words::schedule::satellite_name(live, entry.pass.satellite);
    let antenna = words::schedule::antenna_name(live, entry.antenna).to_owned();
    Some(ReplayEnd::Pass { antenna, satellite, start: entry.start })
}
