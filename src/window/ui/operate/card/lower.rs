//! Lower part of the card, which scrolls if it does not fit: questions and notes, the other
//! antennas, and the readings. In a low window each section folds to one line with its most
//! important content.

use egui::{Color32, Rect, ScrollArea, Ui, UiBuilder, vec2};

use super::{
    Card, CardState, Cursor, control, drive, faults, header, holds, more, offsets, others,
    readings, released, track, travel,
};
use crate::{
    contract::antenna::AntennaModel,
    station::AntennaId,
    ui::{
        icons::{self, Icon},
        theme,
        widgets::{
            fold::{self, Fold, FoldModel},
            paint,
        },
    },
};

/// Height kept free at the foot of a card for the mark of hidden content, points.
const MORE_BELOW: f32 = 20.0;
/// Min height of hidden content that the card marks, points.
const LEAST_HIDDEN: f32 = 4.0;

/// Draws everything below the controls for moving by hand into the rest of the card.
pub(super) fn show(
    ui: &mut Ui,
    at: &mut Cursor,
    card: &mut Card<'_>,
    on_cards: &[AntennaId],
    state: &mut CardState,
) {
    let below = at.card.with_min_y(at.y);
    let foot = if state.goes_on_below { MORE_BELOW } else { 0.0 };
    let (seen, strip) = below.split_top_bottom_at_y(below.bottom() - foot);
    ui.scope_builder(UiBuilder::new().id_salt("lower").max_rect(seen), |ui| {
        // Even in little room, the area ends above the mark.
        let area = ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink(false);
        let shown = area.show(ui, |ui| {
            if ui.ctx().rect_contains_pointer(ui.layer_id(), strip) {
                // The wheel over the mark scrolls the area, too.
                let by = ui.input(|input| input.smooth_scroll_delta().y);
                ui.scroll_with_delta(vec2(0.0, by));
            }
            let top = ui.cursor().top();
            at.y = top;
            sections(ui, at, card, on_cards, state);
            let drawn = at.card.with_min_y(top).with_max_y(at.y);
            ui.allocate_rect(drawn, egui::Sense::hover());
        });
        let hidden = shown.content_size.y - shown.state.clamped_offset().y - below.height();
        // In less room, the cut line shows that the card goes on.
        let goes_on = hidden > LEAST_HIDDEN && below.height() > 2.0 * MORE_BELOW;
        let folds = settle(card.antenna, state, below.height() - shown.content_size.y);
        if std::mem::replace(&mut state.goes_on_below, goes_on) != goes_on || folds {
            ui.request_discard("the lower part of a card has another height");
        }
    });
    if state.goes_on_below {
        more_below(ui, strip);
    }
}

/// Shows a mark in the `strip` at the foot of the card: more content follows below.
fn more_below(ui: &Ui, strip: Rect) {
    let t = theme::tokens(ui);
    let at = strip.center();
    let place = Rect::from_center_size(at, vec2(32.0, 14.0));
    ui.painter().rect(place, 7.0, t.bg3, (1.0, t.edge), egui::StrokeKind::Inside);
    icons::paint(ui.painter(), paint::square(at, 12.0), Icon::ChevronDown, t.t1);
    let words = "Scroll for more";
    paint::name_text(ui, "more below", place, words).on_hover_text(words);
}

/// Shows the sections that appear only when needed, and those that fold.
fn sections(
    ui: &mut Ui,
    at: &mut Cursor,
    card: &mut Card<'_>,
    on_cards: &[AntennaId],
    state: &mut CardState,
) {
    let (model, antenna, short) = (card.model, card.antenna, at.is_short());
    if header::is_released(antenna) {
        released::about(ui, at, antenna);
    }
    control::show(ui, at, card);
    holds::show(ui, at, card, state);
    drive::messages(ui, at, card, &state.drive);
    track::notes(ui, at, card, &state.track);
    if !short {
        at.skip(4.0);
    }
    if let Some((value, mark)) = offsets::in_words(ui, antenna) {
        let opened = own_fold_line(ui, at, "Offsets", &value, mark, &mut state.offsets.fold);
        if state.offsets.fold.is_open() {
            let top = at.y;
            offsets::show(ui, at, card, &mut state.offsets);
            state.offsets.fold.drawn(at.y - top);
        }
        bring_into_sight(ui, at, opened);
    }
    let gauges = travel::gauges(antenna);
    if short && !gauges.is_empty() {
        let value = travel::in_words(&gauges);
        let opened = fold_line(ui, at, "Travel", &value, None, &mut state.travel_open);
        if state.travel_open {
            travel::show(ui, at, &gauges);
            at.skip(4.0);
        }
        bring_into_sight(ui, at, opened);
    }
    if let Some(faults) = faults::Faults::of(model, antenna) {
        let mut opened = None;
        if short {
            let (value, mark) = faults.in_words(ui);
            opened = fold_line(ui, at, "Faults", &value, Some(mark), &mut state.faults_open);
        }
        if !short || state.faults_open {
            faults.show(ui, at);
        }
        bring_into_sight(ui, at, opened);
    }
    others::show(ui, at, model, on_cards, card.commands);
    let reported = &antenna.snapshot.state.readings;
    if !reported.is_empty() {
        let mut opened = None;
        if short {
            let (value, mark) = readings::in_words(ui, reported);
            opened = fold_line(ui, at, "Readings", &value, mark, &mut state.readings_open);
        }
        if !short || state.readings_open {
            readings::show(ui, at, reported, !short);
        }
        bring_into_sight(ui, at, opened);
    }
    let actions = antenna.variant().actions;
    if !actions.is_empty() {
        let labels: Vec<&str> = actions.iter().map(|action| action.label).collect();
        let value = labels.join(", ");
        let opened = own_fold_line(ui, at, "More", &value, None, &mut state.more_fold);
        if state.more_fold.is_open() {
            let top = at.y;
            more::show(ui, at, card, &mut state.more);
            state.more_fold.drawn(at.y - top);
        }
        bring_into_sight(ui, at, opened);
    }
}

/// Opens the folds that fit into the `free` points left in the card, and closes the others. Returns
/// `true` if a fold changed.
fn settle(antenna: &AntennaModel, state: &mut CardState, mut free: f32) -> bool {
    let offsets = offsets::in_force(antenna).map(|_| &mut state.offsets.fold);
    let more = (!antenna.variant().actions.is_empty()).then_some(&mut state.more_fold);
    let mut has_changed = false;
    for fold in offsets.into_iter().chain(more) {
        has_changed |= fold.settle(&mut free);
    }
    has_changed
}

/// Shows the line of a section. Returns its rectangle if the operator has just opened the section.
fn fold_line(
    ui: &Ui,
    at: &mut Cursor,
    title: &str,
    value: &str,
    mark: Option<(Icon, Color32)>,
    open: &mut bool,
) -> Option<Rect> {
    let line = at.take_across(fold::HEIGHT);
    fold::show(ui, line, &FoldModel { title, value, mark }, open).then_some(line)
}

/// Shows a [`fold_line`] for a section that opens when there is room.
fn own_fold_line(
    ui: &Ui,
    at: &mut Cursor,
    title: &str,
    value: &str,
    mark: Option<(Icon, Color32)>,
    fold: &mut Fold,
) -> Option<Rect> {
    let mut is_open = fold.is_open();
    let opened = fold_line(ui, at, title, value, mark, &mut is_open);
    if is_open != fold.is_open() {
        fold.choose(is_open);
    }
    opened
}

/// Scrolls to an opened section, which may lie below the lower end of the card. Keeps the line of
/// the section in sight.
fn bring_into_sight(ui: &Ui, at: &Cursor, opened: Option<Rect>) {
    if let Some(line) = opened {
        let section = line.with_max_y(at.y);
        let has_room = section.height() <= ui.clip_rect().height();
        ui.scroll_to_rect(section, (!has_room).then_some(egui::Align::TOP));
    }
}
