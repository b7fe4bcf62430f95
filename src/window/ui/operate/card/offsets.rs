//! Offsets while tracking: a line each with keys for less and more, zero and undo.

use egui::{Align2, Color32, Rect, Ui, vec2};

use super::{Card, Cursor, show_remark};
use crate::{
    astro::{Offset, TrackOffsets},
    contract::{
        self,
        antenna::AntennaModel,
        driver::{Command, OffsetChange, TrackView},
    },
    model::UiCommand,
    station::OffsetsSubject,
    ui::{
        icons::Icon,
        state_sentence::short,
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            fold::Fold,
            paint,
            segmented::{self, Segment},
        },
        words,
    },
};

const KEY_WIDTH: f32 = 36.0;
const GAP: f32 = 4.0;
/// Width of the choice of steps, points.
const STEPS_WIDTH: f32 = 132.0;

/// Size of a step, in thousandths of a degree or of a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OffsetStep {
    Fine,
    #[default]
    Medium,
    Coarse,
}

impl OffsetStep {
    const ALL: [(Self, &'static str); 3] =
        [(Self::Fine, "0.01"), (Self::Medium, "0.1"), (Self::Coarse, "1")];

    /// Returns a step of the kind of `offset`.
    pub fn to_offset(self, offset: Offset) -> Offset {
        offset.with_thousandths(match self {
            Self::Fine => 10,
            Self::Medium => 100,
            Self::Coarse => 1000,
        })
    }
}

/// Fold of the section, and the chosen step.
#[derive(Debug, Clone, Copy, Default)]
pub struct OffsetsState {
    pub(super) fold: Fold,
    pub step: OffsetStep,
}

/// Returns the offsets of the current track, by Azel or on board, and `true` if a change can be
/// undone. Returns `None` while no track takes offsets.
pub(super) fn current_offsets(antenna: &AntennaModel) -> Option<(TrackOffsets, bool)> {
    if let Some(track) = program_track(antenna) {
        return Some((track.offsets, track.can_undo));
    }
    antenna.variant().track_offsets.filter(|_| antenna.tracks())?;
    let unit = antenna.snapshot.unit_offsets.as_ref();
    Some(unit.map(|unit| (unit.offsets, unit.can_undo)).unwrap_or_default())
}

/// Returns the track for which Azel sends position after position.
fn program_track(antenna: &AntennaModel) -> Option<&TrackView> {
    antenna.snapshot.program_track.as_ref().filter(|_| antenna.follows())
}

fn is_offered(antenna: &AntennaModel, offset: Offset) -> bool {
    match (offset, program_track(antenna)) {
        (Offset::Along(_) | Offset::Across(_), Some(track)) => track.target_moves,
        (Offset::Elevation(_), Some(_)) => antenna.variant().capabilities.has_elevation(),
        (Offset::Time(_), Some(_)) | (Offset::Azimuth(_), _) | (Offset::Elevation(_), None) => true,
        (Offset::Time(_) | Offset::Along(_) | Offset::Across(_), None) => false,
    }
}

/// Describes the offsets that are still on the unit although no track needs them.
pub(super) fn describe_remaining(antenna: &AntennaModel) -> Option<String> {
    let unit = antenna.snapshot.unit_offsets.as_ref()?;
    let is_left = unit.left.is_some() && !unit.offsets.is_none() && !unit.is_changing;
    is_left.then(|| words::offsets(unit.offsets))
}

/// Returns the value and mark of the section's line, if there are offsets to change.
pub(super) fn in_words(
    ui: &Ui,
    antenna: &AntennaModel,
) -> Option<(String, Option<(Icon, Color32)>)> {
    let (offsets, _) = current_offsets(antenna)?;
    let mark = (!offsets.is_none()).then_some((Icon::Sliders, theme::tokens(ui).cmd));
    let unit = antenna.snapshot.unit_offsets.as_ref().filter(|_| program_track(antenna).is_none());
    let changing = if unit.is_some_and(|unit| unit.is_changing) { ", being set" } else { "" };
    Some((format!("{}{changing}", words::offsets(offsets)), mark))
}

/// Shows the section. Call only while there are offsets to change.
pub(super) fn show(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut OffsetsState) {
    let (antenna, t) = (card.antenna, theme::tokens(ui));
    let (offsets, can_undo) = current_offsets(antenna).unwrap_or_default();
    let (followed, snapshot) = (program_track(antenna), &antenna.snapshot);
    let needs_elements = followed.is_none() && snapshot.on_board.is_none();
    let lock = card.locks.link.or(needs_elements.then_some(words::OFFSETS_NEED_ELEMENTS));
    cursor.skip(4.0);
    for offset in offsets.components().into_iter().filter(|offset| is_offered(antenna, *offset)) {
        show_row(ui, cursor.take(SMALL_HEIGHT), offset, lock.is_some(), state.step, card);
        cursor.skip(GAP);
    }
    let row = cursor.take(SMALL_HEIGHT);
    let head = paint::text(ui, row.left_center(), Align2::LEFT_CENTER, "Step", text::small(), t.t2);
    let choice = row.with_min_x(head.right() + 8.0);
    let choice = choice.with_max_x(choice.left() + STEPS_WIDTH);
    let segment =
        |(step, word)| (word, if step == state.step { Segment::Chosen } else { Segment::Free });
    let segments = OffsetStep::ALL.map(segment);
    let name = "Step, degrees or seconds";
    if let Some(index) = segmented::show(ui, "offset step", choice, name, &segments) {
        state.step = OffsetStep::ALL.get(index).map_or(state.step, |(step, _)| *step);
    }
    let mut right = row.right();
    for (word, change, is_free, name) in [
        ("Undo", OffsetChange::Undo, can_undo, "Undo the last offset"),
        ("Zero", OffsetChange::Zero, !offsets.is_none(), "All offsets to zero"),
    ] {
        let button = Button::normal(word).locked(!is_free || lock.is_some());
        let width = (button.width(ui) - 8.0).min(56.0);
        let place = row.with_min_x(right - width).with_max_x(right);
        right = place.left() - GAP;
        let response = button.show(ui, ("offset", word), place).accessible_name(name);
        if response.clicked() {
            card.queue(Command::Offset(change));
        }
    }
    cursor.skip(GAP);
    if let Some(track) = followed {
        show_keep_buttons(ui, cursor.take(SMALL_HEIGHT), track, card);
        cursor.skip(GAP);
    } else {
        let on_unit = words::offsets_on_unit(snapshot.state.on_board.offsets.as_ref());
        let words = words::offsets_on_unit_about(&on_unit);
        let place =
            paint::paragraph(ui, cursor.position(), cursor.width(), &words, text::small(), t.t2);
        paint::name_text(ui, "offsets on the unit", place, &words);
        cursor.y = place.bottom() + GAP;
    }
    if let Some(reason) = lock {
        show_remark(ui, cursor, "offsets locked", Icon::Lock, t.t2, reason);
        cursor.skip(1.0);
    }
    cursor.skip(4.0);
}

/// Shows a button for each subject for which Azel can remember the offsets of the track.
fn show_keep_buttons(ui: &Ui, row: Rect, track: &TrackView, card: &mut Card<'_>) {
    let t = theme::tokens(ui);
    let words = "Remember for";
    let head = paint::text(ui, row.left_center(), Align2::LEFT_CENTER, words, text::small(), t.t2);
    let room = row.with_min_x(head.right() + 8.0);
    let width = (room.width() - GAP) / 2.0;
    let mut left = room.left();
    let satellite =
        track.catalog_number.map(|number| (OffsetsSubject::Satellite(number), short(&track.name)));
    let antenna = (OffsetsSubject::Antenna(card.antenna.id()), &*card.antenna.config.name);
    for (subject, name) in satellite.into_iter().chain([antenna]) {
        let differs = subject.part(track.offsets) != card.model.station.kept_offsets(subject);
        let place = room.with_min_x(left).with_max_x(left + width);
        left = place.right() + GAP;
        let description = match subject {
            OffsetsSubject::Satellite(_) => {
                format!("Remember time, along and across the track for {name}")
            }
            OffsetsSubject::Antenna(_) => format!("Remember azimuth and elevation for {name}"),
        };
        let hint = if differs { description } else { format!("{description}: remembered already") };
        let response = Button::normal(name).locked(!differs).show(ui, ("keep", name), place);
        let response = response.on_hover_text(&hint).accessible_name(hint);
        if response.clicked() {
            let command = contract::Command::KeepOffsets { subject, offsets: track.offsets };
            card.commands.push(UiCommand::Station(command));
        }
    }
}

/// Shows the name, the key for less, the value and the key for more.
fn show_row(
    ui: &Ui,
    row: Rect,
    offset: Offset,
    is_locked: bool,
    step: OffsetStep,
    card: &mut Card<'_>,
) {
    let t = theme::tokens(ui);
    let (name, value) = (words::offset_name(offset), words::offset_value(offset));
    let colour = if offset.is_zero() { t.t2 } else { t.t1 };
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, name, text::small(), t.t2);
    let more = row.with_min_x(row.right() - KEY_WIDTH);
    let less = more.translate(vec2(-KEY_WIDTH - GAP, 0.0));
    let value_rect = row.with_min_x(row.left() + 84.0).with_max_x(less.left() - 12.0);
    let font = text::body_medium();
    paint::text(ui, value_rect.right_center(), Align2::RIGHT_CENTER, &value, font, colour);
    paint::name_text(ui, ("offset value", name), value_rect, &format!("{name} offset: {value}"));
    let change = step.to_offset(offset);
    for (place, mark, change, word) in [(less, "−", -change, "less"), (more, "+", change, "more")]
    {
        let button = Button::normal(mark).locked(is_locked);
        let key_name = format!("{name} offset, {word}");
        let response = button.show(ui, ("offset", name, mark), place).accessible_name(key_name);
        if response.clicked() {
            response.request_focus();
            card.queue(Command::Offset(OffsetChange::Step(change)));
        }
    }
}
