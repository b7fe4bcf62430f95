//! The settings of a Satrak: one description of all its groups, and the way
//! between their values and the words of the protocol.

#[cfg(test)]
mod copy_tests;
mod general;
mod place;
mod proof;
mod report;
mod service;
mod source;
mod times;
mod wish;

use crate::{
    device::{
        UnitClock,
        settings::{Group, SettleError, Unfit, Values},
    },
    protocol::satrak::{Query, Reply, Setting, TextValue, UrlValue, ValueError},
};
pub(super) use proof::{Differing, Judge, Proof};
pub(super) use source::FILE;
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
    /// What the read-back proves wrong.
    pub(super) differing: Differing,
    /// What the faults say about it.
    pub(super) judge: Judge,
    /// The clock is told whole seconds, and not while the unit tracks by it.
    pub(super) is_clock: bool,
}

pub(super) type Write = fn(&Wish<'_>) -> Result<Setting, SettleError>;

/// A new source may be without the satellite, and switches the mode of reading.
const SOURCE: &[Query] = &[Query::Faults, Query::Settings];

impl Plan {
    const fn read(query: Query) -> Self {
        let (differing, judge): (Differing, Judge) = (proof::plain, proof::no_objection);
        Self { query, write: None, also: &[], differing, judge, is_clock: false }
    }

    const fn write(query: Query, write: Write) -> Self {
        Self { write: Some(write), ..Self::read(query) }
    }

    /// The plan of the group with this key.
    pub(super) fn of(key: &str) -> Option<Self> {
        let source = |query, write| Self { also: SOURCE, ..Self::write(query, write) };
        Some(match key {
            "general" => Self::write(Query::Settings, general::write),
            "gps" => Self::write(Query::GpsSettings, place::write),
            "receiver" => Self::read(Query::GpsData),
            "window" => Self::write(Query::StartStopTime, times::write_window),
            "file" => {
                Self { judge: source::judge_file, ..source(Query::Satellite, source::write_file) }
            }
            "web" => Self {
                differing: source::web_differing,
                ..source(Query::SatelliteHttp, source::write_web)
            },
            "ftp" => source(Query::SatelliteFtp, source::write_ftp),
            "clock" => Self {
                differing: times::clock_differing,
                is_clock: true,
                ..Self::write(Query::Clock, times::write_clock)
            },
            "versions" => Self::read(Query::Version),
            "position" => Self::read(Query::TimedPosition),
            "angles" => Self {
                differing: service::angles_differing,
                ..Self::write(Query::AngleSettings, service::write_angles)
            },
            "reduction" => Self::write(Query::Reduction, service::write_reduction),
            "image" => Self::write(Query::ImageStatus, service::write_image),
            _ => return None,
        })
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_group_can_be_read_and_written_where_it_has_something_to_write() {
        for group in GROUPS {
            let plan = Plan::of(group.key).unwrap();
            assert_eq!(plan.write.is_some(), group.is_writable(), "{}", group.key);
            assert_eq!(group_of(plan.query).unwrap().key, group.key);
            let keys: BTreeSet<_> = group.fields.iter().map(|field| field.key).collect();
            let labels: BTreeSet<_> = group.fields.iter().map(|field| field.label).collect();
            assert_eq!((keys.len(), labels.len()), (group.fields.len(), group.fields.len()));
        }
        let keys: BTreeSet<_> = GROUPS.iter().map(|group| group.key).collect();
        assert_eq!(keys.len(), GROUPS.len());
    }
}
