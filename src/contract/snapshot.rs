//! The state that a running station publishes.

use std::sync::Arc;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::written;
use crate::{
    alarms::Alarms,
    antenna::AntennaModel,
    automatic::DayLine,
    clock::Moment,
    closing::Closing,
    copies::Copies,
    driver::TimeSync,
    link_tests::LinkTest,
    older_sets::OlderSets,
    orbit::Catalog,
    passes::PassLists,
    record::{self, Peaks, PointingFitted},
    recorded::Recorded,
    reminders::Reminder,
    schedule::{Planned, Swap},
    source_tests::SourceTests,
    sources::Sources,
    station::Station,
    uploads::Uploads,
};

/// State of the elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum CatalogState {
    Loading,
    Ready(#[serde(skip)] Arc<Catalog>),
    Failed,
}

/// A station at one instant. Clones share the large parts.
///
/// A snapshot can be serialised. Elements and passes are then left out, because there are
/// thousands; their revisions tell when to ask for them again ([`Catalog::range`],
/// [`PassList::range`](super::passes::PassList::range)).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time by both clocks of the station: ages count from here.
    #[serde(rename = "at")]
    pub moment: Moment,
    /// Synchronisation of this computer's clock.
    pub time_sync: TimeSync,
    /// The station as saved.
    #[serde(with = "written::station")]
    pub station: Arc<Station>,
    /// When its file was written last; `None` for the demo station.
    pub station_saved_at: Option<Timestamp>,
    /// This is the demo station with simulated antennas.
    pub demo: bool,
    /// The station file could not be read: nothing of this station is the operator's.
    #[serde(default)]
    pub station_unread: bool,
    pub catalog: CatalogState,
    /// Changes whenever the elements change.
    pub catalog_revision: u64,
    pub sources: Arc<Sources>,
    /// Older sets of the object that was asked for last.
    pub older_sets: Option<Arc<OlderSets>>,
    /// Passes of the record, where they are looked at.
    pub recorded: Option<Arc<Recorded>>,
    /// The fit of a pointing model that was asked for last.
    pub pointing_fitted: Option<Arc<PointingFitted>>,
    /// Peaks of the Sun and the Moon that count in it.
    #[serde(default)]
    pub peaks: Arc<Peaks>,
    /// The antennas of the station, in its order.
    pub antennas: Vec<AntennaModel>,
    pub pass_lists: PassLists,
    /// Reminders of passes that are not over.
    pub reminders: Arc<Vec<Reminder>>,
    pub schedule: Arc<Planned>,
    /// Cost of the pass that a client has asked about.
    pub swap: Option<Arc<Swap>>,
    /// Outcomes of the passes of this day (UTC), and events of automatic operation; the newest is
    /// the last.
    pub day: Arc<Vec<DayLine>>,
    pub uploads: Arc<Uploads>,
    /// Tests, from here, of the sources that units use.
    pub source_tests: Arc<SourceTests>,
    /// Tests of links to units that the station need not have.
    pub link_tests: Arc<Vec<LinkTest>>,
    pub alarms: Alarms,
    /// Copies of the settings of units.
    pub copies: Arc<Copies>,
    /// How the record stands; `None` where none is kept.
    pub record: Option<Arc<record::Status>>,
    /// The closing under way, and what it waits for.
    pub closing: Option<Closing>,
}

impl Snapshot {
    /// The snapshot before the first turn.
    pub fn before_anything(moment: Moment) -> Self {
        Self {
            moment,
            time_sync: TimeSync::NotKnown,
            station: Arc::default(),
            station_saved_at: None,
            demo: false,
            station_unread: false,
            catalog: CatalogState::Loading,
            catalog_revision: 0,
            sources: Arc::default(),
            older_sets: None,
            recorded: None,
            pointing_fitted: None,
            peaks: Arc::default(),
            antennas: Vec::new(),
            pass_lists: PassLists::default(),
            reminders: Arc::default(),
            schedule: Arc::default(),
            swap: None,
            day: Arc::default(),
            uploads: Arc::default(),
            source_tests: Arc::default(),
            link_tests: Arc::default(),
            alarms: Alarms::default(),
            copies: Arc::default(),
            record: None,
            closing: None,
        }
    }
}
