//! The station: its site, antennas, favourites and keep-outs, in one TOML file. The reader replaces
//! invalid values with defaults, and a save keeps the entries that Azel cannot read.

mod antenna;
mod automation_rule;
mod connection;
mod controller_spec;
mod favourite;
mod file;
mod frequency;
mod hook;
mod hours_of_day;
mod keep_out;
mod keeping;
mod kept_offsets;
mod lock_outs;
mod metrics_port;
mod mount;
mod network_port;
mod notices;
mod pass_choice;
mod pass_limits;
pub mod ranges;
mod read;
mod rewrite;
mod satellite_group;
mod scheduling;
mod setting;
mod track_settings;
mod upkeep;
mod watch;

pub use antenna::{Antenna, AntennaId, Direction, MotionLimits, PollRates};
pub use automation_rule::{AutomationRule, RuleAction, RuleSubject, SunIs};
pub use connection::Connection;
pub use connection::check_address;
pub use controller_spec::{ControllerSpec, DefaultFigures, Link};
pub use favourite::{Favourite, Favourites, Priority};
pub use file::{LoadError, Loaded, SaveError, free_path, load, save, saved_at, settings_path};
pub use frequency::Frequency;
pub use hook::{Hook, HookAction, HookEvent, HookProblem};
pub use hours_of_day::HoursOfDay;
pub use keep_out::{Entered, KeepOut, SunAvoidance};
pub use keeping::Retention;
pub use kept_offsets::{KeptOffsets, OffsetsSubject};
pub use lock_outs::{LOCK_OUTS_FILE, LockOut, LockOuts};
pub use metrics_port::MetricsPort;
pub use mount::Mount;
pub use network_port::NetworkPort;
pub use notices::{Notices, Tones};
pub use pass_choice::{PassChoice, Take};
pub use pass_limits::{Light, PassLimits};
pub use read::{Note, NoteReason, Unread, from_toml};
pub use satellite_group::SatelliteGroup;
pub use scheduling::{Automatic, BetweenPasses, ChooseBy, Partly, Scheduling};
pub use setting::{Setting, Table};
pub use track_settings::{AfterPass, TrackSettings};
pub use upkeep::Upkeep;
pub use watch::{DEFAULT_RESUME_AFTER_S, DEFAULT_SWAY_DEG, Monitor, OnClose, Resume};

use std::collections::{BTreeMap, BTreeSet};

use serde::{Serialize, Serializer};

use jiff::Timestamp;

use crate::astro::{
    Angle, HorizonMask, Site,
    time::{DAY_S, seconds_between},
};

/// Max difference between the TCAs of one pass with older and newer elements, seconds.
const SAME_PASS_S: f64 = 300.0;
/// Time for which Azel keeps the choice of a past pass, seconds.
const CHOICE_KEPT_S: f64 = DAY_S;

/// Site, antennas and settings of a ground station.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Station {
    /// Name in the top bar.
    pub name: String,
    #[serde(serialize_with = "Site::serialize_in_file")]
    pub site: Site,
    /// Horizon mask; `None` if nothing blocks the sky. The file contains it as a text for
    /// [`HorizonMask::parse`], one point on each line.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "mask_as_text")]
    pub horizon_mask: Option<HorizonMask>,
    /// Elevation of AOS and LOS, from which a pass counts, degrees, 0 to 90.
    pub aos_elevation_deg: f64,
    /// Elevation floor of the pass list, degrees, 0 to 89.
    pub elevation_floor_deg: f64,
    /// The satellites in the pass list.
    pub favourites: Favourites,
    /// Settings for the schedule.
    #[serde(rename = "schedule", skip_serializing_if = "is_default")]
    pub scheduling: Scheduling,
    /// Groups of satellites, in the operator's order.
    #[serde(rename = "group", skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<SatelliteGroup>,
    /// Passes that the operator always or never wants to take.
    #[serde(rename = "pass", skip_serializing_if = "Vec::is_empty")]
    pub pass_choices: Vec<PassChoice>,
    /// Automation rules; the first matching rule decides.
    #[serde(rename = "rule", skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<AutomationRule>,
    /// Frequencies of satellites; each satellite may have several.
    #[serde(rename = "frequency", skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<Frequency>,
    /// Saved offsets, each for a satellite or an antenna.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub offsets: Vec<KeptOffsets>,
    /// Alarms and reminders that the desktop shows and sounds.
    #[serde(skip_serializing_if = "is_default")]
    pub notices: Notices,
    /// Retention of the record.
    #[serde(skip_serializing_if = "is_default")]
    pub record: Retention,
    /// Action on the antennas when the program ends; `None` asks the operator.
    #[serde(rename = "close", skip_serializing_if = "Option::is_none")]
    pub on_close: Option<OnClose>,
    /// Zones into which antennas must not point.
    #[serde(rename = "keep_out", skip_serializing_if = "Vec::is_empty")]
    pub keep_outs: Vec<KeepOut>,
    /// Sun avoidance; `None` if antennas need not avoid the Sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_avoidance: Option<SunAvoidance>,
    /// Ports on which other programs point antennas.
    #[serde(rename = "rotctld", skip_serializing_if = "Vec::is_empty")]
    pub network_ports: Vec<NetworkPort>,
    /// Port for metrics; `None` if no program can read them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metrics: Option<MetricsPort>,
    /// Programs and web addresses that Azel calls at events.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hooks: Vec<Hook>,
    /// The antennas, in the order of their chips.
    #[serde(rename = "antenna")]
    pub antennas: Vec<Antenna>,
    /// Unreadable settings on which safety depends. Automatic operation does not move the affected
    /// antennas until the operator repairs the file.
    #[serde(skip)]
    pub unread: Vec<Unread>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

// serde prescribes the signature.
#[allow(clippy::ref_option)]
fn mask_as_text<S: Serializer>(mask: &Option<HorizonMask>, out: S) -> Result<S::Ok, S::Error> {
    mask.as_ref().map(HorizonMask::to_string).serialize(out)
}

impl Station {
    pub fn aos_elevation(&self) -> Angle {
        Angle::from_degrees(self.aos_elevation_deg)
    }

    pub fn elevation_floor(&self) -> Angle {
        Angle::from_degrees(self.elevation_floor_deg)
    }

    /// Returns the priority of a favourite: its own, else the priority of its first group with one,
    /// else the default. `None` if the satellite is no favourite.
    pub fn priority(&self, satellite: u32) -> Option<Priority> {
        Some(self.priority_of(self.favourites.get(satellite)?))
    }

    /// Returns the priorities of all favourites, by catalog number.
    pub fn priorities(&self) -> BTreeMap<u32, Priority> {
        let favourites = self.favourites.iter();
        favourites.map(|favourite| (favourite.satellite, self.priority_of(favourite))).collect()
    }

    fn priority_of(&self, favourite: &Favourite) -> Priority {
        let mut groups = self.groups_of(favourite.satellite);
        let of_group = || groups.find_map(|group| group.priority);
        favourite.priority.or_else(of_group).unwrap_or_default()
    }

    /// Returns the satellites of all groups with this name.
    pub fn in_groups(&self, name: &str) -> BTreeSet<u32> {
        let groups = self.groups.iter().filter(|group| group.name == name);
        groups.flat_map(|group| &group.satellites).copied().collect()
    }

    /// Returns the limits of a satellite. Its groups, in their order, provide the limits that it
    /// does not set.
    pub fn pass_limits(&self, satellite: u32) -> PassLimits {
        let own = self
            .favourites
            .get(satellite)
            .map(|favourite| favourite.limits.clone())
            .unwrap_or_default();
        self.groups_of(satellite).fold(own, |limits, group| limits.or(&group.limits))
    }

    /// Returns the operator's choice for the pass of a satellite from `aos` to `los`.
    pub fn pass_choice(
        &self,
        satellite: u32,
        (aos, los): (Timestamp, Timestamp),
    ) -> Option<&PassChoice> {
        let mut choices = self.pass_choices.iter().rev();
        choices.find(|choice| choice.satellite == satellite && (aos..=los).contains(&choice.tca))
    }

    /// Records the choice for or against a pass, instead of any earlier choice. Removes choices of
    /// passes that are long over.
    pub fn choose_pass(
        &mut self,
        satellite: u32,
        tca: Timestamp,
        take: Option<Take>,
        now: Timestamp,
    ) {
        let apart_s = |choice: &PassChoice| seconds_between(choice.tca, tca).abs();
        self.pass_choices.retain(|choice| {
            let is_same = choice.satellite == satellite && apart_s(choice) < SAME_PASS_S;
            !is_same && seconds_between(choice.tca, now) < CHOICE_KEPT_S
        });
        let choice = take.map(|take| PassChoice { satellite, tca, take, chosen_at: now });
        self.pass_choices.extend(choice);
    }

    /// Returns the groups that contain a satellite, in their order.
    pub fn groups_of(&self, satellite: u32) -> impl Iterator<Item = &SatelliteGroup> {
        self.groups.iter().filter(move |group| group.contains(satellite))
    }
}

/// Default station in Istanbul, without antennas.
impl Default for Station {
    fn default() -> Self {
        Self {
            unread: Vec::new(),
            name: "Station".to_owned(),
            site: Site::default(),
            horizon_mask: None,
            aos_elevation_deg: 5.0,
            elevation_floor_deg: 10.0,
            favourites: Favourites::from([
                43013, // NOAA 20
                54234, // NOAA 21
                37849, // Suomi NPP
                59051, // Meteor-M2 4
                57166, // Meteor-M2 3
                25544, // ISS
                36508, // CryoSat 2
                54754, // SWOT
                46984, // Sentinel-6
                38771, // MetOp-B
                43689, // MetOp-C
                49260, // Landsat 9
                57490, // Fengyun 3F
                25994, // Terra
                27424, // Aqua
                44334, // Eutelsat 7C
            ]),
            scheduling: Scheduling::default(),
            groups: Vec::new(),
            pass_choices: Vec::new(),
            rules: Vec::new(),
            frequencies: Vec::new(),
            offsets: Vec::new(),
            network_ports: Vec::new(),
            metrics: None,
            hooks: Vec::new(),
            notices: Notices::default(),
            record: Retention::default(),
            on_close: None,
            keep_outs: Vec::new(),
            sun_avoidance: None,
            antennas: Vec::new(),
        }
    }
}
