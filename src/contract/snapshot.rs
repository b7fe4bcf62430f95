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
    control::PortState,
    copies::Copies,
    driver::TimeSync,
    hooks::HookRun,
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

/// Loading state of the elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum CatalogState {
    Loading,
    Ready(#[serde(skip)] Arc<Catalog>),
    Failed,
}

/// A station at one instant. Clones share the large parts.
///
/// A snapshot is serialisable. The serialised form leaves out elements and passes, because there
/// are thousands. Their revisions tell a client when to fetch them again ([`Catalog::range`],
/// [`PassList::range`](super::passes::PassList::range)).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time by both clocks of the station; ages count from it.
    #[serde(rename = "at")]
    pub moment: Moment,
    /// Synchronisation of this computer's clock.
    pub time_sync: TimeSync,
    /// Station as saved.
    #[serde(with = "written::station")]
    pub station: Arc<Station>,
    /// Time of the last write of the station file; `None` for the demo station.
    pub station_saved_at: Option<Timestamp>,
    /// The station is the demo station with simulated antennas.
    pub demo: bool,
    /// Azel could not read the station file, so nothing of this station comes from the operator.
    #[serde(default)]
    pub station_unread: bool,
    pub catalog: CatalogState,
    /// Number that changes whenever the elements change.
    pub catalog_revision: u64,
    pub sources: Arc<Sources>,
    /// Older sets of the object of the last request.
    pub older_sets: Option<Arc<OlderSets>>,
    /// Passes of the record that a client has requested.
    pub recorded: Option<Arc<Recorded>>,
    /// Fit of a pointing model of the last request.
    pub pointing_fitted: Option<Arc<PointingFitted>>,
    /// Peaks of the Sun and the Moon that the fit uses.
    #[serde(default)]
    pub peaks: Arc<Peaks>,
    /// Antennas, in the order of the station.
    pub antennas: Vec<AntennaModel>,
    pub pass_lists: PassLists,
    /// Reminders of passes that are not over.
    pub reminders: Arc<Vec<Reminder>>,
    pub schedule: Arc<Planned>,
    /// Cost of the pass of the last request.
    pub swap: Option<Arc<Swap>>,
    /// Outcomes of the passes of this UTC day, and events of automatic operation; the newest is the
    /// last.
    pub day: Arc<Vec<DayLine>>,
    pub uploads: Arc<Uploads>,
    /// Tests, from this computer, of the sources that units use.
    pub source_tests: Arc<SourceTests>,
    /// Tests of links to units, which may be outside the station.
    pub link_tests: Arc<Vec<LinkTest>>,
    pub alarms: Alarms,
    /// Copies of the settings of units.
    pub copies: Arc<Copies>,
    /// State of the record; `None` if Azel keeps none.
    pub record: Option<Arc<record::Status>>,
    /// Closing in progress, with the antennas that it waits for.
    pub closing: Option<Closing>,
    /// State of the port for metrics.
    #[serde(default)]
    pub metrics: PortState,
    /// Last calls of hooks, the newest last.
    #[serde(default)]
    pub hooks: Arc<Vec<HookRun>>,
}

impl Snapshot {
    /// Creates the snapshot before the first turn.
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
            metrics: PortState::Closed,
            hooks: Arc::default(),
        }
    }
}
