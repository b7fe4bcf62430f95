//! Times when antennas would join passes. The search for a path around keep-outs is slow, so Azel
//! keeps each result for one second.

use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

use jiff::Timestamp;

use super::Model;
use crate::{
    contract::{antenna::AntennaModel, passes::PassListKey},
    plan::schedule::{Joining, PlannedAntenna, Reach},
    station::AntennaId,
};

/// Max number of kept results: more than a list shows.
const MAX_JOININGS: usize = 200;

type Found = HashMap<(AntennaId, PassListKey), (i64, Option<Joining>)>;

#[derive(Debug, Default)]
pub struct Joinings(Mutex<Found>);

impl Joinings {
    /// Returns when the antenna would join the pass at `now`. Calls `find` only if no result of
    /// this second is kept.
    pub fn get_or_find(
        &self,
        antenna: AntennaId,
        pass: PassListKey,
        now: Timestamp,
        find: impl FnOnce() -> Option<Joining>,
    ) -> Option<Joining> {
        // No code panics while it holds the lock.
        let mut found = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let second = now.as_second();
        if let Some((searched_second, joining)) = found.get(&(antenna, pass))
            && *searched_second == second
        {
            return *joining;
        }
        let joining = find();
        if found.len() >= MAX_JOININGS {
            found.clear();
        }
        found.insert((antenna, pass), (second, joining));
        joining
    }
}

impl Model {
    /// Returns the antenna as the planner needs it, starting from its current position; `None` if
    /// the position is unknown.
    pub fn planned_from_here(&self, antenna: &AntennaModel) -> Option<PlannedAntenna> {
        let has_elevation = antenna.variant().capabilities.has_elevation();
        let measured = antenna.snapshot.state.measured.filter(|_| antenna.is_live())?;
        let reach =
            Reach::from_station(&self.station, &antenna.config, antenna.snapshot.rates_deg_s);
        let travel_deg = antenna.config.mount.travel_deg();
        Some(PlannedAntenna {
            stands_deg: Some(measured.planned_axes_deg(travel_deg, has_elevation)?),
            reach,
            ..PlannedAntenna::from_station(&self.station, &antenna.config, self.now)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_found_is_kept_for_the_second_of_its_antenna_and_pass() {
        let joinings = Joinings::default();
        let time = |ms: i64| Timestamp::from_millisecond(ms).unwrap();
        let join = |antenna: u32, satellite: u32, now: Timestamp, late_s: f64| {
            let joining = Joining { met: now, needs_s: late_s, late_s, left_s: 1.0 };
            let pass = (satellite, Timestamp::UNIX_EPOCH);
            joinings.get_or_find(AntennaId(antenna), pass, now, || Some(joining)).unwrap().late_s
                as i64
        };
        assert_eq!(join(1, 7, time(1_000), 10.0), 10);
        assert_eq!(join(1, 7, time(1_900), 11.0), 10);
        assert_eq!(join(2, 7, time(1_900), 12.0), 12);
        assert_eq!(join(1, 8, time(1_900), 13.0), 13);
        assert_eq!(join(1, 7, time(2_000), 14.0), 14);
    }
}
