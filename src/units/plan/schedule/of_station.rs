//! Inputs of a schedule from a station: its antennas, limits, choices and rules.

use jiff::Timestamp;

use super::{Candidate, Common, Partial, PassPolicy, PlannedAntenna, Reach, Sight};
use crate::{
    astro::sun_moon,
    orbit::{Elements, Pass, Propagator},
    station::{Antenna, AntennaId, RuleAction, RuleSubject, Scheduling, Station, SunIs},
};

/// Step of the late start or early end of a partial pass, seconds.
const STEP_S: f64 = 15.0;

impl PlannedAntenna {
    /// Returns an antenna of a station that is free from `free_from` on, at an unknown position.
    pub fn from_station(station: &Station, antenna: &Antenna, free_from: Timestamp) -> Self {
        Self {
            id: antenna.id,
            reach: Reach::from_station(station, antenna, None),
            set_up_s: antenna.set_up_s(),
            between_passes: antenna.automatic.between_passes,
            free_from,
            stands_deg: None,
            off_reason: None,
        }
    }
}

impl Candidate {
    /// Judges a pass of a satellite by the settings of the station file.
    pub fn from_station(
        station: &Station,
        elements: &Elements,
        propagator: &Propagator,
        pass: &Pass,
        common: Common<'_>,
    ) -> Self {
        let number = elements.catalog_number();
        let choice = station.pass_choice(number, (pass.aos.time, pass.los.time));
        let wanted_pass = PassPolicy {
            priority: station.priority(number).unwrap_or_default(),
            take: choice.map(|choice| choice.take),
            limits: &station.pass_limits(number),
            by_rule: &|antenna| by_rule(station, number, pass.tca.time, antenna),
        };
        let mask = station.horizon_mask.as_ref();
        let mut sight = Sight::new(propagator, station.site, mask, pass).named(elements.name());
        let age_s = elements.epoch_distance_s(pass.aos.time);
        Self::new(number, age_s, (pass, propagator), wanted_pass, &mut sight, common)
    }
}

impl Partial {
    /// Returns how a station takes partial passes; `None` if it takes only whole ones.
    pub fn from_scheduling(scheduling: &Scheduling) -> Option<Self> {
        let partly = scheduling.partly?;
        Some(Self {
            min_share: partly.min_percent / 100.0,
            min_s: partly.min_s,
            step_s: STEP_S,
            hand_over: scheduling.hand_over,
        })
    }
}

/// Returns the action of the first automation rule that fits a satellite and an antenna at a time.
fn by_rule(
    station: &Station,
    satellite: u32,
    time: Timestamp,
    antenna: AntennaId,
) -> Option<RuleAction> {
    station.rules.iter().find(|rule| rule.is_for(antenna))?;
    let place = deciding_rule(station, satellite, (time, sun_is(station, time)), antenna)?;
    station.rules.get(place).map(|rule| rule.action)
}

/// Returns the index of the first automation rule that fits a satellite and an antenna at a time
/// with this state of the Sun.
pub fn deciding_rule(
    station: &Station,
    satellite: u32,
    (time, sun): (Timestamp, SunIs),
    antenna: AntennaId,
) -> Option<usize> {
    let is_of = |rule_of: &RuleSubject| match rule_of {
        RuleSubject::Satellite(number) => *number == satellite,
        RuleSubject::Group(name) => station.groups_of(satellite).any(|group| group.name == *name),
    };
    station.rules.iter().position(|rule| {
        rule.is_for(antenna) && rule.subject.as_ref().is_none_or(is_of) && rule.holds_at(time, sun)
    })
}

/// Returns whether the Sun is up or down at the site of a station.
pub fn sun_is(station: &Station, time: Timestamp) -> SunIs {
    let is_up = sun_moon::sun(station.site.airless(), time).elevation_deg() > 0.0;
    if is_up { SunIs::Up } else { SunIs::Down }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        demo::DemoAddresses,
        orbit::{PassSearch, bundled, passes},
        plan::schedule::{Choice, Refusal},
        station::{AutomationRule, PassLimits, SatelliteGroup},
    };

    const ISS: u32 = 25_544;

    /// Returns the first pass of the ISS, judged at a station after `change`.
    fn judged(change: impl FnOnce(&mut Station)) -> (Candidate, Vec<AntennaId>) {
        let mut station = Station::demo(&DemoAddresses::default());
        change(&mut station);
        let catalog = bundled().unwrap();
        let elements = catalog.get(ISS).unwrap();
        let propagator = Propagator::new(elements).unwrap();
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let search = PassSearch {
            aos_elevation: station.aos_elevation(),
            floor: station.elevation_floor(),
            ..PassSearch::new(station.site, start, crate::astro::time::add_seconds(start, 86_400.0))
        };
        let pass = passes(&propagator, &search, &|| false)[0];
        let planned: Vec<PlannedAntenna> = station
            .antennas
            .iter()
            .map(|antenna| PlannedAntenna::from_station(&station, antenna, start))
            .collect();
        let common = Common {
            site: station.site,
            floor: station.elevation_floor(),
            antennas: &planned,
            max_age_s: None,
        };
        let candidate = Candidate::from_station(&station, elements, &propagator, &pass, common);
        let may =
            |(id, choice): &(AntennaId, Choice)| matches!(choice, Choice::Judged(_)).then_some(*id);
        let allowed = candidate.options.iter().filter_map(may).collect();
        (candidate, allowed)
    }

    fn ids(numbers: &[u32]) -> Vec<AntennaId> {
        numbers.iter().copied().map(AntennaId).collect()
    }

    fn rule(
        antenna: Option<u32>,
        subject: Option<RuleSubject>,
        action: RuleAction,
    ) -> AutomationRule {
        let antenna = antenna.map(AntennaId);
        AutomationRule { is_on: true, antenna, subject, sun: None, hours: None, action }
    }

    #[test]
    fn the_first_rule_that_fits_decides() {
        assert_eq!(judged(|_| ()).1, ids(&[1, 2, 3]));
        let leave = rule(Some(2), None, RuleAction::Leave);
        assert_eq!(judged(|station| station.rules = vec![leave.clone()]).1, ids(&[1, 3]));
        let take = rule(Some(2), Some(RuleSubject::Satellite(ISS)), RuleAction::Take);
        assert_eq!(
            judged(|station| station.rules = vec![take.clone(), leave.clone()]).1,
            ids(&[1, 2, 3])
        );
        assert_eq!(judged(|station| station.rules = vec![leave, take]).1, ids(&[1, 3]));
        let group = || RuleSubject::Group("Stations".to_owned());
        let of_group = rule(None, Some(group()), RuleAction::Park);
        assert_eq!(judged(|station| station.rules = vec![of_group.clone()]).1, ids(&[1, 2, 3]));
        let with_group = |changed: &mut Station| {
            changed.groups = vec![SatelliteGroup {
                name: "Stations".to_owned(),
                satellites: vec![ISS],
                priority: None,
                limits: PassLimits::default(),
            }];
            changed.rules = vec![of_group];
        };
        assert_eq!(judged(with_group).1, []);
    }

    #[test]
    fn limits_leave_a_pass_out_unless_a_rule_takes_it() {
        let limit = |station: &mut Station| {
            let limits = PassLimits { min_max_elevation_deg: Some(89.9), ..PassLimits::default() };
            station.favourites.set_limits(ISS, limits);
        };
        let (candidate, _) = judged(limit);
        assert!(matches!(candidate.refusal, Some(Refusal::Rule(_))), "{:?}", candidate.refusal);
        let (candidate, allowed) = judged(|other| {
            limit(other);
            other.rules = vec![rule(Some(2), None, RuleAction::Take)];
        });
        assert_eq!((candidate.refusal, allowed), (None, ids(&[2])));
    }

    #[test]
    fn the_antennas_of_a_satellite_are_those_of_its_limits() {
        let (_, allowed) = judged(|station| {
            let limits = PassLimits { antennas: Some(ids(&[3])), ..PassLimits::default() };
            station.favourites.set_limits(ISS, limits);
        });
        assert_eq!(allowed, ids(&[3]));
    }
}
