//! The settings of a Satrak: one description of all its groups, with the conversion between
//! their values and the protocol.

#[cfg(test)]
mod copy_tests;
mod desired;
mod general;
mod place;
mod proof;
mod report;
mod service;
mod source;
mod times;

use crate::{
    device::settings::{Group, Unfit, Values, WriteError},
    protocol::satrak::{Query, Reply, Setting, TextValue, UrlValue, ValueError},
};
pub(super) use desired::Desired;
pub use general::{GENERAL, MINIMUM_ELEVATION_DEG, TLE_FROM_FILE, TLE_SOURCE, TRACK_OFFSETS};
pub(super) use place::lock_delay;
pub use place::{GPS, IS_AUTOMATIC, IS_VALID, LATITUDE_DEG, LONGITUDE_DEG, RECEIVER};
pub(super) use proof::{Differing, Judge, Proof};
pub use report::{POSITION, VERSIONS};
pub use service::{ANGLES, IMAGE, REDUCTION};
pub use source::{
    ADDRESS, CATALOG_NUMBER, CONTINUE_TRACKING, FILE, FILE_NAME, FTP, PASSWORD, PERIOD, PORT,
    SATELLITE, SATELLITE_NAME, URL, USER, WEB,
};
pub use times::{AHEAD_S, CLOCK, FROM_GPS, FROM_THIS_PC, SET_FROM, START, STOP, WINDOW};
pub(super) use times::{CLOCK_SETTING, ahead, is_from_gps};

/// All groups in the order of the forms, each with its functions for reading and writing.
static PLANS: [Plan; 13] = [
    Plan::reported(&GENERAL, Query::Settings, general::values).written(general::write),
    Plan::reported(&GPS, Query::GpsSettings, place::values).written(place::write),
    Plan::reported(&RECEIVER, Query::GpsData, place::receiver),
    Plan::reported(&WINDOW, Query::StartStopTime, times::window).written(times::write_window),
    Plan {
        judge: source::judge_file,
        also: SOURCE,
        ..Plan::reported(&FILE, Query::Satellite, source::file).written(source::write_file)
    },
    Plan {
        differing: source::web_differing,
        also: SOURCE,
        ..Plan::reported(&WEB, Query::SatelliteHttp, source::web).written(source::write_web)
    },
    Plan {
        also: SOURCE,
        ..Plan::reported(&FTP, Query::SatelliteFtp, source::ftp).written(source::write_ftp)
    },
    Plan {
        differing: times::clock_differing,
        is_clock: true,
        ..Plan::reported(&CLOCK, Query::Clock, times::clock).written(times::write_clock)
    },
    Plan::reported(&VERSIONS, Query::Version, report::versions),
    Plan::reported(&POSITION, Query::TimedPosition, report::position),
    Plan {
        differing: service::angles_differing,
        ..Plan::reported(&ANGLES, Query::AngleSettings, service::angles)
            .written(service::write_angles)
    },
    Plan::reported(&REDUCTION, Query::Reduction, service::reduction)
        .written(service::write_reduction),
    Plan::reported(&IMAGE, Query::ImageStatus, service::image).written(service::write_image),
];

/// Questions after a change of the source. A new source may lack the satellite, and switches the
/// reading mode.
const SOURCE: &[Query] = &[Query::Faults, Query::Settings];

/// The groups of settings, in the order of `PLANS`.
// An index past the end does not compile here, and `get` would need an unwrap.
#[allow(clippy::indexing_slicing)]
pub static GROUPS: &[&Group] = &{
    let mut groups = [PLANS[0].group; PLANS.len()];
    let mut place = 0;
    while place < PLANS.len() {
        groups[place] = PLANS[place].group;
        place += 1;
    }
    groups
};

pub(super) struct Plan {
    pub(super) group: &'static Group,
    pub(super) query: Query,
    /// Conversion of a reply to the values of the group; `None` for any other reply.
    pub(super) values: fn(&Reply) -> Option<Values>,
    /// Command that changes the group; `None` for a group that the unit only reports.
    pub(super) write: Option<Write>,
    /// Other groups that a change may affect.
    pub(super) also: &'static [Query],
    /// Comparison that finds the fields that the read-back proves wrong.
    pub(super) differing: Differing,
    /// Judgement that finds a fault with which the unit cannot use its values.
    pub(super) judge: Judge,
    /// `true` for the clock. Azel sets it in whole seconds, and not while the unit tracks by it.
    pub(super) is_clock: bool,
}

pub(super) type Write = fn(&Desired<'_>) -> Result<Setting, WriteError>;

impl Plan {
    const fn reported(
        group: &'static Group,
        query: Query,
        values: fn(&Reply) -> Option<Values>,
    ) -> Self {
        let (differing, judge): (Differing, Judge) = (proof::plain, proof::no_objection);
        Self { group, query, values, write: None, also: &[], differing, judge, is_clock: false }
    }

    const fn written(self, write: Write) -> Self {
        Self { write: Some(write), ..self }
    }

    pub(super) fn for_key(key: &str) -> Option<&'static Self> {
        PLANS.iter().find(|plan| plan.group.key == key)
    }
}

pub(super) fn group_of(query: Query) -> Option<&'static Group> {
    PLANS.iter().find(|plan| plan.query == query).map(|plan| plan.group)
}

/// Returns the group of a reply, with its values.
pub(super) fn values_of(reply: &Reply) -> Option<(&'static Group, Values)> {
    PLANS.iter().find_map(|plan| Some((plan.group, (plan.values)(reply)?)))
}

/// Checks a text that goes between commas.
fn text(text: &str) -> Result<(), Unfit> {
    TextValue::new("", text).map(drop).map_err(unfit)
}

/// Checks a web address; its commas are encoded.
fn url(text: &str) -> Result<(), Unfit> {
    UrlValue::new(text).map(drop).map_err(unfit)
}

fn unfit(error: ValueError) -> Unfit {
    match error {
        ValueError::Text { problem, .. } => Unfit::Text(problem.to_string()),
        ValueError::Range { min, max, .. } => Unfit::Number { min, max },
        other => Unfit::Text(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_group_can_be_read_and_written_where_it_has_something_to_write() {
        for Plan { group, write, .. } in &PLANS {
            assert_eq!(write.is_some(), group.is_writable(), "{}", group.key);
            let keys: BTreeSet<_> = group.fields.iter().map(|field| field.key).collect();
            let labels: BTreeSet<_> = group.fields.iter().map(|field| field.label).collect();
            assert_eq!((keys.len(), labels.len()), (group.fields.len(), group.fields.len()));
        }
        let keys: BTreeSet<_> = GROUPS.iter().map(|group| group.key).collect();
        assert_eq!(keys.len(), GROUPS.len());
    }
}
