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

/// Elevation floors to choose from, degrees.
pub const FLOORS_DEG: [f64; 8] = [0.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0];

#[derive(Debug, Clone, Copy)]
pub struct PassRow<'a> {
    /// Key of the pass while the list contains it.
    pub key: PassListKey,
    pub name: &'a str,
    /// AOS, or the start of the list.
    pub aos: Timestamp,
    /// LOS, or the end of the list.
    pub los: Timestamp,
    /// `true` if the satellite is already up at the start of the list.
    pub starts_before: bool,
    /// `true` if the satellite is still up at the end of the list.
    pub ends_after: bool,
    pub max_elevation_deg: f64,
    pub aos_azimuth_deg: f64,
    pub los_azimuth_deg: f64,
    /// Trackability; `None` while unknown.
    pub verdict: Option<Verdict<'a>>,
    /// Time above the horizon mask, seconds; `None` if the mask cuts nothing off.
    pub clear_s: Option<f64>,
    /// Path over the sky, oldest sample first.
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
    /// Function that returns the pass at an index; the list calls it only for rows in view.
    pub row: &'a dyn Fn(usize) -> Option<PassRow<'a>>,
    /// Function that returns the index of a pass in the list; it must be fast.
    pub place: &'a dyn Fn(PassListKey) -> Option<usize>,
    /// Function that returns the keys of all rows.
    pub keys: &'a dyn Fn() -> Arc<[PassListKey]>,
    pub selected: Option<PassListKey>,
    /// Satellites whose passes the list shows.
    pub scope: Scope,
    /// Span of the list, hours.
    pub span_h: u32,
    /// Elevation of AOS and LOS, degrees.
    pub aos_elevation_deg: f64,
    /// Elevation floor, degrees.
    pub floor_deg: f64,
    /// State of the search for the list.
    pub work: Work,
    /// Number of satellites searched and time of the search; `None` before the first search.
    pub made: Option<(usize, Timestamp)>,
    /// Reason why the operator may not change the station or its list of satellites, nor save a
    /// file.
    pub lock: Option<&'static str>,
    /// `true` if rows have thumbnails.
    pub thumbnails: bool,
    /// Sentence for a list without rows.
    pub empty: &'a str,
    /// Function that shows the menu entries of a pass for the row with this id.
    pub menu: &'a PassMenu<'a>,
}

/// State of the column, kept from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PassListState {
    pub filter: Filter,
    /// The selected pass in the last frame.
    shown: Option<PassListKey>,
    scroll: Scroll,
    /// The row at the upper edge, and its pass.
    top: Option<(usize, PassListKey)>,
    /// Scope, text and filters of the last frame with rows.
    listed: Option<(Scope, String, Arrangement)>,
}

impl PassListState {
    /// Returns `true` if the selection has changed since the last frame. The AOS of the same pass
    /// may differ slightly in a new list.
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

    /// Returns the first visible row of a new or newly filtered list. In the list of all satellites
    /// hundreds of passes have begun, the first of them hours ago.
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

    /// Returns the number of rows above the upper edge that are gone since the last frame; negative
    /// if rows were added. This number keeps the visible rows in place when passes end; at the very
    /// top the list moves up.
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

/// Number of rows with begun passes at the top of a long list when it opens.
const BEGUN_SHOWN: usize = 2;

/// Shows the column in `rect`: its head and the scrolling rows. Scrolls to a pass that was selected
/// in another view.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
) -> Vec<UiCommand> {
    let mut commands = Vec::new();
    let (head, mut body) = rect.split_top_bottom_at_y(rect.top() + header::HEIGHT);
    header::show(ui, head, model, &mut state.filter, &mut commands);
    // The search for the few favourites ends before anyone could read a status.
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
