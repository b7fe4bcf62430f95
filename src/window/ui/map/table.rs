//! Table of the satellites' positions, below the map or as a drawer over it.

use std::borrow::Cow;

use egui::{Align2, Color32, FontId, Rect, Role, Ui, pos2, vec2};

use super::{MapState, PADDING, Shown, legend, nodes, words};
use crate::{
    contract::CatalogState,
    model::{DistanceUnit, Model, UiCommand, globe::GlobeSatellite},
    ui::{
        format,
        icons::{self, Icon},
        text::{self, Weight},
        theme,
        tokens::Tokens,
        widgets::{list::List, paint},
    },
};

/// Height of the bar with the title and the legend, points.
pub(super) const BAR: f32 = 32.0;
/// Max height of the bar while the table is folded, points.
pub(super) const MAX_BAR: f32 = 48.0;
const HEAD: f32 = 22.0;
const ROW: f32 = 25.0;
/// Min width of a table with all columns, points.
const ALL_FROM: f32 = 900.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Satellite,
    Latitude,
    Longitude,
    Height,
    Azimuth,
    Elevation,
    Range,
    Goes,
    Next,
    Max,
    Light,
}

impl Column {
    /// All columns, each with its left end, or its right end for numbers, in a table of 1024
    /// points.
    const ALL: (&[(Self, f32)], f32) = (
        &[
            (Self::Satellite, PADDING),
            (Self::Latitude, 208.0),
            (Self::Longitude, 300.0),
            (Self::Height, 384.0),
            (Self::Azimuth, 464.0),
            (Self::Elevation, 548.0),
            (Self::Range, 626.0),
            (Self::Goes, 644.0),
            (Self::Next, 808.0),
            (Self::Max, 876.0),
            (Self::Light, 900.0),
        ],
        1024.0,
    );
    /// Columns of a narrow table, in a table of 632 points.
    const FEWER: (&[(Self, f32)], f32) = (
        &[
            (Self::Satellite, PADDING),
            (Self::Latitude, 178.0),
            (Self::Longitude, 252.0),
            (Self::Azimuth, 314.0),
            (Self::Elevation, 380.0),
            (Self::Next, 504.0),
            (Self::Max, 552.0),
            (Self::Light, 568.0),
        ],
        632.0,
    );

    fn is_left(self) -> bool {
        matches!(self, Self::Satellite | Self::Goes | Self::Light)
    }

    fn head(self, unit: DistanceUnit) -> Cow<'static, str> {
        let in_unit = |name: &str| Cow::from(format!("{name} {}", format::distance_unit(unit)));
        let words = match self {
            Self::Satellite => "Satellite",
            Self::Latitude => "Latitude",
            Self::Longitude => "Longitude",
            Self::Height => return in_unit("Height"),
            Self::Azimuth => "Azimuth",
            Self::Elevation => "Elevation",
            Self::Range => return in_unit("Range"),
            Self::Goes => "Heading",
            Self::Next => "Next here",
            Self::Max => "Max el",
            Self::Light => "Light",
        };
        words.into()
    }

    fn cell(self, satellite: &GlobeSatellite, model: &Model) -> String {
        let direction = satellite.look.direction;
        let distance = |km| format::distance_number(km, 0, model.appearance.distances);
        let max = satellite.next.map(|next| format::degrees(next.max_elevation.degrees(), 0));
        match self {
            Self::Satellite => satellite.satellite.short_name().to_owned(),
            Self::Latitude => words::latitude(satellite.below.point),
            Self::Longitude => words::longitude(satellite.below.point),
            Self::Height => distance(satellite.below.height_km),
            Self::Azimuth => format::azimuth(direction.azimuth_deg()),
            Self::Elevation => format::degrees(direction.elevation_deg(), 1),
            Self::Range if direction.elevation_deg() >= 0.0 => distance(satellite.look.range_km),
            Self::Range => "–".to_owned(),
            Self::Goes => words::goes(satellite.heading).to_owned(),
            Self::Next => words::next(satellite, model),
            Self::Max => max.unwrap_or_else(|| "–".to_owned()),
            Self::Light => words::light(satellite.is_sunlit).to_owned(),
        }
    }

    fn look(self, satellite: &GlobeSatellite, model: &Model, t: &Tokens) -> (FontId, Color32) {
        let is_above = satellite.look.direction.elevation_deg() >= 0.0;
        let small = text::small();
        match self {
            Self::Satellite => (text::sized(13.0, Weight::SemiBold), t.t1),
            Self::Elevation if satellite.is_up => (text::small_strong(), t.ok),
            Self::Azimuth | Self::Elevation | Self::Range if !is_above => (small, t.t3),
            Self::Goes => (small, t.t2),
            Self::Next if satellite.next.is_none() => (small, t.t3),
            Self::Next if satellite.next.is_some_and(|next| next.aos <= model.now) => {
                (small, t.sat)
            }
            Self::Light if satellite.is_sunlit => (small, t.sun),
            Self::Light => (small, t.t3),
            _ => (small, t.t1),
        }
    }
}

/// Returns the height of the table with this number of rows, without its bar, points.
pub(super) fn height(rows: f32) -> f32 {
    HEAD + rows * ROW
}

/// Draws the table; returns `true` when the operator opens or closes its drawer.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    shown: &[&GlobeSatellite],
    is_drawer: bool,
    state: &mut MapState,
    commands: &mut Vec<UiCommand>,
) -> bool {
    let t = theme::tokens(ui);
    let is_open = !is_drawer || state.table_is_open;
    let rows = if is_open { HEAD + ROW } else { 0.0 };
    let bar = if is_drawer { (rect.height() - rows).clamp(BAR, MAX_BAR) } else { BAR };
    let bar = if is_open { BAR } else { bar };
    let (top, rest) = rect.split_top_bottom_at_y(rect.top() + bar);
    ui.painter().rect_filled(rect, 0.0, t.field);
    ui.painter().rect_filled(top, 0.0, t.bg2);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let (end, is_toggled) = title(ui, top, is_drawer, is_open);
    let room = top.with_min_x(end + 24.0).with_max_x(top.right() - PADDING);
    legend::show(ui, room, model, state.layers);
    if is_open {
        let (head, body) = rest.split_top_bottom_at_y(rest.top() + HEAD);
        show_head(ui, head, model.appearance.distances);
        show_rows(ui, body, model, shown, state, commands);
    }
    is_toggled
}

/// Draws the title, which is the button of a drawer. Returns its right end, and `true` after a
/// click.
fn title(ui: &Ui, bar: Rect, is_drawer: bool, is_open: bool) -> (f32, bool) {
    const WORDS: &str = "Where they are";
    let t = theme::tokens(ui);
    let room = bar.shrink2(vec2(PADDING, 0.0));
    let font = text::sized(13.0, Weight::SemiBold);
    if !is_drawer {
        let place = paint::text_in(ui, room, Align2::LEFT_CENTER, WORDS, font, t.t1);
        return (place.right(), false);
    }
    let width = paint::text_width(ui, WORDS, font.clone()) + 20.0;
    let place = Rect::from_center_size(
        pos2(room.left() + width / 2.0, bar.center().y),
        vec2(width + 8.0, 24.0),
    );
    let response = paint::control(ui, "map table", place, Role::Button, true, WORDS);
    if response.hovered() {
        ui.painter().rect_filled(place, 4.0, t.bg3);
    }
    let icon = if is_open { Icon::ChevronDown } else { Icon::ChevronRight };
    let position = pos2(room.left() + 6.0, bar.center().y);
    icons::paint(ui.painter(), paint::square(position, 12.0), icon, t.t1);
    let words = room.with_min_x(room.left() + 18.0);
    paint::text_in(ui, words, Align2::LEFT_CENTER, WORDS, font, t.t1);
    paint::focus_ring(ui, &response, 4);
    (place.right(), response.clicked())
}

/// Returns the shown columns with their rectangles, which scale with the table.
fn columns(row: Rect) -> impl Iterator<Item = (Column, Rect)> {
    let (columns, laid_out) = if row.width() < ALL_FROM { Column::FEWER } else { Column::ALL };
    let scale = row.width() / laid_out;
    columns.iter().map(move |(column, end)| {
        let x = row.left() + end * scale;
        let place = match column {
            Column::Satellite => {
                let left = row.left() + PADDING;
                row.with_min_x(left).with_max_x(left + 108.0 * scale)
            }
            _ if column.is_left() => row.with_min_x(x).with_max_x((x + 96.0).min(row.right())),
            _ => row.with_min_x(x - 108.0).with_max_x(x),
        };
        (*column, place)
    })
}

fn show_head(ui: &Ui, rect: Rect, unit: DistanceUnit) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, (1.0, t.line));
    for (column, place) in columns(rect) {
        let words = column.head(unit);
        let anchor = if column.is_left() { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
        // The arrow marks the column by which the rows are sorted.
        let (font, colour) = if column == Column::Elevation {
            let position = pos2(place.right() + 9.0, rect.center().y);
            icons::paint(ui.painter(), paint::square(position, 10.0), Icon::ChevronDown, t.t2);
            (text::sized(11.0, Weight::SemiBold), t.t1)
        } else {
            (text::caption(), t.t3)
        };
        paint::text_in(ui, place, anchor, &words, font, colour);
    }
}

fn show_rows(
    ui: &mut Ui,
    body: Rect,
    model: &Model,
    shown: &[&GlobeSatellite],
    state: &mut MapState,
    commands: &mut Vec<UiCommand>,
) {
    let list = List::new(ui, body, "where they are", "Where they are", ROW);
    if shown.is_empty() {
        return list.show_empty(ui, "no satellites", why_empty(model, state.shown));
    }
    let mut scroll = state.scroll;
    list.show_rows(ui, shown.len(), &mut scroll, |ui, place, index| {
        if let Some(satellite) = shown.get(index) {
            show_row(ui, &list, place, satellite, model, commands);
        }
    });
    state.scroll = scroll;
}

fn why_empty(model: &Model, choice: Shown) -> &'static str {
    match (&model.catalog, choice) {
        (CatalogState::Loading, _) => "The elements are being read.",
        (CatalogState::Failed, _) => "No elements: they could not be read. See the alarms.",
        (CatalogState::Ready(_), Shown::Favourites) => {
            "No satellite is shown. Choose favourites in Elements."
        }
        (CatalogState::Ready(_), Shown::Tracked) => "No antenna tracks a satellite.",
    }
}

fn show_row(
    ui: &Ui,
    list: &List,
    rect: Rect,
    satellite: &GlobeSatellite,
    model: &Model,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let spoken = || spoken(satellite, model);
    let clear = Color32::TRANSPARENT;
    let response = list.option(ui, rect, satellite.number(), satellite.is_selected, clear, spoken);
    for (column, place) in columns(rect) {
        let anchor = if column.is_left() { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
        let (font, colour) = column.look(satellite, model, t);
        let paint = match column {
            Column::Satellite => paint::name_in,
            _ => paint::text_in,
        };
        paint(ui, place, anchor, &column.cell(satellite, model), font, colour);
    }
    nodes::chosen(&response, satellite, commands);
}

/// Returns the row as text for screen readers.
fn spoken(satellite: &GlobeSatellite, model: &Model) -> String {
    let cell = |column: Column| column.cell(satellite, model);
    format!(
        "{}, {}, {}, height {} {}, azimuth {}, elevation {}, {}, next {}, {}",
        cell(Column::Satellite),
        cell(Column::Latitude),
        cell(Column::Longitude),
        cell(Column::Height),
        format::distance_unit(model.appearance.distances),
        cell(Column::Azimuth),
        cell(Column::Elevation),
        words::motion(satellite.heading),
        cell(Column::Next),
        cell(Column::Light),
    )
}
