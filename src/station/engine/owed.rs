//! STOPs, ends of auto-track and offsets owed to units that no antenna of the station has. The
//! antenna was deleted or got another address while it moved or tracked on its own.

use std::{collections::BTreeSet, sync::Arc};

use jiff::Timestamp;

use super::Engine;
use crate::{
    contract::{
        alarms::{AlarmKind, Alarms},
        driver::Unit,
    },
    controller::SPECS,
    driver::Debts,
    engine::alarms::KeepAlarms,
    plan::Bounds,
    station::Antenna,
};

impl Engine {
    /// Opens sessions for units without an antenna that an earlier run may have left moving or in
    /// auto-track. Each session sends STOP or switches auto-track off, and then ends.
    pub(super) fn pay_left_debts(&mut self) {
        let debts = self.driver.debts();
        let has_it = |unit: &Unit| {
            self.station.antennas.iter().any(|configured| Unit::new(configured) == *unit)
        };
        let left: BTreeSet<Unit> =
            debts.with_auto_track().into_iter().chain(debts.left_moving()).collect();
        for unit in left.into_iter().filter(|unit| !has_it(unit)) {
            let spec = SPECS.iter().find(|spec| spec.key == unit.make);
            // A unit of an unknown make keeps its alarm.
            let Some(spec) = spec else { continue };
            let antenna = spec.antenna(&unit.address, &unit.address);
            match self.claim_unit(&antenna, None) {
                Ok(claim) => {
                    let bounds = Bounds::of_antenna(&antenna);
                    self.left_units
                        .extend(claim.as_ref().map(|claim| (unit, Arc::downgrade(claim))));
                    let learned = self.learned_drives(&antenna);
                    drop(self.driver.open(&antenna, bounds, learned, None, Box::new(claim)));
                }
                // The Azel instance that controls the unit handles its debts.
                Err(_) => debts.leave(&unit),
            }
        }
    }

    /// Leaves the debts of a unit to another process if a name lookup showed that this process
    /// drives the unit.
    pub(super) fn settle_left_units(&mut self) {
        let debts = self.driver.debts();
        self.left_units.retain(|(unit, claim)| {
            let Some(claim) = claim.upgrade() else { return false };
            let is_ours = claim.elsewhere().is_none();
            if !is_ours {
                debts.leave(unit);
            }
            is_ours
        });
    }
}

/// Returns alarms about units with debts that none of `antennas` has.
pub(super) fn strangers<'a>(
    debts: &Debts,
    antennas: impl Iterator<Item = &'a Antenna>,
) -> Vec<AlarmKind> {
    let units: Vec<Unit> = antennas.map(Unit::new).collect();
    let is_strange = |unit: &Unit| !units.contains(unit);
    let stops: BTreeSet<Unit> = debts.units().into_iter().chain(debts.left_moving()).collect();
    let stops = stops.into_iter().filter(is_strange).map(AlarmKind::Owed);
    let auto_track = debts.with_auto_track().into_iter().filter(is_strange);
    let offsets = debts.with_offsets().into_iter().filter(is_strange);
    let owed = stops.chain(auto_track.map(AlarmKind::AutoTrackOwed));
    owed.chain(offsets.map(AlarmKind::OffsetsOwed)).collect()
}

/// Raises these alarms, and clears alarms whose debt is settled.
pub(super) fn tell(alarms: &mut Alarms, strangers: Vec<AlarmKind>, now: Timestamp) {
    alarms.clear(None, now, |kind| {
        let is_that = matches!(
            kind,
            AlarmKind::Owed(_) | AlarmKind::AutoTrackOwed(_) | AlarmKind::OffsetsOwed(_)
        );
        is_that && !strangers.contains(kind)
    });
    for kind in strangers {
        alarms.raise(None, kind, now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing(alarms: &Alarms) -> Vec<&AlarmKind> {
        let list = alarms.list().iter().filter(|alarm| !alarm.is_over());
        list.map(|alarm| &alarm.kind).collect()
    }

    #[test]
    fn a_unit_of_no_antenna_is_named_until_its_debts_are_paid() {
        let present = Antenna::satrak("Dish", "10.0.0.5:4001");
        let removed = Antenna::genius("Mast", "10.0.0.6:9006");
        let left = Antenna::satrak("Dish", "10.0.0.7:4001");
        let debts = Debts::default();
        for antenna in [&present, &left] {
            debts.owe_auto_track_off(&Unit::new(antenna));
        }
        for antenna in [&present, &removed] {
            debts.owe(&Unit::new(antenna));
        }
        let mut alarms = Alarms::default();
        for _ in 0..3 {
            let strangers = strangers(&debts, std::iter::once(&present));
            tell(&mut alarms, strangers, Timestamp::UNIX_EPOCH);
        }
        let expected =
            [AlarmKind::Owed(Unit::new(&removed)), AlarmKind::AutoTrackOwed(Unit::new(&left))];
        assert_eq!(standing(&alarms), expected.iter().collect::<Vec<_>>());
        tell(&mut alarms, Vec::new(), Timestamp::UNIX_EPOCH);
        assert!(standing(&alarms).is_empty());
    }

    #[test]
    fn a_unit_of_no_antenna_that_may_hold_offsets_of_a_pass_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let left = |address: &str| {
            let text = format!(
                "make = 'satrak'\naddress = '{address}'\nsince = '2026-08-12T01:02:03Z'\n\
                 put = [{{ azimuth_deg = 0.2 }}]\nbefore = {{}}\n"
            );
            std::fs::write(folder.path().join(format!("{}.offsets.toml", &address[7..8])), text)
        };
        left("10.0.0.5:4001").unwrap();
        left("10.0.0.7:4001").unwrap();
        let debts = Debts::marked_in(Some(folder.path().to_owned()));
        let present = Antenna::satrak("Dish", "10.0.0.5:4001");
        let mut alarms = Alarms::default();
        let strangers = strangers(&debts, std::iter::once(&present));
        tell(&mut alarms, strangers, Timestamp::UNIX_EPOCH);
        let stranger = Antenna::satrak("Dish", "10.0.0.7:4001");
        assert_eq!(standing(&alarms), [&AlarmKind::OffsetsOwed(Unit::new(&stranger))]);
    }
}
