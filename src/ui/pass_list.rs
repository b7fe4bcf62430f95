//! The passes to come, one row each, with the pass in progress on top.

mod header;
mod phase;
mod row;
mod rows;
mod thumbnail;

#[cfg(test)]
mod tests;

use egui::{Rect, Ui, vec2};
use jiff::Timestamp;

use super::{text, theme, widgets::paint};
use crate::{astro::time::seconds_between, plan::Sample};

/// Width of the column with thumbnails.
pub const WIDTH: f32 = 320.0;
/// Width of the column without thumbnails.
pub const NARROW_WIDTH: f32 = 264.0;
/// The lowest maximum elevations that can be chosen, in degrees.
pub const FLOORS_DEG: [f64; 6] = [0.0, 5.0, 10.0, 20.0, 30.0, 45.0];

/// Names a pass: catalogue number of the satellite and time of AOS.
pub type PassKey = (u32, Timestamp);

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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict<'a> {
    /// All of the pass.
    Trackable,
    /// All but some of it: a sentence such as "Loses 12 s at keyhole N".
    Loses(&'a str),
    /// Nothing: a sentence such as "Not possible: stays below the travel".
    NotPossible(&'a str),
}

impl<'a> Verdict<'a> {
    /// The verdict in words.
    fn sentence(self) -> &'a str {
        match self {
            Self::Trackable => "Trackable",
            Self::Loses(sentence) | Self::NotPossible(sentence) => sentence,
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
    /// The selected pass.
    pub selected: Option<PassKey>,
    /// The lowest maximum elevation that is listed, degrees.
    pub floor_deg: f64,
    /// Rows have thumbnails.
    pub thumbnails: bool,
    /// The sentence shown when there are no rows.
    pub empty: &'a str,
}

/// What the column remembers from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PassListState {
    /// The pass that was selected when the rows were shown last.
    shown: Option<PassKey>,
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
}

/// What the operator did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PassListAction {
    /// A pass was selected.
    Select(PassKey),
    /// Another lowest maximum elevation was chosen, degrees.
    SetFloor(f64),
}

/// Shows the column in `rect`: its head and the rows, which scroll.
/// A pass that was selected elsewhere is scrolled to.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &PassListModel<'_>,
    state: &mut PassListState,
) -> Vec<PassListAction> {
    let mut actions = Vec::new();
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + header::HEIGHT);
    header::show(ui, head, model, &mut actions);
    if model.rows == 0 {
        nothing(ui, body, model.empty);
    } else {
        rows::show(ui, body, model, state.is_news(model.selected), &mut actions);
    }
    actions
}

fn nothing(ui: &Ui, rect: Rect, sentence: &str) {
    let room = rect.shrink2(vec2(16.0, 16.0));
    let colour = theme::tokens(ui).t2;
    let place = paint::paragraph(ui, room.min, room.width(), sentence, text::body(), colour);
    paint::name_text(ui, "no passes", place, sentence);
}
