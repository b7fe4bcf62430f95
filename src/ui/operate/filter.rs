//! The filter of the pass list by name or number of the satellite.

use crate::{
    engine::passes::{PredictedPass, Scope},
    model::Model,
};

/// The found passes, kept until the list or the text changes.
#[derive(Default)]
pub(super) struct FoundPasses {
    made_of: Option<(String, Scope, u64, (usize, usize))>,
    places: Vec<usize>,
}

impl FoundPasses {
    /// The indexes of the passes in the list of `model` that match `text`, in order; `None`
    /// without a filter.
    pub(super) fn places(&mut self, model: &Model, text: &str) -> Option<&[usize]> {
        if text.is_empty() {
            return None;
        }
        let (scope, listed) = (model.list.scope, model.upcoming());
        let revision = model.pass_lists.of(scope).revision;
        let made_of = Some((text.to_lowercase(), scope, revision, listed.version()));
        if self.made_of != made_of {
            let text = text.to_lowercase();
            let is_found = |predicted: &PredictedPass| {
                predicted.satellite.elements.name().to_lowercase().contains(&text)
                    || predicted.number().to_string().starts_with(&text)
            };
            let listed = listed.iter().enumerate();
            self.places = listed
                .filter_map(|(place, predicted)| is_found(predicted).then_some(place))
                .collect();
            self.made_of = made_of;
        }
        Some(&self.places)
    }
}
