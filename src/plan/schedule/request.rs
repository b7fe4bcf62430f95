//! What a schedule is made from.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Entry, Schedule, reach::Reach, sight::Sight, way::Verdict};
use crate::{
    astro::{Angle, Site, sun_moon},
    orbit::{Pass, Propagator, is_sunlit},
    station::{AntennaId, Priority},
};

/// A pass by the catalog number of its satellite and the time of AOS.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct PassKey {
    pub satellite: u32,
    pub aos: Timestamp,
}

/// What the operator wants of a single pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wish {
    /// Taken or left out by its worth.
    #[default]
    ByPlan,
    /// Taken before all passes that are not, whatever the rules of its satellite.
    Always,
    Never,
}

/// Light in which passes of a satellite are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Light {
    /// The Sun is up at the site at TCA.
    Day,
    /// The Sun is down at the site at TCA.
    Night,
    /// The Sun shines on the satellite at TCA.
    Sunlit,
}

/// The rules of a satellite.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SatelliteRules {
    pub min_elevation: Option<Angle>,
    pub min_duration_s: Option<f64>,
    pub light: Option<Light>,
    /// The antennas that may take it; `None` for all.
    pub antennas: Option<Vec<AntennaId>>,
    /// Most passes a day of UTC, by AOS.
    pub max_a_day: Option<u32>,
}

/// A rule of a satellite that leaves out a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    MinElevation { degrees: f64 },
    MinDuration { seconds: f64 },
    Light(Light),
}

/// Why no antenna may take a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    Never,
    /// Its greatest elevation is below the elevation floor.
    BelowFloor {
        floor_deg: f64,
    },
    /// The elements are older than they may be.
    OldElements {
        age_s: f64,
    },
    Rule(Rule),
}

/// Why an antenna takes no passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Off {
    SwitchedOff,
    LockedOut,
}

/// What an antenna does between two passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Between {
    /// It goes to its park position where there is time for it.
    Park,
    /// It goes to the start of the next pass at once.
    #[default]
    Wait,
    /// It stays where it is, and sets out in time.
    Stay,
}

/// An antenna to plan for.
#[derive(Debug, Clone)]
pub struct PlannedAntenna {
    pub id: AntennaId,
    pub reach: Reach,
    /// Time that its unit needs before each pass besides the slew, such as to load it and read it
    /// back, seconds.
    pub set_up_s: f64,
    pub between: Between,
    /// From when on it is free.
    pub free_from: Timestamp,
    /// Where its axes stand then, degrees as the mount counts; `None` if unknown.
    pub stands_deg: Option<[f64; 2]>,
    pub off: Option<Off>,
}

/// A pass that may be taken.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub key: PassKey,
    pub los: Timestamp,
    pub tca: Timestamp,
    pub max_elevation: Angle,
    pub priority: Priority,
    pub wish: Wish,
    pub max_a_day: Option<u32>,
    pub refusal: Option<Refusal>,
    pub options: Vec<(AntennaId, Choice)>,
}

/// What speaks for and against a pass on one antenna.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    Judged(Verdict),
    /// The rules of the satellite leave out this antenna.
    AgainstRule,
}

/// What all candidates of a station have in common.
#[derive(Debug, Clone, Copy)]
pub struct Common<'a> {
    pub site: Site,
    pub floor: Angle,
    pub antennas: &'a [PlannedAntenna],
    /// Greatest age of elements at AOS, seconds.
    pub max_age_s: Option<f64>,
}

/// What the operator wants of a pass and its satellite.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    pub priority: Priority,
    pub wish: Wish,
    pub rules: &'a SatelliteRules,
}

impl Candidate {
    /// Judges `pass` of a satellite with elements of this age at AOS.
    pub fn new(
        satellite: u32,
        age_s: f64,
        (pass, propagator): (&Pass, &Propagator),
        wanted: Wanted<'_>,
        sight: &mut Sight<'_>,
        common: Common<'_>,
    ) -> Self {
        let Wanted { priority, wish, rules } = wanted;
        let always = wish == Wish::Always;
        let max_elevation = pass.max_elevation();
        let too_old = common.max_age_s.filter(|max_s| age_s > *max_s);
        let refusal = if wish == Wish::Never {
            Some(Refusal::Never)
        } else if max_elevation < common.floor && !always {
            Some(Refusal::BelowFloor { floor_deg: common.floor.degrees() })
        } else if too_old.is_some() {
            Some(Refusal::OldElements { age_s })
        } else {
            let broken = if always { None } else { rules.broken(pass, propagator, common.site) };
            broken.map(Refusal::Rule)
        };
        let judged = |antenna: &PlannedAntenna| {
            let is_allowed =
                always || rules.antennas.as_ref().is_none_or(|some| some.contains(&antenna.id));
            let choice = if is_allowed {
                Choice::Judged(antenna.reach.judge(sight))
            } else {
                Choice::AgainstRule
            };
            (antenna.id, choice)
        };
        let options = match refusal {
            Some(Refusal::Never | Refusal::BelowFloor { .. }) => Vec::new(),
            _ => common.antennas.iter().map(judged).collect(),
        };
        Self {
            key: PassKey { satellite, aos: pass.aos.time },
            los: pass.los.time,
            tca: pass.tca.time,
            max_elevation,
            priority,
            wish,
            max_a_day: rules.max_a_day,
            refusal,
            options,
        }
    }
}

impl SatelliteRules {
    /// The rule that leaves out `pass`.
    fn broken(&self, pass: &Pass, propagator: &Propagator, site: Site) -> Option<Rule> {
        if let Some(least) = self.min_elevation.filter(|least| pass.max_elevation() < *least) {
            return Some(Rule::MinElevation { degrees: least.degrees() });
        }
        if let Some(seconds) = self.min_duration_s.filter(|least| pass.duration_s() < *least) {
            return Some(Rule::MinDuration { seconds });
        }
        let at = pass.tca.time;
        let is_day = || sun_moon::sun(site, at).elevation > Angle::ZERO;
        let is_right = |light: &Light| match light {
            Light::Day => is_day(),
            Light::Night => !is_day(),
            Light::Sunlit => propagator.state_at(at).is_ok_and(|state| is_sunlit(&state, at)),
        };
        self.light.filter(|light| !is_right(light)).map(Rule::Light)
    }
}

/// The operator's rule of what is best.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChooseBy {
    /// For each priority the seconds that count, times the sine of the greatest elevation.
    #[default]
    PriorityThenElevation,
    /// For each priority the seconds that count.
    PriorityThenDuration,
    MostPasses,
    MostMinutes,
}

/// How much of a pass has to remain where it is taken in part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partial {
    /// Of the seconds that count, 0 to 1.
    pub min_share: f64,
    pub min_s: f64,
    /// A start is late, and an end early, by a multiple of this.
    pub step_s: f64,
    /// A pass may be handed from one antenna to another. Each part has to be long enough.
    pub hand_over: bool,
}

/// What a change of the schedule has to gain.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Steadiness {
    /// Of what the entry that goes is worth.
    pub percent: u32,
    /// Besides, seconds.
    pub seconds: u32,
}

/// All that a schedule follows from.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    pub antennas: &'a [PlannedAntenna],
    pub candidates: &'a [Candidate],
    pub choose_by: ChooseBy,
    /// `None` where passes are taken as a whole.
    pub partial: Option<Partial>,
    pub previous: Option<&'a Schedule>,
    pub steadiness: Steadiness,
    /// Entries that have begun or are loaded.
    pub fixed: &'a [Entry],
}
