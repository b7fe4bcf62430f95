//! The errors of the last tracks, which stay to be looked at.

use std::{collections::VecDeque, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    antenna::{ErrorSample, Errors},
    astro::Angle,
};

/// Number of tracks that are kept.
const MAX_TRACKS: usize = 8;

/// The errors of a track that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastTrack {
    /// Name of the target.
    pub name: String,
    /// First and last sample.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// Root of the mean square of the angle between beam axis and target.
    pub rms: Angle,
    pub worst: ErrorSample,
    /// About one a second, the worst and the last included.
    pub errors: Errors,
}

/// The last tracks, newest first. Clones share them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct PastTracks(VecDeque<Arc<PastTrack>>);

/// Newest first.
impl FromIterator<Arc<PastTrack>> for PastTracks {
    fn from_iter<I: IntoIterator<Item = Arc<PastTrack>>>(tracks: I) -> Self {
        Self(tracks.into_iter().collect())
    }
}

impl PastTracks {
    /// Newest first.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<PastTrack>> {
        self.0.iter()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a track, and drops the oldest where there are too many.
    pub fn push(&mut self, track: PastTrack) {
        self.0.push_front(Arc::new(track));
        self.0.truncate(MAX_TRACKS);
    }
}
