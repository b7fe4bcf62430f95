//! The settings of a Satrak: one description of all its groups, and the way
//! between their values and the words of the protocol.

mod general;
mod place;
mod report;
mod service;
mod source;
mod times;
mod wish;

use super::state::UnitClock;
use crate::{
    controller::settings::{Group, SettleError, Unfit, Values},
    protocol::satrak::{Query, Reply, Setting, TextValue, UrlValue, ValueError},
};
pub use times::{FROM_GPS, FROM_THIS_PC};
pub(super) use wish::Wish;

/// All groups of a unit, in the order of the forms.
pub static GROUPS: &[&Group] = &[
    &general::GENERAL,
    &place::GPS,
    &place::RECEIVER,
    &times::WINDOW,
    &source::FILE,
    &source::WEB,
    &source::FTP,
    &times::CLOCK,
    &report::VERSIONS,
    &report::POSITION,
    &service::ANGLES,
    &service::REDUCTION,
    &service::IMAGE,
];

/// How a group is read and written.
pub(super) struct Plan {
    /// Asks for it.
    pub(super) query: Query,
    /// Makes the command that changes it; `None` for what is only reported.
    pub(super) write: Option<Write>,
    /// What else a change may have changed, or may prove wrong.
    pub(super) also: &'static [Query],
}

pub(super) type Write = fn(&Wish<'_>) -> Result<Setting, SettleError>;

/// A new source may be without the satellite, and switches the mode of reading.
const SOURCE: &[Query] = &[Query::Faults, Query::Settings];

impl Plan {
    /// The plan of the group with this key.
    pub(super) fn of(key: &str) -> Option<Self> {
        let (query, write, also): (Query, Option<Write>, &'static [Query]) = match key {
            "general" => (Query::Settings, Some(general::write), &[]),
            "gps" => (Query::GpsSettings, Some(place::write), &[]),
            "receiver" => (Query::GpsData, None, &[]),
            "window" => (Query::StartStopTime, Some(times::write_window), &[]),
            "file" => (Query::Satellite, Some(source::write_file), SOURCE),
            "web" => (Query::SatelliteHttp, Some(source::write_web), SOURCE),
            "ftp" => (Query::SatelliteFtp, Some(source::write_ftp), SOURCE),
            "clock" => (Query::Clock, Some(times::write_clock), &[]),
            "versions" => (Query::Version, None, &[]),
            "position" => (Query::TimedPosition, None, &[]),
            "angles" => (Query::AngleSettings, Some(service::write_angles), &[]),
            "reduction" => (Query::Reduction, Some(service::write_reduction), &[]),
            "image" => (Query::ImageStatus, Some(service::write_image), &[]),
            _ => return None,
        };
        Some(Self { query, write, also })
    }
}

/// The group that `query` asks for.
pub(super) fn group_of(query: Query) -> Option<&'static Group> {
    GROUPS.iter().copied().find(|group| Plan::of(group.key).is_some_and(|p| p.query == query))
}

/// The group that a reply tells of, with its values.
pub(super) fn values_of(
    reply: &Reply,
    clock: Option<&UnitClock>,
) -> Option<(&'static Group, Values)> {
    Some(match reply {
        Reply::Settings(settings) => (&general::GENERAL, general::values(settings)),
        Reply::GpsSettings(settings) => (&place::GPS, place::values(settings)),
        Reply::GpsData(data) => (&place::RECEIVER, place::receiver(data)),
        Reply::StartStopTime(window) => (&times::WINDOW, times::window(window)),
        Reply::Satellite(satellite) => (&source::FILE, source::file(satellite)),
        Reply::SatelliteHttp(web) => (&source::WEB, source::web(web)),
        Reply::SatelliteFtp(ftp) => (&source::FTP, source::ftp(ftp)),
        Reply::Clock(read) => (&times::CLOCK, times::clock(*read, clock)),
        Reply::Version(version) => (&report::VERSIONS, report::versions(version)),
        Reply::TimedPosition(position) => (&report::POSITION, report::position(position)),
        Reply::AngleSettings(angles) => (&service::ANGLES, service::angles(angles)),
        Reply::Reduction(reduction) => (&service::REDUCTION, service::reduction(*reduction)),
        Reply::ImageStatus(status) => (&service::IMAGE, service::image(status)),
        Reply::Status(_) | Reply::Faults(_) | Reply::Done | Reply::Refused { .. } => return None,
    })
}

/// A text that stands between commas.
fn text(text: &str) -> Result<(), Unfit> {
    TextValue::new("", text).map(drop).map_err(unfit)
}

/// A web address; its commas are encoded.
fn url(text: &str) -> Result<(), Unfit> {
    UrlValue::new(text).map(drop).map_err(unfit)
}

fn unfit(error: ValueError) -> Unfit {
    match error {
        ValueError::Text { problem, .. } => Unfit::Text(problem.to_string()),
        ValueError::Range { least, most, .. } => {
            Unfit::Range { least: least.to_string(), most: most.to_string() }
        }
        other => Unfit::Text(other.to_string()),
    }
}
