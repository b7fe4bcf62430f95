//! The list of passes, one row each, with the pass in progress on top.

mod arrangement;
mod filter;
mod header;
mod phase;
mod row;
mod rows;
mod short_row;
mod status;
mod thumbnail;
mod verdict;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use egui::{Rect, Ui, vec2};
use jiff::Timestamp;

use super::{menus::PassMenu, text, theme, widgets::paint};
use crate::{
    astro::time::seconds_between,
    contract::passes::{PassListKey, Scope, Work},
    model::UiCommand,
    plan::Sample,
    ui::widgets::list::Scroll,
};
pub use arrangement::{Arrangement, Light, Order};
pub use filter::Filter;
pub use short_row::{SHORT_ROW, short_row};
pub use verdict::{LeftOut, Verdict};

/// Selectable elevation floors.
pub const FLOORS_DEG: [f64; 8] = [0.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0];

#[derive(Debug, Clone, Copy)]
pub struct PassRow<'a> {
    /// Identifies the pass while it is listed.
    pub key: PassListKey,
    pub name: &'a str,
    /// AOS, or the start of the list.
    pub aos: Timestamp,
    /// LOS, or the end of the list.
    pub los: Timestamp,
    /// The satellite is up already at the start of the list.
    pub starts_before: bool,
    /// The satellite is still up at the end of the list.
    pub ends_after: bool,
    pub max_elevation_deg: f64,
    pub aos_azimuth_deg: f64,
    pub los_azimuth_deg: f64,
    /// Trackability; `None` while unknown.
    pub verdict: Option<Verdict<'a>>,
    /// Seconds above the horizon mask; `None` where it cuts nothing off.
    pub clear_s: Option<f64>,
    /// The path over the sky, oldest first.
    pub path: &'a [Sample],
}

/// Content of the column.
#[derive(Clone, Copy)]
pub struct PassListModel<'a> {
    pub now: Timestamp,
    /// Number of passes.
    pub rows: usize,
    /// Number of rows at the top whose passes have begun.
    pub begun: usize,
    /// Number of passes without filters.
    pub total: usize,
    /// Names of the groups of the catalogue.
    pub groups: &'a [&'a str],
    /// The pass at an index. Called only for rows in view.
    pub row: &'a dyn Fn(usize) -> Option<PassRow<'a>>,
    /// The index of a pass in the list; must be fast.
    pub place: &'a dyn Fn(PassListKey) -> Option<usize>,
    /// The keys of all rows.
    pub keys: &'a dyn Fn() -> Arc<[PassListKey]>,
    pub selected: Option<PassListKey>,
    /// The satellites whose passes are listed.
    pub scope: Scope,
    /// Span of the list.
    pub span_h: u32,
    /// Elevation of AOS and LOS.
    pub aos_elevation_deg: f64,
    /// The elevation floor.
    pub floor_deg: f64,
    /// State of the search for the list.
    pub work: Work,
    /// Number of satellites searched, and time of the search; `None` before the first search.
    pub made: Option<(usize, Timestamp)>,
    /// Why the station and its list of satellites may not be changed, nor a file be saved.
    pub lock: Option<&'static str>,
    /// Rows have thumbnails.
    pub thumbnails: bool,
    /// The sentence shown when there are no rows.
    pub empty: &'a str,
    /// Shows the entries of a pass in the menu of the row with this id.
    pub menu: &'a PassMenu<'a>,
}

/// State of the column, kept from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PassListState {
    pub filter: Filter,
    /// The selected pass in the last frame.
    shown: Option<PassListKey>,
    scroll: Scroll,
    /// The row at the upper edge and its pass.
    top: Option<(usize, PassListKey)>,
    /// The list of the last frame with rows, and what it was filtered by.
    listed: Option<(Scope, String, Arrangement)>,
}

impl PassListState {
    /// Returns `true` if the selection has changed since the last frame. In a new list the AOS of
    /// the same pass may differ slightly.
    fn is_news(&mut self, selected: Option<PassListKey>) -> bool {
        let before = std::mem::replace(&mut self.shown, selected);
        match (before, selected) {
            (Some((old, time)), Some((new, moment))) => {
                old != new || seconds_between(time, moment).abs() > 60.0
            }
            (None, Some(_)) => true,
            (_, None) => false,
        }
    }

    /// The row at which a list opens that was not there in the last frame, or was filtered in another
    /// way. In the list of all satellites hundreds of passes have begun, the first of them hours ago.
    fn opens_at(&mut self, model: &PassListModel<'_>) -> Option<usize> {
        let (text, arrangement) = (self.filter.text(), &self.filter.arrangement);
        let is_same = |(scope, before, arranged): &(Scope, String, Arrangement)| {
            (*scope, before.as_str(), arranged) == (model.scope, text, arrangement)
        };
        let is_new = !self.listed.as_ref().is_some_and(is_same);
        if is_new {
            self.listed = Some((model.scope, text.to_owned(), arrangement.clone()));
        }
        is_new.then_some(match model.scope {
            Scope::Favourites => 0,
            Scope::All => model.begun.saturating_sub(BEGUN_SHOWN),
        })
    }

    /// Number of rows above the upper edge that have gone since the last frame; negative if rows
    /// were added. Keeps the visible rows in place when passes end; at the very top the list
    /// moves up.
    fn rows_gone_above(&self, model: &PassListModel<'_>) -> f32 {
        let Some((before, key)) = self.top.filter(|_| self.scroll.offset > 0.0) else { return 0.0 };
        (model.place)(key).map_or(0.0, |place| before as f32 - place as f32)
    }

    fn remember(&mut self, scroll: Scroll, row_height: f32, model: &PassListModel<'_>) {
        let row = (scroll.offset / row_height) as usize;
        self.scroll = scroll;
        self.top = (model.row)(row).map(|pass| (row, pass.key));
    }
}

/// Rows with passes that have begun, above the first that has not, where a long list opens.
const BEGUN_SHOWN: usize = 2;

/// Shows the column in `rect`: its head and the scrolling rows.
/// Scrolls to a pass that was selected elsewhere.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
) -> Vec<UiCommand> {
    let mut commands = Vec::new();
    let (head, mut body) = rect.split_top_bottom_at_y(rect.top() + header::HEIGHT);
    header::show(ui, head, model, &mut state.filter, &mut commands);
    // The search for the few favourites is over before anyone could read a status.
    if model.scope == Scope::All {
        let (strip, rest) = body.split_top_bottom_at_y(body.top() + status::HEIGHT);
        status::show(ui, strip, model, &mut commands);
        body = rest;
    }
    let height = filter::height(ui, body, &state.filter);
    if height > 0.0 {
        let (strip, rest) = body.split_top_bottom_at_y(body.top() + height);
        filter::show(ui, strip, model, &mut state.filter);
        body = rest;
    }
    if model.rows == 0 {
        nothing(ui, body, model.empty);
    } else {
        rows::show(ui, body, model, state, &mut commands);
    }
    commands
}

fn nothing(ui: &Ui, rect: Rect, sentence: &str) {
    let room = rect.shrink2(vec2(16.0, 16.0));
    let colour = theme::tokens(ui).t2;
    let place = paint::paragraph(ui, room.min, room.width(), sentence, text::body(), colour);
    paint::name_text(ui, "no passes", place, sentence);
}
