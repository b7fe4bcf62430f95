//! The page of the automation rules: a table in their order, and the form of the chosen rule.

pub(super) mod cannot_act;
mod decided;
pub(super) mod draft;
mod editor;
mod sentence;
mod table;
#[cfg(test)]
mod tests;

use egui::{Rect, Ui};

use super::{
    FormState, PADDING,
    columns::{self, Part},
    draft::Draft,
};
use crate::{
    model::Model,
    station::Station,
    ui::{object_search::ObjectSearch, words},
};
use cannot_act::{CannotAct, RuleContext};
use decided::{Decided, DecidedPass};
use draft::RulesDraft;

/// Settings of the page that are not fields of the station.
const LABELS: [&str; 3] =
    ["Order of the rules", "Rules by satellite or group", "Rules by Sun and hours"];
/// Max share of the page height that the table takes.
const TABLE_SHARE: f32 = 0.45;
/// Number of rows of each card, for the layout in columns.
const CARDS: [usize; 2] = [10, 8];

/// The chosen rule, and the search text.
#[derive(Default)]
pub(super) struct RulesState {
    chosen: usize,
    /// Index of the row that gets the keyboard focus.
    wants_focus: Option<usize>,
    /// Index of the rule that the operator drags.
    dragged: Option<usize>,
    search: ObjectSearch,
    decided: Option<Decided>,
}

impl RulesState {
    pub(super) fn choose(&mut self, index: usize) {
        self.chosen = index;
        self.wants_focus = Some(index);
    }

    /// Computes the passes that the rules of `station` decide, unless the last result is still
    /// valid.
    fn work_out(&mut self, station: Option<Station>, model: &Model) {
        self.decided = station.map(|station| {
            let previous = self.decided.take().filter(|decided| decided.is_of(&station, model));
            previous.unwrap_or_else(|| Decided::new(station, model))
        });
    }
}

/// A rule of the draft with its texts.
struct Shown {
    index: usize,
    /// Number of the rule; `None` if the operator has removed it.
    number: Option<usize>,
    is_on: bool,
    sentence: String,
    /// Reason why the rule cannot act; for a disabled rule, the reason why Azel could not save it.
    hindrance: Option<(CannotAct, String)>,
}

impl Shown {
    fn new(
        index: usize,
        rules: &RulesDraft,
        context: &RuleContext<'_>,
        model: &Model,
    ) -> Option<Self> {
        let rule = rules.all().get(index)?;
        let number = rules.number(index);
        let hindrance = rules.cannot_act(index, context);
        let counts = |reason: &CannotAct| number.is_some() && (rule.is_on || reason.is_wrong());
        Some(Self {
            index,
            number,
            is_on: rule.is_on,
            sentence: sentence::sentence(rule, context, &|number| words::satellite(model, number)),
            hindrance: hindrance.filter(counts).map(|reason| (reason, reason.words(context))),
        })
    }

    /// Returns the passes that the rule decides; `None` while an entered value is invalid.
    fn decided<'a>(&self, state: &'a RulesState) -> Option<&'a [DecidedPass]> {
        Some(state.decided.as_ref()?.rule(self.number? - 1))
    }
}

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    (draft, before): (&mut Draft, &Draft),
    state: &mut FormState,
) {
    state.rules.work_out(draft.read(), model);
    let (antennas, favourites) = (draft.antenna_titles(), draft.satellites.favourites());
    // The context borrows these fields apart from the rules, which change.
    let Draft { satellites, rules, .. } = draft;
    let context = RuleContext { antennas, favourites, satellites };
    let requested = table::height(rules.all().len());
    let height = requested.min((rect.height() * TABLE_SHARE).max(table::height(2)));
    let (top, below) = rect.split_top_bottom_at_y(rect.top() + height);
    table::show(ui, top, model, rules, &context, &mut state.rules);
    let Some(shown) = Shown::new(state.rules.chosen, rules, &context, model) else { return };
    let below = below.with_min_y(below.top() + PADDING / 2.0);
    columns::show(ui, below, "rules", &CARDS, false, |ui, part| match part {
        Part::Card(0) => editor::show(ui, model, &shown, (rules, &before.rules), &context, state),
        Part::Card(_) => editor::decided(ui, model, &shown, &context, &state.rules),
        Part::Preview { .. } | Part::Findings => {}
    });
}
