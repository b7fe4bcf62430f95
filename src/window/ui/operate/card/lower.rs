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
const MARK_HEIGHT: f32 = 20.0;
/// Min height of hidden content that the card marks, points.
const MIN_HIDDEN: f32 = 4.0;

/// Draws everything below the controls for moving by hand into the rest of the card.
pub(super) fn show(
    ui: &mut Ui,
    cursor: &mut Cursor,
    card: &mut Card<'_>,
    on_cards: &[AntennaId],
    state: &mut CardState,
) {
    let below = cursor.card.with_min_y(cursor.y);
    let foot_height = if state.has_more_below { MARK_HEIGHT } else { 0.0 };
    let (visible, strip) = below.split_top_bottom_at_y(below.bottom() - foot_height);
    ui.scope_builder(UiBuilder::new().id_salt("lower").max_rect(visible), |ui| {
        // Even in little room, the area ends above the mark.
        let area = ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink(false);
        let shown = area.show(ui, |ui| {
            if ui.ctx().rect_contains_pointer(ui.layer_id(), strip) {
                // The wheel over the mark scrolls the area, too.
                let scroll_points = ui.input(|input| input.smooth_scroll_delta().y);
                ui.scroll_with_delta(vec2(0.0, scroll_points));
            }
            let top = ui.cursor().top();
            cursor.y = top;
            show_sections(ui, cursor, card, on_cards, state);
            let drawn = cursor.card.with_min_y(top).with_max_y(cursor.y);
            ui.allocate_rect(drawn, egui::Sense::hover());
        });
        let hidden = shown.content_size.y - shown.state.clamped_offset().y - below.height();
        // In less room, the cut line shows that the card goes on.
        let has_more = hidden > MIN_HIDDEN && below.height() > 2.0 * MARK_HEIGHT;
        let has_folded = settle(card.antenna, state, below.height() - shown.content_size.y);
        if std::mem::replace(&mut state.has_more_below, has_more) != has_more || has_folded {
            ui.request_discard("the lower part of a card has another height");
        }
    });
    if state.has_more_below {
        show_more_mark(ui, strip);
    }
}

/// Shows a mark in the `strip` at the foot of the card: more content follows below.
fn show_more_mark(ui: &Ui, strip: Rect) {
    let t = theme::tokens(ui);
    let center = strip.center();
    let place = Rect::from_center_size(center, vec2(32.0, 14.0));
    ui.painter().rect(place, 7.0, t.bg3, (1.0, t.edge), egui::StrokeKind::Inside);
    icons::paint(ui.painter(), paint::square(center, 12.0), Icon::ChevronDown, t.t1);
    let words = "Scroll for more";
    paint::name_text(ui, "more below", place, words).on_hover_text(words);
}

/// Shows the sections that appear only when needed, and those that fold.
fn show_sections(
    ui: &mut Ui,
    cursor: &mut Cursor,
    card: &mut Card<'_>,
    on_cards: &[AntennaId],
    state: &mut CardState,
) {
    let (model, antenna, is_short) = (card.model, card.antenna, cursor.is_short());
    if header::is_released(antenna) {
        released::show_stop_note(ui, cursor, antenna);
    }
    control::show(ui, cursor, card);
    holds::show(ui, cursor, card, state);
    drive::show_messages(ui, cursor, card, &state.drive);
    track::show_notes(ui, cursor, card, &state.track);
    if !is_short {
        cursor.skip(4.0);
    }
    if let Some((value, mark)) = offsets::in_words(ui, antenna) {
        let opened =
            show_own_fold_line(ui, cursor, "Offsets", &value, mark, &mut state.offsets.fold);
        if state.offsets.fold.is_open() {
            let top = cursor.y;
            offsets::show(ui, cursor, card, &mut state.offsets);
            state.offsets.fold.drawn(cursor.y - top);
        }
        bring_into_sight(ui, cursor, opened);
    }
    let gauges = travel::gauges(antenna);
    if is_short && !gauges.is_empty() {
        let value = travel::in_words(&gauges);
        let opened = show_fold_line(ui, cursor, "Travel", &value, None, &mut state.travel_open);
        if state.travel_open {
            travel::show(ui, cursor, &gauges);
            cursor.skip(4.0);
        }
        bring_into_sight(ui, cursor, opened);
    }
    if let Some(faults) = faults::Faults::from_antenna(model, antenna) {
        let mut opened = None;
        if is_short {
            let (value, mark) = faults.folded_summary(ui);
            opened =
                show_fold_line(ui, cursor, "Faults", &value, Some(mark), &mut state.faults_open);
        }
        if !is_short || state.faults_open {
            faults.show(ui, cursor);
        }
        bring_into_sight(ui, cursor, opened);
    }
    others::show(ui, cursor, model, on_cards, card.commands);
    let reported = &antenna.snapshot.state.readings;
    if !reported.is_empty() {
        let mut opened = None;
        if is_short {
            let (value, mark) = readings::in_words(ui, reported);
            opened = show_fold_line(ui, cursor, "Readings", &value, mark, &mut state.readings_open);
        }
        if !is_short || state.readings_open {
            readings::show(ui, cursor, reported, !is_short);
        }
        bring_into_sight(ui, cursor, opened);
    }
    let actions = antenna.variant().actions;
    if !actions.is_empty() {
        let labels: Vec<&str> = actions.iter().map(|action| action.label).collect();
        let value = labels.join(", ");
        let opened = show_own_fold_line(ui, cursor, "More", &value, None, &mut state.more_fold);
        if state.more_fold.is_open() {
            let top = cursor.y;
            more::show(ui, cursor, card, &mut state.more);
            state.more_fold.drawn(cursor.y - top);
        }
        bring_into_sight(ui, cursor, opened);
    }
}

/// Opens the folds that fit into the `free` points left in the card, and closes the others. Returns
/// `true` if a fold changed.
fn settle(antenna: &AntennaModel, state: &mut CardState, mut free: f32) -> bool {
    let offsets = offsets::current_offsets(antenna).map(|_| &mut state.offsets.fold);
    let more = (!antenna.variant().actions.is_empty()).then_some(&mut state.more_fold);
    let mut has_changed = false;
    for fold in offsets.into_iter().chain(more) {
        has_changed |= fold.settle(&mut free);
    }
    has_changed
}

/// Shows the line of a section. Returns its rectangle if the operator has just opened the section.
fn show_fold_line(
    ui: &Ui,
    cursor: &mut Cursor,
    title: &str,
    value: &str,
    mark: Option<(Icon, Color32)>,
    open: &mut bool,
) -> Option<Rect> {
    let line = cursor.take_across(fold::HEIGHT);
    fold::show(ui, line, &FoldModel { title, value, mark }, open).then_some(line)
}

/// Shows a [`fold_line`] for a section that opens when there is room.
fn show_own_fold_line(
    ui: &Ui,
    cursor: &mut Cursor,
    title: &str,
    value: &str,
    mark: Option<(Icon, Color32)>,
    fold: &mut Fold,
) -> Option<Rect> {
    let mut is_open = fold.is_open();
    let opened = show_fold_line(ui, cursor, title, value, mark, &mut is_open);
    if is_open != fold.is_open() {
        fold.choose(is_open);
    }
    opened
}

/// Scrolls to an opened section, which may lie below the lower end of the card. Keeps the line of
/// the section in sight.
fn bring_into_sight(ui: &Ui, cursor: &Cursor, opened: Option<Rect>) {
    if let Some(line) = opened {
        let section = line.with_max_y(cursor.y);
        let has_room = section.height() <= ui.clip_rect().height();
        ui.scroll_to_rect(section, (!has_room).then_some(egui::Align::TOP));
    }
}
