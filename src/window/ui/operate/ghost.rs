//! Direction that the operator looks at before the antenna moves there: clicked in the sky, or
//! typed. The session checks the path; nothing moves until the operator requests it.

use std::fmt::Write as _;

use egui::{Key, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use super::{OperateState, card::Locks};
use crate::{
    astro::{Angle, AzEl},
    contract::{
        antenna::AntennaModel,
        driver::{Command, Preview, StopState},
    },
    device::Pointing,
    model::{Model, UiCommand},
    station::AntennaId,
    ui::{
        format, replay,
        sky_plot::Ghost,
        state_sentence::short,
        text, theme,
        widgets::{
            button::{Button, SMALL_HEIGHT},
            go_to::Target,
        },
        words,
    },
};

/// Width and spacing of the note, points.
const WIDTH: f32 = 248.0;
const PADDING: f32 = 10.0;
const GAP: f32 = 6.0;
/// Distance of the note from the ghost, points.
const MARGIN: f32 = 18.0;

/// Clicked direction, and the path that the session is to judge.
#[derive(Debug, Clone, Default)]
pub(super) struct GhostState {
    clicked: Option<Target>,
    wants_focus: bool,
    /// The direction in the fields in the last frame.
    typed: Option<Target>,
    requested: Option<(AntennaId, Pointing)>,
}

impl GhostState {
    /// Looks at a direction of the sky with `antenna`.
    pub(super) fn look_at(&mut self, direction: AzEl, antenna: &AntennaModel) {
        let tenths = |deg: f64| (deg * 10.0).round() / 10.0;
        let has_elevation = antenna.variant().capabilities.has_elevation();
        self.clicked = Some(Target {
            azimuth_deg: tenths(direction.azimuth.wrapped_360().degrees()) % 360.0,
            elevation_deg: has_elevation.then(|| tenths(direction.elevation_deg())),
        });
        self.wants_focus = true;
    }

    pub(super) fn forget_click(&mut self) {
        self.clicked = None;
    }

    /// Returns the direction that the operator looks at: a click takes precedence over the fields.
    pub(super) fn target(&self) -> Option<Target> {
        self.clicked.or(self.typed)
    }

    /// Ends the session's check and drops the clicked direction.
    pub(super) fn leave(&mut self, commands: &mut Vec<UiCommand>) {
        self.clicked = None;
        if let Some((antenna, _)) = self.requested.take() {
            commands.push(UiCommand::antenna(antenna, Command::Preview(None)));
        }
    }
}

fn pointing(target: Target) -> Pointing {
    Pointing {
        azimuth: Some(Angle::from_degrees(target.azimuth_deg)),
        elevation: target.elevation_deg.map(Angle::from_degrees),
    }
}

/// Takes the typed direction, drops the ghost at a STOP, and asks the session about a new ghost.
pub(super) fn keep(
    ui: &Ui,
    model: &Model,
    state: &mut OperateState,
    commands: &mut Vec<UiCommand>,
) {
    let antenna = model.antenna();
    let stops = antenna.is_some_and(|model_antenna| {
        matches!(model_antenna.snapshot.stop, StopState::Stopping { .. })
    });
    if stops || ui.input(|input| input.key_pressed(Key::Escape)) {
        state.ghost.clicked = None;
        state.card.drive.go_to.leave_typed();
    }
    let typed = state.card.drive.go_to.typed();
    let ghost = &mut state.ghost;
    if typed.is_some() && typed != ghost.typed {
        ghost.clicked = None;
    }
    ghost.typed = typed;
    let can_be_judged = |model_antenna: &&AntennaModel| {
        model_antenna.snapshot.link.is_open() && model_antenna.held_by.is_none()
    };
    let requested = antenna
        .filter(can_be_judged)
        .and_then(|antenna| Some((antenna.id(), pointing(ghost.target()?))));
    if requested == ghost.requested {
        return;
    }
    let is_same = |id: AntennaId| requested.is_some_and(|(antenna_id, _)| antenna_id == id);
    if let Some((before, _)) = ghost.requested.filter(|(id, _)| !is_same(*id)) {
        commands.push(UiCommand::antenna(before, Command::Preview(None)));
    }
    commands.extend(
        requested.map(|(id, target)| UiCommand::antenna(id, Command::Preview(Some(target)))),
    );
    ghost.requested = requested;
}

/// Returns the result of the session's check of the path to `target`.
fn judged(antenna: &AntennaModel, target: Target) -> Option<&Preview> {
    antenna.snapshot.preview.as_deref().filter(|preview| preview.target == pointing(target))
}

/// Returns the ghost for the plot; `None` if its elevation is unknown.
pub(super) fn shown<'a>(antenna: &'a AntennaModel, state: &OperateState) -> Option<Ghost<'a>> {
    let target = state.ghost.target()?;
    let measured = antenna.snapshot.state.measured.and_then(|measured| measured.direction());
    let elevation_deg = target.elevation_deg.or(measured.map(AzEl::elevation_deg))?;
    let way = judged(antenna, target).map(|preview| &preview.way);
    Some(Ghost {
        end: AzEl::from_degrees(target.azimuth_deg, elevation_deg),
        way: way.and_then(|way| way.as_ref().ok()).map_or(&[], |way| &way.path),
        is_refused: way.is_some_and(Result::is_err),
    })
}

/// Returns the sentence of the note, and `true` if Azel can send the antenna there.
fn found(model: &Model, antenna: &AntennaModel, target: Target) -> (String, bool) {
    let in_replay = replay::locked(&antenna.config.name);
    if let Some(lock) = Locks::new(model, antenna, &in_replay).track {
        return (lock.to_owned(), false);
    }
    let way = match judged(antenna, target).map(|preview| &preview.way) {
        None => return ("The path is being checked.".to_owned(), false),
        Some(Err(refusal)) => return (words::not_possible(refusal, model.now), false),
        Some(Ok(way)) => way,
    };
    let mut spoken = match way.arrives_s {
        Some(seconds) => format!("Arrives in about {}.", format::duration(seconds.ceil())),
        None => "How long it takes is not known.".to_owned(),
    };
    spoken += if way.is_round_a_corner {
        " The axes move one after the other, to stay clear of forbidden directions."
    } else {
        " The path is clear."
    };
    if let Some(tracked) = antenna.tracked_name() {
        // Writing to a string cannot fail.
        let _ = write!(spoken, " It ends the track of {}.", short(tracked));
    }
    (spoken, true)
}

/// Shows the note beside the ghost at `position`. The operator confirms a clicked direction in the
/// note.
pub(super) fn note(
    ui: &mut Ui,
    plot: Rect,
    position: Pos2,
    model: &Model,
    state: &mut OperateState,
    commands: &mut Vec<UiCommand>,
) {
    let (Some(target), Some(antenna)) = (state.ghost.target(), model.antenna()) else { return };
    let is_clicked = state.ghost.clicked.is_some();
    let t = theme::tokens(ui);
    let can = antenna.variant().capabilities;
    let head = format!("{} to {}", antenna.config.name, format::pointing(pointing(target), can));
    let (text, is_possible) = found(model, antenna, target);
    let width = WIDTH - 2.0 * PADDING;
    let layout =
        |words: &str, font, colour| ui.painter().layout(words.to_owned(), font, colour, width);
    let title = layout(&head, text::small_strong(), t.t1);
    let sentence = layout(&text, text::small(), if is_possible { t.t2 } else { t.warn });
    let buttons = if is_clicked { SMALL_HEIGHT + GAP } else { 0.0 };
    let height = 2.0 * PADDING + title.size().y + GAP + sentence.size().y + buttons;
    let place = beside_point(plot.shrink(8.0), position, vec2(WIDTH, height));

    // The note keeps clicks off the sky below.
    let response = ui.interact(place, ui.make_persistent_id("ghost note"), Sense::click());
    let spoken = format!("{head}. {text}");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let edge = if is_possible { t.cmd } else { t.warn };
    ui.painter().rect(place, 6.0, t.bg2, Stroke::new(1.0, edge), StrokeKind::Inside);
    let top_left = place.min + vec2(PADDING, PADDING);
    let below = top_left + vec2(0.0, title.size().y + GAP);
    ui.painter().galley(top_left, title, t.t1);
    ui.painter().galley(below, sentence, t.t2);
    if !is_clicked {
        return;
    }
    let row = Rect::from_min_max(
        pos2(top_left.x, place.bottom() - PADDING - SMALL_HEIGHT),
        place.max - vec2(PADDING, PADDING),
    );
    let go = Button::primary("Point here").locked(!is_possible);
    let go_place = row.with_max_x(row.left() + go.width(ui));
    let drop = Button::normal("Drop");
    let drop_place = row.with_min_x(go_place.right() + GAP);
    let drop_place = drop_place.with_max_x(drop_place.left() + drop.width(ui));
    let go = go.show(ui, "point here", go_place);
    let drop = drop.show(ui, "drop ghost", drop_place);
    if is_possible && std::mem::take(&mut state.ghost.wants_focus) {
        go.request_focus();
    }
    if drop.clicked() {
        state.ghost.clicked = None;
    }
    if go.clicked() {
        let Pointing { azimuth, elevation } = pointing(target);
        commands.push(UiCommand::antenna(antenna.id(), Command::Position { azimuth, elevation }));
        state.ghost.clicked = None;
    }
}

/// Returns the place of a note of `size` beside `position`: the first of four places that has room
/// in `plot`.
fn beside_point(plot: Rect, position: Pos2, size: egui::Vec2) -> Rect {
    let outward = vec2(MARGIN, MARGIN);
    let places = [
        Rect::from_min_size(position + outward, size),
        Rect::from_min_size(pos2(position.x - outward.x - size.x, position.y + outward.y), size),
        Rect::from_min_size(pos2(position.x + outward.x, position.y - outward.y - size.y), size),
        Rect::from_min_size(position - outward - size, size),
    ];
    let [first, ..] = places;
    let inner = places.into_iter().find(|place| plot.contains_rect(*place));
    inner.unwrap_or_else(|| {
        let min = first.min.min(plot.max - size).max(plot.min);
        Rect::from_min_size(min, size)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_note_stays_in_the_plot_and_beside_the_ghost() {
        let plot = Rect::from_min_max(pos2(100.0, 100.0), pos2(700.0, 600.0));
        let size = vec2(WIDTH, 90.0);
        for x in [101.0, 300.0, 520.0, 699.0] {
            for y in [101.0, 350.0, 599.0] {
                let place = beside_point(plot, pos2(x, y), size);
                assert!(plot.contains_rect(place), "{place} of {x} {y}");
                assert!(!place.contains(pos2(x, y)), "{place} over {x} {y}");
            }
        }
    }
}
