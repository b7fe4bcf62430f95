//! The Antennas view: every setting of every unit, with its value on the unit, the new value, and
//! the result of sending the new value.
//!
//! Invariant: a form shows a value as on the unit only if Azel read it there, with its age. An edit
//! remains the operator's until Azel has read it back.

mod cards;
mod draft;
mod field_row;
mod field_state;
mod foot;
mod form;
mod head;
mod list;
mod makes;
mod outcome;
mod row;
mod section;
mod unit;
mod unlock;
mod unlock_dialog;

use std::collections::BTreeMap;

use egui::{Align2, Rect, ScrollArea, Ui, UiBuilder, vec2};

use self::{
    cards::CardEffects,
    form::Form,
    section::Section,
    unit::ShownUnit,
    unlock::Unlock,
    unlock_dialog::{UnlockAnswer, UnlockDialog},
};
use super::{
    copies::{self, CompareState, CopiedValues},
    text, theme,
    widgets::{
        button::{Button, HEIGHT},
        paint,
    },
};
use crate::model::{Model, UiCommand, View};

const PADDING: f32 = 16.0;

/// Edits of all units, by antenna name. The type has no `Debug`, because an edit may be a password.
#[derive(Default)]
pub struct AntennasState {
    forms: BTreeMap<String, Form>,
    scroll_to: Option<Section>,
    unlock: Option<UnlockDialog>,
    compare: CompareState,
}

impl AntennasState {
    /// Takes the results of changes, and locks service functions that may no longer be open. Runs
    /// in every frame, in every view.
    pub fn watch(&mut self, model: &Model) {
        for index in 0..model.antennas.len() {
            let Some(unit) = ShownUnit::new(model, index) else { continue };
            let Some(form) = self.forms.get_mut(unit.name()) else { continue };
            form.take_outcomes(&unit);
            form.unlock = form.unlock.filter(|unlock| unlock.holds(&unit));
        }
    }

    /// Takes `copy` over into the form of the antenna at index `place`, as if the operator had
    /// typed it, and scrolls to it.
    pub fn type_in(&mut self, model: &Model, place: usize, copy: CopiedValues) {
        let Some(unit) = ShownUnit::new(model, place) else { return };
        let sections = Section::new(&unit.antenna.config.connection).into_iter();
        let holds = |section: &Section| section.keys.contains(&copy.group);
        self.scroll_to = sections.into_iter().find(holds);
        let form = self.forms.entry(unit.name().to_owned()).or_default();
        form.take_over(&unit, vec![copy]);
    }

    /// Returns the number of typed values that are not on their unit.
    pub fn edited(&self, model: &Model) -> usize {
        let units = (0..model.antennas.len()).filter_map(|index| ShownUnit::new(model, index));
        let edited =
            |unit: ShownUnit<'_>| Some(self.forms.get(unit.name())?.count_all(&unit).edited);
        units.filter_map(edited).sum()
    }
}

/// Draws the Antennas view into `rect`.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut AntennasState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let (side, body) = rect.split_left_right_at_x(rect.left() + list::WIDTH);
    let Some(mut unit) = ShownUnit::new(model, model.selected_antenna) else {
        list::show(ui, side, model, None, commands);
        return none(ui, body, model, commands);
    };
    let form = state.forms.entry(unit.name().to_owned()).or_default();
    unit.is_unlocked = form.unlock.is_some();
    form.ask_unread(&unit, commands);
    let clicked = list::show(ui, side, model, Some((&unit, form)), commands);
    state.scroll_to = clicked.or(state.scroll_to);
    let (top, rest) = body.split_top_bottom_at_y(body.top() + head::HEIGHT);
    head::show(ui, top, &unit, commands);
    let has_settings = !unit.antenna.groups().is_empty();
    let foot = if has_settings { foot::height(ui, &unit, form, rest.width()) } else { 0.0 };
    let foot = foot.min(rest.height() / 2.0);
    let (middle, bottom) = rest.split_top_bottom_at_y(rest.bottom() - foot);
    let mut wants_unlock = false;
    let builder = UiBuilder::new().id_salt(("settings", unit.name())).max_rect(middle);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(middle);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let inner = ui.available_rect_before_wrap();
            let room = inner.shrink2(vec2(PADDING, 0.0)).with_min_y(inner.top() + PADDING);
            ui.scope_builder(UiBuilder::new().max_rect(room), |ui| {
                let mut effects =
                    CardEffects { commands: &mut *commands, unlock: &mut wants_unlock };
                cards::show(ui, &unit, form, &mut state.scroll_to, &mut effects);
            });
        });
    });
    if has_settings {
        foot::show(ui, bottom, &unit, form, commands);
    }
    if let Some(open) = model.copies.open.as_ref().filter(|open| open.antenna == unit.name()) {
        let entries = copies::show(ui, unit.antenna, open, &mut state.compare, commands);
        form.take_over(&unit, entries);
    }
    if wants_unlock {
        state.unlock = Some(UnlockDialog::default());
    }
    let answer = state.unlock.as_mut().map(|dialog| dialog.show(ui, &unit));
    if answer == Some(UnlockAnswer::Unlock) {
        form.unlock = Some(Unlock::new(&unit));
    }
    state.unlock.take_if(|_| answer != Some(UnlockAnswer::Open) && answer.is_some());
}

/// Shows that there is no antenna. Offers no new antenna while the station file is unread, because
/// Azel could not save over that file.
pub(super) fn none(ui: &Ui, rect: Rect, model: &Model, commands: &mut Vec<UiCommand>) {
    let t = theme::tokens(ui);
    let inner = rect.shrink(PADDING);
    let words = if model.station_unread {
        "No antenna: the station file was not read."
    } else {
        "No antenna yet. Set one up."
    };
    let line = paint::text(ui, inner.left_top(), Align2::LEFT_TOP, words, text::body(), t.t2);
    if model.station_unread {
        return;
    }
    let button = Button::primary("Set up an antenna");
    let size = vec2(button.width(ui), HEIGHT);
    let place = Rect::from_min_size(line.left_bottom() + vec2(0.0, 12.0), size);
    if button.show(ui, "set up antenna", place).clicked() {
        commands.push(UiCommand::Show(View::Preferences));
    }
}
