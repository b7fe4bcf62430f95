//! The card of an antenna: its activity, its position and its controls.

mod automatic;
mod axes;
mod control;
mod drive;
mod faults;
mod follow;
mod header;
mod holds;
mod live;
mod lock_out;
mod locks;
mod lower;
mod modes;
mod more;
mod offer;
mod offsets;
mod others;
mod readings;
mod released;
mod speed;
mod steps;
mod track;
mod travel;

use egui::{Align2, AsIdSalt, Color32, Pos2, Rect, Ui, UiBuilder, pos2, vec2};

pub(super) use self::locks::Locks;
use self::{drive::DriveState, more::MoreState, track::TrackState};
pub use self::{offsets::OffsetStep, offsets::OffsetsState};
use crate::{
    contract::{CatalogState, antenna::AntennaModel, driver::Command},
    model::{Model, UiCommand},
    station::AntennaId,
    ui::{
        antennas,
        confirm::Question,
        dialogs::MaintenanceDialog,
        icons::{self, Icon},
        replay,
        state_sentence::state_sentence,
        text, theme,
        widgets::{beam_bar, fold::Fold, hold_button::HoldState, paint, sentence},
    },
};

/// Width of the card, points.
pub const WIDTH: f32 = 344.0;
/// Width of the card in a small window, points.
pub const SMALL_WIDTH: f32 = 304.0;
/// Card height below which travel and faults fold to one line each, points.
const FULL_HEIGHT: f32 = 740.0;

/// Input, held keys and open folds. The type has no `Debug`, because it may contain a password.
#[derive(Clone, Default)]
pub struct CardState {
    /// State of jog and go-to.
    pub drive: DriveState,
    /// Questions below the mode.
    track: TrackState,
    /// Offsets while tracking.
    pub offsets: OffsetsState,
    /// Flag: the travel gauges are unfolded in a small window.
    pub travel_open: bool,
    /// Flag: the faults are unfolded in a small window.
    pub faults_open: bool,
    /// Flag: the readings are unfolded in a small window.
    readings_open: bool,
    /// Fold of the actions of the make.
    more_fold: Fold,
    /// Flag: the card hides content below its edge.
    has_more_below: bool,
    /// Open lock-out dialog.
    maintenance: Option<MaintenanceDialog>,
    standing_hold: HoldState,
    unseen_hold: HoldState,
    way_out_hold: HoldState,
    unguarded_hold: HoldState,
    more: MoreState,
}

impl CardState {
    /// Clears the input when the card shows another antenna, because the operator did not mean it
    /// for that antenna. Folds stay as they are.
    pub fn change_antenna(&mut self) {
        self.drive = DriveState::default();
        self.track = TrackState::default();
        self.more = MoreState::default();
        self.more_fold.forget_height();
        self.offsets.fold.forget_height();
        self.maintenance = None;
        self.standing_hold = HoldState::default();
        self.unseen_hold = HoldState::default();
        self.way_out_hold = HoldState::default();
        self.unguarded_hold = HoldState::default();
    }

    /// Releases a held jog key when the card of `antenna` disappears.
    pub fn hide(&mut self, antenna: Option<AntennaId>, commands: &mut Vec<UiCommand>) {
        self.maintenance = None;
        if self.drive.release_key() {
            commands.extend(antenna.map(|antenna| UiCommand::antenna(antenna, Command::EndJog)));
        }
    }
}

/// The antenna of the card, and the receivers of the operator's requests.
struct Card<'a> {
    model: &'a Model,
    antenna: &'a AntennaModel,
    locks: Locks<'a>,
    question: &'a mut Option<Question>,
    commands: &'a mut Vec<UiCommand>,
}

impl Card<'_> {
    /// Queues a command for the session of the antenna.
    fn queue(&mut self, command: Command) {
        self.commands.push(UiCommand::antenna(self.antenna.id(), command));
    }
}

/// The layout position, which moves down the card.
struct Cursor {
    card: Rect,
    left: f32,
    right: f32,
    y: f32,
}

impl Cursor {
    fn new(card: Rect) -> Self {
        let padding = if card.width() < WIDTH { 12.0 } else { 16.0 };
        Self { card, left: card.left() + padding, right: card.right() - padding, y: card.top() }
    }

    /// Returns `true` for a card that folds some of its parts.
    fn is_short(&self) -> bool {
        self.card.height() < FULL_HEIGHT
    }

    fn take(&mut self, height: f32) -> Rect {
        let rect = Rect::from_min_max(pos2(self.left, self.y), pos2(self.right, self.y + height));
        self.y += height;
        rect
    }

    /// Takes a row like [`Self::take`], over the whole width of the card.
    fn take_across(&mut self, height: f32) -> Rect {
        let row = self.take(height);
        Rect::from_x_y_ranges(self.card.x_range(), row.y_range())
    }

    fn skip(&mut self, height: f32) {
        self.y += height;
    }

    /// Skips `short` points in a short card, `full` points in a full one.
    fn skip_by_room(&mut self, short: f32, full: f32) {
        self.skip(if self.is_short() { short } else { full });
    }

    fn position(&self) -> Pos2 {
        pos2(self.left, self.y)
    }

    fn width(&self) -> f32 {
        self.right - self.left
    }
}

/// Draws the card of `antenna` in `rect`. `on_cards` are all antennas with a card; `live` is the
/// live station, which replaces the controls for moving by hand.
///
/// State sentence, axes table, mode, Track and these controls always stay in sight; the rest
/// scrolls if it does not fit.
// The arguments are the card, its antenna, and the receivers of requests.
#[allow(clippy::too_many_arguments)]
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    antenna: &AntennaModel,
    on_cards: &[AntennaId],
    live: Option<&Model>,
    state: &mut CardState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let in_replay = replay::locked(&antenna.config.name);
    let locks = Locks::new(model, antenna, &in_replay);
    let mut card = Card { model, antenna, locks, question: &mut *question, commands };
    let builder = UiBuilder::new().id_salt(("card", &antenna.config.name)).max_rect(rect);
    ui.scope_builder(builder, |ui| {
        let mut cursor = Cursor::new(rect);
        show_upper_part(ui, &mut cursor, &mut card, live, state);
        lower::show(ui, &mut cursor, &mut card, on_cards, state);
    });
    MaintenanceDialog::show(&mut state.maintenance, ui, model, antenna, question, commands);
}

/// Draws the part that always stays in sight.
fn show_upper_part(
    ui: &mut Ui,
    cursor: &mut Cursor,
    card: &mut Card<'_>,
    live: Option<&Model>,
    state: &mut CardState,
) {
    let (model, antenna) = (card.model, card.antenna);
    let t = theme::tokens(ui);
    ui.painter().vline(cursor.card.left() + 0.5, cursor.card.y_range(), (1.0, t.line));
    header::show(ui, cursor, card, &mut state.maintenance);

    cursor.skip_by_room(10.0, 12.0);
    let offer = offer::available_offer(antenna);
    let foot_height = if offer.is_some() { offer::HEIGHT } else { 0.0 };
    let block = state_sentence(model, antenna).with_sentence(|sentence| {
        sentence::show(ui, cursor.position(), cursor.width(), foot_height, sentence)
    });
    if let Some(offer) = offer {
        offer::show(ui, block, offer, card.commands);
    }
    cursor.y = block.bottom();
    cursor.skip_by_room(6.0, 10.0);
    automatic::show(ui, cursor, model, antenna, card.commands);
    lock_out::show_band(ui, cursor, antenna, &mut state.maintenance);
    if header::is_released(antenna) {
        released::show(ui, cursor, card);
    }

    axes::show(ui, cursor, model, antenna);
    // Keep the bar without a prediction: the keys below must not jump.
    let error_deg = antenna.error().map(|error| error.off_beam.degrees());
    let half_beam_deg = antenna.config.beam_width_deg / 2.0;
    beam_bar::show(ui, cursor.take(beam_bar::HEIGHT), error_deg, half_beam_deg);
    if !cursor.is_short() {
        travel::show(ui, cursor, &travel::gauges(antenna));
    }

    cursor.skip_by_room(6.0, 12.0);
    if !cursor.is_short() {
        let head = cursor.take(20.0);
        paint::text(ui, head.left_top(), Align2::LEFT_TOP, "Mode", text::caption(), t.t3);
    }
    modes::show(ui, cursor.take(32.0), card, &mut state.track);
    track::show_row(ui, cursor, card, state);
    cursor.skip_by_room(6.0, 12.0);
    match live {
        Some(live) => live::show(ui, cursor, live),
        None => drive::show(ui, cursor, card, &mut state.drive),
    }
}

/// Shows a sentence behind its mark.
fn show_remark(
    ui: &Ui,
    cursor: &mut Cursor,
    salt: impl AsIdSalt,
    icon: Icon,
    colour: Color32,
    words: &str,
) {
    let mark = paint::square(cursor.position() + vec2(7.0, 8.0), 13.0);
    icons::paint(ui.painter(), mark, icon, colour);
    let start = cursor.position() + vec2(20.0, 0.0);
    let place = paint::paragraph(ui, start, cursor.width() - 20.0, words, text::small(), colour);
    paint::name_text(ui, salt, place, words);
    cursor.y = place.bottom();
}

/// Draws the placeholder of the card while there is no antenna.
pub(super) fn show_placeholder(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    commands: &mut Vec<UiCommand>,
) {
    if model.demo && !matches!(model.catalog, CatalogState::Failed) {
        let (t, inner) = (theme::tokens(ui), rect.shrink(16.0));
        let words = "The simulated antennas are starting.";
        paint::text(ui, inner.left_top(), Align2::LEFT_TOP, words, text::body(), t.t2);
        return;
    }
    antennas::none(ui, rect, model, commands);
}
