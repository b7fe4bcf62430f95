//! The card of the selected antenna: what it does, where it is, and what it
//! can be told.

mod again;
mod drive;
mod faults;
mod follow;
mod header;
mod holds;
mod lock_out;
mod lower;
mod more;
mod others;
mod readings;
mod released;
mod speed;
mod steps;
mod track;

use egui::{Align2, Pos2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};

use super::{
    dialogs::MaintenanceDialog,
    icons::Icon,
    text, theme,
    widgets::{
        axes_table::{self, AxisRow, WantedColumn},
        beam_bar::{self, BeamModel},
        button,
        go_to::Target,
        hold_button::HoldState,
        mode_selector::{self, ModeModel},
        paint,
        sentence::{self, Sentence},
        travel_gauge::TravelModel,
    },
};
use crate::{
    device::panel::{Act, CheckState, Reading},
    driver::Intent,
};
pub use drive::{DriveModel, DriveState};
pub use faults::FaultsModel;
pub use follow::{FollowChoice, FollowModel};
pub use header::{HeaderModel, LinkStatus};
pub use holds::WayOutModel;
pub use lock_out::LockOutModel;
pub use more::MoreModel;
use more::MoreState;
pub use others::OtherAntenna;
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
    /// Name, kind, and whether it can be reached.
    pub header: HeaderModel<'a>,
    /// What the antenna does, why, and what comes next.
    pub sentence: Sentence<'a>,
    /// What it tracked until STOP, to be tracked again in one step.
    pub track_again: Option<&'a str>,
    /// What the second column of the axes table holds.
    pub wanted: WantedColumn,
    /// Of the angles that the unit is told and tells, at most two.
    pub decimals: usize,
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
    /// What the unit tells of itself.
    pub readings: &'a [Reading],
    /// Checks of the unit; none for a unit that has none.
    pub faults: Option<FaultsModel<'a>>,
    /// What only this make can do.
    pub more: MoreModel<'a>,
    /// The unit is locked out for maintenance.
    pub lock_out: Option<LockOutModel<'a>>,
    /// Why the operator is asked whether the antenna stands.
    pub asks_standing: Option<&'a str>,
    /// What an action does that was refused because nobody here knows where it leads:
    /// the operator may answer for it.
    pub asks_unseen: Option<&'a str>,
    /// It stands where it must not point.
    pub way_out: Option<WayOutModel<'a>>,
    /// The antennas that have no card now.
    pub others: &'a [OtherAntenna],
}

/// What the operator typed, held and folded. It has no `Debug`: a password may
/// be in it.
#[derive(Clone, Default)]
pub struct CardState {
    /// Jog and go-to.
    pub drive: DriveState,
    /// Questions that are open below the mode.
    pub track: TrackState,
    /// The travel gauges are unfolded in a small window.
    pub travel_open: bool,
    /// The faults are unfolded in a small window.
    pub faults_open: bool,
    /// What the unit tells is unfolded in a small window.
    pub readings_open: bool,
    /// The actions are unfolded.
    pub more_open: bool,
    /// The dialog about a lock-out is open.
    pub maintenance: Option<MaintenanceDialog>,
    standing: HoldState,
    unseen: HoldState,
    way_out: HoldState,
    unguarded: HoldState,
    more: MoreState,
}

impl CardState {
    /// To be called when the card shows another antenna: what was typed is not
    /// for that one. What is unfolded stays so.
    pub fn change_antenna(&mut self) {
        self.drive = DriveState::default();
        self.track = TrackState::default();
        self.more = MoreState::default();
        self.maintenance = None;
        self.standing = HoldState::default();
        self.unseen = HoldState::default();
        self.way_out = HoldState::default();
        self.unguarded = HoldState::default();
    }

    /// To be called when the card is not shown any more: a jog key that was
    /// held is released.
    pub fn hide(&mut self) -> Option<CardAction> {
        self.maintenance = None;
        self.drive.let_go().then_some(CardAction::JogReleased)
    }
}

/// What the operator did.
#[derive(Debug, Clone, PartialEq)]
pub enum CardAction {
    /// Open the link.
    Connect,
    /// Close the link.
    Disconnect,
    /// Stop this antenna, which takes a connection.
    Stop,
    /// Lock the unit out for maintenance, or take that off.
    Maintenance,
    /// Wants another mode.
    SetMode(Intent),
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
    /// It may be moved by hand without a dead-man, for a minute.
    AllowUnguarded,
    /// It may be moved by hand out of where it must not point, for a minute.
    AllowWayOut,
    /// The operator has seen that it stands.
    SeenStanding,
    /// Start the action that was refused because nobody here knows where it leads.
    ActUnseen,
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
    /// Track what STOP has ended.
    TrackAgain,
    /// Track the selected satellite although the unit would miss it.
    TrackAnyway,
    /// Follow this position by position.
    Follow(FollowChoice),
    /// Let the unit start passes by itself, or not.
    SetAutoTrack(bool),
    /// Do what only this make can do.
    Act(Act),
    /// Show the card of the antenna at this place.
    Select(usize),
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
    header::show(ui, &mut at, &model.header, rect, short, actions);

    at.skip(if short { 10.0 } else { 12.0 });
    let foot = if model.track_again.is_some() { again::HEIGHT } else { 0.0 };
    let block = sentence::show(ui, at.at(), at.width(), foot, &model.sentence);
    if let Some(name) = model.track_again {
        again::show(ui, block, name, actions);
    }
    at.y = block.bottom() + if short { 6.0 } else { 10.0 };
    if let Some(lock_out) = &model.lock_out {
        lock_out::band(ui, at.take(button::HEIGHT), lock_out, actions);
        at.skip(6.0);
    }
    if model.header.status == LinkStatus::NotConnected {
        released::show(ui, &mut at, &model.header, actions);
    }

    let table = at.take(axes_table::height(model.axes.len()));
    axes_table::show(ui, table, model.wanted, model.decimals, model.axes);
    if let Some(beam) = &model.beam {
        beam_bar::show(ui, at.take(beam_bar::HEIGHT), beam);
    }
    if !short && !model.travel.is_empty() {
        at.skip(8.0);
        lower::travel(ui, &mut at, model.travel, true);
    }

    at.skip(if short { 6.0 } else { 12.0 });
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
            lower::show(ui, rect, &mut at, model, state, actions, short);
            ui.allocate_rect(
                Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), at.y - top)),
                egui::Sense::hover(),
            );
        });
    });
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
