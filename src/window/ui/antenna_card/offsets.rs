//! Offsets while tracking: a line each with keys for less and more, zero and undo.

use egui::{Align2, Color32, Rect, Ui, pos2, vec2};

use super::{CardAction, Cursor};
use crate::{
    astro::{Offset, TrackOffsets},
    contract::driver::OffsetChange,
    station::OffsetsSubject,
    ui::{
        icons::{self, Icon},
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

const KEY: f32 = 36.0;
const GAP: f32 = 4.0;
/// Width of the choice of steps.
const STEPS: f32 = 132.0;

/// Content of the section: what can be added to a track.
#[derive(Debug, Clone, Copy)]
pub struct OffsetsModel<'a> {
    /// In force.
    pub offsets: TrackOffsets,
    /// There is a change to be undone.
    pub can_undo: bool,
    /// The reason why nothing is changed now.
    pub locked: Option<&'a str>,
    pub of: OffsetsIn<'a>,
}

/// Place that holds the offsets.
#[derive(Debug, Clone, Copy)]
pub enum OffsetsIn<'a> {
    /// Azel, which sends position after position.
    Azel {
        /// The target has a way over the sky, so that something is along and across it.
        target_moves: bool,
        has_elevation: bool,
        /// Subjects that Azel can remember the offsets for: the name, and whether the offsets in
        /// force differ from the remembered ones.
        keep: &'a [(OffsetsSubject, &'a str, bool)],
    },
    /// The unit, which tracks by itself; with the sum of the offsets that it adds, in words.
    Unit { held: &'a str, is_changing: bool },
}

impl OffsetsIn<'_> {
    fn offers(self, offset: Offset) -> bool {
        match self {
            Self::Azel { target_moves, has_elevation, .. } => match offset {
                Offset::Along(_) | Offset::Across(_) => target_moves,
                Offset::Elevation(_) => has_elevation,
                Offset::Time(_) | Offset::Azimuth(_) => true,
            },
            Self::Unit { .. } => matches!(offset, Offset::Azimuth(_) | Offset::Elevation(_)),
        }
    }
}

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

    /// A step of the kind of `offset`.
    pub fn of(self, offset: Offset) -> Offset {
        offset.with_thousandths(match self {
            Self::Fine => 10,
            Self::Medium => 100,
            Self::Coarse => 1000,
        })
    }
}

/// The section, and the chosen step.
#[derive(Debug, Clone, Copy, Default)]
pub struct OffsetsState {
    pub(super) fold: Fold,
    pub step: OffsetStep,
}

/// The value and mark of the section's line.
pub(super) fn in_words(ui: &Ui, model: &OffsetsModel<'_>) -> (String, Option<(Icon, Color32)>) {
    let mark = (Icon::Sliders, theme::tokens(ui).cmd);
    let (said, mark) = (words::offsets(model.offsets), (!model.offsets.is_none()).then_some(mark));
    match model.of {
        OffsetsIn::Unit { is_changing: true, .. } => (format!("{said}, being set"), mark),
        OffsetsIn::Unit { .. } | OffsetsIn::Azel { .. } => (said, mark),
    }
}

pub(super) fn show(
    ui: &Ui,
    at: &mut Cursor,
    model: &OffsetsModel<'_>,
    state: &mut OffsetsState,
    actions: &mut Vec<CardAction>,
) {
    let t = theme::tokens(ui);
    at.skip(4.0);
    for offset in model.offsets.components().into_iter().filter(|offset| model.of.offers(*offset)) {
        row(ui, at.take(SMALL_HEIGHT), offset, model, state.step, actions);
        at.skip(GAP);
    }
    let row = at.take(SMALL_HEIGHT);
    let head = paint::text(ui, row.left_center(), Align2::LEFT_CENTER, "Step", text::small(), t.t2);
    let choice = row.with_min_x(head.right() + 8.0);
    let choice = choice.with_max_x(choice.left() + STEPS);
    let segment =
        |(step, word)| (word, if step == state.step { Segment::Chosen } else { Segment::Free });
    let segments = OffsetStep::ALL.map(segment);
    let name = "Step, degrees or seconds";
    if let Some(index) = segmented::show(ui, "offset step", choice, name, &segments) {
        state.step = OffsetStep::ALL.get(index).map_or(state.step, |(step, _)| *step);
    }
    let mut right = row.right();
    for (word, change, is_free, name) in [
        ("Undo", OffsetChange::Undo, model.can_undo, "Undo the last offset"),
        ("Zero", OffsetChange::Zero, !model.offsets.is_none(), "All offsets to zero"),
    ] {
        let button = Button::normal(word).locked(!is_free || model.locked.is_some());
        let width = (button.width(ui) - 8.0).min(56.0);
        let place = row.with_min_x(right - width).with_max_x(right);
        right = place.left() - GAP;
        let response = button.show(ui, ("offset", word), place).accessible_name(name);
        if response.clicked() {
            actions.push(CardAction::Offset(change));
        }
    }
    at.skip(GAP);
    match model.of {
        OffsetsIn::Azel { keep, .. } => {
            self::keep(ui, at.take(SMALL_HEIGHT), keep, actions);
            at.skip(GAP);
        }
        OffsetsIn::Unit { held, .. } => {
            let words = words::offsets_on_unit_about(held);
            let taken = paint::paragraph(ui, at.at(), at.width(), &words, text::small(), t.t2);
            paint::name_text(ui, "offsets on the unit", taken, &words);
            at.y = taken.bottom() + GAP;
        }
    }
    if let Some(why) = model.locked {
        let glyph = paint::square(pos2(at.left + 7.0, at.y + 8.0), 13.0);
        icons::paint(ui.painter(), glyph, Icon::Lock, t.t2);
        let start = at.at() + vec2(20.0, 0.0);
        let taken = paint::paragraph(ui, start, at.width() - 20.0, why, text::small(), t.t2);
        paint::name_text(ui, "offsets locked", taken, why);
        at.y = taken.bottom() + 1.0;
    }
    at.skip(4.0);
}

/// A button for each that the offsets can be remembered of.
fn keep(ui: &Ui, row: Rect, kept: &[(OffsetsSubject, &str, bool)], actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    let words = "Remember for";
    let head = paint::text(ui, row.left_center(), Align2::LEFT_CENTER, words, text::small(), t.t2);
    let room = row.with_min_x(head.right() + 8.0);
    let width = (room.width() - GAP) / 2.0;
    let mut left = room.left();
    for (of, name, differs) in kept {
        let place = room.with_min_x(left).with_max_x(left + width);
        left = place.right() + GAP;
        let about = match of {
            OffsetsSubject::Satellite(_) => {
                format!("Remember time, along and across the track for {name}")
            }
            OffsetsSubject::Antenna(_) => format!("Remember azimuth and elevation for {name}"),
        };
        let said = if *differs { about } else { format!("{about}: remembered already") };
        let response = Button::normal(name).locked(!differs).show(ui, ("keep", *name), place);
        let response = response.on_hover_text(&said).accessible_name(said);
        if response.clicked() {
            actions.push(CardAction::KeepOffsets(*of));
        }
    }
}

/// Name, less, value and more.
fn row(
    ui: &Ui,
    row: Rect,
    offset: Offset,
    model: &OffsetsModel<'_>,
    step: OffsetStep,
    actions: &mut Vec<CardAction>,
) {
    let t = theme::tokens(ui);
    let (name, value) = (words::offset_name(offset), words::offset_value(offset));
    let colour = if offset.is_zero() { t.t2 } else { t.t1 };
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, name, text::small(), t.t2);
    let more = row.with_min_x(row.right() - KEY);
    let less = more.translate(vec2(-KEY - GAP, 0.0));
    let shown = row.with_min_x(row.left() + 84.0).with_max_x(less.left() - 12.0);
    let font = text::body_medium();
    paint::text(ui, shown.right_center(), Align2::RIGHT_CENTER, &value, font, colour);
    paint::name_text(ui, ("offset value", name), shown, &format!("{name} offset: {value}"));
    let by = step.of(offset);
    for (place, mark, by, word) in [(less, "−", -by, "less"), (more, "+", by, "more")] {
        let button = Button::normal(mark).locked(model.locked.is_some());
        let said = format!("{name} offset, {word}");
        let response = button.show(ui, ("offset", name, mark), place).accessible_name(said);
        if response.clicked() {
            response.request_focus();
            actions.push(CardAction::Offset(OffsetChange::Step(by)));
        }
    }
}
