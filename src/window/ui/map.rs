//! The Map view: the satellites over the globe, a table of where they are, and the selected one
//! in detail.

mod bar;
mod canvas;
mod caps;
mod facts;
mod grid;
mod ground;
mod inspector;
mod labels;
mod land;
mod legend;
mod nodes;
mod projection;
mod table;
mod tracks;
mod words;

use std::collections::HashMap;

use egui::{Rect, Ui, pos2, vec2};

use self::{land::Land, projection::Zoom};
use super::{
    sky_plot::{labels::Key, placement::Memory},
    theme,
    widgets::list::Scroll,
};
use crate::model::{
    Model, UiCommand,
    globe::{GlobeSatellite, MapDirection},
};

/// Largest height of the bar below the map.
pub(super) const FOOT: f32 = table::MAX_BAR;
/// In a window below this width the inspector is a drawer.
const DRAWER_BELOW: f32 = 1100.0;
const INSPECTOR: f32 = 344.0;
const PADDING: f32 = 16.0;
/// Rows for which the table must have room beside the map; else it is a drawer over it.
const ROWS: f32 = 3.0;
/// Rows of the table for which the map gives way, down to this part of its height.
const WANTED_ROWS: usize = 8;
const MIN_MAP: f32 = 0.85;

/// Layers of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
// Independent check boxes.
#[allow(clippy::struct_excessive_bools)]
pub struct MapLayers {
    /// The ground track of the selected satellite.
    pub tracks: bool,
    /// The ground tracks of the other satellites.
    pub other_tracks: bool,
    /// The ground from which each satellite is seen.
    pub footprints: bool,
    /// Day and night.
    pub terminator: bool,
    /// Names of the satellites that are not selected.
    pub names: bool,
    /// Parallels and meridians.
    pub grid: bool,
}

impl Default for MapLayers {
    fn default() -> Self {
        Self {
            tracks: true,
            other_tracks: false,
            footprints: true,
            terminator: true,
            names: true,
            grid: true,
        }
    }
}

/// The satellites on the map, besides the selected one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Shown {
    #[default]
    Favourites,
    Tracked,
}

impl Shown {
    /// The selected satellite is always shown.
    fn has(self, satellite: &GlobeSatellite) -> bool {
        satellite.is_selected || self.counts(satellite)
    }

    fn counts(self, satellite: &GlobeSatellite) -> bool {
        match self {
            Self::Favourites => satellite.is_favourite,
            Self::Tracked => satellite.is_tracked,
        }
    }
}

/// Layers, section of the map, open drawers, and shapes that are kept.
#[derive(Default)]
pub struct MapState {
    pub layers: MapLayers,
    shown: Shown,
    zoom: Zoom,
    table_is_open: bool,
    inspector_is_open: bool,
    layers_key: bool,
    labels: HashMap<Key, Memory>,
    land: Option<Land>,
    scroll: Scroll,
}

impl MapState {
    /// Zooms in or out of the middle.
    pub fn change_zoom(&mut self, is_closer: bool) {
        self.zoom.step(is_closer);
    }

    /// Shows the whole world again.
    pub fn reset_zoom(&mut self) {
        self.zoom = Zoom::default();
    }

    /// Opens or closes the list of layers.
    pub fn toggle_layers(&mut self) {
        self.layers_key = true;
    }

    /// The next satellite on that side of the selected one.
    pub fn nearest(&self, model: &Model, direction: MapDirection) -> Option<u32> {
        model.globe.nearest(direction, |satellite| self.shown.has(satellite))
    }
}

/// Draws the view. The inspector has room beside the map if `window` is wide enough.
pub fn show(
    ui: &mut Ui,
    window: Rect,
    rect: Rect,
    model: &Model,
    state: &mut MapState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let shown: Vec<&GlobeSatellite> =
        model.globe.satellites.iter().filter(|satellite| state.shown.has(satellite)).collect();
    let has_drawer = window.width() < DRAWER_BELOW;
    let side = if has_drawer && !state.inspector_is_open { 0.0 } else { INSPECTOR };
    let (left, right) = rect.split_left_right_at_x(rect.right() - side);
    let left = if has_drawer { rect } else { left };
    let (head, rest) = left.split_top_bottom_at_y(left.top() + bar::HEIGHT);

    bar::show(ui, head, model, has_drawer, state);
    let areas = Areas::new(rest, shown.len(), state.table_is_open);
    // A drawer over the map takes the pointer.
    let visible = areas.map.with_max_x(right.left().min(areas.map.right()));
    let visible = visible.with_max_y(areas.table.top().min(visible.bottom()));
    canvas::show(ui, areas.map, visible, model, &shown, state, commands);
    let table = areas.table.with_max_x(visible.right());
    if table::show(ui, table, model, &shown, areas.is_drawer, state, commands) {
        state.table_is_open = !state.table_is_open;
    }
    if side > 0.0 {
        let place = if has_drawer { right.with_min_y(head.bottom()) } else { right };
        inspector::show(ui, place, model, commands);
    }
}

/// The parts below the view bar.
struct Areas {
    map: Rect,
    table: Rect,
    /// The table lies over the map and opens from its bar.
    is_drawer: bool,
}

impl Areas {
    fn new(rest: Rect, rows: usize, is_open: bool) -> Self {
        let map = rest.width() / 2.0;
        let spare = rest.height() - map;
        if spare >= table::BAR + table::height(ROWS) {
            let requested = table::BAR + table::height(rows.min(WANTED_ROWS) as f32);
            let map = map.min((rest.height() - requested).max(MIN_MAP * map));
            let (map, table) = rest.split_top_bottom_at_y(rest.top() + map);
            return Self { map, table, is_drawer: false };
        }
        let bar = spare.clamp(table::BAR, table::MAX_BAR);
        let map = rest.with_max_y(rest.bottom() - bar);
        let rows = if is_open { table::height(rows.clamp(1, 8) as f32) } else { 0.0 };
        let table = rest.with_min_y(map.bottom() - rows);
        Self { map, table, is_drawer: true }
    }
}

/// The largest map of the whole world in `rect`.
fn world_in(rect: Rect) -> Rect {
    let width = rect.width().min(2.0 * rect.height());
    Rect::from_center_size(pos2(rect.center().x, rect.center().y), vec2(width, width / 2.0))
}
