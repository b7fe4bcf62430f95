//! Works out the table of the catalog and the next passes in it, on threads.

use std::sync::Arc;

use super::App;
use crate::{
    astro::time::seconds_between,
    engine::CatalogState,
    job::Job,
    model::{
        View,
        catalog_table::{Answer, Inputs, NEXT_PASSES_STALE_S, NextKey, NextPasses, arrange},
        object_detail::{DetailKey, ObjectDetail},
    },
};

/// The work under way, with what it was begun for.
#[derive(Default)]
pub(super) struct CatalogWork {
    rows: Option<(Inputs, Option<Job<Answer>>)>,
    next: Option<(NextKey, Option<Job<NextPasses>>)>,
    detail: Option<(DetailKey, Option<Job<ObjectDetail>>)>,
}

impl App {
    /// Brings the table up to date while it is shown.
    pub(super) fn work_on_catalog(&mut self) {
        self.take_catalog();
        let CatalogState::Ready(catalog) = &self.model.catalog else { return };
        if self.model.view != View::Elements {
            // Replaced jobs are cancelled.
            self.catalog_work = CatalogWork::default();
            return;
        }
        let (model, work) = (&self.model, &mut self.catalog_work);
        let inputs = model.catalog_table.inputs(catalog, &model.station);
        let is_known =
            model.catalog_table.answer.as_ref().is_some_and(|known| known.inputs == inputs);
        if !is_known && work.rows.as_ref().is_none_or(|(begun, _)| *begun != inputs) {
            let (asked, now) = (inputs.clone(), model.now);
            let job =
                Job::start("azel-catalog", Arc::clone(&self.wake), move |_| arrange(asked, now));
            work.rows = Some((inputs, started(job)));
        }
        let key = NextKey::new(catalog, &model.station);
        let is_young = |next: &Arc<NextPasses>| {
            next.key == key && seconds_between(next.made_at, model.now).abs() < NEXT_PASSES_STALE_S
        };
        let is_known = model.catalog_table.next.as_ref().is_some_and(is_young);
        if !is_known && work.next.as_ref().is_none_or(|(begun, _)| *begun != key) {
            let (asked, now) = (key.clone(), model.now);
            let job = Job::start("azel-next-passes", Arc::clone(&self.wake), move |cancelled| {
                NextPasses::search(asked, now, cancelled)
            });
            work.next = Some((key, started(job)));
        }
        let inspected = model.catalog_table.inspected.and_then(|number| catalog.get(number));
        let Some(elements) = inspected else { return };
        let key = DetailKey::new(elements, &model.station, model.older_sets.as_ref());
        let detail = model.catalog_table.detail.as_ref();
        let is_known = detail.is_some_and(|detail| detail.is_of(&key, model.now));
        if !is_known && work.detail.as_ref().is_none_or(|(begun, _)| *begun != key) {
            let (asked, now) = (key.clone(), model.now);
            let job = Job::start("azel-object", Arc::clone(&self.wake), move |cancelled| {
                ObjectDetail::new(asked, now, cancelled)
            });
            work.detail = Some((key, started(job)));
        }
    }

    fn take_catalog(&mut self) {
        let (table, work) = (&mut self.model.catalog_table, &mut self.catalog_work);
        // Work that broke off stays noted: the same would break off again.
        if let Some((_, job)) = &mut work.rows
            && let Some(Ok(answer)) = Job::take(job)
        {
            table.answer = Some(answer);
            work.rows = None;
        }
        if let Some((_, job)) = &mut work.next
            && let Some(Ok(next)) = Job::take(job)
        {
            table.next = Some(Arc::new(next));
            work.next = None;
        }
        if let Some((_, job)) = &mut work.detail
            && let Some(Ok(detail)) = Job::take(job)
        {
            table.detail = Some(detail);
            work.detail = None;
        }
    }
}

fn started<T>(job: std::io::Result<Job<T>>) -> Option<Job<T>> {
    job.inspect_err(|error| tracing::error!(%error, "no thread for the table of the catalog")).ok()
}
