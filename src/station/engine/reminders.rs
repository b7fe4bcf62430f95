//! Reminders of marked favourites' passes, and an alarm if no antenna takes such a pass.

use std::time::Duration;

use jiff::Timestamp;

use super::{Engine, StationClaim};
use crate::{
    astro::time::seconds_between,
    contract::{
        alarms::{AlarmKind, Alarms},
        passes::{PassList, PredictedPass},
        reminders::Reminder,
    },
    engine::alarms::KeepAlarms,
    plan::Trackability,
    station::Station,
};

/// Min time before AOS at which an antenna should be on its way.
const ON_ITS_WAY: Duration = Duration::from_secs(30);

impl Engine {
    /// Updates the reminders and their alarms.
    pub(super) fn remind(&mut self) {
        // The Azel that holds this station shows the reminders.
        if matches!(self.station_claim, StationClaim::Theirs(_)) {
            self.reminders.clear();
        } else {
            let passes = &self.pass_lists.favourites;
            refresh(&mut self.reminders, &self.station, passes, self.now);
        }
        let takes = |number| self.antennas.iter().any(|antenna| antenna.shown.takes(number));
        watch(&mut self.alarms, &self.reminders, takes, self.now);
    }
}

/// Adds due reminders, and drops reminders of passes that are over.
fn refresh(reminders: &mut Vec<Reminder>, station: &Station, passes: &PassList, now: Timestamp) {
    let notices = &station.notices;
    let is_marked =
        |number: u32| station.favourites.contains(number) && notices.reminders.contains(&number);
    reminders.retain(|reminder| reminder.los > now && is_marked(reminder.pass.0));
    if notices.reminders.is_empty() {
        return;
    }
    let is_near = |aos| seconds_between(now, aos) <= notices.reminder_min * 60.0;
    let ahead = passes.upcoming(now);
    for predicted in ahead.iter().take_while(|predicted| is_near(predicted.pass.aos.time)) {
        let (number, aos) = predicted.key();
        let is_due = now < aos;
        // A new list may predict the pass at a slightly different time.
        let is_it = |reminder: &Reminder| reminder.pass.0 == number && aos < reminder.los;
        if is_due && is_marked(number) && !reminders.iter().any(is_it) {
            reminders.push(reminder(predicted, station));
        }
    }
}

fn reminder(predicted: &PredictedPass, station: &Station) -> Reminder {
    let can_track = station.antennas.iter().enumerate().filter(|(index, _)| {
        let trackability = predicted.trackability(*index);
        matches!(trackability, Some(Trackability::Whole | Trackability::Loses { .. }))
    });
    Reminder {
        pass: predicted.key(),
        name: predicted.satellite.short_name().to_owned(),
        los: predicted.pass.los.time,
        max_elevation: predicted.pass.max_elevation(),
        can_track: can_track.map(|(_, antenna)| antenna.id).collect(),
    }
}

/// Raises an alarm shortly before AOS while no antenna takes the pass. The alarm lasts until an
/// antenna takes the pass, or until LOS.
fn watch(alarms: &mut Alarms, reminders: &[Reminder], takes: impl Fn(u32) -> bool, now: Timestamp) {
    alarms.clear(None, now, |kind| match kind {
        AlarmKind::NoAntennaFor { pass, .. } => {
            takes(pass.0) || !reminders.iter().any(|reminder| reminder.pass == *pass)
        }
        _ => false,
    });
    for Reminder { pass, name, .. } in reminders {
        let until_s = seconds_between(now, pass.1);
        let is_close = 0.0 < until_s && until_s <= ON_ITS_WAY.as_secs_f64();
        if is_close && !takes(pass.0) {
            let kind = AlarmKind::NoAntennaFor { pass: *pass, name: name.clone() };
            alarms.raise(None, kind, now);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use jiff::ToSpan as _;

    use super::*;
    use crate::{
        clock::Instant,
        contract::{
            antenna::AntennaModel,
            driver::{LinkState, Snapshot},
            passes::{ListedSatellite, Observer},
        },
        device::{HeldSatellite, Phase, Program},
        makes::DemoAddresses,
        orbit::{PassSearch, Propagator, bundled, passes},
        station::{Antenna, Favourites, Notices},
    };

    const ISS: u32 = 25_544;

    /// Returns the demo station with a mark at the ISS, and the passes of half a day.
    fn desk() -> (Station, PassList) {
        let notices = Notices { reminders: [ISS].into(), ..Notices::default() };
        let station = Station { notices, ..Station::demo(&DemoAddresses::default()) };
        let elements = bundled().unwrap().get(ISS).unwrap().clone();
        let propagator = Propagator::new(&elements).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let observer = Arc::new(Observer::from_station(&station));
        let search = PassSearch {
            aos_elevation: observer.aos_elevation,
            ..PassSearch::new(station.site, start, start + 12.hours())
        };
        let found = passes(&propagator, &search, &|| false);
        let satellite = Arc::new(ListedSatellite { elements, propagator });
        let predicted = found
            .into_iter()
            .map(|pass| PredictedPass::new(Arc::clone(&satellite), pass, Arc::clone(&observer)));
        let passes = Arc::new(predicted.collect());
        (station, PassList { passes, ..PassList::default() })
    }

    #[test]
    fn a_marked_favourite_is_reminded_of_in_time_once_a_pass() {
        let (mut station, list) = desk();
        let first = &list.passes[0];
        let (aos, los) = (first.pass.aos.time, first.pass.los.time);
        let mut reminders = Vec::new();
        let mut schedule_at = |station: &Station, list: &PassList, now| {
            refresh(&mut reminders, station, list, now);
            reminders.iter().map(Reminder::aos).collect::<Vec<_>>()
        };
        assert_eq!(schedule_at(&station, &list, aos - 301.seconds()), []);
        assert_eq!(schedule_at(&station, &list, aos - 300.seconds()), [aos]);
        // The next search finds the pass a little later.
        let mut pass = first.pass;
        pass.aos.time += 2.seconds();
        let observer = Arc::new(Observer::from_station(&station));
        let again = PredictedPass::new(Arc::clone(&first.satellite), pass, observer);
        let renewed = PassList { passes: Arc::new(vec![again]), ..PassList::default() };
        assert_eq!(schedule_at(&station, &renewed, aos - 60.seconds()), [aos]);
        assert_eq!(schedule_at(&station, &list, los - 1.second()), [aos]);
        assert_eq!(schedule_at(&station, &list, los), []);

        station.notices.reminder_min = 20.0;
        let next = list.passes[1].pass.aos.time;
        assert_eq!(schedule_at(&station, &list, next - 20.minutes()), [next]);
        station.notices.reminders.clear();
        assert_eq!(schedule_at(&station, &list, next - 19.minutes()), []);
        station.notices.reminders.insert(ISS);
        station.favourites = Favourites::default();
        assert_eq!(schedule_at(&station, &list, next - 18.minutes()), []);
    }

    #[test]
    fn a_pass_that_no_antenna_takes_is_an_alarm_until_one_does_or_until_los() {
        let (station, list) = desk();
        let aos = list.passes[0].pass.aos.time;
        let mut reminders = Vec::new();
        let mut alarms = Alarms::default();
        let mut standing = |now, takes: bool| {
            refresh(&mut reminders, &station, &list, now);
            watch(&mut alarms, &reminders, |number| takes && number == ISS, now);
            let stands = |alarm: &&crate::contract::alarms::Alarm| !alarm.is_over();
            alarms.list().iter().filter(stands).count()
        };
        assert_eq!(standing(aos - 31.seconds(), false), 0);
        assert_eq!(standing(aos - 30.seconds(), false), 1);
        assert_eq!(standing(aos - 20.seconds(), true), 0);
        // The antenna drops the pass before its start.
        assert_eq!(standing(aos - 10.seconds(), false), 1);
        assert_eq!(standing(aos + 1.minute(), false), 1);
        assert_eq!(standing(aos + 2.minutes(), true), 0);
        assert_eq!(standing(aos + 3.minutes(), false), 0, "what STOP ends during the pass is none");

        let (aos, los) = (list.passes[1].pass.aos.time, list.passes[1].pass.los.time);
        standing(aos - 5.minutes(), true);
        assert_eq!(standing(aos - 30.seconds(), true), 0);
        assert_eq!(standing(aos - 5.seconds(), false), 1);
        assert_eq!(standing(los - 1.second(), false), 1);
        assert_eq!(standing(los, false), 0);
    }

    #[test]
    fn a_unit_takes_a_pass_by_its_own_program_until_that_is_completed() {
        let takes = |phase, satellite, link| {
            let mut snapshot = Snapshot::before_anything(link);
            snapshot.state.program = Some(Program { enabled: true, phase, auto: None });
            snapshot.state.on_board.satellite = Some(HeldSatellite {
                catalog_number: satellite,
                name: "ISS".to_owned(),
                maximum_elevation_deg: None,
            });
            let config = Antenna::satrak("Dish", "10.0.0.5:4001");
            AntennaModel::new(config, Arc::new(snapshot)).takes(ISS)
        };
        let up = LinkState::Up { start: Instant::now() };
        assert!(takes(Phase::AtStart, ISS, up.clone()) && takes(Phase::Tracking, ISS, up.clone()));
        assert!(!takes(Phase::Completed, ISS, up.clone()), "the pass before");
        assert!(!takes(Phase::AtStart, 43_013, up));
        assert!(!takes(Phase::AtStart, ISS, LinkState::Off));
    }

    #[test]
    fn a_reminder_names_the_antennas_that_can_track_the_pass() {
        let (mut station, list) = desk();
        let found = reminder(&list.passes[0], &station);
        let able = |index| {
            let trackability = list.passes[0].trackability(index);
            matches!(trackability, Some(Trackability::Whole | Trackability::Loses { .. }))
        };
        let antennas = station.antennas.iter().enumerate().filter(|(index, _)| able(*index));
        assert_eq!(found.can_track, antennas.map(|(_, antenna)| antenna.id).collect::<Vec<_>>());
        assert!(!found.can_track.is_empty() && found.name == "ISS");
        station.antennas.clear();
        assert_eq!(reminder(&list.passes[0], &station).can_track, []);
    }
}
