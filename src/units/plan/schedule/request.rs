//! Inputs of a schedule.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Entry, Schedule, reach::Reach, sight::Sight, way::Verdict};
use crate::{
    astro::{Angle, Site, sun_moon},
    orbit::{Pass, Propagator, is_sunlit},
    station::{AntennaId, BetweenPasses, ChooseBy, Light, PassLimits, Priority, RuleAction, Take},
};

/// Key of a pass: the catalog number of its satellite and the time of AOS.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct PassKey {
    pub satellite: u32,
    pub aos: Timestamp,
}

/// Rule of a satellite that leaves out a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    MinElevation { degrees: f64 },
    MinDuration { seconds: f64 },
    Light(Light),
}

/// Reason why no antenna may take a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    Never,
    /// Maximum elevation below the elevation floor.
    BelowFloor {
        floor_deg: f64,
    },
    /// Elements beyond their max age.
    OldElements {
        age_s: f64,
    },
    Rule(Rule),
}

/// Reason why an antenna takes no passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AntennaOff {
    SwitchedOff,
    LockedOut,
}

/// Antenna for which the schedule plans passes.
#[derive(Debug, Clone)]
pub struct PlannedAntenna {
    pub id: AntennaId,
    pub reach: Reach,
    /// Time that its unit needs before each pass besides the slew, seconds, such as to load the
    /// pass and read it back.
    pub set_up_s: f64,
    pub between_passes: BetweenPasses,
    /// Time from which the antenna is free.
    pub free_from: Timestamp,
    /// Axis positions at that time, degrees as the mount counts; `None` if unknown.
    pub stands_deg: Option<[f64; 2]>,
    pub off_reason: Option<AntennaOff>,
}

/// Pass that the schedule may take.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub key: PassKey,
    pub los: Timestamp,
    pub tca: Timestamp,
    pub max_elevation: Angle,
    pub priority: Priority,
    /// Operator's choice for this pass.
    pub take: Option<Take>,
    pub max_per_day: Option<u32>,
    pub refusal: Option<Refusal>,
    pub options: Vec<(AntennaId, Choice)>,
}

/// Reasons for and against a pass on one antenna.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    Judged(Verdict),
    /// Exclusion of this antenna by the rules of the satellite.
    AgainstRule,
}

/// Values that all candidates of a station have in common.
#[derive(Debug, Clone, Copy)]
pub struct Common<'a> {
    pub site: Site,
    pub floor: Angle,
    pub antennas: &'a [PlannedAntenna],
    /// Max age of elements at AOS, seconds.
    pub max_age_s: Option<f64>,
}

/// Policy of the operator for a pass and its satellite.
#[derive(Clone, Copy)]
pub struct PassPolicy<'a> {
    pub priority: Priority,
    pub take: Option<Take>,
    pub limits: &'a PassLimits,
    /// Action of the automation rules for the pass on an antenna.
    pub by_rule: &'a dyn Fn(AntennaId) -> Option<RuleAction>,
}

impl Candidate {
    /// Judges `pass` of a satellite with elements of this age at AOS.
    pub fn new(
        satellite: u32,
        age_s: f64,
        (pass, propagator): (&Pass, &Propagator),
        limits_of_pass: PassPolicy<'_>,
        sight: &mut Sight<'_>,
        common: Common<'_>,
    ) -> Self {
        let PassPolicy { priority, take, limits, by_rule } = limits_of_pass;
        let always = take == Some(Take::Always);
        let max_elevation = pass.max_elevation();
        let too_old = common.max_age_s.filter(|max_s| age_s > *max_s);
        let broken = if always { None } else { broken(limits, pass, propagator, common.site) };
        let is_forced = |antenna: &PlannedAntenna| by_rule(antenna.id) == Some(RuleAction::Take);
        let refusal = if take == Some(Take::Never) {
            Some(Refusal::Never)
        } else if max_elevation < common.floor && !always {
            Some(Refusal::BelowFloor { floor_deg: common.floor.degrees() })
        } else if too_old.is_some() {
            Some(Refusal::OldElements { age_s })
        } else {
            broken.filter(|_| !common.antennas.iter().any(is_forced)).map(Refusal::Rule)
        };
        let is_allowed = |antenna: &PlannedAntenna| match by_rule(antenna.id) {
            Some(RuleAction::Take) => true,
            Some(RuleAction::Leave | RuleAction::Park) => false,
            None => {
                // This also applies if the pass is always taken: an antenna may be unable to
                // receive it.
                let antennas = limits.antennas.as_ref();
                let is_chosen = antennas.is_none_or(|some| some.contains(&antenna.id));
                is_chosen && broken.is_none()
            }
        };
        let judged = |antenna: &PlannedAntenna| {
            let choice = if is_allowed(antenna) {
                Choice::Judged(antenna.reach.judge(sight))
            } else {
                Choice::AgainstRule
            };
            (antenna.id, choice)
        };
        let options = match refusal {
            // No antenna can change these refusals, and a judgement costs time.
            Some(Refusal::Never | Refusal::BelowFloor { .. }) => Vec::new(),
            _ => common.antennas.iter().map(judged).collect(),
        };
        Self {
            key: PassKey { satellite, aos: pass.aos.time },
            los: pass.los.time,
            tca: pass.tca.time,
            max_elevation,
            priority,
            take,
            max_per_day: limits.max_per_day.filter(|_| !always),
            refusal,
            options,
        }
    }
}

/// Returns the limit that leaves out `pass`.
fn broken(limits: &PassLimits, pass: &Pass, propagator: &Propagator, site: Site) -> Option<Rule> {
    let too_low = limits.min_max_elevation_deg;
    if let Some(degrees) = too_low.filter(|deg| pass.max_elevation().degrees() < *deg) {
        return Some(Rule::MinElevation { degrees });
    }
    if let Some(seconds) = limits.min_duration_s.filter(|min| pass.duration_s() < *min) {
        return Some(Rule::MinDuration { seconds });
    }
    let time = pass.tca.time;
    let is_day = || sun_moon::sun(site.airless(), time).elevation > Angle::ZERO;
    let is_right = |light: &Light| match light {
        Light::Day => is_day(),
        Light::Night => !is_day(),
        Light::Sunlit => propagator.state_at(time).is_ok_and(|state| is_sunlit(&state, time)),
    };
    limits.light.filter(|light| !is_right(light)).map(Rule::Light)
}

/// Required rest of a partial pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partial {
    /// Min share of the seconds that count, 0 to 1.
    pub min_share: f64,
    pub min_s: f64,
    /// Step of a late start or early end, seconds.
    pub step_s: f64,
    /// `true` if one antenna may hand a pass over to another. Each part must be long enough.
    pub hand_over: bool,
}

/// Min gain for which an entry of the previous schedule is replaced.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Steadiness {
    /// Gain in percent of the worth of the replaced entry.
    pub percent: u32,
    /// Additional gain, seconds.
    pub seconds: u32,
}

/// Inputs that determine a schedule.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    pub antennas: &'a [PlannedAntenna],
    pub candidates: &'a [Candidate],
    pub choose_by: ChooseBy,
    /// Settings for partial passes; `None` if the schedule takes only whole passes.
    pub partial: Option<Partial>,
    pub previous: Option<&'a Schedule>,
    pub steadiness: Steadiness,
    /// Entries that antennas are currently taking.
    pub fixed: &'a [Entry],
}
