//! The passes to come, one row each, with the pass in progress on top.

mod filter;
mod header;
mod phase;
mod row;
mod rows;
mod status;
mod thumbnail;

#[cfg(test)]
mod tests;

use std::borrow::Cow;

use egui::{Rect, Ui, vec2};
use jiff::Timestamp;

use super::{format, text, theme, widgets::paint};
use crate::{
    astro::time::seconds_between,
    engine::passes::{PassKey, Scope, Work},
    model::UiCommand,
    plan::{Loss, Sample},
};

pub use filter::Filter;

/// The lowest maximum elevations that can be chosen, in degrees.
pub const FLOORS_DEG: [f64; 6] = [0.0, 5.0, 10.0, 20.0, 30.0, 45.0];

/// One pass.
#[derive(Debug, Clone, Copy)]
pub struct PassRow<'a> {
    /// Names the pass as long as it is listed.
    pub key: PassKey,
    /// Name of the satellite.
    pub name: &'a str,
    /// When it rises, or the start of the list.
    pub aos: Timestamp,
    /// When it sets, or the end of the list.
    pub los: Timestamp,
    /// The satellite is up already where the list starts.
    pub starts_before: bool,
    /// The satellite is still up where the list ends.
    pub ends_after: bool,
    /// The highest elevation, degrees.
    pub max_elevation_deg: f64,
    /// Azimuth of AOS, degrees.
    pub aos_azimuth_deg: f64,
    /// Azimuth of LOS, degrees.
    pub los_azimuth_deg: f64,
    /// What the mount can follow; None while that is not known.
    pub verdict: Option<Verdict<'a>>,
    /// The way over the sky, oldest first.
    pub path: &'a [Sample],
}

/// What the mount can follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict<'a> {
    /// All of the pass.
    Trackable,
    /// All but some of it.
    Loses {
        /// How much, seconds.
        seconds: f64,
        /// Where that begins.
        at: Loss,
    },
    /// The mount follows, but the unit would miss by what it tells of itself.
    Misses,
    /// Nothing: a sentence such as "Not possible: stays below the travel".
    NotPossible(&'a str),
    /// Nothing for now: the unit is worked on.
    InMaintenance,
}

/// Where something is lost, such as "at keyhole N".
fn place(loss: Loss) -> Cow<'static, str> {
    match loss {
        Loss::Keyhole(azimuth) => {
            let towards = match azimuth.degrees().round() as i32 % 360 {
                0 => "N".into(),
                90 => "E".into(),
                180 => "S".into(),
                270 => "W".into(),
                _ => format::azimuth(azimuth.degrees()),
            };
            format!("at keyhole {towards}").into()
        }
        Loss::Overhead => "overhead".into(),
        Loss::Slew => "turning round".into(),
        Loss::OutOfReach => "out of reach".into(),
    }
}

impl<'a> Verdict<'a> {
    /// The verdict in words, such as "Loses 12 s at keyhole N".
    fn sentence(self) -> Cow<'a, str> {
        match self {
            Self::Trackable => "Trackable".into(),
            Self::Misses => "The unit would miss".into(),
            Self::NotPossible(sentence) => sentence.into(),
            Self::InMaintenance => "In maintenance".into(),
            Self::Loses { seconds, at } => {
                format!("Loses {} {}", format::age(seconds.ceil()), place(at)).into()
            }
        }
    }
}

/// What the column shows.
#[derive(Clone, Copy)]
pub struct PassListModel<'a> {
    /// The time.
    pub now: Timestamp,
    /// How many passes there are.
    pub rows: usize,
    /// The pass at an index. Asked for only where a row is in view.
    pub row: &'a dyn Fn(usize) -> Option<PassRow<'a>>,
    /// The place of a pass in the list, quickly.
    pub place: &'a dyn Fn(PassKey) -> Option<usize>,
    /// The selected pass.
    pub selected: Option<PassKey>,
    /// Whose passes are listed.
    pub scope: Scope,
    /// How far ahead, hours.
    pub span_h: u32,
    /// The lowest maximum elevation that is listed, degrees.
    pub floor_deg: f64,
    /// What is being done for the list.
    pub work: Work,
    /// How many satellites the list was made of, and when; None before the first.
    pub made: Option<(usize, Timestamp)>,
    /// Rows have thumbnails.
    pub thumbnails: bool,
    /// The sentence shown when there are no rows.
    pub empty: &'a str,
}

/// What the column remembers from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PassListState {
    /// What the operator looks for in the list.
    pub filter: Filter,
    /// The pass that was selected when the rows were shown last.
    shown: Option<PassKey>,
    /// How far the rows were scrolled down, points.
    offset: f32,
    /// The row at the upper edge and its pass.
    top: Option<(usize, PassKey)>,
}

impl PassListState {
    /// Whether another pass is selected than in the last frame. A new list has
    /// the same pass with an AOS that differs by a little.
    fn is_news(&mut self, selected: Option<PassKey>) -> bool {
        let before = std::mem::replace(&mut self.shown, selected);
        match (before, selected) {
            (Some((old, then)), Some((new, at))) => {
                old != new || seconds_between(then, at).abs() > 60.0
            }
            (None, Some(_)) => true,
            (_, None) => false,
        }
    }

    /// How many rows above the one at the upper edge have gone since the last
    /// frame; negative when some were added. What the operator reads stays
    /// where it is when passes end; at the very top the list moves up.
    fn rows_gone_above(&self, model: &PassListModel<'_>) -> f32 {
        let Some((before, key)) = self.top.filter(|_| self.offset > 0.0) else { return 0.0 };
        (model.place)(key).map_or(0.0, |place| before as f32 - place as f32)
    }

    fn remember(&mut self, offset: f32, row_height: f32, model: &PassListModel<'_>) {
        let row = (offset / row_height) as usize;
        self.offset = offset;
        self.top = (model.row)(row).map(|pass| (row, pass.key));
    }
}

/// Shows the column in `rect`: its head and the rows, which scroll.
/// A pass that was selected elsewhere is scrolled to.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
) -> Vec<UiCommand> {
    let mut commands = Vec::new();
    let (head, mut body) = rect.split_top_bottom_at_y(rect.top() + header::HEIGHT);
    header::show(ui, head, model, &mut state.filter, &mut commands);
    // Those few that the operator follows are found before anyone could look.
    if model.scope == Scope::All {
        let (strip, rest) = body.split_top_bottom_at_y(body.top() + status::HEIGHT);
        status::show(ui, strip, model, &mut commands);
        body = rest;
    }
    if state.filter.is_open {
        let (strip, rest) = body.split_top_bottom_at_y(body.top() + filter::HEIGHT);
        filter::show(ui, strip, &mut state.filter);
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
