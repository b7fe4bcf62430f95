//! Values that a call passes on: as environment variables to a program, and as JSON to a server.

use jiff::{SignedDuration, Timestamp};
use serde::Serialize;

use super::timetable::{Matter, Occurrence};
use crate::{
    astro::{Angle, AzEl},
    contract::{
        alarms::AlarmKind,
        antenna::AntennaModel,
        automatic::{Flown, MissCause},
        passes::PredictedPass,
        record::RecordedReport,
    },
    device::Pointing,
    plan::pass_report::PassVerdict,
    station::{AntennaId, Hook, HookEvent, Station},
};

/// Max length of a value, bytes. Longer values are cut.
const MAX_BYTES: usize = 4096;

/// Pass of an antenna, as hooks need it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HookPass {
    pub(super) antenna: AntennaId,
    /// Catalog number.
    pub(super) satellite: u32,
    /// Short name of the satellite.
    pub(super) name: String,
    pub(super) aos: Timestamp,
    pub(super) tca: Timestamp,
    pub(super) los: Timestamp,
    /// `false` if the satellite is up when the list begins: AOS is then the start of the list.
    pub(super) has_aos: bool,
    /// `false` if the satellite is up when the list ends.
    pub(super) has_los: bool,
    /// Directions at AOS, TCA and LOS.
    pub(super) directions: [AzEl; 3],
    pub(super) plan: PlanState,
    pub(super) report: Option<ReportValues>,
}

impl HookPass {
    pub(super) fn new(predicted: &PredictedPass, antenna: AntennaId, plan: PlanState) -> Self {
        let pass = &predicted.pass;
        Self {
            antenna,
            satellite: predicted.number(),
            name: predicted.satellite.short_name().to_owned(),
            aos: pass.aos.time,
            tca: pass.tca.time,
            los: pass.los.time,
            has_aos: !pass.starts_before,
            has_los: !pass.ends_after,
            directions: [pass.aos.direction, pass.tca.direction, pass.los.direction],
            plan,
            report: None,
        }
    }

    /// Returns a pass for a trial call, three minutes from `now`.
    pub(super) fn sample(antenna: AntennaId, now: Timestamp) -> Self {
        let after = |minutes| now.checked_add(SignedDuration::from_mins(minutes)).unwrap_or(now);
        let direction = |azimuth_deg, elevation_deg| AzEl {
            azimuth: Angle::from_degrees(azimuth_deg),
            elevation: Angle::from_degrees(elevation_deg),
        };
        Self {
            antenna,
            satellite: 25_544,
            name: "ISS".to_owned(),
            aos: after(3),
            tca: after(8),
            los: after(13),
            has_aos: true,
            has_los: true,
            directions: [direction(200.0, 5.0), direction(290.0, 45.0), direction(20.0, 5.0)],
            plan: PlanState::Automatic,
            report: None,
        }
    }

    /// Returns `true` for the same pass of the same antenna. The passes of a satellite do not
    /// overlap, but newer elements shift their times.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let is_own = self.antenna == other.antenna && self.satellite == other.satellite;
        is_own && self.aos < other.los && other.aos < self.los
    }
}

/// State of a pass in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum PlanState {
    /// Automatic operation takes the pass.
    Automatic,
    /// The plan gives the pass to the antenna, but automatic operation is off or suspended.
    Planned,
    /// The antenna has the command to track the satellite.
    Commanded,
    /// Neither the plan nor a command has the pass any more.
    Dropped,
}

impl PlanState {
    fn word(self) -> &'static str {
        match self {
            Self::Automatic => "automatic",
            Self::Planned => "planned",
            Self::Commanded => "commanded",
            Self::Dropped => "dropped",
        }
    }
}

/// Report of a pass.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct ReportValues {
    verdict: &'static str,
    counted_s: f64,
    in_beam_s: f64,
    rms_deg: Option<f64>,
    miss_cause: Option<MissCause>,
}

impl ReportValues {
    pub(super) fn new(report: &RecordedReport) -> Self {
        let report = &report.report;
        Self {
            verdict: report.verdict.word(),
            counted_s: report.counted_s,
            in_beam_s: report.in_beam_s,
            rms_deg: report.rms.map(|rms| rms.off_deg),
            miss_cause: None,
        }
    }

    /// Returns a report for tests.
    #[cfg(test)]
    pub(super) fn sample() -> Self {
        Self {
            verdict: "good",
            counted_s: 600.0,
            in_beam_s: 600.0,
            rms_deg: None,
            miss_cause: None,
        }
    }

    /// Returns the report of a missed pass.
    fn missed(flown: &Flown) -> Self {
        Self {
            verdict: PassVerdict::Poor.word(),
            counted_s: flown.of_s,
            in_beam_s: flown.in_beam_s,
            rms_deg: None,
            miss_cause: flown.cause,
        }
    }
}

/// Values of a call.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Values<'a> {
    hook: &'a str,
    event: HookEvent,
    event_time: Timestamp,
    /// Seconds from the event to the planned time of the call.
    delay_s: f64,
    is_trial: bool,
    station: &'a str,
    antenna: Option<AntennaValues<'a>>,
    satellite: Option<SatelliteValues<'a>>,
    pass: Option<PassValues>,
    report: Option<ReportValues>,
    alarm: Option<&'a AlarmKind>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct AntennaValues<'a> {
    id: AntennaId,
    name: &'a str,
    /// Measured direction; `None` if it is not known now.
    azimuth_deg: Option<f64>,
    elevation_deg: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct SatelliteValues<'a> {
    number: u32,
    name: &'a str,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct PassValues {
    aos: Timestamp,
    tca: Timestamp,
    los: Timestamp,
    aos_azimuth_deg: f64,
    tca_azimuth_deg: f64,
    los_azimuth_deg: f64,
    max_elevation_deg: f64,
    plan: PlanState,
}

impl<'a> Values<'a> {
    pub(super) fn new(
        station: &'a Station,
        antennas: impl Iterator<Item = &'a AntennaModel>,
        hook: &'a Hook,
        occurrence: &'a Occurrence,
        is_trial: bool,
    ) -> Self {
        let Occurrence { event, time, antenna, pass, matter } = occurrence;
        let mut antennas = antennas.filter(|model| Some(model.id()) == *antenna);
        let pass = pass.as_ref();
        let report = pass.and_then(|pass| pass.report.clone());
        let (report, alarm) = match matter {
            Matter::None => (report, None),
            Matter::Missed(flown) => (Some(ReportValues::missed(flown)), None),
            Matter::Alarm(kind) => (report, Some(&**kind)),
        };
        Self {
            hook: &hook.name,
            event: *event,
            event_time: *time,
            delay_s: hook.delay_s,
            is_trial,
            station: &station.name,
            antenna: antennas.next().map(AntennaValues::new),
            satellite: pass
                .map(|pass| SatelliteValues { number: pass.satellite, name: &pass.name }),
            pass: pass.map(PassValues::new),
            report,
            alarm,
        }
    }

    /// Returns the values as JSON. A secret serialises to `null`.
    pub(super) fn json(&self) -> String {
        serde_json::to_string(self).unwrap_or_else(|error| {
            tracing::error!(%error, "a hook without its values");
            "{}".to_owned()
        })
    }

    /// Returns the values as environment variables. Unknown values have no variable.
    pub(super) fn environment(&self) -> Vec<(&'static str, String)> {
        let deg = |angle_deg: f64| format!("{angle_deg:.2}");
        let mut variables = vec![
            ("AZEL_HOOK", self.hook.to_owned()),
            ("AZEL_EVENT", self.event.word().to_owned()),
            ("AZEL_EVENT_TIME", self.event_time.to_string()),
            ("AZEL_DELAY_S", self.delay_s.to_string()),
            ("AZEL_TRIAL", u8::from(self.is_trial).to_string()),
            ("AZEL_STATION", self.station.to_owned()),
        ];
        if let Some(antenna) = &self.antenna {
            variables.extend([
                ("AZEL_ANTENNA", antenna.name.to_owned()),
                ("AZEL_ANTENNA_ID", antenna.id.0.to_string()),
            ]);
            variables.extend(antenna.azimuth_deg.map(|angle| ("AZEL_AZIMUTH_DEG", deg(angle))));
            variables.extend(antenna.elevation_deg.map(|angle| ("AZEL_ELEVATION_DEG", deg(angle))));
        }
        if let Some(satellite) = &self.satellite {
            variables.extend([
                ("AZEL_SATELLITE", satellite.name.to_owned()),
                ("AZEL_SATELLITE_NUMBER", satellite.number.to_string()),
            ]);
        }
        if let Some(pass) = &self.pass {
            variables.extend([
                ("AZEL_AOS", pass.aos.to_string()),
                ("AZEL_TCA", pass.tca.to_string()),
                ("AZEL_LOS", pass.los.to_string()),
                ("AZEL_AOS_AZIMUTH_DEG", deg(pass.aos_azimuth_deg)),
                ("AZEL_TCA_AZIMUTH_DEG", deg(pass.tca_azimuth_deg)),
                ("AZEL_LOS_AZIMUTH_DEG", deg(pass.los_azimuth_deg)),
                ("AZEL_MAX_ELEVATION_DEG", deg(pass.max_elevation_deg)),
                ("AZEL_PLAN", pass.plan.word().to_owned()),
            ]);
        }
        if let Some(report) = &self.report {
            variables.extend([
                ("AZEL_VERDICT", report.verdict.to_owned()),
                ("AZEL_COUNTED_S", format!("{:.1}", report.counted_s)),
                ("AZEL_IN_BEAM_S", format!("{:.1}", report.in_beam_s)),
            ]);
            variables.extend(report.rms_deg.map(|rms_deg| ("AZEL_RMS_DEG", deg(rms_deg))));
            variables.extend(report.miss_cause.map(|cause| ("AZEL_MISS_CAUSE", text_of(&cause))));
        }
        variables.extend(self.alarm.map(|kind| ("AZEL_ALARM", text_of(kind))));
        for (_, value) in &mut variables {
            // A name from a file of elements may contain anything; a null character would prevent
            // the call.
            value.retain(|letter| !letter.is_control());
            value.truncate(value.floor_char_boundary(MAX_BYTES));
        }
        variables
    }
}

/// Returns a value as JSON, or as plain text if it is only a word.
fn text_of(value: &impl Serialize) -> String {
    let text = serde_json::to_string(value).unwrap_or_default();
    text.trim_matches('"').to_owned()
}

impl<'a> AntennaValues<'a> {
    fn new(antenna: &'a AntennaModel) -> Self {
        let measured = antenna.snapshot.state.measured.filter(|_| antenna.is_live());
        let Pointing { azimuth, elevation } = measured
            .map_or(Pointing { azimuth: None, elevation: None }, |measured| measured.pointing);
        Self {
            id: antenna.id(),
            name: &antenna.config.name,
            azimuth_deg: azimuth.map(Angle::degrees),
            elevation_deg: elevation.map(Angle::degrees),
        }
    }
}

impl PassValues {
    fn new(pass: &HookPass) -> Self {
        let [aos, tca, los] = pass.directions;
        Self {
            aos: pass.aos,
            tca: pass.tca,
            los: pass.los,
            aos_azimuth_deg: aos.azimuth.degrees(),
            tca_azimuth_deg: tca.azimuth.degrees(),
            los_azimuth_deg: los.azimuth.degrees(),
            max_elevation_deg: tca.elevation.degrees(),
            plan: pass.plan,
        }
    }
}
