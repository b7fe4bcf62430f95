//! Passes of the list that match its filters, in the chosen order.

use std::{
    collections::{HashMap, HashSet},
    sync::Arc,
    time::{Duration, Instant},
};

use crate::{
    astro::sun_moon,
    contract::{
        CatalogState,
        passes::{PassListKey, PredictedPass, Scope, UpcomingPasses},
    },
    model::Model,
    orbit::is_sunlit,
    plan::Trackability,
    ui::pass_list::{Arrangement, Filter, Light, Order},
};

/// Max time per frame for judging passes: a whole catalogue takes some seconds.
const BUDGET: Duration = Duration::from_millis(5);

/// Inputs that the rows depend on.
#[derive(Clone, PartialEq)]
struct FilterQuery {
    text: String,
    arrangement: Arrangement,
    scope: Scope,
    revision: u64,
    antenna: usize,
    /// Identity of the catalogue whose groups the filter uses.
    catalog: usize,
}

/// Found passes, kept until the list or the filters change.
#[derive(Default)]
pub(super) struct FoundPasses {
    made_of: Option<(FilterQuery, (usize, usize))>,
    /// Places in the list, in the order of the rows.
    places: Vec<usize>,
    /// Row of each place.
    rows: HashMap<usize, usize>,
    /// Passes that Azel has judged for the chosen filters.
    judged: HashMap<PassListKey, bool>,
    is_whole: bool,
}

impl FoundPasses {
    /// Finds the matching passes of `model`, as far as the time of a frame allows. Returns `None`
    /// if the list needs no filter.
    pub(super) fn arrange(&mut self, model: &Model, filter: &Filter) -> Option<&Self> {
        let (text, arrangement) = (filter.text().to_lowercase(), &filter.arrangement);
        if text.is_empty() && *arrangement == Arrangement::default() {
            *self = Self::default();
            return None;
        }
        let (scope, listed) = (model.list.scope, model.upcoming());
        let query = FilterQuery {
            text,
            arrangement: arrangement.clone(),
            scope,
            revision: model.pass_lists.list(scope).revision,
            antenna: model.selected_antenna,
            catalog: catalog_id(model),
        };
        let made_of = (query, listed.version());
        let is_new = self.made_of.as_ref() != Some(&made_of);
        if self.made_of.as_ref().is_none_or(|(before, _)| *before != made_of.0) {
            self.judged.clear();
        }
        if is_new || !self.is_whole {
            self.find(model, &listed, &made_of.0);
            self.made_of = Some(made_of);
        }
        Some(self)
    }

    /// Returns `true` if Azel has judged every pass.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Returns the index in the list for a row.
    pub(super) fn place(&self, row: usize) -> Option<usize> {
        self.places.get(row).copied()
    }

    /// Returns the row for an index in the list.
    pub(super) fn row(&self, place: usize) -> Option<usize> {
        self.rows.get(&place).copied()
    }

    pub(super) fn places(&self) -> impl Iterator<Item = usize> {
        self.places.iter().copied()
    }

    fn find(&mut self, model: &Model, listed: &UpcomingPasses<'_>, query: &FilterQuery) {
        let begun = Instant::now();
        let group = group(model, query.arrangement.group.as_deref());
        let mut fitting = Vec::new();
        self.is_whole = true;
        for (place, predicted) in listed.iter().enumerate() {
            if !is_named(predicted, &query.text) || !fits(predicted, model, query, group.as_ref()) {
                continue;
            }
            let key = predicted.key();
            let judged = match self.judged.get(&key) {
                Some(judged) => *judged,
                None if begun.elapsed() > BUDGET => {
                    self.is_whole = false;
                    break;
                }
                None => {
                    let judged = is_wanted(predicted, model, &query.arrangement);
                    self.judged.insert(key, judged);
                    judged
                }
            };
            if judged {
                fitting.push((place, predicted));
            }
        }
        sort(&mut fitting, query.arrangement.order);
        self.places = fitting.into_iter().map(|(place, _)| place).collect();
        self.rows = self.places.iter().enumerate().map(|(row, place)| (*place, row)).collect();
    }
}

fn catalog_id(model: &Model) -> usize {
    match &model.catalog {
        CatalogState::Ready(catalog) => Arc::as_ptr(catalog).addr(),
        CatalogState::Loading | CatalogState::Failed => 0,
    }
}

/// Returns the catalog numbers of a group; `None` if no group is chosen or the group is gone.
fn group(model: &Model, name: Option<&str>) -> Option<HashSet<u32>> {
    let CatalogState::Ready(catalog) = &model.catalog else { return None };
    let name = name.filter(|name| catalog.groups().any(|(group_name, _)| group_name == *name))?;
    Some(catalog.in_group(name).map(crate::orbit::Elements::catalog_number).collect())
}

fn is_named(predicted: &PredictedPass, text: &str) -> bool {
    text.is_empty()
        || predicted.satellite.elements.name().to_lowercase().contains(text)
        || predicted.number().to_string().starts_with(text)
}

/// Returns `true` if the pass fits the filters that need no computation.
fn fits(
    predicted: &PredictedPass,
    model: &Model,
    query: &FilterQuery,
    group: Option<&HashSet<u32>>,
) -> bool {
    let is_to_come = predicted.pass.aos.time > model.now && !predicted.pass.starts_before;
    group.is_none_or(|group| group.contains(&predicted.number()))
        && (is_to_come || !query.arrangement.to_come)
}

/// Returns `true` if the pass fits the filters that need a computation.
fn is_wanted(predicted: &PredictedPass, model: &Model, arrangement: &Arrangement) -> bool {
    let highest = predicted.pass.tca.time;
    let is_day = || sun_moon::sun(model.station.site.airless(), highest).elevation_deg() > 0.0;
    let light = match arrangement.light {
        Light::Any => true,
        Light::Day => is_day(),
        Light::Night => !is_day(),
    };
    let is_lit = || {
        let state = predicted.satellite.propagator.state_at(highest);
        state.is_ok_and(|state| is_sunlit(&state, highest))
    };
    let is_trackable = || {
        let judged = predicted.judge(model.selected_antenna);
        matches!(judged, Some(Trackability::Whole | Trackability::Loses { .. }))
    };
    light && (!arrangement.sunlit || is_lit()) && (!arrangement.trackable || is_trackable())
}

/// Sorts passes that are in the order of AOS.
fn sort(passes: &mut [(usize, &PredictedPass)], order: Order) {
    match order {
        Order::Aos => {}
        Order::Maximum => passes.sort_by(|(_, a), (_, b)| {
            b.pass.max_elevation().degrees().total_cmp(&a.pass.max_elevation().degrees())
        }),
        Order::Duration => {
            passes.sort_by(|(_, a), (_, b)| b.pass.duration_s().total_cmp(&a.pass.duration_s()));
        }
    }
}
