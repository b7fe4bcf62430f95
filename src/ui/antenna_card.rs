//! The card of the selected antenna: what it does, where it is, and what it
//! can be told.

mod drive;
mod faults;
mod header;
mod steps;
mod track;

use egui::{Align2, Pos2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};

use super::{
    icons::Icon,
    text, theme,
    widgets::{
        axes_table::{self, AxisRow, WantedColumn},
        beam_bar::{self, BeamModel},
        fold::{self, FoldModel},
        go_to::Target,
        mode_selector::{self, Mode, ModeModel},
        paint,
        sentence::{self, Sentence},
        travel_gauge::{self, TravelModel},
    },
};
pub use drive::{DriveModel, DriveState};
pub use faults::{CheckRow, CheckState, FaultsModel};
pub use header::{Control, HeaderModel};
pub use track::{TrackModel, TrackState};

/// Width of the card.
pub const WIDTH: f32 = 344.0;
/// Width of the card in a small window.
pub const SMALL_WIDTH: f32 = 304.0;
/// Below this height travel and faults fold to one line each.
pub const FULL_HEIGHT: f32 = 740.0;

/// All that the card shows. A number that is not known is `None` and shown as
/// a dash.
#[derive(Debug, Clone, Copy)]
pub struct CardModel<'a> {
    /// Name, kind and who controls.
    pub header: HeaderModel<'a>,
    /// What the antenna does, why, and what comes next.
    pub sentence: Sentence<'a>,
    /// What the second column of the axes table holds.
    pub wanted: WantedColumn,
    /// The axes in which the unit is commanded.
    pub axes: &'a [AxisRow<'a>],
    /// The error against the beam; none if the antenna has no wanted direction.
    pub beam: Option<BeamModel>,
    /// The axes of the mount; empty for a unit that does not report them.
    pub travel: &'a [TravelModel<'a>],
    /// Modes of the unit.
    pub modes: ModeModel<'a>,
    /// What the unit tracks; none for a unit that cannot track.
    pub track: Option<TrackModel<'a>>,
    /// Jogging and going to a direction.
    pub drive: DriveModel<'a>,
    /// Checks of the unit.
    pub faults: FaultsModel<'a>,
}

/// What the operator typed, held and folded; one for each antenna.
#[derive(Debug, Clone, Default)]
pub struct CardState {
    /// Jog and go-to.
    pub drive: DriveState,
    /// Questions that are open below the mode.
    pub track: TrackState,
    /// The travel gauges are unfolded in a small window.
    pub travel_open: bool,
    /// The faults are unfolded in a small window.
    pub faults_open: bool,
}

impl CardState {
    /// To be called when the card is not shown any more: a jog key that was
    /// held is released.
    pub fn hide(&mut self) -> Option<CardAction> {
        self.drive.let_go().then_some(CardAction::JogReleased)
    }
}

/// What the operator did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CardAction {
    /// Wants another mode.
    SetMode(Mode),
    /// Holds a jog key. Comes in every frame in which it is held.
    Jog {
        /// Sign of the first axis, −1 to 1.
        x: i8,
        /// Sign of the second axis, −1 to 1.
        y: i8,
        /// Wanted rate, in degrees per second.
        rate_deg_s: f64,
    },
    /// The jog key is not held any more. Comes once.
    JogReleased,
    /// Turn an axis by an amount, once.
    Step {
        /// Sign of the first axis, −1 to 1.
        x: i8,
        /// Sign of the second axis, −1 to 1.
        y: i8,
        /// The amount, in degrees.
        step_deg: f64,
    },
    /// Shows where a direction leads, moves nothing.
    PreviewGoTo(Target),
    /// Go to a direction.
    GoTo(Target),
    /// Track the selected satellite.
    TrackSelected,
    /// Let the unit start passes by itself, or not.
    SetAutoTrack(bool),
}

/// A place that moves down the card.
struct Cursor {
    left: f32,
    right: f32,
    y: f32,
}

impl Cursor {
    fn take(&mut self, height: f32) -> Rect {
        let rect = Rect::from_min_max(pos2(self.left, self.y), pos2(self.right, self.y + height));
        self.y += height;
        rect
    }

    fn skip(&mut self, height: f32) {
        self.y += height;
    }

    fn at(&self) -> Pos2 {
        pos2(self.left, self.y)
    }

    fn width(&self) -> f32 {
        self.right - self.left
    }
}

/// Shows the card in `rect`. State sentence, axes table and mode always stay in
/// sight; what does not fit below them scrolls.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &CardModel<'_>,
    state: &mut CardState,
) -> Vec<CardAction> {
    let mut actions = Vec::new();
    let builder = UiBuilder::new().id_salt(("card", model.header.name)).max_rect(rect);
    ui.scope_builder(builder, |ui| fill(ui, rect, model, state, &mut actions));
    actions
}

fn fill(
    ui: &mut Ui,
    rect: Rect,
    model: &CardModel<'_>,
    state: &mut CardState,
    actions: &mut Vec<CardAction>,
) {
    let t = theme::tokens(ui);
    let short = rect.height() < FULL_HEIGHT;
    let padding = if rect.width() < WIDTH { 12.0 } else { 16.0 };
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let mut at =
        Cursor { left: rect.left() + padding, right: rect.right() - padding, y: rect.top() };
    header::show(ui, &mut at, &model.header, rect, short);

    at.skip(if short { 10.0 } else { 12.0 });
    let block = sentence::show(ui, at.at(), at.width(), &model.sentence);
    at.y = block.bottom() + if short { 6.0 } else { 10.0 };

    let table = at.take(axes_table::height(model.axes.len()));
    axes_table::show(ui, table, model.wanted, model.axes);
    if let Some(beam) = &model.beam {
        beam_bar::show(ui, at.take(beam_bar::HEIGHT), beam);
    }
    if !short && !model.travel.is_empty() {
        at.skip(8.0);
        travel(ui, &mut at, model.travel, true);
    }

    at.skip(if short { 8.0 } else { 12.0 });
    if !short {
        let head = at.take(20.0);
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, "Mode", text::caption(), t.t3);
    }
    if let Some(mode) = mode_selector::show(ui, at.take(32.0), &model.modes) {
        track::mode_clicked(mode, &mut state.track, actions);
    }

    let below = rect.with_min_y(at.y);
    ui.scope_builder(UiBuilder::new().id_salt("lower").max_rect(below), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let top = ui.cursor().top();
            at.y = top;
            lower(ui, rect, &mut at, model, state, actions, short);
            ui.allocate_rect(
                Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), at.y - top)),
                egui::Sense::hover(),
            );
        });
    });
}

/// Everything below the mode.
fn lower(
    ui: &mut Ui,
    card: Rect,
    at: &mut Cursor,
    model: &CardModel<'_>,
    state: &mut CardState,
    actions: &mut Vec<CardAction>,
    short: bool,
) {
    track::show(ui, at, model.track.as_ref(), &mut state.track, actions);
    at.skip(if short { 8.0 } else { 12.0 });
    drive::show(ui, at, &model.drive, &mut state.drive, actions, short);
    at.skip(4.0);
    if !short {
        faults::show(ui, at, card, &model.faults);
        return;
    }
    let line =
        |y: f32| Rect::from_min_max(pos2(card.left(), y), pos2(card.right(), y + fold::HEIGHT));
    if !model.travel.is_empty() {
        let value = travel_in_words(model.travel);
        let travel_line = FoldModel { title: "Travel", value: &value, mark: None };
        fold::show(ui, line(at.y), &travel_line, &mut state.travel_open);
        at.skip(fold::HEIGHT);
        if state.travel_open {
            travel(ui, at, model.travel, false);
            at.skip(4.0);
        }
    }
    let (value, mark) = faults::in_words(ui, &model.faults);
    let faults_line = FoldModel { title: "Faults", value: &value, mark: Some(mark) };
    fold::show(ui, line(at.y), &faults_line, &mut state.faults_open);
    at.skip(fold::HEIGHT);
    if state.faults_open {
        faults::show(ui, at, card, &model.faults);
    }
}

fn travel(ui: &Ui, at: &mut Cursor, axes: &[TravelModel<'_>], with_head: bool) {
    let t = theme::tokens(ui);
    if with_head {
        let head = at.take(18.0);
        let words = "Travel, as the unit reports it";
        paint::text(ui, head.left_center(), Align2::LEFT_CENTER, words, text::caption(), t.t3);
        if let Some(range) = common_range(axes) {
            paint::text(
                ui,
                head.right_center(),
                Align2::RIGHT_CENTER,
                range,
                text::caption(),
                t.t3,
            );
        }
    }
    for axis in axes {
        travel_gauge::show(ui, at.take(travel_gauge::HEIGHT), axis);
    }
}

/// The travel in words, if all axes have the same.
fn common_range(axes: &[TravelModel<'_>]) -> Option<String> {
    let (low, high) = axes.first()?.travel_deg;
    let same = |deg: f64, other: f64| (deg - other).abs() < 0.05;
    let all = axes.iter().all(|axis| same(axis.travel_deg.0, low) && same(axis.travel_deg.1, high));
    all.then(|| format!("{low:.0}° to {high:.0}°").replace('-', "−"))
}

fn travel_in_words(axes: &[TravelModel<'_>]) -> String {
    let words: Vec<String> = axes
        .iter()
        .map(|axis| {
            let deg = axis.position_deg.map_or_else(
                || axes_table::UNKNOWN.to_owned(),
                |deg| format!("{deg:.1}°").replace('-', "−"),
            );
            let limit = if axis.lower_limit || axis.upper_limit { " limit" } else { "" };
            format!("{} {deg}{limit}", axis.name)
        })
        .collect();
    words.join("  ")
}

/// The shape of a verdict.
const fn verdict_icon(state: CheckState) -> Icon {
    match state {
        CheckState::Good => Icon::Check,
        CheckState::Caution => Icon::Warning,
        CheckState::Fault => Icon::Cross,
        CheckState::Unknown => Icon::Dash,
    }
}

#[cfg(test)]
mod tests;
