//! Computes the effects of the keep-outs on the passes, on a thread.

use std::sync::Arc;

use super::App;
use crate::{
    job::Job,
    model::effects::{DEBOUNCE, Effect, Question, answer, ways},
};

/// A running computation, with its question and the revision of the pass list.
pub(super) type EffectsJob = (Question, u64, Job<Effect>);

impl App {
    pub(super) fn work_on_effects(&mut self) {
        let (effects, begun) = (&mut self.model.effects, &mut self.effects_job);
        let end = match begun.take() {
            Some((of, at, job)) => {
                let mut job = Some(job);
                let end = Job::take(&mut job);
                *begun = job.map(|job| (of, at, job));
                end
            }
            None => None,
        };
        match end {
            Some(Ok(effect)) => effects.effect = Some(effect),
            // The same question would fail again.
            Some(Err(_)) => effects.asked = None,
            None => {}
        }
        let Some((question, since)) = &effects.asked else { return };
        let listing = &self.model.pass_lists.favourites;
        let revision = listing.revision;
        let is_answered = effects
            .effect
            .as_ref()
            .is_some_and(|effect| effect.question == *question && effect.revision == revision);
        let is_begun = begun.as_ref().is_some_and(|(of, at, _)| of == question && *at == revision);
        if is_answered || is_begun || self.model.steady.saturating_duration_since(*since) < DEBOUNCE
        {
            return;
        }
        let known = effects.effect.as_ref().filter(|effect| effect.revision == revision);
        let known = known.map(|effect| Arc::clone(&effect.ways));
        let passes = if known.is_some() {
            Vec::new()
        } else {
            listing.upcoming(self.model.now).iter().cloned().collect()
        };
        let asked = question.clone();
        let work = move |cancelled: &(dyn Fn() -> bool + Sync)| {
            let ways = known.unwrap_or_else(|| ways(&passes, cancelled));
            answer(asked, &ways, revision)
        };
        match Job::start("azel-effects", Arc::clone(&self.wake), work) {
            // Replacing the job of an older question cancels it.
            Ok(job) => *begun = Some((question.clone(), revision, job)),
            Err(error) => tracing::error!(%error, "no thread for the effects"),
        }
    }
}
