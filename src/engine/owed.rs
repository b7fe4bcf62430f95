//! STOPs owed to units that no antenna of the station has: the antenna was deleted, or
//! given another address, while it moved.

use jiff::Timestamp;

use super::alarms::{AlarmKind, Alarms};
use crate::{driver::Unit, station::Antenna};

/// The units of `owed` that no antenna has.
pub(super) fn strangers<'a>(
    mut owed: Vec<Unit>,
    antennas: impl Iterator<Item = &'a Antenna>,
) -> Vec<Unit> {
    for antenna in antennas {
        let known = Unit::of(antenna);
        owed.retain(|unit| *unit != known);
    }
    owed
}

/// Raises an alarm for each of `strangers`, and clears those whose STOP is paid.
pub(super) fn tell(alarms: &mut Alarms, strangers: Vec<Unit>, now: Timestamp) {
    alarms.clear(
        None,
        now,
        |kind| matches!(kind, AlarmKind::Owed(unit) if !strangers.contains(unit)),
    );
    for unit in strangers {
        alarms.raise(None, AlarmKind::Owed(unit), now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::words;

    fn standing(alarms: &Alarms) -> Vec<String> {
        let list = alarms.list().iter().filter(|alarm| !alarm.is_over());
        list.map(|alarm| words::alarm(&alarm.kind, "")).collect()
    }

    #[test]
    fn a_unit_of_no_antenna_is_named_until_its_stop_is_paid() {
        let kept = Antenna::satrak("Dish", "10.0.0.5:4001");
        let gone = Antenna::genius("Mast", "10.0.0.6:9006");
        let owed = vec![Unit::of(&kept), Unit::of(&gone)];
        let mut alarms = Alarms::default();
        for _ in 0..3 {
            let strangers = strangers(owed.clone(), std::iter::once(&kept));
            tell(&mut alarms, strangers, Timestamp::UNIX_EPOCH);
        }
        let told = standing(&alarms);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].starts_with("The 4O3A Rotator Genius at 10.0.0.6:9006"), "{told:?}");
        tell(&mut alarms, Vec::new(), Timestamp::UNIX_EPOCH);
        assert_eq!(standing(&alarms), [""; 0]);
    }
}
