//! Effects of edited settings on the passes of the favourites in the next 48 hours, compared with
//! the saved settings. A thread computes them.

pub mod mounts;
pub mod obstacles;
pub mod sites;

use std::{sync::Arc, time::Duration};

use crate::{clock::Instant, contract::passes::PredictedPass, plan::Sample};

/// Time without a change before the computation starts.
pub const DEBOUNCE: Duration = Duration::from_millis(300);

/// A question: saved and edited settings to compare over the passes.
pub trait Compare: Clone + PartialEq + Send + 'static {
    type Tally: Send + 'static;
    /// Interval between the evaluated samples of a track, in samples.
    const EVERY: usize;

    /// Returns the tallies of the passes with the saved and with the edited settings.
    fn tallies(&self, ways: &[PassTrack]) -> [Self::Tally; 2];
}

/// The track of a satellite through one pass.
#[derive(Debug, Clone, PartialEq)]
pub struct PassTrack {
    /// Catalog number of the satellite.
    pub number: u32,
    /// Samples in order of time.
    pub samples: Vec<Sample>,
}

/// The answer to a question.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect<Q: Compare> {
    pub question: Q,
    /// The passes of the next 48 hours.
    pub ways: Arc<[PassTrack]>,
    /// Tally with the saved settings.
    pub before: Q::Tally,
    /// Tally with the edited settings.
    pub after: Q::Tally,
    /// Revision of the list of passes.
    pub revision: u64,
}

impl<Q: Compare> Effect<Q> {
    pub fn new(question: Q, ways: &Arc<[PassTrack]>, revision: u64) -> Self {
        let [before, after] = question.tallies(ways);
        Self { ways: Arc::clone(ways), before, after, revision, question }
    }
}

/// The last question and its answer.
pub struct Effects<Q: Compare> {
    /// The last answer, kept until the next one so that the view does not flicker.
    pub effect: Option<Effect<Q>>,
    /// The question, and the time when a view first asked it.
    pub requested: Option<(Q, Instant)>,
}

impl<Q: Compare> Default for Effects<Q> {
    fn default() -> Self {
        Self { effect: None, requested: None }
    }
}

impl<Q: Compare> Effects<Q> {
    /// Asks a question. The computation starts once no other question has come for [`DEBOUNCE`].
    pub fn ask(&mut self, question: Q, now: Instant) {
        if self.requested() != Some(&question) {
            self.requested = Some((question, now));
        }
    }

    pub fn requested(&self) -> Option<&Q> {
        self.requested.as_ref().map(|(question, _)| question)
    }
}

/// Returns the tracks of all passes, or the tracks finished before cancellation.
pub fn ways<Q: Compare>(
    passes: &[PredictedPass],
    cancelled: &dyn Fn() -> bool,
) -> Arc<[PassTrack]> {
    let listed = passes.iter().filter(|predicted| !predicted.is_always_up());
    let way = |predicted: &PredictedPass| PassTrack {
        number: predicted.number(),
        samples: predicted.track().iter().step_by(Q::EVERY).copied().collect(),
    };
    listed.take_while(|_| !cancelled()).map(way).collect()
}
