//! What a running station shows of itself.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{
    alarms::Alarms, antenna::AntennaModel, closing::Closing, copies::Copies, passes::PassLists,
    source_tests::SourceTests, sources::Sources, uploads::Uploads, written,
};
use crate::{clock::Moment, driver::TimeSync, orbit::Catalog, station::Station};

/// The elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum CatalogState {
    /// They are being read.
    Loading,
    /// They are here.
    Ready(#[serde(skip)] Arc<Catalog>),
    /// There are none, and why.
    Failed,
}

/// A station at one instant. A copy shares what is large.
///
/// It can be written down and read back; elements and passes are left out then, by their
/// thousands, but for the revisions that tell when to ask for them again
/// ([`Catalog::range`], [`PassList::range`](super::passes::PassList::range)).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot {
    /// When it was taken, by both clocks of the station: ages count from here.
    pub at: Moment,
    /// How the clock of this computer is kept.
    pub time_sync: TimeSync,
    /// The station as saved.
    #[serde(with = "written::station")]
    pub station: Arc<Station>,
    /// The station is the demo station with simulated antennas.
    pub demo: bool,
    /// The elements.
    pub catalog: CatalogState,
    /// Another number whenever the elements are others.
    pub catalog_revision: u64,
    /// Where the elements come from.
    pub sources: Arc<Sources>,
    /// The antennas of the station, in its order.
    pub antennas: Vec<AntennaModel>,
    /// The passes to come.
    pub pass_lists: PassLists,
    /// Files of elements on their way to units.
    pub uploads: Arc<Uploads>,
    /// The sources that units are told to use, tested from here.
    pub source_tests: Arc<SourceTests>,
    /// What must not be missed.
    pub alarms: Alarms,
    /// Copies of the settings of units.
    pub copies: Arc<Copies>,
    /// The station is about to end, and what it waits for.
    pub closing: Option<Closing>,
}

impl Snapshot {
    /// What there is to show before the first turn.
    pub(super) fn before_anything(at: Moment) -> Self {
        Self {
            at,
            time_sync: TimeSync::NotKnown,
            station: Arc::default(),
            demo: false,
            catalog: CatalogState::Loading,
            catalog_revision: 0,
            sources: Arc::default(),
            antennas: Vec::new(),
            pass_lists: PassLists::default(),
            uploads: Arc::default(),
            source_tests: Arc::default(),
            alarms: Alarms::default(),
            copies: Arc::default(),
            closing: None,
        }
    }
}
