//! Work on the catalog table and on the next passes in it, on threads.

use std::sync::Arc;

use crate::{
    astro::time::seconds_between,
    contract::CatalogState,
    job::{Job, Wake},
    model::{
        Model, View,
        catalog_table::{Answer, Inputs, NEXT_PASSES_STALE_S, NextKey, NextPasses, arrange},
        object_detail::{DetailKey, ObjectDetail},
    },
};

/// Running jobs, each with the inputs that it started with.
#[derive(Default)]
pub(super) struct CatalogWork {
    rows: Option<(Inputs, Option<Job<Answer>>)>,
    next: Option<(NextKey, Option<Job<NextPasses>>)>,
    detail: Option<(DetailKey, Option<Job<ObjectDetail>>)>,
}

impl CatalogWork {
    /// Updates the table while the Elements view shows it.
    pub(super) fn work(&mut self, model: &mut Model, wake: &Wake) {
        self.take(model);
        let CatalogState::Ready(catalog) = &model.catalog else { return };
        if model.view != View::Elements {
            // Dropping a job cancels it.
            *self = Self::default();
            return;
        }
        let inputs = model.catalog_table.inputs(catalog, &model.station);
        let is_known =
            model.catalog_table.answer.as_ref().is_some_and(|answer| answer.inputs == inputs);
        if !is_known && self.rows.as_ref().is_none_or(|(begun, _)| *begun != inputs) {
            let (requested_inputs, now) = (inputs.clone(), model.now);
            let job = Job::start("azel-catalog", Arc::clone(wake), move |_| {
                arrange(requested_inputs, now)
            });
            self.rows = Some((inputs, Some(job)));
        }
        let key = NextKey::new(catalog, &model.station);
        let is_young = |next: &Arc<NextPasses>| {
            next.key == key && seconds_between(next.made_at, model.now).abs() < NEXT_PASSES_STALE_S
        };
        let is_known = model.catalog_table.next.as_ref().is_some_and(is_young);
        if !is_known && self.next.as_ref().is_none_or(|(begun, _)| *begun != key) {
            let (next_key, now) = (key.clone(), model.now);
            let job = Job::start("azel-next-passes", Arc::clone(wake), move |cancelled| {
                NextPasses::search(next_key, now, cancelled)
            });
            self.next = Some((key, Some(job)));
        }
        let inspected = model.catalog_table.inspected.and_then(|number| catalog.get(number));
        let Some(elements) = inspected else { return };
        let key = DetailKey::new(elements, &model.station, model.older_sets.as_ref());
        let detail = model.catalog_table.detail.as_ref();
        let is_known = detail.is_some_and(|detail| detail.is_of(&key, model.now));
        if !is_known && self.detail.as_ref().is_none_or(|(begun, _)| *begun != key) {
            let (detail_key, now) = (key.clone(), model.now);
            let job = Job::start("azel-object", Arc::clone(wake), move |cancelled| {
                ObjectDetail::new(detail_key, now, cancelled)
            });
            self.detail = Some((key, Some(job)));
        }
    }

    fn take(&mut self, model: &mut Model) {
        let table = &mut model.catalog_table;
        // Keep the inputs of work that broke off: the same work would break off again.
        if let Some((_, job)) = &mut self.rows
            && let Some(Ok(answer)) = Job::take(job)
        {
            table.answer = Some(answer);
            self.rows = None;
        }
        if let Some((_, job)) = &mut self.next
            && let Some(Ok(next)) = Job::take(job)
        {
            table.next = Some(Arc::new(next));
            self.next = None;
        }
        if let Some((_, job)) = &mut self.detail
            && let Some(Ok(detail)) = Job::take(job)
        {
            table.detail = Some(detail);
            self.detail = None;
        }
    }
}
