//! The Operate view, for watching and driving the antennas.

mod all_antennas;
pub mod card;
mod divider;
mod filter;
mod ghost;
mod layout;
pub(super) mod passes;
mod side_card;
pub(super) mod sky;
mod sky_time;
mod strip;

use std::time::Duration;

use egui::{Rect, Role, Sense, Ui, WidgetInfo};
use jiff::Timestamp;

use super::{
    banner, confirm::Question, pass_header, pass_list::PassListState, profile::ProfileState,
    sky_plot::SkyPlotState, theme, timeline::Zoom,
};
use crate::{
    contract::{
        antenna::AntennaModel,
        passes::{PassListKey, PredictedPass},
    },
    model::{Model, UiCommand},
    station::AntennaId,
};
use card::CardState;
use ghost::GhostState;
pub(super) use layout::side_cards;
use layout::{Areas, SIDE_CARDS};
use side_card::SideCard;
use sky_time::SkyTime;
pub use sky_time::row::LONG_STEP_S;

/// Height of the edge that marks the selected antenna's card among several, points.
const SELECTED_EDGE: f32 = 3.0;
/// Delay of one additional frame.
const NEXT_FRAME: Duration = Duration::from_millis(1);

/// Input, open parts and folds of this view.
#[derive(Default)]
pub struct OperateState {
    /// State of the antenna card.
    pub card: CardState,
    /// Flag: the window shows the strip of the demo station, or keeps its room.
    pub has_banner: bool,
    /// Flag: the pass list lies over the plot, in a small window.
    pub drawer_open: bool,
    /// Zoom of the timeline: its number of hours.
    pub zoom: Zoom,
    /// Width of the list chosen by the operator, points.
    pub list_width: Option<u32>,
    /// State of the sky plot.
    pub sky: SkyPlotState,
    pub sky_time: SkyTime,
    /// Time of the pass that the operator marks in the sky plot or in the profile.
    marked: Option<Timestamp>,
    profile: ProfileState,
    ghost: GhostState,
    /// State of the pass list.
    pub passes: PassListState,
    found: filter::FoundPasses,
    /// Antenna of the card in the last frame.
    shown_antenna: Option<AntennaId>,
    /// Cards beside the antenna card in a wide window.
    side_cards: [SideCard; SIDE_CARDS],
}

impl OperateState {
    /// Opens the list and its filter, and gives the filter the keyboard focus.
    pub fn filter_list(&mut self) {
        self.drawer_open = true;
        self.passes.filter.open();
    }

    /// Returns the pass `down` rows below the selected one in the filtered list.
    pub fn neighbour(&mut self, model: &Model, down: isize) -> Option<PassListKey> {
        let listed = model.upcoming();
        let found = self.found.arrange(model, &self.passes.filter);
        let place = model.selected.and_then(|key| listed.row(key));
        let index = match found {
            Some(found) => place.and_then(|place| found.row(place)),
            None => place,
        };
        let requested = index.map_or(Some(0), |index| index.checked_add_signed(down))?;
        let place = found.map_or(Some(requested), |found| found.place(requested))?;
        listed.get(place).map(PredictedPass::key)
    }

    /// Hides the card and returns the sky plot to the current time, when another view replaces this
    /// one.
    pub fn leave(&mut self, commands: &mut Vec<UiCommand>) {
        self.leave_card(commands);
        self.sky_time.return_to_now();
    }

    /// Releases a held key when the card disappears.
    pub fn leave_card(&mut self, commands: &mut Vec<UiCommand>) {
        self.ghost.leave(commands);
        for card in &mut self.side_cards {
            card.leave(commands);
        }
        self.card.hide(self.shown_antenna, commands);
    }
}

/// Draws the view into `rect` of the `window`. `live` is the station that `model` shows, or the
/// live station during a replay.
// The arguments are the window, the state, and the receivers of requests.
#[allow(clippy::too_many_arguments)]
pub fn show(
    ui: &mut Ui,
    window: Rect,
    rect: Rect,
    live: &Model,
    model: &Model,
    state: &mut OperateState,
    question: &mut Option<Question>,
    commands: &mut Vec<UiCommand>,
) {
    let list_width = state.list_width.map(|width| width as f32);
    let count = model.antennas.len();
    let areas = Areas::new(window, rect, state.drawer_open, state.has_banner, count, list_width);
    let t = theme::tokens(ui);
    let shown = model.antenna().map(AntennaModel::id);
    if state.shown_antenna != shown {
        state.leave_card(commands);
        state.card.change_antenna();
        if let Some(card) = state.side_cards.first_mut() {
            card.turn_to(state.shown_antenna);
        }
        state.shown_antenna = shown;
    }
    let mut on_cards: Vec<AntennaId> = shown.into_iter().collect();
    let neighbours: [Option<&AntennaModel>; SIDE_CARDS] = std::array::from_fn(|index| {
        let card = state.side_cards.get_mut(index)?;
        if areas.side_cards.get(index).copied().flatten().is_none() {
            card.leave(commands);
            return None;
        }
        let antenna = card.antenna(model, &on_cards, commands)?;
        on_cards.push(antenna.id());
        Some(antenna)
    });
    if let Some(strip) = areas.banner {
        banner::show(ui, strip, model, commands);
    }
    if passes::header(ui, areas.header, model, areas.small) {
        state.drawer_open = !state.drawer_open;
    }
    state.sky.folds_legend = areas.small && areas.list.is_some();
    let pointed = sky::show(ui, areas.sky, model, state, commands);
    sky_time::row::show(ui, areas.sky_time, model, &mut state.sky_time);
    let time = state.sky_time.time();
    if let Some(timeline) = areas.timeline {
        strip::show(ui, timeline, model, time, &mut state.zoom, commands);
    }
    let mut marked = pointed;
    if let Some(profile) = areas.profile {
        let read = passes::profile(ui, profile, model, pointed.or(time), &mut state.profile);
        marked = marked.or(read);
    }
    if state.marked != marked {
        state.marked = marked;
        // Draw again: the plot came before the profile in this frame.
        ui.request_repaint_after_for(NEXT_FRAME, egui::ViewportId::ROOT);
    }
    if let Some(list) = areas.list {
        if areas.small {
            // The drawer lies over the plot and needs a background of its own.
            ui.painter().rect_filled(list, 0.0, t.bg1);
            // The drawer keeps the pointer off the sky below. It takes no keys: Tab skips it.
            let id = ui.make_persistent_id("drawer");
            let drawer = ui.interact(list, id, Sense::CLICK | Sense::DRAG);
            drawer.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Drawer of the passes"));
        }
        let (list_state, found) = (&mut state.passes, &mut state.found);
        passes::list(ui, list, model, areas.thumbnails, list_state, found, commands);
    }
    if let Some(selected) = model.antenna() {
        let neighbours = neighbours.into_iter().zip(&mut state.side_cards);
        let neighbours = neighbours.filter_map(|(antenna, card)| Some((antenna?, card.card())));
        let mut cards: Vec<_> =
            std::iter::once((selected, &mut state.card)).chain(neighbours).collect();
        // Keep the order of the station: selecting another antenna must not swap two cards.
        cards.sort_by_key(|(antenna, _)| {
            model.antennas.iter().position(|model_antenna| model_antenna.id() == antenna.id())
        });
        let places = std::iter::once(areas.card).chain(areas.side_cards.into_iter().flatten());
        let is_one_of_several = cards.len() > 1;
        for (place, (antenna, card)) in places.zip(cards) {
            let is_selected = antenna.id() == selected.id();
            let live = (is_selected && model.replay.is_some()).then_some(live);
            card::show(ui, place, model, antenna, &on_cards, live, card, question, commands);
            if is_one_of_several && is_selected {
                let edge = place.with_max_y(place.top() + SELECTED_EDGE);
                ui.painter().rect_filled(edge, 0.0, t.sat);
            }
        }
    } else {
        card::show_placeholder(ui, areas.card, model, commands);
    }
    for line in areas.dividers() {
        ui.painter().rect_filled(line, 0.0, t.line);
    }
    if let (Some(list), Some(widths)) = (areas.list, areas.list_widths) {
        divider::show(ui, list, widths, &mut state.list_width);
    }
}
