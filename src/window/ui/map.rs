//! Map view: the satellites over the globe, a table of their positions, and details of the selected
//! one.

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

/// Max height of the bar below the map, points.
pub(super) const FOOT: f32 = table::MAX_BAR;
/// Window width below which the inspector is a drawer, points.
const DRAWER_BELOW: f32 = 1100.0;
const INSPECTOR: f32 = 344.0;
const PADDING: f32 = 16.0;
/// Min number of rows of a table below the map; with less room the table is a drawer.
const ROWS: f32 = 3.0;
/// Number of rows for which the map shrinks, down to [`MIN_MAP`] of its height.
const WANTED_ROWS: usize = 8;
const MIN_MAP: f32 = 0.85;

/// Choice of the layers that the map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
// The layers are independent check boxes.
#[allow(clippy::struct_excessive_bools)]
pub struct MapLayers {
    /// Ground track of the selected satellite.
    pub tracks: bool,
    /// Ground tracks of the other satellites.
    pub other_tracks: bool,
    /// Areas from which each satellite is visible.
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

/// Satellites on the map, besides the selected one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Shown {
    #[default]
    Favourites,
    Tracked,
}

impl Shown {
    /// Returns `true` if the map shows the satellite: the selected one, or one of the chosen kind.
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

/// Layers, section of the map, open drawers, and cached shapes.
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
    /// Zooms in or out around the middle of the map.
    pub fn change_zoom(&mut self, is_closer: bool) {
        self.zoom.step(is_closer);
    }

    /// Shows the whole world again.
    pub fn reset_zoom(&mut self) {
        self.zoom = Zoom::default();
    }

    /// Requests that the bar opens or closes the list of layers.
    pub fn toggle_layers(&mut self) {
        self.layers_key = true;
    }

    /// Returns the next shown satellite on that side of the selected one.
    pub fn nearest(&self, model: &Model, direction: MapDirection) -> Option<u32> {
        model.globe.nearest(direction, |satellite| self.shown.has(satellite))
    }
}

/// Draws the view. The inspector stands beside the map if `window` is wide enough.
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
    // A drawer above the map takes the pointer.
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

/// Parts below the view bar.
struct Areas {
    map: Rect,
    table: Rect,
    /// Flag: the table lies over the map and opens from its bar.
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

/// Returns the largest map of the whole world that fits in `rect`.
fn world_in(rect: Rect) -> Rect {
    let width = rect.width().min(2.0 * rect.height());
    Rect::from_center_size(pos2(rect.center().x, rect.center().y), vec2(width, width / 2.0))
}
