//! The page of the satellites: priorities and limits of the favourites, groups and frequencies.

pub(super) mod draft;
mod favourites;
mod followed;
mod groups;

use egui::{Rect, Ui};

use super::{
    FormState,
    columns::{self, Part},
    draft::Draft,
    form,
};
use crate::{model::Model, station::AntennaId, ui::object_search::ObjectSearch};

/// Open parts of the page.
#[derive(Default)]
pub(super) struct SatellitesState {
    /// Catalog number of the favourite whose limits are open.
    favourite: Option<u32>,
    /// Index of the open group.
    group: Option<usize>,
    search: ObjectSearch,
}

/// Data that the cards of the page show in addition to the draft.
struct GroupContext<'a> {
    model: &'a Model,
    favourites: Vec<u32>,
    antennas: Vec<(AntennaId, String)>,
}

/// Settings of the page that have no field.
const LABELS: [&str; 3] = [favourites::TITLE, "Limits of passes", groups::TITLE];

pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    (draft, before): (&mut Draft, &Draft),
    state: &mut FormState,
) {
    let context = GroupContext {
        model,
        favourites: draft.satellites.favourites(),
        antennas: draft.antenna_titles(),
    };
    let sections = draft.satellites.followed.sections();
    let mut rows = vec![context.favourites.len() + 2, draft.satellites.groups().len() + 2];
    rows.extend(sections.iter().map(|(_, rows)| *rows));
    let standings = draft.satellites.followed.read().1;
    columns::show(ui, rect, "satellites", &rows, false, |ui, part| {
        let Part::Card(card) = part else { return };
        let satellites = &mut draft.satellites;
        match card {
            0 => {
                let drafts = (satellites, &before.satellites);
                favourites::show(ui, &context, drafts, &mut state.satellites);
            }
            1 => groups::show(ui, &context, satellites, state),
            card => {
                let Some((section, _)) = sections.get(card - 2) else { return };
                let typed = (&mut satellites.followed, &*standings);
                form::section(ui, "satellites", typed, section, &mut state.focus_target, |_| {});
            }
        }
    });
}
