//! Hooks: programs and web addresses that Azel calls at events of passes, antennas and alarms.

use std::{ops::RangeInclusive, time::Duration};

use serde::{Deserialize, Serialize};

use super::{AntennaId, RuleSubject, Station};

/// A program or a web address that Azel calls at an event.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hook {
    /// Name, not empty, and unique among the hooks of the station.
    pub name: String,
    #[serde(rename = "on", default = "enabled_by_default", skip_serializing_if = "is_enabled")]
    pub is_on: bool,
    /// Antenna of the hook; `None` for all antennas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub antenna: Option<AntennaId>,
    /// Satellites of the hook; `None` for all satellites.
    #[serde(flatten)]
    pub subject: Option<RuleSubject>,
    pub event: HookEvent,
    /// Time from the event to the call, seconds; negative for a call before the event.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub delay_s: f64,
    #[serde(flatten)]
    pub action: HookAction,
    /// Time after which Azel ends the call, seconds.
    #[serde(default = "default_timeout_s")]
    pub timeout_s: f64,
}

/// Event that calls a hook.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HookEvent {
    /// AOS of a pass that an antenna is to take.
    Aos,
    /// LOS of such a pass.
    Los,
    /// Start of an antenna's track of a satellite.
    TrackingStart,
    TrackingEnd,
    /// End of a pass that automatic operation should have tracked but did not.
    MissedPass,
    /// New alarm of the top priority.
    Alarm,
}

impl HookEvent {
    /// All events with their words in the station file.
    pub const WORDS: [(&'static str, Self); 6] = [
        ("aos", Self::Aos),
        ("los", Self::Los),
        ("tracking_start", Self::TrackingStart),
        ("tracking_end", Self::TrackingEnd),
        ("missed_pass", Self::MissedPass),
        ("alarm", Self::Alarm),
    ];

    /// Returns the word in the station file.
    pub fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, event)| *event == self).map_or("", |(word, _)| word)
    }

    /// Returns `true` if the plan contains the time of the event, so that a call can precede it.
    pub fn is_predicted(self) -> bool {
        match self {
            Self::Aos | Self::Los => true,
            Self::TrackingStart | Self::TrackingEnd | Self::MissedPass | Self::Alarm => false,
        }
    }
}

/// Call of a hook.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HookAction {
    /// Program and its arguments. No shell interprets them.
    Command(Vec<String>),
    /// Address for a POST request with the values as JSON.
    Webhook(String),
}

/// Reason why a hook cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum HookProblem {
    #[error("must be a program and its arguments, such as [\"/usr/bin/logger\", \"pass\"]")]
    NoProgram,
    #[error("must contain no null character")]
    NullCharacter,
    #[error("must be an address that begins with http:// or https://")]
    NoAddress,
    #[error("must contain no user name and no password")]
    LoginInAddress,
    #[error("must be a number from -600 to 600")]
    DelayOutOfRange,
    #[error("must not be negative: Azel learns of this event when it happens")]
    NoLead,
    #[error("must be a number from 1 to 3600")]
    TimeoutOutOfRange,
    #[error("must be empty for an alarm: an alarm concerns no satellite")]
    AlarmOfSatellite,
}

impl HookAction {
    /// Checks that Azel can use the program or the address.
    pub fn check(&self) -> Result<(), HookProblem> {
        match self {
            Self::Command(arguments) => {
                if arguments.first().is_none_or(|program| program.trim().is_empty()) {
                    return Err(HookProblem::NoProgram);
                }
                let has_null = arguments.iter().any(|argument| argument.contains('\0'));
                if has_null { Err(HookProblem::NullCharacter) } else { Ok(()) }
            }
            Self::Webhook(url) => check_address(url),
        }
    }
}

fn check_address(url: &str) -> Result<(), HookProblem> {
    let (scheme, rest) = url.split_once("://").ok_or(HookProblem::NoAddress)?;
    if !["http", "https"].iter().any(|allowed| scheme.eq_ignore_ascii_case(allowed)) {
        return Err(HookProblem::NoAddress);
    }
    let authority = rest.split(['/', '?', '#']).next().unwrap_or_default();
    if authority.contains('@') {
        return Err(HookProblem::LoginInAddress);
    }
    let host_end = if authority.starts_with('[') { ']' } else { ':' };
    let has_host = authority.split(host_end).next().is_some_and(|host| !host.is_empty());
    let is_plain = !url.chars().any(|letter| letter.is_whitespace() || letter.is_control());
    if has_host && is_plain { Ok(()) } else { Err(HookProblem::NoAddress) }
}

impl Hook {
    /// Max number of hooks of a station.
    pub const MAX_NUMBER: usize = 100;
    /// Range of [`Self::delay_s`], seconds.
    pub const DELAY_S: RangeInclusive<f64> = -600.0..=600.0;
    /// Range of [`Self::timeout_s`], seconds.
    pub const TIMEOUT_S: RangeInclusive<f64> = 1.0..=3600.0;
    /// Default of [`Self::timeout_s`], seconds.
    pub const DEFAULT_TIMEOUT_S: f64 = 60.0;

    /// Creates a hook for all antennas and satellites that calls at the event itself.
    pub fn new(name: impl Into<String>, event: HookEvent, action: HookAction) -> Self {
        Self {
            name: name.into(),
            is_on: true,
            antenna: None,
            subject: None,
            event,
            delay_s: 0.0,
            action,
            timeout_s: Self::DEFAULT_TIMEOUT_S,
        }
    }

    /// Checks the delay against the event.
    pub fn check_delay(&self) -> Result<(), HookProblem> {
        if !Self::DELAY_S.contains(&self.delay_s) {
            return Err(HookProblem::DelayOutOfRange);
        }
        let is_early = self.delay_s < 0.0 && !self.event.is_predicted();
        if is_early { Err(HookProblem::NoLead) } else { Ok(()) }
    }

    /// Checks the satellites against the event.
    pub fn check_subject(&self) -> Result<(), HookProblem> {
        let is_alarm = self.event == HookEvent::Alarm;
        if is_alarm && self.subject.is_some() {
            return Err(HookProblem::AlarmOfSatellite);
        }
        Ok(())
    }

    /// Checks all settings except the name, and antenna and group, which depend on the station.
    pub fn check(&self) -> Result<(), HookProblem> {
        self.action.check()?;
        self.check_delay()?;
        self.check_subject()?;
        let is_valid = Self::TIMEOUT_S.contains(&self.timeout_s);
        if is_valid { Ok(()) } else { Err(HookProblem::TimeoutOutOfRange) }
    }

    /// Returns the time after which Azel ends the call.
    pub fn timeout(&self) -> Duration {
        let (min_s, max_s) = (*Self::TIMEOUT_S.start(), *Self::TIMEOUT_S.end());
        // A value that is no number counts as the min.
        let timeout_s = self.timeout_s.max(min_s).min(max_s);
        Duration::try_from_secs_f64(timeout_s).unwrap_or_default()
    }

    /// Returns the lag after an event that no plan contains.
    pub fn lag(&self) -> Duration {
        let lag_s = self.delay_s.max(0.0).min(*Self::DELAY_S.end());
        Duration::try_from_secs_f64(lag_s).unwrap_or_default()
    }

    /// Returns `true` if an event of this kind, antenna and satellite calls the hook.
    pub fn matches(
        &self,
        station: &Station,
        event: HookEvent,
        antenna: Option<AntennaId>,
        satellite: Option<u32>,
    ) -> bool {
        let is_antenna = self.antenna.is_none_or(|own| antenna == Some(own));
        let is_subject = match &self.subject {
            None => true,
            Some(RuleSubject::Satellite(number)) => satellite == Some(*number),
            Some(RuleSubject::Group(name)) => satellite
                .is_some_and(|number| station.groups_of(number).any(|group| group.name == *name)),
        };
        self.is_on && self.event == event && is_antenna && is_subject
    }
}

impl Station {
    /// Replaces the settings that only the operator at the station's own machine may change, hooks
    /// and network ports, with those of `current`.
    pub fn keep_local_settings(&mut self, current: &Self) {
        self.hooks.clone_from(&current.hooks);
        self.network_ports.clone_from(&current.network_ports);
    }
}

fn enabled_by_default() -> bool {
    true
}

fn default_timeout_s() -> f64 {
    Hook::DEFAULT_TIMEOUT_S
}

// serde prescribes the signature.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_enabled(is_on: &bool) -> bool {
    *is_on
}

// serde prescribes the signature, and the default is exactly zero.
#[allow(clippy::trivially_copy_pass_by_ref, clippy::float_cmp)]
fn is_zero(delay_s: &f64) -> bool {
    *delay_s == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::station::SatelliteGroup;

    fn hook(event: HookEvent) -> Hook {
        Hook::new("hook", event, HookAction::Command(vec!["true".to_owned()]))
    }

    #[test]
    fn only_plain_web_addresses_can_be_called() {
        for (url, problem) in [
            ("http://127.0.0.1:8123/api/webhook/x?y=1", None),
            ("HTTPS://example.org", None),
            ("http://[::1]:80/x", None),
            ("https://example.org/@station", None),
            ("ftp://example.org", Some(HookProblem::NoAddress)),
            ("example.org/hook", Some(HookProblem::NoAddress)),
            ("https://", Some(HookProblem::NoAddress)),
            ("https://:80/x", Some(HookProblem::NoAddress)),
            ("https://example.org/a b", Some(HookProblem::NoAddress)),
            ("https://op:word@example.org/", Some(HookProblem::LoginInAddress)),
        ] {
            let action = HookAction::Webhook(url.to_owned());
            assert_eq!(action.check().err(), problem, "{url}");
        }
    }

    #[test]
    fn only_events_of_the_plan_have_a_lead() {
        for (_, event) in HookEvent::WORDS {
            let early = Hook { delay_s: -30.0, ..hook(event) };
            let is_predicted = matches!(event, HookEvent::Aos | HookEvent::Los);
            assert_eq!(early.check().is_ok(), is_predicted, "{event:?}");
            assert!(Hook { delay_s: 600.0, ..hook(event) }.check().is_ok());
            assert!(Hook { delay_s: 601.0, ..hook(event) }.check().is_err());
            assert!(Hook { delay_s: f64::NAN, ..hook(event) }.check().is_err());
        }
    }

    #[test]
    fn a_hook_is_of_its_antenna_and_its_satellites() {
        let mut station = Station::default();
        station.groups.push(SatelliteGroup {
            name: "Weather".to_owned(),
            satellites: vec![33_591],
            priority: None,
            limits: crate::station::PassLimits::default(),
        });
        let (first, second) = (Some(AntennaId(1)), Some(AntennaId(2)));
        let matches = |hook: &Hook, antenna, satellite| {
            hook.matches(&station, HookEvent::Aos, antenna, satellite)
        };
        let all = hook(HookEvent::Aos);
        assert!(matches(&all, first, Some(7)) && matches(&all, None, None));
        assert!(!all.matches(&station, HookEvent::Los, first, Some(7)));
        assert!(!matches(&Hook { is_on: false, ..all.clone() }, first, Some(7)));
        let own = Hook { antenna: first, ..all.clone() };
        assert!(matches(&own, first, Some(7)));
        assert!(!matches(&own, second, Some(7)) && !matches(&own, None, Some(7)));
        let group = Some(RuleSubject::Group("Weather".to_owned()));
        for subject in [group, Some(RuleSubject::Satellite(33_591))] {
            let hook = Hook { subject, ..all.clone() };
            assert!(matches(&hook, first, Some(33_591)));
            assert!(!matches(&hook, first, Some(7)) && !matches(&hook, first, None));
        }
    }
}
