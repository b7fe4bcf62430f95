//! Errors of the last tracks, for display.

use std::{collections::VecDeque, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    antenna::{ErrorSample, Errors},
    astro::Angle,
};

/// Max number of kept tracks.
const MAX_TRACKS: usize = 8;

/// Errors of a completed track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastTrack {
    /// Name of the target.
    pub name: String,
    /// Time of the first sample.
    #[serde(rename = "from")]
    pub start: Timestamp,
    #[serde(rename = "until")]
    pub end: Timestamp,
    /// Root mean square of the angle between beam axis and target.
    pub rms: Angle,
    pub worst: ErrorSample,
    /// About one error a second, including the worst and the last.
    pub errors: Errors,
}

/// Last tracks, newest first. Clones share them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct PastTracks(VecDeque<Arc<PastTrack>>);

/// Conversion from tracks that are sorted newest first.
impl FromIterator<Arc<PastTrack>> for PastTracks {
    fn from_iter<I: IntoIterator<Item = Arc<PastTrack>>>(tracks: I) -> Self {
        Self(tracks.into_iter().collect())
    }
}

impl PastTracks {
    /// Returns the tracks, newest first.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<PastTrack>> {
        self.0.iter()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a track, and drops the oldest if the list is full.
    pub fn push(&mut self, track: PastTrack) {
        self.0.push_front(Arc::new(track));
        self.0.truncate(MAX_TRACKS);
    }
}
