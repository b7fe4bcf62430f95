//! Handles that the operator drags: corners of the selected zone and points of the skyline.

use egui::{
    Align2, EventFilter, Key, Modifiers, PointerButton, Pos2, Response, Role, Sense, Stroke,
    StrokeKind, Ui, WidgetInfo, vec2,
};

use super::{
    super::{
        Chosen, HorizonState,
        draft::{Corner, Skies},
        edit::{self, place},
    },
    HANDLE, direction, label,
};
use crate::ui::{sky_plot::geometry::Dome, tokens::Tokens, widgets::paint};

/// Max number of skyline points with handles.
const MAX_HANDLES: usize = 120;
const CHOSEN: f32 = 12.0;
const MIDDLE: f32 = 7.0;
const POINT: f32 = 6.0;
/// Side of the area around a mark that the pointer grips, points.
const GRIP: f32 = 16.0;

pub(super) fn zone_handles(
    ui: &mut Ui,
    dome: Dome,
    index: usize,
    skies: &mut Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let Some(zone) = skies.zones.get_mut(index) else { return };
    for corner in 0..zone.corners.len() {
        let Some(middle) = zone.middle(corner) else { continue };
        let position = place(dome, middle);
        let name = format!("Middle of edge {} of {}", corner + 1, zone.name.trim());
        let response = handle(ui, ("middle", corner), position, &name);
        ui.painter().circle(position, MIDDLE / 2.0, t.bg0, Stroke::new(1.25, t.sat));
        if response.drag_started()
            && let Some(added) = zone.split(corner)
        {
            state.begin_drag(added, zone.corners.get(added).map(Corner::point));
            break;
        }
    }
    let count = zone.corners.len();
    let mut removed = None;
    let mut added = None;
    for number in 0..count {
        let Some(corner) = zone.corners.get(number) else { continue };
        let (azimuth_deg, elevation_deg) = corner.point();
        let position = place(dome, (azimuth_deg, elevation_deg));
        let words = direction((azimuth_deg, elevation_deg));
        let name = format!("Corner {} of {}, {words}", number + 1, zone.name.trim());
        let response = handle(ui, ("corner", number), position, &name);
        let is_chosen = state.corner == Some(number);
        if is_chosen {
            ui.painter().rect_filled(paint::square(position, CHOSEN), 0.0, t.sat);
            let side =
                if position.x > dome.centre.x { Align2::RIGHT_BOTTOM } else { Align2::LEFT_BOTTOM };
            let offset = vec2(if position.x > dome.centre.x { -12.0 } else { 12.0 }, -6.0);
            let words = format!("{words}\npoint {} of {count}", number + 1);
            label(ui, position + offset, side, &words, t.sat, t);
        } else {
            let stroke = Stroke::new(1.5, t.sat);
            ui.painter().rect(
                paint::square(position, HANDLE),
                0.0,
                t.bg0,
                stroke,
                StrokeKind::Inside,
            );
        }
        paint::focus_ring(ui, &response, 2);
        if response.clicked() || response.drag_started() {
            state.corner = Some(number);
            response.request_focus();
        }
        if response.drag_started() {
            state.begin_drag(number, Some((azimuth_deg, elevation_deg)));
        }
        if response.has_focus() {
            state.corner = Some(number);
            let (step, keys) = keys(ui, &response);
            if let Some((right, up)) = step
                && let Some(corner) = zone.corners.get_mut(number)
            {
                corner.azimuth.set(azimuth_deg + right);
                corner.elevation.set(elevation_deg + up);
            }
            removed = removed.or(keys.removes.then_some(number));
            added = added.or(keys.adds.then_some(number));
        }
    }
    if let Some(corner) = removed
        && zone.remove(corner)
    {
        state.corner = Some(corner.min(zone.corners.len().saturating_sub(1)));
    }
    if let Some(corner) = added.and_then(|corner| zone.split(corner)) {
        state.corner = Some(corner);
    }
}

pub(super) fn skyline_handles(
    ui: &mut Ui,
    dome: Dome,
    skies: &mut Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let mut points = skies.skyline();
    if points.len() > MAX_HANDLES {
        return;
    }
    let mut changed = None;
    for (index, point) in points.iter().enumerate() {
        let position = place(dome, *point);
        let name = format!("Skyline point {}, {}", index + 1, direction(*point));
        let response = handle(ui, ("skyline", index), position, &name);
        let is_chosen = state.corner == Some(index);
        let fill = if is_chosen { t.sat } else { t.bg0 };
        let stroke = Stroke::new(1.5, if is_chosen { t.sat } else { t.t2 });
        ui.painter().circle(position, POINT / 2.0, fill, stroke);
        paint::focus_ring(ui, &response, 2);
        if response.clicked() || response.drag_started() {
            state.corner = Some(index);
            response.request_focus();
        }
        if response.drag_started() {
            state.begin_drag(index, Some(*point));
        }
        if response.has_focus() {
            let (step, keys) = keys(ui, &response);
            let moved = step.map(|(right, up)| Some((point.0 + right, point.1 + up)));
            changed = changed.or(moved.or(keys.removes.then_some(None)).map(|end| (index, end)));
        }
    }
    if let Some((index, end)) = changed {
        match end {
            Some(end) => {
                if let Some(point) = points.get_mut(index) {
                    *point = end;
                }
            }
            None => {
                points.remove(index);
            }
        }
        skies.set_skyline(points);
    }
}

/// Draws a mark that the operator can drag, click and reach with Tab.
fn handle(ui: &Ui, salt: (&str, usize), position: Pos2, name: &str) -> Response {
    let rect = paint::square(position, GRIP);
    let response = ui.interact(rect, ui.make_persistent_id(salt), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    response
}

struct Keys {
    removes: bool,
    adds: bool,
}

/// Returns the step of an arrow key in degrees, and other pressed keys.
fn keys(ui: &Ui, response: &Response) -> (Option<(f64, f64)>, Keys) {
    let filter =
        EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    ui.input_mut(|input| {
        let mut step = None;
        for (modifiers, amount) in
            [(Modifiers::NONE, 0.5), (Modifiers::SHIFT, 5.0), (Modifiers::COMMAND, 0.1)]
        {
            for (key, right, up) in [
                (Key::ArrowLeft, -1.0, 0.0),
                (Key::ArrowRight, 1.0, 0.0),
                (Key::ArrowUp, 0.0, 1.0),
                (Key::ArrowDown, 0.0, -1.0),
            ] {
                if input.modifiers.matches_exact(modifiers) && input.consume_key(modifiers, key) {
                    step = Some((right * amount, up * amount));
                }
            }
        }
        let keys = Keys {
            removes: input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace),
            adds: input.key_pressed(Key::Insert),
        };
        (step, keys)
    })
}

/// Moves the dragged mark to the pointer.
pub(super) fn continue_drag(ui: &Ui, dome: Dome, skies: &mut Skies, state: &mut HorizonState) {
    let Some((index, start)) = state.drag else { return };
    let (position, is_down, shift) = ui.input(|input| {
        let pointer = &input.pointer;
        (pointer.interact_pos(), pointer.button_down(PointerButton::Primary), input.modifiers.shift)
    });
    if !is_down {
        state.drag = None;
        return;
    }
    let Some(position) = position else { return };
    let near = match state.chosen {
        Chosen::Zone(zone) => {
            let zone = skies.zones.get(zone);
            zone.and_then(|zone_draft| zone_draft.corners.get(index))
                .map_or(start.0, |corner| corner.azimuth.saved())
        }
        Chosen::Skyline | Chosen::Sun => start.0,
    };
    let mut end = edit::snapped(edit::position_under(dome, position, near), state.snaps);
    if shift {
        end = edit::along_one_axis(start, end);
    }
    match state.chosen {
        Chosen::Zone(zone) => {
            if let Some(zone) = skies.zones.get_mut(zone) {
                zone.put(index, end);
            }
        }
        Chosen::Skyline | Chosen::Sun => {
            let mut points = skies.skyline();
            if let Some(point) = points.get_mut(index) {
                *point = end;
            }
            if skies.set_skyline(points) {
                // Points stay in the order of their azimuths.
                let azimuth_deg = end.0.rem_euclid(360.0);
                let place =
                    skies.skyline().iter().position(|vertex| (vertex.0 - azimuth_deg).abs() < 1e-9);
                state.drag = place.map(|place| (place, start));
                state.corner = place;
            }
        }
    }
}
