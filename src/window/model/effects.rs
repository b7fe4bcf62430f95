//! Effects of edited settings on the passes of the favourites in the next 48 hours, beside those of
//! the settings as saved. Worked out on a thread.

pub mod mounts;
pub mod obstacles;
pub mod sites;

use std::{sync::Arc, time::Duration};

use crate::{clock::Instant, contract::passes::PredictedPass, plan::Sample};

/// Time without a change before the work begins.
pub const DEBOUNCE: Duration = Duration::from_millis(300);

/// A question: settings as saved and as edited, which are compared over passes.
pub trait Compare: Clone + PartialEq + Send + 'static {
    type Tally: Send + 'static;
    /// Interval between the samples of a track that are evaluated, in samples.
    const EVERY: usize;

    /// Returns the tallies of the passes by the settings as saved, and as edited.
    fn tallies(&self, ways: &[PassTrack]) -> [Self::Tally; 2];
}

/// The track of a satellite through one pass.
#[derive(Debug, Clone, PartialEq)]
pub struct PassTrack {
    /// Catalog number.
    pub number: u32,
    /// In the order of time.
    pub samples: Vec<Sample>,
}

/// The answer to a question.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect<Q: Compare> {
    pub question: Q,
    /// The passes of the next 48 hours.
    pub ways: Arc<[PassTrack]>,
    /// As saved.
    pub before: Q::Tally,
    /// As edited.
    pub after: Q::Tally,
    /// Edition of the list of passes.
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
    /// The question, and the time it was asked first.
    pub requested: Option<(Q, Instant)>,
}

impl<Q: Compare> Default for Effects<Q> {
    fn default() -> Self {
        Self { effect: None, requested: None }
    }
}

impl<Q: Compare> Effects<Q> {
    /// Asks a question. The work begins once no other was asked for a while.
    pub fn ask(&mut self, question: Q, now: Instant) {
        if self.requested() != Some(&question) {
            self.requested = Some((question, now));
        }
    }

    pub fn requested(&self) -> Option<&Q> {
        self.requested.as_ref().map(|(question, _)| question)
    }
}

/// The tracks of all passes, or of those that were done before cancellation.
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
