//! The card of the selected antenna: its activity, its position and its controls.

mod automatic;
mod drive;
mod faults;
mod follow;
mod header;
mod holds;
mod live;
mod lock_out;
mod lower;
mod more;
mod offer;
mod offsets;
mod others;
mod readings;
mod released;
mod speed;
mod steps;
mod track;

use egui::{Align2, Pos2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};

use super::{
    dialogs::MaintenanceDialog,
    icons::{self, Icon},
    text, theme,
    widgets::{
        axes_table::{self, AxesTable},
        beam_bar::{self, BeamModel},
        button,
        fold::Fold,
        go_to::Target,
        hold_button::HoldState,
        link_chip::AutomaticModel,
        mode_selector::{self, ModeModel},
        paint,
        sentence::{self, Sentence},
        travel_gauge::TravelModel,
    },
};
use crate::{
    contract::driver::{Intent, OffsetChange},
    device::panel::{Act, CheckState, Reading},
    station::OffsetsSubject,
};
pub use drive::{DriveModel, DriveState};
pub use faults::FaultsModel;
pub use follow::{FollowChoice, FollowModel};
pub use header::{HeaderModel, LinkStatus};
pub use holds::WayOutModel;
pub use live::{LiveAntenna, LiveNow};
pub use lock_out::LockOutModel;
pub use more::MoreModel;
use more::MoreState;
pub use offer::Offer;
pub use offsets::{OffsetStep, OffsetsIn, OffsetsModel, OffsetsState};
pub use others::OtherAntenna;
pub use track::{TrackModel, TrackState};

/// Width of the card.
pub const WIDTH: f32 = 344.0;
/// Width of the card in a small window.
pub const SMALL_WIDTH: f32 = 304.0;
/// In a card below this height travel and faults fold to one line each.
pub const FULL_HEIGHT: f32 = 740.0;
/// Height at the foot of a card that is kept free for the mark that it goes on below.
const MORE_BELOW: f32 = 20.0;
/// A card that hides less than this below its edge does not say so.
const LEAST_HIDDEN: f32 = 4.0;

/// Content of the card. An unknown number is `None` and shown as a dash.
#[derive(Debug, Clone, Copy)]
pub struct CardModel<'a> {
    /// Name, kind and link.
    pub header: HeaderModel<'a>,
    /// The state sentence.
    pub sentence: Sentence<'a>,
    /// The target tracked until STOP, offered to be tracked again.
    pub offer: Option<Offer<'a>>,
    /// Automatic operation; none while it is off.
    pub automatic: Option<AutomaticModel<'a>>,
    /// The button that lets suspended automatic operation go on.
    pub go_on: Option<&'a str>,
    pub axes: AxesTable<'a>,
    /// Pointing error and beam; none if the antenna has no demanded direction.
    pub beam: Option<BeamModel>,
    /// The axes of the mount; empty for a unit that does not report them.
    pub travel: &'a [TravelModel<'a>],
    /// Modes of the antenna.
    pub modes: ModeModel<'a>,
    /// Target of the tracking; none for a unit that cannot track.
    pub track: Option<TrackModel<'a>>,
    /// Offsets of the track that runs; none while nothing is tracked.
    pub offsets: Option<OffsetsModel<'a>>,
    /// Jogging and going to a direction.
    pub drive: DriveModel<'a>,
    /// In a replay: the live station, in place of the controls for moving by hand.
    pub live: Option<&'a LiveNow>,
    /// Readings that the unit reports about itself.
    pub readings: &'a [Reading],
    /// Checks of the unit; none for a unit without checks.
    pub faults: Option<FaultsModel<'a>>,
    /// Actions of this make.
    pub more: MoreModel<'a>,
    /// The lock-out for maintenance, if any.
    pub lock_out: Option<LockOutModel<'a>>,
    /// The reason for asking the operator to confirm that the antenna stands still.
    pub asks_standing: Option<&'a str>,
    /// Description of an action that was refused because Azel cannot know where it ends; the
    /// operator may start it on their own responsibility.
    pub asks_unseen: Option<&'a str>,
    /// The antenna points where it must not; the way out of there.
    pub way_out: Option<WayOutModel<'a>>,
    /// The other antennas, which have no card now.
    pub others: &'a [OtherAntenna],
}

/// Input, held keys and open folds. No `Debug`: it may contain a password.
#[derive(Clone, Default)]
pub struct CardState {
    /// Jog and go-to.
    pub drive: DriveState,
    /// Questions that are open below the mode.
    pub track: TrackState,
    /// Offsets while tracking.
    pub offsets: OffsetsState,
    /// The travel gauges are unfolded in a small window.
    pub travel_open: bool,
    /// The faults are unfolded in a small window.
    pub faults_open: bool,
    /// The readings are unfolded in a small window.
    pub readings_open: bool,
    /// The actions of the make.
    pub more_fold: Fold,
    /// Something is hidden below the edge of the card.
    goes_on_below: bool,
    /// The open lock-out dialog.
    pub maintenance: Option<MaintenanceDialog>,
    standing: HoldState,
    unseen: HoldState,
    way_out: HoldState,
    unguarded: HoldState,
    more: MoreState,
}

impl CardState {
    /// Call when the card shows another antenna. Clears the input, which was not meant for that
    /// antenna; folds stay as they are.
    pub fn change_antenna(&mut self) {
        self.drive = DriveState::default();
        self.track = TrackState::default();
        self.more = MoreState::default();
        self.more_fold.forget_height();
        self.offsets.fold.forget_height();
        self.maintenance = None;
        self.standing = HoldState::default();
        self.unseen = HoldState::default();
        self.way_out = HoldState::default();
        self.unguarded = HoldState::default();
    }

    /// Call when the card disappears. Releases a held jog key.
    pub fn hide(&mut self) -> Option<CardAction> {
        self.maintenance = None;
        self.drive.let_go().then_some(CardAction::JogReleased)
    }
}

#[derive(Debug, Clone, PartialEq)]
pub enum CardAction {
    Connect,
    Disconnect,
    /// Connect to this antenna and stop it.
    Stop,
    /// Lock the unit out for maintenance, or end the lock-out.
    Maintenance,
    /// Request another mode.
    SetMode(Intent),
    /// A jog key is held. Sent in every frame of the hold.
    Jog {
        /// Sign of the first axis, −1 to 1.
        x: i8,
        /// Sign of the second axis, −1 to 1.
        y: i8,
        /// Demanded rate.
        rate_deg_s: f64,
    },
    /// The jog key was released. Sent once.
    JogReleased,
    /// Allow moving the antenna by hand without a dead-man, for a minute.
    AllowUnguarded,
    /// Allow moving the antenna by hand out of the zone into which it must not point, for a minute.
    AllowWayOut,
    /// The operator has seen that the antenna stands still.
    SeenStanding,
    /// Start the action that was refused because Azel cannot know where it ends.
    ActUnseen,
    /// Turn an axis by an amount, once.
    Step {
        /// Sign of the first axis, −1 to 1.
        x: i8,
        /// Sign of the second axis, −1 to 1.
        y: i8,
        /// Amount.
        step_deg: f64,
    },
    /// Show a direction in the sky plot without moving the antenna.
    PreviewGoTo(Target),
    /// Move to a direction.
    GoTo(Target),
    /// Track the selected satellite.
    TrackSelected,
    /// Track again the target whose tracking STOP ended.
    TrackAgain,
    /// Take over what the unit tracks by itself.
    TakeOver,
    /// Let automatic operation go on.
    GoOn,
    /// Track the selected satellite although the unit would miss it.
    TrackAnyway,
    /// Program-track this target.
    Follow(FollowChoice),
    /// Change the offsets of the track.
    Offset(OffsetChange),
    /// Remember the offsets that are on.
    KeepOffsets(OffsetsSubject),
    /// Switch automatic starting of passes by the unit.
    SetAutoTrack(bool),
    /// Start an action of this make.
    Act(Act),
    /// Show the card of the antenna with this index.
    Select(usize),
}

/// The layout position, which moves down the card.
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

/// Shows the card in `rect`. State sentence, axes table, mode, Track and the controls for moving
/// by hand always stay in sight; the rest scrolls if it does not fit.
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
    let foot = if model.offer.is_some() { offer::HEIGHT } else { 0.0 };
    let block = sentence::show(ui, at.at(), at.width(), foot, &model.sentence);
    if let Some(offer) = model.offer {
        offer::show(ui, block, offer, actions);
    }
    at.y = block.bottom() + if short { 6.0 } else { 10.0 };
    automatic::show(ui, &mut at, model, actions);
    if let Some(lock_out) = &model.lock_out {
        lock_out::band(ui, at.take(button::HEIGHT), lock_out, actions);
        at.skip(6.0);
    }
    if model.header.status == LinkStatus::NotConnected {
        released::show(ui, &mut at, &model.header, actions);
    }

    let table = at.take(axes_table::height(model.axes.axes.len()));
    axes_table::show(ui, table, &model.axes);
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
    let typed = state.drive.go_to.previewed();
    track::row(ui, &mut at, model.track.as_ref(), typed, &mut state.track, actions);
    at.skip(if short { 6.0 } else { 12.0 });
    match model.live {
        Some(live) => live::show(ui, &mut at, live, short),
        None => drive::show(ui, &mut at, &model.drive, &mut state.drive, actions, short),
    }

    let below = rect.with_min_y(at.y);
    let foot = if state.goes_on_below { MORE_BELOW } else { 0.0 };
    let (seen, strip) = below.split_top_bottom_at_y(below.bottom() - foot);
    ui.scope_builder(UiBuilder::new().id_salt("lower").max_rect(seen), |ui| {
        // However little room there is, it ends above the mark.
        let area = ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink(false);
        let shown = area.show(ui, |ui| {
            if ui.ctx().rect_contains_pointer(ui.layer_id(), strip) {
                // The wheel turns what goes on below the mark as well.
                let by = ui.input(|input| input.smooth_scroll_delta().y);
                ui.scroll_with_delta(vec2(0.0, by));
            }
            let top = ui.cursor().top();
            at.y = top;
            lower::show(ui, rect, &mut at, model, state, actions, short);
            ui.allocate_rect(
                Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), at.y - top)),
                egui::Sense::hover(),
            );
        });
        let hidden = shown.content_size.y - shown.state.clamped_offset().y - below.height();
        // In less room the line that is cut says it.
        let goes_on = hidden > LEAST_HIDDEN && below.height() > 2.0 * MORE_BELOW;
        let folds = lower::settle(model, state, below.height() - shown.content_size.y);
        if std::mem::replace(&mut state.goes_on_below, goes_on) != goes_on || folds {
            ui.request_discard("the lower part of a card has another height");
        }
    });
    if state.goes_on_below {
        more_below(ui, strip);
    }
}

/// Shows in the `strip` at the foot of the card that it goes on below.
fn more_below(ui: &Ui, strip: Rect) {
    let t = theme::tokens(ui);
    let at = strip.center();
    let place = Rect::from_center_size(at, vec2(32.0, 14.0));
    ui.painter().rect(place, 7.0, t.bg3, (1.0, t.edge), egui::StrokeKind::Inside);
    icons::paint(ui.painter(), paint::square(at, 12.0), Icon::ChevronDown, t.t1);
    let words = "Scroll for more";
    paint::name_text(ui, "more below", place, words).on_hover_text(words);
}

/// The icon of a check.
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
