//! Effects of edited settings on the passes, computed on a thread.

use std::sync::Arc;

use crate::{
    clock::Moment,
    contract::passes::PassList,
    job::{Job, Wake},
    model::{
        Model,
        effects::{Compare, DEBOUNCE, Effect, Effects, mounts, obstacles, sites, ways},
    },
};

/// A running computation, with its question and the revision of the pass list.
type EffectsJob<Q> = (Q, u64, Job<Effect<Q>>);

/// The running computations, one for each kind of question.
#[derive(Default)]
pub(super) struct EffectsJobs {
    obstacles: Option<EffectsJob<obstacles::Question>>,
    mounts: Option<EffectsJob<mounts::Question>>,
    sites: Option<EffectsJob<sites::Question>>,
}

impl EffectsJobs {
    pub(super) fn work(&mut self, model: &mut Model, wake: &Wake) {
        let Self { obstacles, mounts, sites } = self;
        let shown = Arc::clone(model.shown());
        let passes = &shown.pass_lists.favourites;
        let now = Moment { utc: model.now, steady: model.steady };
        work(&mut model.obstacle_effects, obstacles, passes, now, wake);
        work(&mut model.mount_effects, mounts, passes, now, wake);
        work(&mut model.site_effects, sites, passes, now, wake);
    }
}

/// Takes a finished answer and starts to answer the pending question.
fn work<Q: Compare>(
    effects: &mut Effects<Q>,
    begun: &mut Option<EffectsJob<Q>>,
    listing: &PassList,
    now: Moment,
    wake: &Wake,
) {
    let end = match begun.take() {
        Some((asked_question, asked_revision, job)) => {
            let mut job = Some(job);
            let end = Job::take(&mut job);
            *begun = job.map(|job| (asked_question, asked_revision, job));
            end
        }
        None => None,
    };
    match end {
        Some(Ok(effect)) => effects.effect = Some(effect),
        // Drop the question: it would fail again.
        Some(Err(_)) => effects.requested = None,
        None => {}
    }
    let Some((question, start)) = &effects.requested else { return };
    let revision = listing.revision;
    let current = effects.effect.as_ref().filter(|effect| effect.revision == revision);
    let is_answered = current.is_some_and(|effect| effect.question == *question);
    let is_begun = begun
        .as_ref()
        .is_some_and(|(other, begun_revision, _)| other == question && *begun_revision == revision);
    let is_early = now.steady.saturating_duration_since(*start) < DEBOUNCE;
    if is_answered || is_begun || is_early {
        return;
    }
    let pass_tracks = current.map(|effect| Arc::clone(&effect.ways));
    let passes = if pass_tracks.is_some() {
        Vec::new()
    } else {
        listing.upcoming(now.utc).iter().cloned().collect()
    };
    let requested = question.clone();
    let job = move |cancelled: &(dyn Fn() -> bool + Sync)| {
        let ways = pass_tracks.unwrap_or_else(|| ways::<Q>(&passes, cancelled));
        Effect::new(requested, &ways, revision)
    };
    // Replacing the job of an older question cancels it.
    *begun = Some((question.clone(), revision, Job::start("azel-effects", Arc::clone(wake), job)));
}
